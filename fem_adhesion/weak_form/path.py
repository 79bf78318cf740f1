"""The path of equilibria through the folds: pseudo-arclength, and the events on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq
from scipy.optimize import newton as secant

from fem_adhesion.weak_form.body import Array
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.newton import Equilibrium, along, at_approach, at_load, even, newton, on_axis
from fem_adhesion.weak_form.settings import USUAL, Settings
from halfspace.errors import NotConverged, Unsolved, tried
from halfspace.values import Valued


@dataclass(frozen=True, eq=False, repr=False)
class Point(Valued):
    """An equilibrium and the direction of the path there.

    Attributes
    ----------
    state : Equilibrium
        The equilibrium.
    direction, row : (q + 1,) array
        Unit tangent of the path, and the row <tangent, .> of the inner product.
    """

    state: Equilibrium
    direction: Array
    row: Array

    @cached_property
    def observables(self) -> Array:
        """Approach and load, central gap H(0) in eps, contact radius in beta (nan without contact)."""
        state = self.state
        return np.array([state.approach, state.load, state.central_gap, state.contact_radius])

    @cached_property
    def rates(self) -> Array:
        """Change of approach, load and central gap along the path."""
        contact, direction = self.state.contact, self.direction
        load = float(contact.load_row(self.state.y) @ direction)
        return np.array([direction[-1], load, on_axis(contact, direction[:-1])])

    @property
    def stable(self) -> bool:
        """Whether the state is stable under fixed grips."""
        return self.state.tangent.unstable == 0


Condition = Callable[[Point], float]
CONDITIONS: Mapping[str, Condition] = {
    "fold": lambda point: float(point.rates[0]),
    "pull_off": lambda point: float(point.rates[1]),
    "zero_load": lambda point: point.state.load,
}
"""What vanishes at an event: d(alpha)/ds at a jump or a further fold, dW/ds at pull-off, W at no load."""


def condition_of(name: str) -> Condition:
    """What vanishes at the event of a name."""
    return CONDITIONS.get(name, CONDITIONS["fold"])


@dataclass(frozen=True, eq=False, repr=False)
class Path(Valued):
    """The equilibria of a contact; the mean square of a change of the gap on a disc measures their arclength.

    The radius of the disc is in beta.
    """

    contact: Contact
    disc: float
    how: Settings = USUAL

    @cached_property
    def inner(self) -> Array:
        """Weights (q + 1,) of <y, y'> = alpha alpha' + mean over the disc of h h'."""
        body = self.contact.body
        return np.append(np.where(body.radii < self.disc, body.area, 0.0) / (np.pi * self.disc**2), 1.0)

    def point(self, state: Equilibrium, onward: Array) -> Point:
        """Point of the path at an equilibrium, in the direction in which a row rises."""
        rate = state.tangent.rate
        row = self.inner * rate
        size = np.copysign(np.sqrt(row @ rate), onward @ rate)
        return Point(state, rate / size, row / size)

    def onward(self, a: Point, s: float, start: Array | None = None) -> Point:
        """Point an arclength past another, from a state nearby: on the tangent there unless given."""
        if s == 0:
            return a
        start = a.state.y + s * a.direction if start is None else start
        reached = along(a.row, float(a.row @ a.state.y) + s)
        return self.point(newton(self.contact, start, reached, self.how.most_along), a.row)

    def between(self, a: Point, b: Point, s: float) -> Point:
        """Point an arclength past one of two neighbours, from the tangents at both."""
        length = float(a.row @ (b.state.y - a.state.y))
        ahead, back, part = a.state.y + s * a.direction, b.state.y - (length - s) * b.direction, s / length
        return self.onward(a, s, ahead + part**2 * (3 - 2 * part) * (back - ahead))

    def follow(self, approach: float, to_load: float) -> list[Point]:
        """Points from an approach of separated surfaces, through every fold, to a compressive load."""
        start, how = self.contact.undeformed(approach), self.how
        points = [self.point(newton(self.contact, start, at_approach(start)), np.eye(1, start.size, start.size - 1)[0])]
        s, bend = how.first, np.zeros(1)
        while points[-1].state.load < to_load:
            before = points[-1]
            if s < how.shortest or len(points) > how.most_points:
                at = f"alpha = {before.state.approach:.4g} eps"
                raise NotConverged(f"the weak form's path ends at {at}; try another to_load or a smaller tabor")
            point = tried(self.onward, before, s, before.state.y + s * (before.direction + s / 2 * bend))
            if isinstance(point, Unsolved):
                s /= 2
                continue
            opened = abs((1 + point.observables[2]) / (1 + before.observables[2]) - 1) / how.opening
            # The chord turns half as much as the tangent: a long one has led to another part of the path.
            chord = s**2 / float(self.inner @ (point.state.y - before.state.y) ** 2)
            turned = (1 - min(float(before.row @ point.direction), 2 * chord - 1)) / (1 - how.turn)
            if max(opened, turned) > 1 or turns_twice(before, point):
                s /= 2
                continue
            bend = (point.direction - before.direction) / s
            points.append(point)
            s *= float(np.clip(how.suits / max(opened, turned), 0.5, 2.0))
        last, end = points[-1], at_load(self.contact, to_load)
        return [*points[:-1], self.point(newton(self.contact, last.state.y, end), last.row)]

    def located(self, points: Sequence[Point], condition: Condition) -> list[Point]:
        """All points at which a condition changes its sign, in order.

        Each is a root in the arclength past the point before it; the state is solved for at every trial.
        """
        found = []
        for a, b in pairwise(points):
            if condition(a) * condition(b) < 0:
                length = float(a.row @ (b.state.y - a.state.y))
                to = partial(self.between, a, b)
                root = brentq(lambda s, to=to: condition(to(s)), 0.0, length, xtol=self.how.root * length)
                found.append(to(root))
        return found

    def events(self, points: Sequence[Point]) -> dict[str, Point]:
        """Pull-off, zero load in contact, and the folds: jump_on and jump_off the outermost, fold_2 ... between."""
        folds, extrema, zeros = (self.located(points, condition) for condition in CONDITIONS.values())
        if not extrema:
            raise NotConverged("the weak form's path has no minimum of the load; give a larger to_load")
        found = {"pull_off": min(extrema, key=CONDITIONS["zero_load"])}
        if len(folds) > 1:
            found |= {"jump_on": folds[0], "jump_off": folds[-1]}
            found |= {f"fold_{n}": point for n, point in enumerate(folds[1:-1], 2)}
        return found | ({"zero_load": zeros[-1]} if zeros else {})

    def taken_over(self, point: Point) -> Point:
        """Point on the same cells by elements of another degree, on its plane across the path."""
        y, direction = (carried(self.contact, point.state.contact, each) for each in (point.state.y, point.direction))
        row = self.inner * direction
        return self.point(newton(self.contact, y, along(row, float(row @ y))), row)

    def event_near(self, point: Point, condition: Condition) -> Point:
        """Event near a point, by the secant in the arclength."""
        how = self.how
        s = secant(lambda s: condition(self.onward(point, s)), 0.0, x1=how.beside, tol=how.root * how.first)
        return self.onward(point, float(s))


def carried(onto: Contact, source: Contact, y: Array) -> Array:
    """State, or direction, at the points of other elements."""
    return np.append(even(source.body.radii, y[:-1])(onto.body.radii), y[-1])


def turns_twice(a: Point, b: Point) -> bool:
    """Whether approach or load turn and turn back between two points, by the cubics with their values and rates."""
    means = (b.observables - a.observables)[:2] / (a.row @ (b.state.y - a.state.y))
    before, after = a.rates[:2], b.rates[:2]
    halfway = 1.5 * means - (before + after) / 4
    return bool(((before * after > 0) & (before * halfway < 0)).any())


def arclength(a: Point, b: Point) -> float:
    """Arclength between two points of a path, each on its own elements, by the tangent at the second."""
    return abs(float(b.row @ (b.state.y - carried(b.state.contact, a.state.contact, a.state.y))))
