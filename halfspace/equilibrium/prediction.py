"""The next state of a path where the contact edge runs over a grid that stands still, and with it the spike of tension.

At a fixed place gaps bend as sharply as the spike is narrow; seen from the edge they change as smoothly as the radius
of the contact. So they are extrapolated there, through the last states, and the body is asked for what lies below.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from halfspace.elastic.grid import polynomial
from halfspace.equilibrium.contact import LARGEST, ContactProblem
from halfspace.equilibrium.newton import Traceable
from halfspace.values import Array, Valued

KNOWN = 3  # states through which the next is extrapolated


@dataclass(frozen=True, eq=False, repr=False)
class Passed(Valued):
    """A state that the path has passed, as its `interface` knows it: (q + 2,), at an arclength."""

    interface: ContactProblem
    state: Array
    arclength: float

    @cached_property
    def radius(self) -> float:
        """Contact radius on the undeformed body, in beta; nan without contact."""
        return self.interface.contact_radius(self.state)

    def seen(self, radii: Array, radius: float) -> Array:
        """Gaps where these radii are, were the contact of another radius, and its approach, (n + 1,)."""
        body = self.interface.operator_at(self.state)
        own = np.interp(radii, (0.0, radius, body.extent), (0.0, self.radius, body.extent))
        return np.append(body.values_at(own, self.state[:-2]), self.state[-2])


def passed(problem: Traceable, x: Array, arclength: float) -> Passed:
    """A state of a problem, as passed."""
    return Passed(problem.interface, problem.surface_state(x), arclength)


def with_edge(problem: Traceable, trail: Sequence[Passed], near: Array, arclength: float) -> Array | None:
    """State at an arclength beyond the last of those passed, near that; None unless two have a contact."""
    known = [state for state in trail if state.radius > 0][-KNOWN:]  # nor nan
    if len(known) < 2 or not trail[-1].radius > 0:
        return None
    weights = polynomial(np.array([state.arclength for state in known]), arclength)
    radius = float(weights @ [state.radius for state in known])
    surface = problem.interface
    body = surface.operator_at(problem.surface_state(near))
    if not 0 < radius < body.extent:
        return None
    radii = body.radii
    views = np.array([state.seen(radii, radius) for state in known])
    ahead, last_gaps = weights @ views, views[-1, :-1]
    gaps = np.maximum(ahead[:-1], last_gaps - LARGEST * surface.law.room(last_gaps))
    return problem.state_from_surface(np.append(gaps, [ahead[-1], 1.0]), near)
