"""The load-approach curve of one contact by the solvers asked for, its jumps, and the units in which it is shown."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import halfspace
from fem_adhesion import convergence
from fem_adhesion.common.jobs import Progress, in_turn, unheard
from fem_adhesion.common.numbers import PREFIXES, exponent_of
from fem_adhesion.common.record import UNITS
from fem_adhesion.scene import Scene
from halfspace.accuracy.kernels import require_kernel
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, cycle
from halfspace.errors import InputError
from halfspace.limits import require_load, require_points, require_rtol
from halfspace.scales import Scales
from halfspace.scaling import Units
from halfspace.values import Array

HALF_SPACE, FINITE_ELEMENTS, WEAK_FORM = "half-space", "finite elements", "weak form"
SolverName = Literal["half-space", "fem", "both", "weak-form"]
SOLVERS: Mapping[SolverName, tuple[str, ...]] = {
    "half-space": (HALF_SPACE,),
    "fem": (FINITE_ELEMENTS,),
    "both": (FINITE_ELEMENTS, HALF_SPACE),
    "weak-form": (WEAK_FORM,),
}


@dataclass(frozen=True)
class Question:
    """What is asked of a contact.

    Of a body that is neither a half-space nor layers the integral equation solves the half-space under the same
    profile, so that it serves for comparison only: `Curves.left_out` says what is missing.

    `rtol` is the relative accuracy asked of loads and approaches, 1e-9 to 1e-1; the curve ends at a compressive load in
    R dgamma; units are of the contact in SI, if its material is known; the stiffness is that of the apparatus in
    R dgamma/eps, infinite for fixed grips. Each curve has so many points in files, evenly spaced in arclength; as many
    as its tracing takes unless given, or drawn. The kernel is that of `halfspace.trace`.

    InputError if a value is out of range, or the solver does not serve the scene.
    """

    scene: Scene
    solver: SolverName = "half-space"
    rtol: float = 1e-5
    to_load: float = 5.0
    units: Units | None = None
    stiffness: float = math.inf
    points: int | None = None
    kernel: str = "panels"

    def __post_init__(self) -> None:
        require_rtol(self.rtol)
        scene = self.scene
        surface = scene.shape.surface(scene.tabor)
        require_kernel(self.kernel, Scales(scene.tabor, scene.law, surface, scene.body.layered), self.rtol)
        require_load(self.to_load)
        if self.points is not None:
            require_points(self.points)
        if not self.stiffness > 0:
            raise InputError(
                f"stiffness = {self.stiffness:g} R dgamma/eps is outside 0 < stiffness; leave it out for fixed grips"
            )
        if self.solver == "half-space" and self.scene.left_out:
            raise InputError(
                f"solver = half-space does not serve body = {self.scene.body.name}, limit: a half-space or layers; "
                "take fem or both"
            )


@dataclass(frozen=True)
class Curves:
    """Curves of what was asked of a contact.

    The paths are by solver, `FINITE_ELEMENTS` first if it was asked: each an `EquilibriumPath`, or by the weak form a
    `fem_adhesion.weak_form.curve.Curve`, which has points and events alone. `grips` and `apparatus` are the jumps on
    the first path under fixed grips and with the apparatus, if the contact jumps; with fixed grips there is no
    apparatus.
    """

    question: Question
    paths: Mapping[str, Any]
    grips: Cycle | None = None
    apparatus: Cycle | None = None

    @property
    def path(self) -> EquilibriumPath:
        """The first path, whose states and jumps are shown."""
        path: EquilibriumPath = next(iter(self.paths.values()))
        return path

    @property
    def solver(self) -> str:
        """What the first path was solved with."""
        return next(iter(self.paths))

    @property
    def sampled(self) -> Mapping[str, Any]:
        """The paths with the number of points asked for."""
        points = self.question.points
        return {
            name: path if points is None or path.count == points else path.resampled(points)
            for name, path in self.paths.items()
        }

    def left_out(self, solver: str) -> list[str]:
        """What a solver was not given of the scene, in words."""
        return self.question.scene.left_out if solver == HALF_SPACE else []

    def missed(self, solver: str) -> dict[str, tuple[str, ...]]:
        """By event, and by end of a jump on the first path, the numbers that miss the tolerance."""
        cycles = {"fixed grips": self.grips, "apparatus": self.apparatus} if solver == self.solver else {}
        jumps = {f"{name}, {device},": m for device, c in cycles.items() if c for name, m in c.missed.items()}
        missed: dict[str, tuple[str, ...]] = self.paths[solver].missed | jumps
        return missed

    @property
    def other(self) -> EquilibriumPath | None:
        """The second path."""
        return self.paths.get(HALF_SPACE) if self.solver == FINITE_ELEMENTS else None

    @cached_property
    def scales(self) -> Mapping[str, Scale]:
        """Scale of each quantity, with the prefix that suits the largest of its values at events and jumps."""
        units = self.question.units
        if units is None:
            return PAPER
        largest, scales = _largest(self), {}
        for name, paper in PAPER.items():
            size, unit = units.si(name)
            exponent = exponent_of(size * largest.get(ALIKE.get(name, name), 1.0))
            shown = PREFIXES[exponent] + unit
            scales[name] = Scale(f"{paper.in_si}, {shown}", shown, size=size * 10.0**-exponent)
        return scales

    def shown(self, **values: Array | float) -> list[Any]:
        """Quantities by their names, in the units in which they are shown."""
        return [value * self.scales[name].size for name, value in values.items()]


def solve(question: Question, progress: Progress = unheard) -> Curves:
    """Trace the curve by each solver asked for, and find its jumps, or raise NotConverged."""
    names, points = SOLVERS[question.solver], question.points
    if names == (WEAK_FORM,):
        from fem_adhesion.weak_form.curve import trace as by_weak_form  # here, as few curves need it

        return Curves(question, {WEAK_FORM: by_weak_form(question.scene, question.rtol, to_load=question.to_load)})
    paths, begin = {}, in_turn(progress, len(names) + 1)
    for name in names:
        begin(name)
        path = trace(question, name)
        paths[name] = path.resampled(points) if points and points > path.count else path
    begin("jumps")
    path = paths[names[0]]
    apparatus = None if math.isinf(question.stiffness) else cycle(path, question.stiffness)
    return Curves(question, paths, cycle(path), apparatus)


def trace(question: Question, solver: str) -> EquilibriumPath:
    """Trace the curve by one solver."""
    scene, rtol, to_load = question.scene, question.rtol, question.to_load
    if solver == FINITE_ELEMENTS:
        return convergence.trace(scene, rtol=rtol, to_load=to_load)
    return halfspace.trace(**scene.for_half_space, kernel=question.kernel, rtol=rtol, to_load=to_load)


@dataclass(frozen=True)
class Scale:
    """Unit in which a quantity is shown, and the size by which the dimensionless one is multiplied in it.

    The label is that of an axis, with symbol and unit; of the paper's also that `in_si`, without one.
    """

    label: str
    unit: str
    in_si: str = ""
    size: float = 1.0


PAPER: Mapping[str, Scale] = {
    "approach": Scale(r"approach $\alpha^* = \alpha/\epsilon$", UNITS["approach"], r"approach $\alpha$"),
    "load": Scale(r"load $W/R\Delta\gamma$", UNITS["load"], "load $W$"),
    "central_gap": Scale(r"central gap $H(0)$", UNITS["central_gap"], r"central gap $h(0) - \epsilon$"),
    "gap": Scale(r"gap $H = h/\epsilon - 1$", "eps", r"gap $h - \epsilon$"),
    "contact_radius": Scale(r"contact radius $a/\beta$", UNITS["contact_radius"], "contact radius $a$"),
    "radius": Scale(r"radius $u = r/\beta$", "beta", "radius $r$"),
    "pressure": Scale(r"pressure $P = \mu\epsilon p/\Delta\gamma$", "dgamma/(mu eps)", "pressure $p$"),
    "energy": Scale(r"energy $E/R\Delta\gamma\epsilon$", UNITS["energy"], "energy $E$"),
    "stiffness": Scale(r"stiffness $k\epsilon/R\Delta\gamma$", UNITS["stiffness"], "stiffness $k$"),
}

ALIKE: Mapping[str, str] = {"gap": "central_gap", "radius": "contact_radius"}  # quantities with the prefix of another


def _largest(curves: Curves) -> Mapping[str, float]:
    """Largest size of what a table of events shows, in dimensionless units; what is not known is left out."""
    states = [event for path in curves.paths.values() for event in path.events.values()]
    cycles = [cycle for cycle in (curves.grips, curves.apparatus) if cycle]
    states += [state for cycle in cycles for jump in cycle.jumps.values() for state in jump.ends]
    sizes = {name: [abs(getattr(state, name)) for state in states] for name in OBSERVABLES}
    sizes["energy"] = [abs(cycle.energy_lost.value) for cycle in cycles]
    known = {name: [size for size in found if math.isfinite(size) and size] for name, found in sizes.items()}
    return {name: max(found) for name, found in known.items() if found}
