"""The numbers of the algorithms in the weak form."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Numbers of the algorithms in the weak form, relative unless a unit is given.

    Attributes
    ----------
    even, growth, inner, within
        Cells of the box of a half-space about a contact edge at radius 1: equal ones next to the edge, ratio of one of
        the others to that before, how far they go inwards, and the longest inside the reach of the attraction, as a
        part of that.
    most
        Newton steps after which there is no equilibrium, and steps in approach from afar.
    near
        Relative change of the gaps that a further Newton step would make where its steps end.
    closing, opening
        Largest parts of a gap that one Newton step may close, and by which a step of approach may change one.
    aside, turned_at, farthest, tries
        Of the secant to a turning point: first step in 1 + the size of its coordinate at a blunt edge, part of that
        within which the point is found, farthest place of it in such steps, and most steps.
    longest, shortest
        Longest step along the path in the central gap, or in one and the squared contact radius: with 0.3 both folds
        at a Tabor parameter of 0.72 were passed by, with 0.15 they are found; and the step below which it ends.
    root, beside
        Place of an event along the path to which it is found, and the second one from which it is sought again.
    degrees
        Of the elements of a curve, until the events of two in a row agree to rtol.
    separated
        Approach in eps at which the curve begins; the attraction is a hundredth of its maximum there.
    left_out
        Part of rtol eps that the far clamp may take from the approach.
    found
        To which a number is solved for, in its unit.
    cells
        Length of the fine cells of a curve in the width of the spike of tension, or of the attraction.
    """

    even: int = 3
    growth: float = 3.0
    inner: float = 0.7
    within: float = 0.3
    most: int = 20
    near: float = 1e-9
    closing: float = 0.75
    opening: float = 0.3
    aside: float = 2e-3
    turned_at: float = 1e-3
    farthest: float = 500.0
    tries: int = 10
    longest: float = 0.1
    shortest: float = 1e-6
    root: float = 1e-7
    beside: float = 1e-3
    degrees: tuple[int, ...] = (2, 3, 4, 5)
    separated: float = -9.0
    left_out: float = 0.001
    found: float = 1e-8
    cells: float = 0.3


USUAL = Settings()
