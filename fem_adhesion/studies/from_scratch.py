"""The fourth level of the cross-check: what both solvers share, against closed forms and a problem that shares nothing.

Law, profile, load, energy, Newton's method, the path and its events are the same code on either side. Three kinds of
rows look for mistakes there. Closed forms: the work of adhesion, the rigid and the soft limit. Equations: residual,
tangent, load and its slope at a state made up, so that nothing has to converge. Events: each state of the finite
elements in `fem_adhesion.weak_form`, on two degrees, whose difference is the error. It looks for mistakes, not digits:
its budget is a part in a thousand, whatever the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.integrate import quad

import halfspace
from fem_adhesion.scene import Scene
from fem_adhesion.studies.comparison import CLOSED_FORM, WEAK_FORM, Row, difference
from fem_adhesion.weak_form import (
    Body,
    Contact,
    Turn,
    half_space,
    newton,
    paraboloid,
    tension,
    tension_slope,
    turning_point,
)
from halfspace.compliance import Array, ElasticOperator
from halfspace.contact import LOAD, ContactProblem
from halfspace.curve import EquilibriumPath, Estimate
from halfspace.errors import NotConverged
from halfspace.events import Located
from halfspace.lennard_jones import LENNARD_JONES

BUDGET = 1e-3  # of each quantity
FINENESS = ((3, 10.0), (4, 30.0))  # degree of the elements, size of the box in contact radii: coarse, fine
ROUND_OFF = 1e-10

# Closed forms


def closed_forms() -> list[Row]:
    """Law and limits: what the shared code makes of them, beside what is known."""
    work, error = quad(lambda H: -float(LENNARD_JONES.pressure(np.array(H), 1.0)), 0, np.inf, epsabs=0, epsrel=1e-9)
    adhesion = Estimate(1.0, 0.0), Estimate(work, error)
    return [
        Row("limit: integral of tension", "dgamma", *adhesion, difference(*adhesion), 1e-6, CLOSED_FORM),
        _limit("limit: Bradley pull_off load", -2 * np.pi, (1e-9,)),
        _limit("limit: JKR pull_off load", -1.5 * np.pi, (50.0, 100.0)),
    ]


def _limit(quantity: str, value: float, tabors: Sequence[float]) -> Row:
    """Pull-off load towards a limit: what is left is less than the last step towards it."""
    known, loads = Estimate(value, 0.0), []
    try:
        loads = [halfspace.trace(tabor, rtol=1e-3).events["pull_off"] for tabor in tabors]
    except NotConverged:
        return Row(quantity, "R dgamma", known, None, float("nan"), BUDGET * abs(value), CLOSED_FORM)
    step = float(np.abs(np.diff([event.load for event in loads])).sum())
    found = Estimate(loads[-1].load, loads[-1].load_error + step)
    return Row(quantity, "R dgamma", known, found, difference(known, found), BUDGET * abs(value), CLOSED_FORM)


# Equations

APPROACH, CHANGE = -0.5, 0.3  # in eps, of the state made up and of its change


def equations(scene: Scene, operators: Sequence[ElasticOperator]) -> Iterator[Row]:
    """Residual, tangent, load and its slope at a state made up, by the shared code and by the weak form.

    The shared code is given the elastic operators of two degrees, the finer one last. Residual and tangent are means
    over the contact; what is off counts relative to what in them is elastic.
    """
    apart = np.array([_apart(Contact(body, scene.tabor)) for body in bodies(scene)])
    shared = np.array([_shared(ContactProblem(operator, scene.tabor)) for operator in operators])
    sizes = np.abs(apart[1, 4:])
    for n, (name, unit) in enumerate(EQUATIONS.items()):
        first, second = (_estimate(side[:, n].tolist()) for side in (apart, shared))
        yield Row(f"equations: {name}", unit, first, second, difference(first, second), BUDGET * sizes[n], WEAK_FORM)


EQUATIONS = {"residual": "eps", "tangent": "eps", "load": "R dgamma", "load's slope": "R dgamma"}


def _made_up(r: Array) -> tuple[Array, Array]:
    """Gap and its change in eps; the attraction ends where the contact does."""
    return 0.2 + r**2 / 2 + r**4 / 8, _weight(r)


def _weight(r: Array) -> Array:
    return np.exp(-(r**2)) / np.pi


def _shared(problem: ContactProblem) -> list[float]:
    """What the shared code has for the state made up."""
    operator = problem.operator_at(np.ones(1))
    H, dH = _made_up(operator.radii)
    x, dx = np.append(H, [APPROACH, 1.0]), np.append(dH, [CHANGE, 0.0])
    mean = operator.weights * _weight(operator.radii)
    residual, tangent = (float(mean @ field[:-1]) for field in (problem.residual(x), problem.jacobian(x) @ dx))
    return [residual, tangent, problem.load(x), float(problem.gradient(x, np.eye(4)[LOAD]) @ dx)]


def _apart(contact: Contact) -> list[float]:
    """The same by the weak form, and of each the elastic part alone."""
    body, mu = contact.body, contact.tabor
    H, dH = _made_up(body.radii)
    tensions = mu * tension(1 + H), mu * tension_slope(1 + H) * dH

    def mean(field: Array) -> float:
        return body.integral(field * _weight(body.radii))

    rise, further = (mu * mean(body.rise(body.yielding(body.forces(values)))) for values in tensions)
    load, slope = (-body.integral(values) for values in tensions)
    residual, tangent = mean(H + APPROACH - mu * contact.height) + rise, mean(dH + CHANGE) + further
    return [residual, tangent, load, slope, rise, further, load, slope]


def _estimate(values: Sequence[float]) -> Estimate:
    """The last of some values, each of which errs by less than the one before differs from it."""
    change = float(np.abs(np.diff(values)).sum())
    return Estimate(float(values[-1]), change + ROUND_OFF * (1 + abs(float(values[-1]))))


# Events


@dataclass(frozen=True)
class Compared:
    """A number of the finite elements beside those of the coarse and the fine body, None where they have none."""

    quantity: str
    unit: str
    both: tuple[float | None, float | None]
    second: Estimate
    size: float

    @property
    def change(self) -> float:
        """Difference of both bodies relative to the size."""
        coarse, fine = self.both
        return 0.0 if coarse is None or fine is None else abs(fine - coarse) / self.size

    def row(self, doubt: float) -> Row:
        """Row, if what the weak form errs by is so much of the size."""
        coarse, fine = self.both
        first = None if coarse is None or fine is None else Estimate(fine, doubt * self.size)
        off, budget = difference(first, self.second), BUDGET * self.size
        return Row(f"apart: {self.quantity}", self.unit, first, self.second, off, budget, WEAK_FORM)


def events(scene: Scene, path: EquilibriumPath) -> list[Row]:
    """Balance, reaction, turning points and energy of every event of the finite elements, in the weak form.

    The weak form errs by less than its coarse and its fine body differ. As they may agree by chance on one number, the
    largest of their differences counts for all, relative to the sizes.
    """
    coarse, fine = bodies(scene)
    found = [row for name in path.events for row in _of_event(name, path, coarse, fine)]
    both = _energy_released(coarse, path), _energy_released(fine, path)
    found.append(Compared("energy released", "R dgamma eps", both, path.energy, abs(path.energy.value)))
    doubt = max(compared.change for compared in found)
    return [compared.row(doubt) for compared in found]


def _of_event(name: str, path: EquilibriumPath, coarse_body: Body, fine_body: Body) -> Iterator[Compared]:
    event, located = path.events[name], path.stages[-1][name]
    coarse, fine = _state(coarse_body, located), _state(fine_body, located)
    approach, load = (Estimate(getattr(event, key), getattr(event, f"{key}_error")) for key in ("approach", "load"))
    width, force = 1 + abs(approach.value), abs(load.value)
    balances, reactions = (coarse.balance, fine.balance), (coarse.reaction, fine.reaction)
    yield Compared(f"{name} balance", "eps", balances, Estimate(0.0, approach.error), width)
    if name != "zero_load":
        doubt = abs(_state(fine_body, path.stages[-2][name]).reaction - fine.reaction)
        doubted = Estimate(load.value, load.error + doubt)
        yield Compared(f"{name} reaction", "R dgamma", reactions, doubted, force)
    # What turns is stationary, and at the edge of a contact the coarse body turns elsewhere: it is solved beside.
    smooth = name == "jump_on"
    a = (_turn if smooth else _beside)(name, coarse)
    b = (_turn if smooth or fine.contact.tabor <= SHARP else _beside)(name, fine)
    if name != "pull_off":
        yield Compared(f"{name} approach", "eps", _numbers(a, b, lambda turn: turn.approach), approach, width)
    if name in ("pull_off", "jump_on"):
        yield Compared(f"{name} load", "R dgamma", _numbers(a, b, lambda turn: turn.load), load, force)


def _numbers(a: Turn | None, b: Turn | None, of: Callable[[Turn], float]) -> tuple[float | None, float | None]:
    return None if a is None else of(a), None if b is None else of(b)


@dataclass(frozen=True, eq=False, repr=False)
class State:
    """A state of the finite elements in the weak form: the displacements that its gaps would make.

    Attributes
    ----------
    contact, gap, approach, load
        The problem, and h, alpha and W of the finite elements.
    u : (n,) array
        The displacements.
    balance : float
        By how much the gaps that the displacements leave differ from those in eps, weighted by the tension.
    """

    contact: Contact
    gap: Array
    approach: float
    load: float
    u: Array
    balance: float

    @property
    def reaction(self) -> float:
        """Far reaction in R dgamma, and what is pulled at beyond the mesh."""
        return self.contact.far_reaction(self.u) + self.contact.load_beyond(self.approach)


def _state(body: Body, event: Located) -> State:
    """Take over the gaps, on a mesh of the size of the contact or of the attraction."""
    mu = event.problem.tabor
    approach, load, central_gap, radius = (float(value) for value in event.point.observables)
    attraction = 0.7 * float(np.sqrt(2 * (1 + central_gap) / mu))
    contact = Contact(body.scaled(float(np.fmax(radius, attraction))), mu)
    h = 1 + _gaps(event, contact.body.radii)
    u, weight = contact.displacement(h), np.abs(tension(h))
    off = (contact.gap(u, approach) - h) * weight
    return State(contact, h, approach, load, u, contact.body.integral(off) / contact.body.integral(weight))


def _gaps(event: Located, radii: Array) -> Array:
    """Gaps H of a state of the finite elements; beyond their cells they deflect as under a point load."""
    mu, (approach, load) = event.problem.tabor, event.point.observables[:2]
    problem, x = event.problem.interface, event.problem.surface_state(event.point.x)
    operator, beyond = problem.operator_at(x), -approach + mu * (paraboloid(radii) + load / (np.pi * radii))
    inside = np.minimum(radii, operator.extent)
    values = operator.values_at(inside.ravel(), x[:-2]).reshape(radii.shape)
    return np.where(radii < operator.extent, values, beyond)


def _turn(name: str, state: State) -> Turn | None:
    """Load and approach of the event in the weak form, or None where there is none nearby."""
    if name == "zero_load":
        return _beside(name, state)
    try:
        return turning_point(state.contact, state.gap, state.approach, state.load, under_load=name == "pull_off")
    except NotConverged:
        return None


def _beside(name: str, state: State) -> Turn | None:
    """Equilibrium at the approach of pull-off, or at the load of another event: what turns there is stationary."""
    try:
        found = newton(state.contact, state.gap, state.approach, load=None if name == "pull_off" else state.load)
    except NotConverged:
        return None
    return Turn(found.load, found.approach)


def _energy_released(body: Body, path: EquilibriumPath) -> float:
    """Potential energy between the two states of `EquilibriumPath.energy`; its error is of second order in theirs."""
    before, after = (_state(body, path.stages[-1][name]) for name in ("separated", "zero_approach"))
    return before.contact.energy(before.u, before.approach) - after.contact.energy(after.u, after.approach)


# Bodies


SHARP = 6.0
"""Tabor parameter beyond which the spike of tension is too narrow for the weak form to show where a contact turns."""


def bodies(scene: Scene) -> tuple[Body, ...]:
    """Half-spaces, coarse and fine, with cells at the contact edge finer than the spike of tension there."""
    finest = 0.04 * 3.0 ** -max(0.0, np.ceil(np.log(scene.tabor**2 / 4) / np.log(3)))
    more = int(scene.tabor > SHARP) + int(scene.tabor > 3 * SHARP)
    return tuple(_half_space(float(finest), size, degree + more, scene.poisson) for degree, size in FINENESS)


@lru_cache(maxsize=8)
def _half_space(finest: float, size: float, degree: int, poisson: float) -> Body:
    return half_space(finest, size, degree, poisson)
