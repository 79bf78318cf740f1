"""What is asked of a contact of the study of the finite sphere, and how that ended; both as plain data for the disk."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Literal

from halfspace.errors import InputError
from halfspace.values import Estimate

Status = Literal["solved", "refused", "died", "left out"]
InputName = Literal["tabor", "radius_ratio", "poisson"]
Values = Mapping[str, Estimate]

CRITICAL = "critical_tabor"
APPROACH_SCALE = "approach_scale"  # in eps, of a whole curve: see `halfspace.equilibrium.events.approach_scale`
QUANTITIES = {
    "pull_off_load": "R dgamma",
    "jump_on_approach": "eps",
    "jump_on_load": "R dgamma",
    "jump_off_approach": "eps",
    "jump_off_load": "R dgamma",
    "hysteresis": "R dgamma eps",
    "zero_load_radius": "beta",
}
"""Quantities of a curve and their units; hysteresis is the energy lost in a cycle under fixed grips."""

STORED: Mapping[str, Status] = {"solved": "solved", "refused": "refused"}  # endings that are kept for the next run


@dataclass(frozen=True)
class Case:
    """One contact under one set of assumptions; an input on which they do not depend is None.

    Attributes
    ----------
    model : str
        The assumptions, a key of `fem_adhesion.finite_sphere.cases.MODELS`.
    tabor : float or None
        Tabor parameter.
    radius_ratio : float or None
        R/eps.
    poisson : float or None
        Poisson's ratio.
    rtol : float
        Relative accuracy asked of the solver.
    """

    model: str
    tabor: float | None = None
    radius_ratio: float | None = None
    poisson: float | None = None
    rtol: float = 1e-5

    @property
    def name(self) -> str:
        """For the eye."""
        parts = (("tabor", self.tabor), ("R/eps", self.radius_ratio), ("poisson", self.poisson))
        return ", ".join([self.model, *(f"{word} {value:g}" for word, value in parts if value is not None)])

    def given(self, name: InputName) -> float:
        """Input of a model that depends on it, or InputError if the case has none."""
        inputs = {"tabor": self.tabor, "radius_ratio": self.radius_ratio, "poisson": self.poisson}
        value = inputs[name]
        if value is None:
            raise InputError(f"{name} = None for the model {self.model}, limit: a number; give it")
        return value


@dataclass(frozen=True)
class Record:
    """How a case ended.

    Attributes
    ----------
    case : Case
        What was asked.
    status : str
        ``solved``; ``refused`` by the solver; ``died`` with the process that worked on it; ``left out`` beforehand, as
        beyond the limits of the solver.
    values : mapping of str to Estimate
        Quantities in the units of `QUANTITIES`, with the estimated bounds of their errors; those that the contact does
        not have, as the jumps of a hard one, are absent.
    reason : str
        Why it is not solved, or empty.
    seconds : float
        Wall time.
    kind : str
        Which error the reason is of, as ``ContactTooWide``; empty if it is solved or died.
    """

    case: Case
    status: Status
    values: Values = field(default_factory=dict)
    reason: str = ""
    seconds: float = 0.0
    kind: str = ""

    @property
    def failed(self) -> bool:
        """Whether it was tried and has no solution."""
        return self.status in ("refused", "died")


@dataclass(frozen=True)
class Study:
    """All records of a study.

    Attributes
    ----------
    records : sequence of Record
        With those that were left out.
    quick : bool
        Whether it was done at few points and a lower accuracy.
    """

    records: Sequence[Record]
    quick: bool = False

    @property
    def failed(self) -> tuple[Record, ...]:
        """Cases that were tried and have no solution."""
        return tuple(record for record in self.records if record.failed)

    @property
    def left_out(self) -> tuple[Record, ...]:
        """Cases that were not tried."""
        return tuple(record for record in self.records if record.status == "left out")


def to_plain(record: Record) -> dict[str, object]:
    """Contents of a record but for its case, as JSON can hold them."""
    return {key: value for key, value in asdict(record).items() if key != "case"}


def from_plain(case: Case, plain: Mapping[str, object]) -> Record:
    """Record of a case from what `to_plain` made.

    Raises
    ------
    InputError
        If that is not what it is: a key is missing, a number is none or not finite, a status or quantity is unknown.
    """
    match plain:
        case {
            "status": str(status),
            "values": dict(values),
            "reason": str(reason),
            "seconds": float(seconds),
            "kind": str(kind),
        } if status in STORED and (status == "refused") == bool(kind) and (status == "solved") != bool(reason):
            found = {str(name): _estimate(str(name), pair) for name, pair in values.items()}
            return Record(case, STORED[status], found, reason, seconds, kind)
    raise InputError("it is no record of a case")


def _estimate(name: str, pair: object) -> Estimate:
    known = name in (*QUANTITIES, CRITICAL, APPROACH_SCALE)
    match pair:
        case {"value": float(value), "error": float(error)} if known and math.isfinite(value) and 0 <= error < math.inf:
            return Estimate(value, error)
    raise InputError(f"its {name} is no number with an error")
