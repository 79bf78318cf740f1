"""Where the events of a body by finite elements are solved for: on operators made for the places of the events.

An operator is dear, so that no chart serves all contact radii as well as an event needs it. Each event is solved for on
an operator made around its own contact radius, or all of them on one made across theirs, whichever takes fewer.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from halfspace.accuracy.finite_bodies import SizedBody, step_above
from halfspace.accuracy.grids import operators_of_curve
from halfspace.accuracy.stages import Charted
from halfspace.accuracy.standing import WhereAsked
from halfspace.equilibrium.charts import Chart, moved
from halfspace.equilibrium.conditions import Located
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.equilibrium.newton import Traceable
from halfspace.errors import NotConverged

WINDOW, AROUND = 2e-3, 3  # half the logarithmic width of the radii around an event on the lowest rung, operators in it
WIDE, WIDELY = 0.4, 7  # the same farther around: an event that lies off by a fifth is then found to 1e-6 of its radius
ASTRAY = 0.05  # part of a contact radius: a leap in which a chart made for the first says nothing about the second
COARSEST = 1e-3  # tolerance up to which operators follow it: at 1e-2 landings and pull-off were up to 4.9 times outside
BESIDE = 0.01  # logarithmic width by which a chart for all events reaches past them: they move from grid to grid
TIGHT = 1e-6  # tolerance below which a derivative that errs by the window's square is not good enough
CLIMBED = 2  # rungs up, from which on it is not either


def surroundings(rtol: float, level: int) -> tuple[float, int]:
    """Half the logarithmic width of the radii around an event on a rung, halved on each above it, and operators in it.

    In their middle the operator is as good as exact. Its derivative, by which a fold or an extremum is found, errs by
    the window's square with three operators, some 1e-7 of the approach at pull-off, and by its fourth power with five.
    What each operator errs by counts the more the narrower the window: under a large sphere on strata as much at a
    quarter of the lowest rung's as its square does, so that there are five where the two lowest rungs did not do.
    """
    window, count = (WINDOW, AROUND) if rtol >= TIGHT and level < CLIMBED else (2 * WINDOW, AROUND + 2)
    return window / 2**level, count


@dataclass(frozen=True, eq=False, repr=False)
class AroundEvents(WhereAsked):
    """Stage of a ladder on which events have operators made for their contact radii, all of them together or each.

    The window is half the logarithmic width of the contact radii that a chart for one event serves, with `count`
    operators in it, see `surroundings`. A fold is where a derivative vanishes, which errs by a power of the window:
    windows that differ from rung to rung let the error estimate see it. A chart for all events leaves an error `across`
    of loads in R dgamma and gaps in eps by its polynomial, of which rung after rung takes one operator more, `more`;
    without it each event has its own.
    """

    body: SizedBody
    nodes: int
    window: float = WINDOW
    count: int = AROUND
    across: float | None = None
    more: int = 0

    def prepare(self, events: Iterable[Located]) -> None:
        """Make one chart for all these events, where one for each takes more operators."""
        radii = sorted({radius for event in events if (radius := _radius(event)) and not self.serving(radius)})
        if not self.across or not radii:
            return
        alone = 1 + sum(b > a * (1 + self.window) for a, b in pairwise(radii))
        least, most = 1 / step_above(np.exp(BESIDE) / radii[0]), step_above(np.exp(BESIDE) * radii[-1])
        middle, window = float(np.sqrt(least * most)), float(np.log(most / least)) / 2
        count = self.body.operators_between(*self.body.span(middle, window), self.across) + self.more
        if count < alone * self.count:
            self._made_around(middle, window, count)

    def __call__(self, event: Located) -> Chart:
        """Chart for an event, made unless one made before will do."""
        radius = _radius(event)
        return self.serving(radius) or self._made_around(radius, self.window, self.count)

    def _made_around(self, radius: float, window: float, count: int) -> Chart:
        chart = self._around(radius, window, count) if radius else self.body.centred()
        return self.keep(radius * np.exp(-window), radius * np.exp(window), chart)

    def _around(self, radius: float, window: float, count: int) -> Chart:
        return self.body.over(*self.body.span(radius, window), count)

    def moved(self, event: Located, problem: Traceable) -> Located:
        """Solve for an event on a chart made for where it was found, or if that leads astray on one for farther off."""
        if not problem.interface.follows_contact:
            return moved(event, problem)
        before = float(event.point.observables[CONTACT_RADIUS])
        with suppress(NotConverged):
            found = moved(event, problem)
            if abs(found.point.observables[CONTACT_RADIUS] - before) <= ASTRAY * before:
                return found
        found = moved(event, self._around(before, WIDE, WIDELY).problem)
        there = self(found).problem  # from nearer; the wide chart, which errs more, is none of this stage's
        return moved(found, problem if there is self(event).problem else there)

    @cached_property
    def everywhere(self) -> Charted:
        """The same grid for every point of a curve."""
        return Charted(self.body.curve(operators_of_curve(self.body, self.nodes)))


def _radius(event: Located) -> float:
    """Contact radius for which an event has operators; 0 on the chart that stands on the axis."""
    return float(event.point.observables[CONTACT_RADIUS]) if event.problem.interface.follows_contact else 0.0
