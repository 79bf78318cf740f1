"""What an attempt at a hard case found: an error beside its estimate."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from halfspace.equilibrium.curve import EquilibriumPath


@dataclass(frozen=True)
class Measured:
    """A number that was computed twice.

    Attributes
    ----------
    quantity : str
        Which number: of several, the one whose error comes nearest to its estimate or is the furthest beyond it.
    error, estimate : float
        Difference from the reference, and what the computation itself says its error is.
    reference : str
        What it was compared with.
    reference_error : float
        Estimated error of the reference.
    newton_steps : int
        Along the curve, or to the state.
    """

    quantity: str
    error: float
    estimate: float
    reference: str
    reference_error: float = 0.0
    newton_steps: int = 0

    @property
    def within(self) -> bool:
        """Whether the error is no more than both estimates; false for a NaN."""
        return self.error <= self.estimate + self.reference_error

    @property
    def ratio(self) -> float:
        """Error in units of both estimates; infinite for a NaN."""
        if math.isnan(self.error):
            return math.inf
        return self.error / max(self.estimate + self.reference_error, 1e-300)


def compare_events(path: EquilibriumPath, truth: EquilibriumPath, reference: str) -> Measured:
    """Compare the loads and approaches of all events; one that only one of the curves has is infinitely wrong."""
    return worst(_event_measures(path, truth, reference))


def worst(measures: Iterable[Measured]) -> Measured:
    """The measure whose error is largest beside its estimate."""
    return max(measures, key=lambda m: m.ratio)


def _event_measures(path: EquilibriumPath, truth: EquilibriumPath, reference: str) -> Iterator[Measured]:
    steps = newton_steps(path)
    for name in {**path.events, **truth.events}:
        a, b = path.event(name), truth.event(name)
        if a is None or b is None:
            yield Measured(name, math.inf, 0.0, reference, 0.0, steps)
            continue
        for quantity in ("load", "approach"):
            error = abs(getattr(a, quantity) - getattr(b, quantity))
            own, other = (getattr(event, f"{quantity}_error") for event in (a, b))
            yield Measured(f"{name} {quantity}", error, own, reference, other, steps)


def newton_steps(path: EquilibriumPath) -> int:
    """Newton steps taken along a curve."""
    return sum(point.iterations for segment in path.segments for point in segment.points)
