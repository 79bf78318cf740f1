"""What one case of the study of the finite sphere computes, and how it is recorded.

Between a paraboloid on a half-space and a true elastic sphere lie several assumptions. A case is a contact under one
set of them; two that differ in one assumption tell what it does. Cases and records are plain data for the disk, too.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from itertools import product
from typing import Any, Literal

import halfspace
from fem_adhesion.bodies.body import Discretisation, GripName
from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.common.fold_birth import FIRST, Birth, NoBirth, born, tabor_of
from fem_adhesion.convergence import trace
from fem_adhesion.discretise import sized_body
from fem_adhesion.finite_strain.scene import find_jumps, require_well_posed
from fem_adhesion.materials import AreaName, LinearElastic, NeoHookean, TractionName
from fem_adhesion.scene import Scene
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import FOLDS, Event, usual
from halfspace.equilibrium.newton import Traceable
from halfspace.errors import InputError, Unsolved, tried
from halfspace.limits import SMALLEST_SPHERE
from halfspace.profiles import PARABOLOID, Profile, Sphere
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


@dataclass(frozen=True)
class SphereCase:
    """One contact under one set of assumptions, a key of `MODELS`; an input on which they do not depend is None.

    Its inputs are the Tabor parameter, R/eps and Poisson's ratio; `rtol` is what is asked of the solver.
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
        value: float | None = getattr(self, name)
        if value is None:
            raise InputError(f"{name} = None for the model {self.model}, limit: a number; give it")
        return value


@dataclass(frozen=True)
class Record:
    """How a case ended.

    The status is ``solved``; ``refused`` by the solver; ``died`` with the process that worked on it; ``left out``
    beforehand, as beyond the limits of the solver. Values are in the units of `QUANTITIES`; those that the contact does
    not have, as the jumps of a hard one, are absent. Reason and kind say why it is not solved, and which error says so,
    as ``ContactTooWide``; empty if it is solved, the kind if it died. Seconds are wall time.
    """

    case: SphereCase
    status: Status
    values: Values = field(default_factory=dict)
    reason: str = ""
    seconds: float = 0.0
    kind: str = ""

    @property
    def failed(self) -> bool:
        """Whether it was tried and has no solution."""
        return self.status in ("refused", "died")


def to_plain(record: Record) -> dict[str, object]:
    """Contents of a record but for its case, as JSON can hold them."""
    return {key: value for key, value in asdict(record).items() if key != "case"}


def from_plain(case: SphereCase, plain: Mapping[str, Any]) -> Record:
    """Record of a case from what `to_plain` made."""
    values = {name: Estimate(**number) for name, number in plain["values"].items()}
    return Record(case, **{**plain, "values": values})


TO_LOAD = 0.5  # R dgamma: past every event, and little, since a sphere is no wider than it is


@dataclass(frozen=True)
class Model:
    """A set of assumptions: what solves a case, or raises InputError or NotConverged; the inputs on which it depends.

    `grip` is what holds the body, none for the half-space; `check` refuses a case beyond limits that only this model
    has.
    """

    solve: Callable[[SphereCase], Values]
    inputs: tuple[InputName, ...]
    grip: GripName | None = None
    check: Callable[[SphereCase], None] = lambda _: None


def compute(case: SphereCase) -> Record:
    """Solve a case; one that the solver refuses or does not solve is recorded with the kind of its error and reason.

    Any other error is a defect of the program and ends the study.
    """
    began = time.perf_counter()
    values = tried(MODELS[case.model].solve, case, refusals=True)
    seconds = time.perf_counter() - began
    if isinstance(values, Unsolved):
        return Record(case, "refused", {}, values.reason, seconds, values.kind.__name__)
    return Record(case, "solved", values, "", seconds)


def quantities_of(path: EquilibriumPath) -> dict[str, Estimate]:
    """Quantities of a traced curve."""
    pull_off, zero_load = path.events["pull_off"], path.events["zero_load"]
    values = {
        "pull_off_load": pull_off.estimate("load"),
        "zero_load_radius": zero_load.estimate("contact_radius"),
        APPROACH_SCALE: Estimate(path.approach_scale, 2 * max(e.approach_error for e in usual(path.events).values())),
    }
    values |= _jumps(path.events)
    if grips := cycle(path):
        values["hysteresis"] = grips.energy_lost
    return values


def _jumps(events: Mapping[str, Event]) -> dict[str, Estimate]:
    """Approach and load of the jumps that there are."""
    found = product((name for name in FOLDS if name in events), ("approach", "load"))
    return {f"{name}_{number}": events[name].estimate(number) for name, number in found}


def _half_space(case: SphereCase, *, true_profile: bool = False) -> Values:
    """A half-space under a sphere, or a paraboloid, which is the reference."""
    profile = Sphere(case.given("radius_ratio")) if true_profile else PARABOLOID
    return quantities_of(halfspace.trace(case.given("tabor"), profile=profile, rtol=case.rtol, to_load=TO_LOAD))


def hemisphere(
    case: SphereCase, *, profile: Profile | None = None, grip: GripName = "sliding", traction: AreaName = "projected"
) -> Scene:
    """Elastic hemisphere of a case, held at its mid-plane."""
    material = LinearElastic(case.given("poisson"), traction)
    body = Hemisphere(radius_ratio=case.given("radius_ratio"), grip=grip, material=material)
    return Scene(case.given("tabor"), body, profile)


def _elastic(case: SphereCase, **how: Any) -> Values:
    """A linear hemisphere; `how` as of `hemisphere`."""
    return quantities_of(trace(hemisphere(case, **how), rtol=case.rtol, to_load=TO_LOAD))


def _neo_hookean(case: SphereCase, traction: TractionName) -> Scene:
    return hemisphere(case).made_of(NeoHookean(case.given("poisson"), traction))


def _finite_strain(case: SphereCase, traction: TractionName) -> Values:
    """A neo-Hookean hemisphere: pull-off and jumps only; a finer tolerance is dear, and the effect is some beta/R."""
    events = find_jumps(_neo_hookean(case, traction), max(case.rtol, 1e-4))
    return {"pull_off_load": events["pull_off"].estimate("load")} | _jumps(events)


def _well_posed(case: SphereCase, traction: TractionName) -> None:
    """InputError unless the equations are, for a way to count the traction and for the default beside it."""
    for name in (traction, NeoHookean().traction):
        require_well_posed(_neo_hookean(case, name))


def _first_jump(case: SphereCase, degrees: tuple[int, int] = (5, 6)) -> Values:
    """Tabor parameter from which on a hemisphere jumps under fixed grips; none if none that is large enough does.

    That of every sphere, small or bonded, is between 0.4 and 1.25. It is solved for with elements of two degrees.
    """
    largest = (1 - 1e-9) * case.given("radius_ratio") / SMALLEST_SPHERE  # not beyond it by rounding
    birth = Birth((0.4, min(1.25, largest)), FIRST.gaps, FIRST.falling)

    def at(degree: int) -> float:
        def problem(mu: float) -> Traceable:  # its elements fine on the axis
            return sized_body(hemisphere(replace(case, tabor=mu)), Discretisation(degree)).centred().problem

        return born(birth, problem)

    try:
        return {CRITICAL: Estimate.refined(*map(at, degrees))}
    except NoBirth:
        return {}


def _first_jump_half_space(case: SphereCase) -> Values:
    """The same of the half-space under a paraboloid."""
    coarse, fine = (tabor_of(FIRST, rtol=rtol) for rtol in (case.rtol, case.rtol / 100))
    return {CRITICAL: Estimate.refined(coarse, fine)}


SPHERE: tuple[InputName, ...] = ("tabor", "radius_ratio", "poisson")
TRACTIONS: Mapping[str, TractionName] = {
    "finite_strain": "projected",
    "finite_strain_normal": "normal",
    "finite_strain_reference": "reference",
}
MODELS: Mapping[str, Model] = {
    "half_space": Model(_half_space, ("tabor",)),
    "true_profile": Model(partial(_half_space, true_profile=True), ("tabor", "radius_ratio")),
    "finite_body": Model(partial(_elastic, profile=PARABOLOID), SPHERE, "sliding"),
    "sphere": Model(_elastic, SPHERE, "sliding"),
    "bonded": Model(partial(_elastic, grip="bonded"), SPHERE, "bonded"),
    "surface_traction": Model(partial(_elastic, traction="surface"), SPHERE, "sliding"),
    **{
        name: Model(
            partial(_finite_strain, traction=traction), SPHERE, "sliding", partial(_well_posed, traction=traction)
        )
        for name, traction in TRACTIONS.items()
    },
    "first_jump": Model(_first_jump, ("radius_ratio", "poisson"), "sliding"),
    "first_jump_half_space": Model(_first_jump_half_space, ()),
}


def case_of(
    model: str, tabor: float | None, radius_ratio: float | None, poisson: float | None, rtol: float
) -> SphereCase:
    """SphereCase of a model at a point, without the inputs on which it does not depend."""
    given: Mapping[InputName, float | None] = {"tabor": tabor, "radius_ratio": radius_ratio, "poisson": poisson}
    needed = MODELS[model].inputs
    return SphereCase(model, **{name: value for name, value in given.items() if name in needed}, rtol=rtol)
