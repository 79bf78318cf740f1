"""The load-approach curve of a sphere at finite strain, to an accuracy asked for."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace

import numpy as np

from fem_adhesion import sized
from fem_adhesion.finite_strain import FiniteStrainProblem
from fem_adhesion.finite_strain_events import corrected, undeformed_radius
from fem_adhesion.finite_strain_meshes import Discretised, ScenesBody, enriched, linear
from fem_adhesion.finite_strain_traction import convention_of
from fem_adhesion.finite_strain_windows import trace_windows
from fem_adhesion.scene import Scene, TractionName
from halfspace.contact import APPROACH
from halfspace.curve import (
    COMPRESSION,
    Chart,
    EquilibriumPath,
    Estimate,
    energy_released,
    find_events,
    metric_for,
    trace_charts,
)
from halfspace.errors import InputError, NotConverged
from halfspace.events import EVENTS, REMAINING, ROUND_OFF, Event, Located, Tolerance, estimate_event
from halfspace.lennard_jones import LENNARD_JONES
from halfspace.limits import require_load, require_rtol
from halfspace.path import Segment
from halfspace.values import Valued

WIDEST_TABOR = 3.0  # for a whole curve: its points grow as the square, to a minute's work at 3
TIGHTEST = 1e-6  # relative tolerance
MOST_LEVELS = 2
NEARBY = 0.01  # relative difference of contact radii that one mesh serves
LITTLE = 0.5  # R dgamma: a load past every event
JUMPS = ("pull_off", "jump_on", "jump_off")
NUMBERS = ("approach", "load", "central_gap", "contact_radius")
CONSERVATIVE: tuple[TractionName, ...] = ("projected", "reference", "normal")

State = Mapping[str, Located]


@dataclass(frozen=True, eq=False, repr=False)
class AroundEvents(Valued):
    """A discretisation on which every event has a mesh made for its own contact radius.

    Parameters
    ----------
    body : ScenesBody
        The body, and how it is meshed.
    linear : sequence of Segment
        Curve of the linear body, where starts are taken from.
    below : AroundEvents, optional
        With elements of a lower degree, whose meshes are shared.
    """

    body: ScenesBody
    linear: Sequence[Segment]
    below: AroundEvents | None = None
    made: list[tuple[float, Discretised]] = field(default_factory=list, compare=False, repr=False)

    def __call__(self, event: Located) -> Chart:
        """Chart for an event."""
        return self.mesh(event)[1].chart

    def mesh(self, event: Located) -> tuple[float, Discretised]:
        """Mesh for an event and the contact radius that it is made for, unless one made before will do."""
        radius, apart = self._place(event)
        for made in self.made:
            if abs(radius - made[0]) <= apart:
                return made
        self.made.append((radius, self.body.meshed(radius, radius)))
        return self.made[-1]

    def _place(self, event: Located) -> tuple[float, float]:
        """Contact radius that a mesh is wanted for, and how far off it may be: not at all from that of the one below.

        An event may have moved on its mesh by more than meshes serve; it is the mesh that counts, not the event.
        """
        if self.below is None:
            radius = float(np.nan_to_num(undeformed_radius(event.problem, event.point)))
            return radius, NEARBY * radius
        own = [radius for radius, mesh in self.below.made if mesh.problem is event.problem]
        return (own[0] if own else self.below.mesh(event)[0]), 0.0

    def located(self, found: State) -> State:
        """Solve for events again that were found on the discretisation below, or if there is none on any."""
        return {name: self._located(event) for name, event in found.items()}

    def _located(self, event: Located) -> Located:
        on = self.mesh(event)[1]
        if self.below and isinstance(event.problem, FiniteStrainProblem):
            u = enriched(event.problem.displacement(event.point.x), event.problem.body.space, on.problem.body.space)
            x = on.problem.state_from(float(event.point.observables[APPROACH]), u)
        else:
            x = on.near(self.linear, event.problem, event.point)
        return corrected(event, on.problem, x, metric_for(self.body.scene.tabor))

    @property
    def unknowns(self) -> int:
        """Most unknowns of a mesh made so far."""
        return max(mesh.problem.body.unknowns for _, mesh in self.made)


def trace(scene: Scene, rtol: float = 1e-4, to_load: float = COMPRESSION) -> EquilibriumPath:
    """Trace the load-approach curve of a scene at finite strain and solve for its events.

    Parameters
    ----------
    scene : Scene
        A hemisphere of Tabor parameter 3 or less.
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-6 to 1e-1.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.

    Returns
    -------
    EquilibriumPath
        Each event has a mesh of its own; its error estimate is half the larger of the changes from elements one degree
        lower, on the same mesh and on that of the curve. Its spread is that between the tractions ``reference`` and
        ``normal``. The energy is nan with the vertical traction, which has none; stability is as said at
        `FiniteStrainProblem.negative_directions`.

    Raises
    ------
    InputError
        If an input is out of range, or does not go with finite strain.
    halfspace.errors.NotConverged
        If the curve or an event is lost, as where the material is squeezed or torn beyond what Newton's method follows.
    """
    _require(scene, rtol, to_load)
    if scene.tabor > WIDEST_TABOR:
        raise InputError(
            f"tabor = {scene.tabor:g} is outside tabor <= {WIDEST_TABOR:g} for a curve at finite strain; "
            'take strain = "small"'
        )
    began = time.perf_counter()
    lowest = _lowest(scene, rtol, _linear_curve(scene, to_load))
    along = replace(lowest.body, how=replace(lowest.body.how, finest=sized.FINEST))
    segments = trace_windows(along, lowest.linear, to_load)
    climbed = _climb(rtol, lowest, find_events(segments), compare=True)
    curve, events = (asdict(how) for how in (along.how, climbed.finest.body.how))
    settings = {"rtol": rtol, "traction": scene.traction, "curve": curve, "events": events}
    return EquilibriumPath(
        scene.tabor,
        segments,
        climbed.events,
        _energy(climbed),
        climbed.states,
        climbed.finest,
        seconds=time.perf_counter() - began,
        settings=settings,
        spread={
            name: _spread(event, event.problem, scene)
            for name, event in climbed.states[0].items()
            if name in climbed.events and isinstance(event.problem, FiniteStrainProblem)
        },
    )


def _spread(event: Located, problem: FiniteStrainProblem, scene: Scene) -> dict[str, float]:
    """How far the conservative tractions lie apart in the numbers of an event; nan if one does not have it."""
    found = []
    for name in CONSERVATIVE:
        counted = replace(problem, convention=convention_of(name, scene.poisson))
        try:
            require_well_posed(replace(scene, traction=name))
            found.append(corrected(event, counted, event.point.x, metric_for(problem.tabor)).point.observables)
        except (InputError, NotConverged):
            found.append(np.full(len(NUMBERS), np.nan))
    return dict(zip(NUMBERS, np.ptp(found, axis=0).tolist(), strict=True))


def find_jumps(scene: Scene, rtol: float = 1e-4) -> dict[str, Event]:
    """Solve for pull-off and jumps alone, without the curve between: corrected from those of the linear body.

    Parameters and errors as of `trace`, without the limit of the Tabor parameter. The error estimates are half the
    changes from elements one degree lower.
    """
    _require(scene, rtol, COMPRESSION)
    curve = _linear_curve(scene, LITTLE)
    found = {name: event for name, event in find_events(curve).items() if name in JUMPS}
    return dict(_climb(rtol, _lowest(scene, rtol, curve), found).events)


@dataclass(frozen=True, eq=False, repr=False)
class _Climbed(Valued):
    """Events on the finest discretisation, with those on the others before it."""

    events: Mapping[str, Event]
    states: tuple[State, ...]
    finest: AroundEvents


def _lowest(scene: Scene, rtol: float, curve: Sequence[Segment]) -> AroundEvents:
    """Discretisation by elements of a degree that suits the tolerance.

    The spike of tension is as wide as the surface is stiff.
    """
    degree = int(np.clip(np.ceil(-np.log10(rtol)), 4, 6))
    finest = sized.FINEST * (1 - softening(scene))
    return AroundEvents(ScenesBody(scene, sized.Discretisation(degree, finest)), curve)


def _climb(rtol: float, rung: AroundEvents, found: State, *, compare: bool = False) -> _Climbed:
    """Solve for events on ever higher degrees until the tolerance is met."""
    states = [rung.located(found)]
    for level in range(MOST_LEVELS):
        rung = AroundEvents(rung.body.richer(), rung.linear, rung)
        states.append(rung.located(states[-1]))
        chains = [states[-2:], [found, states[-1]]] if compare and not level else [states[-2:]]
        events = {n: estimate_event(n, [[s[n] for s in c] for c in chains]) for n in EVENTS if n in found}
        if not Tolerance.on(events, rtol).missed(events):
            break
    return _Climbed(events, tuple(states), rung)


def _energy(climbed: _Climbed) -> Estimate:
    """Potential energy between the states ``separated`` and ``zero_approach``."""
    values = [energy_released(state) for state in climbed.states[-2:]]
    change = abs(values[1] - values[0])
    return Estimate(values[1], REMAINING * change + ROUND_OFF * (1 + abs(values[1])))


def _linear_curve(scene: Scene, to_load: float) -> tuple[Segment, ...]:
    """Curve of the linear body."""
    body = sized.sized_body(linear(scene), sized.Discretisation(sized.CURVE_DEGREE))
    return trace_charts(body.curve(to_load), to_load)


def _require(scene: Scene, rtol: float, to_load: float) -> None:
    """Refuse what is out of range or has no meaning at finite strain."""
    require_rtol(rtol)
    require_load(to_load)
    if rtol < TIGHTEST:
        raise InputError(f"rtol = {rtol:g} is outside {TIGHTEST:g} <= rtol for finite strain; take 1e-4")
    require_well_posed(scene)
    if scene.counter is not None:
        raise InputError(f"counter = {scene.counter!r} does not go with finite strain; take counter = None")


def softening(scene: Scene) -> float:
    """Part of the surface's stiffness to short waves that the surface stress takes at the contact edge; 1 is too much.

    That is c sigma, at the law's largest tension, over 2 G/(3 - 4 nu): see `fem_adhesion.finite_strain_traction`.
    """
    c, nu = convention_of(scene.traction, scene.poisson).surface_stress, scene.poisson
    return c * _edge_tension(scene) * (3 - 4 * nu) / (1 - nu)


def _edge_tension(scene: Scene) -> float:
    """Largest tension of the law over E*."""
    law = LENNARD_JONES
    return -float(law.pressure(np.array(law.edge_gap), scene.tabor)) / scene.sphere_radius


def require_well_posed(scene: Scene) -> None:
    """Refuse a sphere whose surface stress would let waves of any length loose at the contact edge."""
    part, ratio = softening(scene), scene.tabor * scene.sphere_radius**2
    if part >= 1:
        raise InputError(
            f"radius_ratio = {ratio:g} is outside {ratio * part**2:.3g} < radius_ratio for traction = "
            f"{scene.traction!r}, tabor {scene.tabor:g}, poisson {scene.poisson:g}: the equations are ill-posed under "
            f"an edge tension of {_edge_tension(scene):.2g} E*; take traction = 'reference'"
        )
