"""What one case of the study of the finite sphere computes, and which difference of two cases isolates which cause.

Between a paraboloid on a half-space and a true elastic sphere lie several assumptions. A case is a contact under one
set of them; two that differ in one assumption tell what it does.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import Literal, cast

import halfspace
from fem_adhesion import Scene, trace
from fem_adhesion.finite_strain_scene import find_jumps
from fem_adhesion.finite_strain_traction import ConventionName
from halfspace.curve import EquilibriumPath, Estimate
from halfspace.devices import cycle
from halfspace.errors import InputError, NotConverged
from halfspace.events import Event

FINITE_STRAIN_RTOL = 1e-4  # the tightest: a finer one is dear, and the effect is of the order of beta/R
TO_LOAD = 0.5  # R dgamma: past every event, and little, since a sphere is no wider than it is

Status = Literal["solved", "refused", "died"]
ProfileName = Literal["paraboloid", "sphere"]
GripName = Literal["sliding", "bonded"]
TractionName = Literal["projected", "surface"]
Values = Mapping[str, Estimate]


@dataclass(frozen=True)
class Case:
    """One contact under one set of assumptions; an input on which they do not depend is None.

    Attributes
    ----------
    model : str
        The assumptions, a key of `MODELS`.
    tabor : float
        Tabor parameter.
    radius_ratio : float or None
        R/eps.
    poisson : float or None
        Poisson's ratio.
    rtol : float
        Relative accuracy asked of the solver.
    """

    model: str
    tabor: float
    radius_ratio: float | None = None
    poisson: float | None = None
    rtol: float = 1e-5

    @property
    def name(self) -> str:
        """For the eye."""
        parts = (("tabor", self.tabor), ("R/eps", self.radius_ratio), ("poisson", self.poisson))
        return ", ".join([self.model, *(f"{word} {value:g}" for word, value in parts if value is not None)])


@dataclass(frozen=True)
class Record:
    """How a case ended.

    Attributes
    ----------
    case : Case
        What was asked.
    status : str
        ``solved``; ``refused`` by the solver; ``died`` with the process that worked on it.
    values : mapping of str to Estimate
        Quantities in the units of `QUANTITIES`, with the estimated bounds of their errors; those that the contact does
        not have, as the jumps of a hard one, are absent.
    reason : str
        Why it is not solved, or empty.
    seconds : float
        Wall time.
    """

    case: Case
    status: Status
    values: Values = field(default_factory=dict)
    reason: str = ""
    seconds: float = 0.0


@dataclass(frozen=True)
class Model:
    """A set of assumptions.

    Attributes
    ----------
    solve : callable
        Computes the quantities of a case; raises InputError or NotConverged where there are none.
    inputs : tuple of str
        Those of ``radius_ratio`` and ``poisson`` on which it depends.
    grip : str, optional
        What holds the body; none for the half-space.
    """

    solve: Callable[[Case], Values]
    inputs: tuple[str, ...] = ()
    grip: str | None = None


@dataclass(frozen=True)
class Cause:
    """An assumption: the model that drops it less the one that makes it.

    Attributes
    ----------
    model, baseline : str
        Keys of `MODELS`.
    meaning : str
        What is switched, in words.
    """

    model: str
    baseline: str
    meaning: str


QUANTITIES = {
    "pull_off_load": "R dgamma",
    "jump_on_approach": "eps",
    "jump_on_load": "R dgamma",
    "jump_off_approach": "eps",
    "jump_off_load": "R dgamma",
    "hysteresis": "R dgamma eps",
    "zero_load_radius": "beta",
}
"""Quantities and their units; hysteresis is the energy lost in a cycle under fixed grips."""


def compute(case: Case) -> Record:
    """Solve a case; one that cannot be solved is recorded with the solver's reason."""
    began = time.perf_counter()
    try:
        values = MODELS[case.model].solve(case)
    except (InputError, NotConverged) as error:
        return Record(case, "refused", {}, str(error), time.perf_counter() - began)
    return Record(case, "solved", values, "", time.perf_counter() - began)


def quantities_of(path: EquilibriumPath) -> dict[str, Estimate]:
    """Quantities of a traced curve."""
    pull_off, zero_load = path.events["pull_off"], path.events["zero_load"]
    values = {
        "pull_off_load": Estimate(pull_off.load, pull_off.load_error),
        "zero_load_radius": Estimate(zero_load.contact_radius, zero_load.contact_radius_error),
    }
    values |= _jumps(path.events)
    if grips := cycle(path):
        values["hysteresis"] = grips.energy_lost
    return values


def _jumps(events: Mapping[str, Event]) -> dict[str, Estimate]:
    """Approach and load of the jumps that there are."""
    values = {}
    for name in ("jump_on", "jump_off"):
        if jump := events.get(name):
            values[f"{name}_approach"] = Estimate(jump.approach, jump.approach_error)
            values[f"{name}_load"] = Estimate(jump.load, jump.load_error)
    return values


def _half_space(case: Case) -> dict[str, Estimate]:
    """Reference: a paraboloid on a half-space."""
    return quantities_of(halfspace.trace(case.tabor, rtol=case.rtol, to_load=TO_LOAD))


def _true_profile(case: Case) -> dict[str, Estimate]:
    """A half-space under a sphere."""
    ratio = case.radius_ratio
    return quantities_of(halfspace.trace(case.tabor, rtol=case.rtol, to_load=TO_LOAD, radius_ratio=ratio))


def _hemisphere(
    case: Case, *, profile: ProfileName = "sphere", grip: GripName = "sliding", traction: TractionName = "projected"
) -> dict[str, Estimate]:
    """An elastic hemisphere, held at its mid-plane."""
    assert case.poisson is not None
    scene = Scene(
        case.tabor,
        poisson=case.poisson,
        body="hemisphere",
        profile=profile,
        radius_ratio=case.radius_ratio,
        grip=grip,
        traction=traction,
    )
    return quantities_of(trace(scene, rtol=case.rtol, to_load=TO_LOAD))


def _finite_strain(case: Case, convention: ConventionName) -> dict[str, Estimate]:
    """A neo-Hookean hemisphere: pull-off and jumps only, to a tolerance of 1e-4 or more."""
    assert case.poisson is not None
    ratio = case.radius_ratio
    scene = Scene(
        case.tabor, poisson=case.poisson, body="hemisphere", profile="sphere", radius_ratio=ratio, strain="finite"
    )
    events = find_jumps(scene, max(case.rtol, FINITE_STRAIN_RTOL), convention=convention)
    pull_off = events["pull_off"]
    return {"pull_off_load": Estimate(pull_off.load, pull_off.load_error)} | _jumps(events)


BOTH = ("radius_ratio", "poisson")

MODELS = {
    "half_space": Model(_half_space),
    "true_profile": Model(_true_profile, ("radius_ratio",)),
    "finite_body": Model(partial(_hemisphere, profile="paraboloid"), BOTH, "sliding"),
    "sphere": Model(_hemisphere, BOTH, "sliding"),
    "bonded": Model(partial(_hemisphere, grip="bonded"), BOTH, "bonded"),
    "surface_traction": Model(partial(_hemisphere, traction="surface"), BOTH, "sliding"),
    "finite_strain": Model(partial(_finite_strain, convention="vertical"), BOTH, "sliding"),
    "finite_strain_normal": Model(partial(_finite_strain, convention="normal"), BOTH, "sliding"),
    "finite_strain_reference": Model(partial(_finite_strain, convention="reference"), BOTH, "sliding"),
}

CAUSES = {
    "profile": Cause("true_profile", "half_space", "sphere for paraboloid, on the half-space"),
    "body": Cause("finite_body", "half_space", "hemisphere for half-space, under the paraboloid"),
    "all": Cause("sphere", "half_space", "hemisphere on a sliding mid-plane, with the sphere's profile"),
    "grip": Cause("bonded", "sphere", "bonded for sliding mid-plane"),
    "traction": Cause("surface_traction", "sphere", "surface law per true for per projected area"),
    "strain": Cause("finite_strain", "sphere", "neo-Hookean for linear, traction vertical per deformed area"),
    "direction": Cause("finite_strain_normal", "finite_strain", "traction normal to the deformed surface for vertical"),
    "area": Cause("finite_strain_reference", "finite_strain", "vertical traction per undeformed for per deformed area"),
}


def case_of(model: str, tabor: float, radius_ratio: float | None, poisson: float | None, rtol: float) -> Case:
    """Case of a model at a point, without the inputs on which it does not depend."""
    needed = MODELS[model].inputs
    ratio = radius_ratio if "radius_ratio" in needed else None
    return Case(model, tabor, ratio, poisson if "poisson" in needed else None, rtol)


def to_plain(record: Record) -> dict[str, object]:
    """Contents of a record but for its case, as JSON can hold them."""
    return {key: value for key, value in asdict(record).items() if key != "case"}


def from_plain(case: Case, plain: Mapping[str, object]) -> Record:
    """Record of a case from what `to_plain` made, or InputError if that is not what it is."""
    try:
        values = {name: Estimate(**pair) for name, pair in cast(dict[str, dict[str, float]], plain["values"]).items()}
        status, reason = cast(Status, plain["status"]), str(plain["reason"])
        return Record(case, status, values, reason, float(cast(float, plain["seconds"])))
    except (KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{plain} is no record of a case; compute it again") from error
