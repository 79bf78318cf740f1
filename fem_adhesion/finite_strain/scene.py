"""A sphere at finite strain: its load-approach curve to an accuracy asked for, on meshes fine where the contact is."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from functools import partial

import numpy as np

from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.discretise import ELEMENTS, FAR_FIELDS, finest_length, layout_of, meshes_of, quadrilateral, sized_body
from fem_adhesion.elasticity.cells import projects
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain.body import material_body
from fem_adhesion.finite_strain.problem import FiniteStrainProblem, finite_strain_problem
from fem_adhesion.finite_strain.settings import USUAL, Settings
from fem_adhesion.finite_strain.traction import convention_of
from fem_adhesion.materials import LinearElastic, NeoHookean, TractionName
from fem_adhesion.scene import Scene
from halfspace.accuracy.grids import GRIDS
from halfspace.accuracy.refinement import ascend, climb
from halfspace.accuracy.stages import Rung, State, on_all
from halfspace.accuracy.standing import Standing, WhereAsked
from halfspace.elastic import grid
from halfspace.equilibrium.charts import COMPRESSION, Chart, metric_for, moved, trace_charts, transfer
from halfspace.equilibrium.conditions import Located, relocate
from halfspace.equilibrium.contact import APPROACH, LOAD, OBSERVABLES
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import REMAINING, ErrorRule, Event
from halfspace.equilibrium.newton import Traceable
from halfspace.equilibrium.search import find_events
from halfspace.errors import ContactTooWide, IllPosed, InputError, NotConverged, Unsolved
from halfspace.limits import require_load, require_rtol
from halfspace.values import Array, Valued

WIDEST_TABOR = 3.0  # limit of the Tabor parameter for a whole curve: its points grow as the square
TIGHTEST = 1e-6  # limit of the relative tolerance
LITTLE = 0.5  # R dgamma: a load past every event
FARTHEST = 0.98  # undeformed radius in R up to which a contact may spread; small slopes end before
JUMPS = ("pull_off", "jump_on", "jump_off")
CONSERVATIVE: tuple[TractionName, ...] = ("projected", "reference", "normal")


def trace(
    scene: Scene, rtol: float = 1e-4, to_load: float = COMPRESSION, settings: Settings = USUAL
) -> EquilibriumPath:
    """Trace the load-approach curve of a scene at finite strain and solve for its events.

    The scene is a hemisphere of Tabor parameter 3 or less, `rtol` the relative accuracy asked of loads and approaches,
    1e-6 to 1e-1, and `to_load` the compressive load at which the curve ends, in R dgamma. InputError if one is out of
    range, or does not go with finite strain; NotConverged if the curve or an event is lost, as where the material is
    squeezed or torn beyond what Newton's method follows.

    Where strains are small the curve is that of the linear body, whose events are the starts for those at finite
    strain, and its points are solved for at finite strain when they are asked for. Each event has a mesh of its own,
    and another of other cells for elements one degree lower; its error estimate is twice the change from that to the
    event's own, and more where the tension ends by a step. Its spread is that between the tractions that have an
    energy. The energy is nan with the vertical traction, which has none; stability is as said at
    `FiniteStrainProblem.negative_directions`.
    """
    _require(scene, rtol, to_load)
    if scene.tabor > WIDEST_TABOR:
        raise InputError(
            f"tabor = {scene.tabor:g} is outside tabor <= {WIDEST_TABOR:g} for a curve at finite strain; "
            "take LinearElastic"
        )
    began = time.perf_counter()
    rung = partial(Stages(scene, settings).rung, rtol, to_load)
    with _cause_told(scene, settings):
        path = climb(rtol, rung, to_load=to_load, most_rungs=settings.most_rungs)
        _require_no_needle(path.stages[-1])
    made = {**path.settings, "traction": scene.material.traction}
    apart = partial(_apart, scene, path.stages[-2])
    return replace(path, model_uncertainty=apart, settings=made, seconds=time.perf_counter() - began)


@dataclass(frozen=True, eq=False, repr=False)
class Stages(Valued):
    """Discretisations of a hemisphere at finite strain by elements of every degree, each made when first asked for."""

    scene: Scene
    settings: Settings = USUAL
    along: dict[int, Windows] = field(default_factory=dict, compare=False, repr=False)

    def rung(self, rtol: float, to_load: float, level: int) -> Rung:
        """Rung of a level: the degree and, from the second level on, other cells of the degree below before it.

        On the lowest level events come from the curve of the linear body, where strains are small, and are solved for
        at finite strain on the cells of the second level. Where the linear body does not have them, the curve of a
        higher level is traced at finite strain.

        Where the tension ends by a step, in whichever cell that is, a degree more may gain no more than a factor of 2.
        One chain has no twin beside it: the shift of an event along the path counts, see `ErrorRule.along`.
        """
        degree = _lowest_degree(rtol, self.scene.tabor) + max(level, 1)
        linear = not level and nearly_linear(self.scene, to_load, self.settings)
        at_finite_strain = partial(self.charts, degree - 1, to_load)
        curve = partial(linear_charts, self.scene, to_load) if linear else at_finite_strain
        other, body = self.body(degree - 1, *GRIDS.twin[:2]), self.body(degree)
        bodies = [other] if not level else [body] if level == 1 else [other, body]
        stages = tuple(Raising(one, partial(Stages.windows, self, one.how.degree)) for one in bodies)
        left, parts = REMAINING / self.scene.scales.gradual, (1.0, self.settings.other_cells)
        settings = {"linear": linear, **asdict(bodies[-1].how)}
        rule = ErrorRule(left, parts=parts, along=True)
        return Rung(curve, stages, settings, rule=rule)

    def charts(self, degree: int, to_load: float) -> Iterable[Chart]:
        """Charts of a curve up to a load; NotConverged if that takes more of them than are worth their time."""
        scene, windows, most = self.scene, self.windows(degree), self.settings.most_windows
        if (count := windows.number(scene.scales.widest_radius(to_load)) + 1) > most:
            raise NotConverged(
                f"tabor = {scene.tabor:g} with radius_ratio = {scene.radius_ratio:g} takes {count} meshes along the "
                f"curve at finite strain, limit {most}; take a smaller tabor, a smaller to_load or LinearElastic"
            )
        return windows

    def windows(self, degree: int) -> Windows:
        """For the curve."""
        return self.along.setdefault(degree, Windows(ScenesBody(self.scene, Discretisation(degree), self.settings)))

    def body(self, degree: int, finest: float = 1.0, growth: float = 1.0) -> ScenesBody:
        """For events, in cells of other lengths and growth by these factors: stiff surfaces have wide spikes."""
        length = finest * (1 - softening(self.scene)) * Discretisation.finest
        return ScenesBody(self.scene, Discretisation(degree, length, growth * Discretisation.growth), self.settings)


def _lowest_degree(rtol: float, tabor: float) -> int:
    """Degree of the elements on the lowest rung: one for each decade, and more where spikes of tension are narrow.

    With a degree less a third rung was needed at tabor 3 and 1e-5, 7.3 s for 4.9; at 1e-4 it was not, 2.1 s for 3.2.
    """
    return int(np.clip(np.round(-np.log10(rtol) * (1 + 0.65 * np.log10(max(tabor, 1.0))) - 1), 4, 6))


def _apart(scene: Scene, events: State, name: str) -> dict[str, float]:
    """How far the conservative tractions lie apart in the numbers of an event; nan if one does not have it."""
    others = (scene.made_of(NeoHookean(scene.poisson, traction)) for traction in CONSERVATIVE)
    found = [_counted(events[name], other) for other in others]
    return dict(zip(OBSERVABLES, np.ptp(found, axis=0).tolist(), strict=True))


def _counted(event: Located, scene: Scene) -> Array:
    """Numbers of an event by another traction."""
    convention, problem = convention_of(scene.material.traction, scene.poisson), event.problem
    if not isinstance(problem, FiniteStrainProblem) or problem.convention == convention:
        return event.point.observables
    other = replace(problem, convention=convention)
    found = softening(scene) < 1 and relocate(event, other, event.point.x, metric_for(other))
    return found.point.observables if found else np.full(len(OBSERVABLES), np.nan)


def find_jumps(scene: Scene, rtol: float = 1e-4, settings: Settings = USUAL) -> dict[str, Event]:
    """Solve for pull-off and jumps alone, without the curve between: from those of the linear body.

    Parameters, errors and error estimates as of `trace`, without the limit of the Tabor parameter; in the place of the
    curve's mesh each event has one of its own. It takes a third to two thirds of the time of `trace`, with the
    same numbers, and serves scenes whose curve is lost.
    """
    _require(scene, rtol, COMPRESSION)
    rung = partial(Stages(scene, settings).rung, rtol, LITTLE)
    lowest, curve = rung(0), trace_charts(linear_charts(scene, LITTLE), LITTLE)
    found = {name: event for name, event in find_events(curve).items() if name in JUMPS}
    with _cause_told(scene, settings):
        ascent = ascend(on_all(found, lowest.stages[0]), lowest, rtol, rung, range(1, 1 + settings.most_rungs))
        _require_no_needle(ascent.state)
    return ascent.events


def _require_no_needle(events: State) -> None:
    """Refuse events whose surface is drawn out to a needle, or whose cells are too long."""
    for event in events.values():
        event.problem.require_resolution(event.point.x)


@contextmanager
def _cause_told(scene: Scene, settings: Settings) -> Iterator[None]:
    """Say, where a surface stress draws a tiny sphere flat or leaves no stiffness to short waves, that this is why."""
    part, ratio, R = softening(scene), scene.tabor * scene.sphere_radius**2, scene.sphere_radius
    round_from = scene.tabor * (_surface_stress(scene) / settings.flattened) ** (2 / 3)
    try:
        yield
    except NotConverged as error:
        ill_posed = part >= settings.soft or (part > 0 and isinstance(error, IllPosed))
        if isinstance(error, ContactTooWide) or not ill_posed:
            if ratio >= round_from:
                raise
            raise ContactTooWide(
                f"radius_ratio = {ratio:g} is below {round_from:.3g} for tabor {scene.tabor:g} and traction = "
                f"{scene.material.traction!r}: the sphere, of radius {R:.3g} beta, is drawn flat, or nearly so, before "
                f"it bears a load ({error}); take traction = 'reference', or a radius_ratio above it"
            ) from error
        raise IllPosed(
            f"radius_ratio = {ratio:g} is close to its limit {ratio * part**2:.3g} for traction = "
            f"{scene.material.traction!r}: the edge tension leaves {1 - part:.1%} of the surface's stiffness "
            f"to short waves ({error}); take traction = 'reference', or radius_ratio above "
            f"{max(ratio * (part / settings.soft) ** 2, round_from):.3g}"
        ) from error


@dataclass(frozen=True, eq=False, repr=False)
class Raising(Standing):
    """A stage on which events of the linear body are solved for at finite strain, each on a mesh of its own."""

    def moved(self, event: Located, problem: Traceable) -> Located | Unsolved:
        """Solve for an event again, of a linear body by raising its strain."""
        if not isinstance(problem, FiniteStrainProblem):
            return moved(event, problem)
        of_linear = event.problem.interface is event.problem
        found = raised(event, problem) if of_linear else moved(event, problem)
        problem.held.forget()
        return found


def raised(event: Located, problem: FiniteStrainProblem) -> Located | Unsolved:
    """Solve for an event of the linear body at finite strain, raising delta in as many parts as that takes.

    The start is the linear body under the pressure that its gaps make. A state is the start for the next one as it is:
    at the same gaps the law's forces are the same, and only those of the body change. Unsolved if a small part of delta
    is too much.
    """
    found: Located | Unsolved = event
    start, done, part = transfer(event.problem, event.point.x, problem.stretched(0.0)), 0.0, problem.stretch
    how = problem.held.settings
    while found and done < problem.stretch:
        last = done + part >= (1 - how.smallest_part) * problem.stretch
        target = problem if last else problem.stretched(done + part)
        farther = relocate(found, target, start, metric_for(target), how.raised_points)
        if farther:
            found, start, done = farther, farther.point.x, target.stretch
            continue
        part /= 2
        if part < how.smallest_part:
            approach, load = event.point.observables[[APPROACH, LOAD]]
            return Unsolved(
                f"the event at approach {approach:.6g} eps, load {load:.6g} R dgamma is lost at beta/R = "
                f"{target.stretch:.3g} ({farther.reason.partition(';')[0]}); take a larger radius_ratio"
            )
    return found


def linear_charts(scene: Scene, to_load: float) -> tuple[Chart, Chart]:
    """Charts for the curve of the linear body."""
    linear = scene.made_of(LinearElastic(scene.poisson))
    return sized_body(linear, Discretisation(ELEMENTS.curve_degree), to_load).curve()


def nearly_linear(scene: Scene, to_load: float, settings: Settings) -> bool:
    """Whether strains are so small that the linear body has about the same events."""
    widest = scene.scales.widest_radius(to_load) / scene.sphere_radius
    return softening(scene) < settings.soft and widest < settings.strained


def _require(scene: Scene, rtol: float, to_load: float) -> None:
    """Refuse what is out of range or has no meaning at finite strain."""
    require_rtol(rtol)
    require_load(to_load)
    if rtol < TIGHTEST:
        raise InputError(f"rtol = {rtol:g} is outside {TIGHTEST:g} <= rtol for finite strain; take 1e-4")
    require_well_posed(scene)


def softening(scene: Scene) -> float:
    """Part of the surface's stiffness to short waves that the surface stress takes at the contact edge; 1 is too much.

    That is c sigma, at the law's largest tension, over 2 G/(3 - 4 nu): see `fem_adhesion.finite_strain.traction`.
    """
    return _surface_stress(scene) * _edge_tension(scene) * (3 - 4 * scene.poisson) / (1 - scene.poisson)


def _surface_stress(scene: Scene) -> float:
    """c, over the law's energy; c dgamma/(E* R) is c (beta/R)^3."""
    return convention_of(scene.material.traction, scene.poisson).surface_stress


def _edge_tension(scene: Scene) -> float:
    """Largest tension of the law over E*."""
    law = scene.law
    return -float(law.pressure(np.array(law.edge_gap), scene.tabor)) / scene.sphere_radius


def require_well_posed(scene: Scene) -> None:
    """Refuse a sphere whose surface stress would let waves of any length loose at the contact edge."""
    part, ratio = softening(scene), scene.tabor * scene.sphere_radius**2
    if part >= 1:
        raise InputError(
            f"radius_ratio = {ratio:g} is outside {ratio * part**2:.3g} < radius_ratio for traction = "
            f"{scene.material.traction!r}, tabor {scene.tabor:g}, poisson {scene.poisson:g}: the equations are "
            f"ill-posed under an edge tension of {_edge_tension(scene):.2g} E*; take traction = 'reference'"
        )


# Its meshes


@dataclass(frozen=True, eq=False, repr=False)
class ScenesBody(Valued):
    """The body of a scene, a hemisphere at finite strain, to be meshed for any range of contact radii.

    `how` is the degree of the elements and the size of their cells, which grow along the surface as slowly as the
    law asks, see `Scales.growth`.
    """

    scene: Scene
    how: Discretisation
    settings: Settings = USUAL

    def standing(self, radius: float) -> Chart:
        """Chart finest at a contact radius in beta."""
        return replace(self.chart(radius, radius), until=np.inf)

    def chart(self, inner: float, outer: float) -> Chart:
        """Chart that serves contact radii between these."""
        problem = self.meshed(inner, outer)
        return Chart(problem, problem.body.unknowns, min(outer, self.farthest))

    def meshed(self, inner: float, outer: float) -> FiniteStrainProblem:
        """Discretise with cells that are fine for contact radii between these, as far as a contact may reach."""
        scene, how, R = self.scene, self.how, self.scene.sphere_radius
        ends, coordinate = layout_of(scene, how)
        first, last = (coordinate.of(min(radius, self.farthest)) for radius in (inner, outer))
        growth = scene.scales.growth(how.growth)
        lines = grid.graded(first, self.length, float(ends[0]), growth=growth, until=last)
        space = Space(meshes_of(scene, lines, how)[0], quadrilateral(how.degree))
        pressure = quadrilateral(how.degree - 1) if projects(space, scene.poisson) else None
        return finite_strain_problem(
            material_body(space, scene.poisson, 1 / R, pressure),
            FAR_FIELDS[scene.body.held](space, scene.poisson),
            scene.tabor,
            profile=scene.surface,
            convention=convention_of(scene.material.traction, scene.poisson),
            law=scene.law,
            settings=self.settings,
        )

    @property
    def farthest(self) -> float:
        """Undeformed radius in beta up to which a contact may spread."""
        return FARTHEST * self.scene.sphere_radius

    @property
    def length(self) -> float:
        """Length in beta of the cells at the contact edge."""
        return finest_length(self.scene, self.how)


@dataclass(frozen=True, eq=False, repr=False)
class Windows(WhereAsked):
    """Charts for the whole curve, each fine for a window of contact radii."""

    body: ScenesBody

    def __iter__(self) -> Iterator[Chart]:
        """All of them in order."""
        return (self.serving(self._width * (number + 0.5)) for number in range(self._count))

    def make(self, radius: float) -> tuple[float, float, Chart]:
        """Chart for a window of contact radii, in beta; the last one serves all that are wider."""
        number = self.number(radius)
        first, last = self._width * number, self._width * (number + 1)
        for *_, chart in self.made:  # the points of a curve come in order
            if isinstance(chart.problem, FiniteStrainProblem):
                chart.problem.held.forget()
        return first, last if number < self._count - 1 else np.inf, self.body.chart(first, last)

    def number(self, radius: float) -> int:
        """Number of the window of a contact radius in beta."""
        return min(int(radius / self._width), self._count - 1)

    @property
    def _width(self) -> float:
        return self.body.settings.window * self.body.length

    @property
    def _count(self) -> int:
        return int(np.ceil(self.body.farthest / self._width))
