"""Sentences made of numbers: each is left unsaid where one of them is missing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from halfspace.values import Array

NOTHING = "No numbers were found to tell of."


def told(text: str, *numbers: float | Array) -> str:
    """The text, or nothing if a number that it rests on is missing or not finite."""
    known = all(np.size(number) and np.all(np.isfinite(number)) for number in numbers)
    return text if known else ""


def joined(*sentences: str) -> str:
    """Sentences that have something to tell, as one paragraph."""
    return " ".join(filter(None, sentences)) or NOTHING


def listed(names: Sequence[str]) -> str:
    """Names with commas and an `and`."""
    return " and ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))


def counted(count: int, what: str) -> str:
    """How many there are of something: 1 case, 2 cases."""
    return f"{count} {what}{'' if count == 1 else 's'}"


def rises(values: Array) -> bool:
    """Whether each value exceeds the one before it; there must be two."""
    return values.size > 1 and bool(np.all(np.diff(values) > 0))


def span(values: Sequence[float] | Array) -> str:
    """Least and largest of some numbers, to two digits or to the last before the point."""
    ends = (float(np.min(values)), float(np.max(values)))
    return " to ".join(dict.fromkeys(f"{end:.2g}" if abs(end) < 99.5 else f"{end:.0f}" for end in ends))


def at_points(count: int) -> str:
    """At how many points something was found."""
    return f" ({counted(count, 'point')})"
