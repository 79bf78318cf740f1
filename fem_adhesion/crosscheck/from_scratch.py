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
from functools import partial
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from scipy.optimize import newton as secant

import halfspace
from fem_adhesion.crosscheck.comparison import CLOSED_FORM, WEAK_FORM, Row, of_values
from fem_adhesion.crosscheck.definitions import numbers
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.crosscheck.weak_bodies import FineAt, contacts, displaced, sharpness
from fem_adhesion.fields import gaps_at
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.newton import Equilibrium, at_approach, at_load, newton
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
        return mu * mean(body.rise(displaced(body, tension)))

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
    before = _state(fine.contact, path.stages[-2][name])  # how much of ripples a stiff law makes
    approach, load = map(event.estimate, ("approach", "load"))
    width, force = 1 + abs(approach.value), abs(load.value)
    balanced = Estimate(0.0, approach.error + abs(before.balance - fine.balance))
    yield Compared(f"{name} balance", "eps", (coarse.balance, fine.balance), balanced, width)
    if name != "zero_load":
        doubt = Estimate(0.0, abs(before.attraction - fine.attraction))
        yield Compared(f"{name} attraction", "R dgamma", (coarse.attraction, fine.attraction), load + doubt, force)
    a, b = _beside(name, coarse), _beside(name, fine)
    for quantity, unit in (("central_gap", "eps"), ("contact_radius", "beta")):
        known, both = event.estimate(quantity), (getattr(a, quantity, None), getattr(b, quantity, None))
        if not all(value is not None and math.isnan(value) for value in (*both, known.value)):
            ripples = (_ripple(a), _ripple(b)) if quantity == "central_gap" else (0.0, 0.0)
            size = USUAL.pointwise * (1 + abs(np.nan_to_num(known.value)))
            yield Compared(f"{name} {quantity}", unit, both, known, size, ripples)
    # What turns is stationary, and at the edge of a contact the coarse body turns elsewhere: it is solved beside.
    smooth, sharp = name == "jump_on", sharpness(scene, radius) > USUAL.sharp
    if name in FOLDS and (smooth or not sharp):
        side = None if b is None else _stable_side(b)
        yield Compared(f"{name} stable side", "", (side, side), Estimate(FOLDS[name], 0.0), 1.0)
    if smooth:
        a, b = (_found(_from_afar, scene.scales.separated_approach, state) for state in (coarse, fine))
        a = _turn(name, a)
    if smooth or (name != "zero_load" and not sharp):
        b = _turn(name, b)
    approaches, loads = ((getattr(a, of, None), getattr(b, of, None)) for of in ("approach", "load"))
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
        below = _found(state.nearby, at_load(state.contact, state.load - step))
        above = below and _found(state.nearby, at_load(state.contact, state.load + step))
        if below and above:
            ways = below.unstable, above.unstable
            return float(ways[0] - ways[1]) if min(ways) == 0 else math.nan
    return math.nan


def _from_afar(far: float, fold: StateInWeakForm) -> Equilibrium | None:
    """Equilibrium at the load of a fold that is reached from undeformed surfaces; None if no fold is there.

    The way left shrinks by the same part in each step, so that near the fold each changes the state as much.
    """
    contact, approach = fold.contact, float(fold.y[-1])
    near = USUAL.near * (1 + abs(approach))
    first, *others = approach - np.geomspace(approach - far, near, USUAL.steps)
    state = newton(contact, contact.undeformed(first), at_approach(first))
    for place in others:
        state = state.nearby(at_approach(place))
    if abs(state.load - fold.load) >= USUAL.away * (1 + abs(fold.load)):
        return None
    return newton(contact, state.y, at_load(contact, fold.load))


@dataclass(frozen=True, eq=False, repr=False)
class StateInWeakForm(Valued):
    """A state of the finite elements in the weak form, whether or not it is in equilibrium there.

    `load` is W of the finite elements, `balance` by how much the gaps that their tensions leave differ from theirs in
    eps, weighted by the tension.
    """

    contact: Contact
    y: Array
    load: float
    balance: float

    @property
    def attraction(self) -> float:
        """Load of the tensions across these gaps by the weak form."""
        return self.contact.load(self.y)


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
    body, h = contact.body, 1 + _gaps(event, contact)
    tension = contact.law.tension(h)
    off = contact.left_by(displaced(body, contact.tabor * tension), approach) - h
    balance = body.integral(off * np.abs(tension)) / body.integral(np.abs(tension))
    return StateInWeakForm(contact, np.append(h, approach), load, balance)


def _gaps(event: Located, contact: Contact) -> Array:
    """Gaps H of a state of the finite elements; beyond their cells what yields deflects as under a point load."""
    radii, yields, (approach, load) = contact.body.radii, contact.body.yields, event.point.observables[:2]
    beyond = -approach + event.problem.tabor * (contact.height + yields * load / (np.pi * radii))
    extent = event.problem.interface.operator_at(event.problem.surface_state(event.point.x)).extent
    return np.where(yields & (radii < extent), gaps_at(event, radii), beyond)


def _beside(name: str, state: StateInWeakForm) -> Equilibrium | None:
    """Equilibrium at the approach of pull-off, or at the load of another event: what turns there is stationary."""
    load = 0.0 if name == "zero_load" else state.load
    to = at_approach(float(state.y[-1])) if name == "pull_off" else at_load(state.contact, load)
    return _found(newton, state.contact, state.y, to)


def _turn(name: str, state: Equilibrium | None) -> Equilibrium | None:
    """Event in the weak form near a state, found by the secant; None where there is none.

    At a fold d(alpha)/dW vanishes along the load, at the load's own extremum dW/d(alpha) does along the approach.
    """
    if state is None:
        return None
    at = at_approach if name == "pull_off" else partial(at_load, state.contact)
    place = state.approach if name == "pull_off" else state.load
    step = USUAL.turn * (1 + abs(place))

    def slope(there: float) -> float:
        stiffness = state.nearby(at(there)).stiffness
        return stiffness if name == "pull_off" else 1 / stiffness

    def turned() -> Equilibrium | None:
        how: dict[str, Any] = {"tol": USUAL.turned * step, "maxiter": USUAL.tries, "full_output": True, "disp": False}
        root, found = secant(slope, place, x1=place + step, **how)
        return state.nearby(at(float(root))) if found.converged else None

    return _found(turned)


def _ripple(state: Equilibrium | None) -> float:
    """What gaps next to the axis have in eps that a polynomial of the radius squared has not.

    Or displacements, whichever have less: the gaps are smooth in contact, the displacements apart, where a profile
    need not be.
    """
    if state is None:
        return 0.0
    body = state.contact.body
    first = np.argsort(body.radii)[: USUAL.innermost]
    x = body.radii[first] ** 2
    fields = state.y[first], state.contact.tabor * body.rise(state.u)[first]
    return min(float(np.max(np.abs(f - np.polynomial.Polynomial.fit(x, f, 2)(x)))) for f in fields)


def _energy(state: Equilibrium) -> float:
    """Potential energy in R dgamma eps, see `Contact.energy`."""
    return state.contact.energy(state.u, state.approach)


def _energy_released(scene: Scene, on: FineAt, path: EquilibriumPath) -> float | None:
    """Potential energy from undeformed surfaces that deform far apart to the equilibrium in contact at no approach."""
    apart, touching = (path.stages[-1][name] for name in ("separated", "zero_approach"))
    first, second = (on(*_places(end)) for end in (apart, touching))
    far = scene.scales.separated_approach
    before = _found(newton, first, first.undeformed(far), at_approach(far))
    after = _found(newton, second, np.append(1 + _gaps(touching, second), 0.0), at_approach(0.0))
    return _energy(before) - _energy(after) if before and after else None
