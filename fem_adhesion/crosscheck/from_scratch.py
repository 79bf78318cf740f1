"""The fourth level of the cross-check: what both solvers share, against closed forms and a problem that shares nothing.

Law, profile, load, energy, Newton's method, the path and its events are the same code on either side. Three kinds of
rows look for mistakes there. Closed forms: the work of adhesion, the rigid and the soft limit. Equations: residual,
tangent, load and its slope at a state made up, so that nothing has to converge. Events: each state of the finite
elements in `fem_adhesion.weak_form`, on two bodies, whose difference is the error. It looks for mistakes, not digits:
its budget is a part in a thousand, whatever the tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

import halfspace
from fem_adhesion.crosscheck.comparison import CLOSED_FORM, WEAK_FORM, Row, of_values
from fem_adhesion.crosscheck.definitions import numbers
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.crosscheck.weak_bodies import FineAt, contacts, sharpness
from fem_adhesion.fields import gaps_at
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.newton import Equilibrium, at_approach, at_load, from_afar, newton, turning_point
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import usual
from halfspace.errors import tried
from halfspace.laws import LENNARD_JONES, Law
from halfspace.values import Array, Estimate, Valued

Answer = TypeVar("Answer")

# Closed forms


def closed_forms(law: Law = LENNARD_JONES) -> list[Row]:
    """Law and limits of the default: what the shared code makes of them, beside what is known."""
    adhesion = Estimate(1.0, 0.0), numbers(lambda h: -law.pressure(h - 1, 1.0)).work + Estimate(0.0, USUAL.round_off)
    return [
        of_values("limit: integral of tension", "dgamma", *adhesion, 1e-6, CLOSED_FORM),
        _limit("limit: Bradley pull_off load", -2 * np.pi, (1e-9,)),
        _limit("limit: JKR pull_off load", -1.5 * np.pi, (50.0, 100.0)),
    ]


def _limit(quantity: str, value: float, tabors: Sequence[float]) -> Row:
    """Pull-off load towards a limit: what is left is less than the last step towards it."""
    loads = [_found(lambda tabor: halfspace.trace(tabor, rtol=1e-3).events["pull_off"], tabor) for tabor in tabors]
    events = [event for event in loads if event]
    found = None
    if len(events) == len(tabors):
        step = float(np.abs(np.diff([event.load for event in events])).sum())
        found = events[-1].estimate("load") + Estimate(0.0, step)
    return of_values(quantity, "R dgamma", Estimate(value, 0.0), found, USUAL.budget * abs(value), CLOSED_FORM)


def _found(solve: Callable[..., Answer], *given: Any, **how: Any) -> Answer | None:
    """Answer of a solver, None where it does not converge: such a row disagrees."""
    return tried(solve, *given, **how) or None


# Equations


def equations(scene: Scene, problems: Sequence[ContactProblem], radius: float) -> Iterator[Row]:
    """Residual, tangent, load and its slope at a state made up, by the shared code and by the weak form.

    The shared code is given the problem on elastic operators of two degrees, the finer one last. Residual and tangent
    are means over a contact of the radius given; what is off counts relative to what in them is elastic under
    tensions of one sign.
    """
    apart = np.array([_apart(contact(radius, radius), radius) for contact in contacts(scene, np.inf)[:2]])
    shared = np.array([_shared(problem, radius) for problem in problems])
    sizes = np.abs(apart[1, 4:])
    # Of each the largest, lest both bodies agree by chance on one.
    doubt = max(USUAL.least, float(np.max(np.abs(np.diff(apart[:, :4], axis=0)) / sizes)))
    for n, (name, unit) in enumerate(EQUATIONS.items()):
        change = float(np.abs(np.diff(shared[:, n])).sum())
        value = float(shared[-1, n])
        second = Estimate(value, change + USUAL.round_off * (1 + abs(value)))
        first = Estimate(float(apart[1, n]), doubt * sizes[n])
        yield of_values(f"equations: {name}", unit, first, second, USUAL.budget * sizes[n], WEAK_FORM)


EQUATIONS = {"residual": "eps", "tangent": "eps", "load": "R dgamma", "load's slope": "R dgamma"}


def _made_up(r: Array) -> tuple[Array, Array, Array]:
    """Gap and its change in eps, and a weight, at radii in that of the contact; the attraction ends where that does."""
    weight = np.exp(-(r**2)) / np.pi
    return 0.2 + r**2 / 2 + r**4 / 8, weight, weight


def _shared(problem: ContactProblem, radius: float) -> list[float]:
    """What the shared code has for the state made up."""
    operator = problem.operator_at(np.ones(1))
    H, dH, weight = _made_up(operator.radii / radius)
    x, dx = np.append(H, [USUAL.approach, 1.0]), np.append(dH, [USUAL.change, 0.0])
    mean = operator.weights * weight / radius**2
    residual, tangent = (float(mean @ field[:-1]) for field in (problem.residual(x), problem.jacobian(x) @ dx))
    return [residual, tangent, problem.load(x), float(problem.gradient(x, np.eye(4)[LOAD]) @ dx)]


def _apart(contact: Contact, radius: float) -> list[float]:
    """The same by the weak form, and the size of each: its elastic part, or the load, by tensions of one sign."""
    body, mu = contact.body, contact.tabor
    H, dH, weight = _made_up(body.radii / radius)
    tensions = mu * contact.law.tension(1 + H), mu * contact.law.slope(1 + H) * dH

    def mean(field: Array) -> float:
        return body.integral(field * weight) / radius**2

    def rise(tension: Array) -> float:
        return mu * mean(body.rise(body.displaced(tension)))

    load, slope = (-body.integral(values) for values in tensions)
    raised, further = map(rise, tensions)
    residual, tangent = mean(H + USUAL.approach - mu * contact.height) + raised, mean(dH + USUAL.change) + further
    sizes = [of(np.abs(values)) for of in (rise, body.integral) for values in tensions]
    return [residual, tangent, load, slope, *sizes]


# Events


@dataclass(frozen=True)
class Compared:
    """A number of the finite elements beside those of the coarse and the fine body, None where they have none.

    The ripples of theirs are what no finer body has less of.
    """

    quantity: str
    unit: str
    both: tuple[float | None, float | None]
    second: Estimate
    size: float
    ripples: tuple[float, float] = (0.0, 0.0)

    @property
    def change(self) -> float:
        """Difference of both bodies that their ripples do not explain, relative to the size."""
        coarse, fine = self.both
        return 0.0 if coarse is None or fine is None else max(abs(fine - coarse) - sum(self.ripples), 0.0) / self.size

    def row(self, doubt: float) -> Row:
        """Row, if what the weak form errs by, but for ripples, is so much of the size."""
        coarse, fine = self.both
        first = None if coarse is None or fine is None else Estimate(fine, doubt * self.size + self.ripples[1])
        return of_values(f"apart: {self.quantity}", self.unit, first, self.second, USUAL.budget * self.size, WEAK_FORM)


def events(scene: Scene, path: EquilibriumPath) -> list[Row]:
    """Balance, load, turning points and energy of every event of the finite elements, in the weak form.

    The weak form errs by less than a coarser and a finer body differ; they are ever finer until that is within its
    budget, and both have every number: ripples of a law with a step may hide where a state turns. As two may agree by
    chance on one number, the largest of their differences counts for all, relative to the sizes.
    """
    rows: list[Row] = []
    for both in pairwise(contacts(scene)):
        found = list(_on_both(scene, path, *both))
        doubt = max(USUAL.least, *(compared.change for compared in found))
        rows = [compared.row(doubt) for compared in found]
        if all(row.first and row.first.error <= row.budget for row in rows):
            break
    return rows


def _on_both(scene: Scene, path: EquilibriumPath, on_coarse: FineAt, on_fine: FineAt) -> Iterator[Compared]:
    for name in usual(path.events):
        yield from _of_event(name, scene, path, on_coarse, on_fine)
    coarse, fine = (_energy_released(scene, contact, path) for contact in (on_coarse, on_fine))
    yield Compared("energy released", "R dgamma eps", (coarse, fine), path.energy, abs(path.energy.value))


def _of_event(name: str, scene: Scene, path: EquilibriumPath, on_coarse: FineAt, on_fine: FineAt) -> Iterator[Compared]:
    event, located = path.events[name], path.stages[-1][name]
    radius, reach = _places(located)
    coarse, fine = (_state(contact(radius, reach), located) for contact in (on_coarse, on_fine))
    before = _state(fine.at.contact, path.stages[-2][name])  # how much of ripples a stiff law makes
    approach, load = map(event.estimate, ("approach", "load"))
    width, force = 1 + abs(approach.value), abs(load.value)
    balances, forces = (coarse.balance, fine.balance), (coarse.at.load, fine.at.load)
    balanced = Estimate(0.0, approach.error + abs(before.balance - fine.balance))
    yield Compared(f"{name} balance", "eps", balances, balanced, width)
    if name != "zero_load":
        doubt = Estimate(0.0, abs(before.at.load - fine.at.load))
        yield Compared(f"{name} attraction", "R dgamma", forces, load + doubt, force)
    a, b = _beside(name, coarse), _beside(name, fine)
    for quantity, unit in (("central_gap", "eps"), ("contact_radius", "beta")):
        known, both = event.estimate(quantity), (getattr(a, quantity, None), getattr(b, quantity, None))
        if not all(value is not None and math.isnan(value) for value in (*both, known.value)):
            gap, size = quantity == "central_gap", USUAL.pointwise * (1 + abs(known.value))
            of_gap = (getattr(a, "ripple", 0.0), getattr(b, "ripple", 0.0)) if gap else (0.0, 0.0)
            yield Compared(f"{name} {quantity}", unit, both, known, size, of_gap)
    # What turns is stationary, and at the edge of a contact the coarse body turns elsewhere: it is solved beside.
    smooth, sharp = name == "jump_on", sharpness(scene, radius) > USUAL.sharp
    if name in FOLDS and (smooth or not sharp):
        side = None if b is None else _stable_side(b)
        yield Compared(f"{name} stable side", "", (side, side), Estimate(FOLDS[name], 0.0), 1.0)
    a, b = (_from_afar(scene, each) for each in (coarse, fine)) if smooth else (a, b)
    first = _turn(name, a) if smooth else a
    second = _turn(name, b) if smooth or (name != "zero_load" and not sharp) else b
    approaches, loads = ((getattr(first, of, None), getattr(second, of, None)) for of in ("approach", "load"))
    if name != "pull_off":
        yield Compared(f"{name} approach", "eps", approaches, approach, width)
    if name in ("pull_off", "jump_on"):
        yield Compared(f"{name} load", "R dgamma", loads, load, force)


FOLDS = {"jump_on": 1.0, "jump_off": -1.0}
"""The side of each jump's load where states are stable under fixed grips: above, coming from afar, or below."""


def _stable_side(state: Equilibrium) -> float:
    """1 if the states beside a fold are stable at loads above and have one way to fall below, -1 if it is reverse.

    So the approach has a maximum there that is reached from stable states, or a minimum that is left to them; anything
    else is no jump.
    """
    for step in np.array(USUAL.aside) * (1 + abs(state.load)):
        below, above = (_found(state.past, d, under_load=False) for d in (-step, step))
        if below and above:
            ways = below.unstable, above.unstable
            return float(ways[0] - ways[1]) if min(ways) == 0 else math.nan
    return math.nan


def _from_afar(scene: Scene, state: StateInWeakForm) -> Equilibrium | None:
    """Equilibrium at the load of a fold that is reached from undeformed surfaces; None if no fold is there."""
    near = state.at.approach - USUAL.near * (1 + abs(state.at.approach))
    found = _found(from_afar, state.at.contact, scene.scales.separated_approach, near)
    if found is None or abs(found.load - state.load) >= USUAL.away * (1 + abs(state.load)):
        return None
    return _found(newton, state.at.contact, found.y, at_load(state.at.contact, state.load))


@dataclass(frozen=True, eq=False, repr=False)
class StateInWeakForm(Valued):
    """A state of the finite elements in the weak form, whether or not it is in equilibrium there.

    `load` is W of the finite elements, `balance` by how much the gaps that their tensions leave differ from theirs in
    eps, weighted by the tension.
    """

    at: Equilibrium
    load: float
    balance: float


def _places(event: Located) -> tuple[float, float]:
    """Radii in beta: where cells are finest, at the edge of the contact unless it is small, and how far it attracts.

    That far the gap has opened by as much as takes the attraction away, in the same part as by the 3-9 law.
    """
    _, _, central_gap, radius = (float(value) for value in event.point.observables)
    scales = event.problem.interface.scales
    grain = float(np.sqrt(LENNARD_JONES.stiffness / scales.law.stiffness))
    attraction = scales.radius_at(USUAL.opening * grain * max(1 + central_gap, USUAL.closest))
    return (radius, max(radius, attraction)) if radius > USUAL.tiny * attraction else (attraction, attraction)


def _state(contact: Contact, event: Located) -> StateInWeakForm:
    """Take over the gaps."""
    approach, load = (float(value) for value in event.point.observables[:2])
    h = 1 + _gaps(event, contact)
    weight = np.abs(contact.law.tension(h))
    off = contact.body.integral((contact.left_by(contact.displaced(h), approach) - h) * weight)
    return StateInWeakForm(Equilibrium(contact, np.append(h, approach)), load, off / contact.body.integral(weight))


def _gaps(event: Located, contact: Contact) -> Array:
    """Gaps H of a state of the finite elements; beyond their cells what yields deflects as under a point load."""
    radii, yields, (approach, load) = contact.body.radii, contact.body.yields, event.point.observables[:2]
    beyond = -approach + event.problem.tabor * (contact.height + yields * load / (np.pi * radii))
    extent = event.problem.interface.operator_at(event.problem.surface_state(event.point.x)).extent
    return np.where(yields & (radii < extent), gaps_at(event, radii), beyond)


def _turn(name: str, state: Equilibrium | None) -> Equilibrium | None:
    """Load and approach of the event in the weak form, or None where there is none nearby."""
    if state is None:
        return None
    return _found(turning_point, state, under_load=name == "pull_off")


def _beside(name: str, state: StateInWeakForm) -> Equilibrium | None:
    """Equilibrium at the approach of pull-off, or at the load of another event: what turns there is stationary."""
    contact, y = state.at.contact, state.at.y
    to = at_approach(y) if name == "pull_off" else at_load(contact, state.load * (name != "zero_load"))
    return _found(newton, contact, y, to)


def _energy_released(scene: Scene, on: FineAt, path: EquilibriumPath) -> float | None:
    """Potential energy from undeformed surfaces that deform far apart to the equilibrium in contact at no approach."""
    apart, touching = (path.stages[-1][name] for name in ("separated", "zero_approach"))
    first, second = (on(*_places(end)) for end in (apart, touching))
    starts = first.undeformed(scene.scales.separated_approach), np.append(1 + _gaps(touching, second), 0.0)
    before, after = (_found(newton, each, y, at_approach(y)) for each, y in zip((first, second), starts, strict=True))
    return before.energy - after.energy if before and after else None
