"""Numbers with errors, and results that hold arrays, as values.

They are compared by what they hold, shown in a few lines, and pickled without their caches.
The comparison that `dataclasses` writes asks an array for its truth and raises; its repr prints every number.
"""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable, Hashable, Mapping
from dataclasses import Field, dataclass, fields, is_dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from halfspace.errors import InputError

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

FEW = 4  # items of a sequence, and numbers of an array, that are shown one by one


@dataclass(frozen=True)
class Estimate:
    """A number and the estimated bound of its error, in the same unit.

    Of sums the bounds add up, of products to the first order: they are no standard deviations, of which some cancel.
    """

    value: float
    error: float

    def __add__(self, other: Estimate | float) -> Estimate:
        more = _exact(other)
        return Estimate(self.value + more.value, self.error + more.error)

    def __sub__(self, other: Estimate | float) -> Estimate:
        less = _exact(other)
        return Estimate(self.value - less.value, self.error + less.error)

    def __mul__(self, other: Estimate | float) -> Estimate:
        by = _exact(other)
        return Estimate(self.value * by.value, abs(self.value) * by.error + self.error * abs(by.value))

    def __truediv__(self, other: Estimate | float) -> Estimate:
        by, value = _exact(other), self.value / _exact(other).value
        least = abs(by.value) - by.error  # zero may be by what is divided then, and the quotient anything
        return Estimate(value, (self.error + abs(value) * by.error) / least if least > 0 else math.inf)

    def __abs__(self) -> Estimate:
        return Estimate(abs(self.value), self.error)

    @classmethod
    def refined(cls, coarse: float, fine: float) -> Estimate:
        """Return the finer of two results, with the change from the coarser as its error."""
        return cls(fine, abs(fine - coarse))

    def agrees(self, other: Estimate) -> bool:
        """Whether the two differ by no more than both errors; not so if one is not a number."""
        return abs(self.value - other.value) <= self.error + other.error


def _exact(number: Estimate | float) -> Estimate:
    return number if isinstance(number, Estimate) else Estimate(number, 0.0)


class Valued:
    """Base of a dataclass, declared with ``eq=False, repr=False``, whose fields may hold arrays."""

    def __eq__(self, other: object) -> bool:
        """Whether all compared fields hold the same; nan is the same as nan."""
        return self is other or (type(self) is type(other) and _same_fields(self, other))

    def __hash__(self) -> int:
        """Return one number for all of a class, since arrays have none: equal values must not differ."""
        return hash(type(self).__qualname__)

    def __repr__(self) -> str:
        """Fields by name; arrays by their shape, long sequences by their length, parts by their class."""
        told = (f"{f.name}={shown(getattr(self, f.name))}" for f in _fields(self) if f.repr)
        return f"{type(self).__name__}({', '.join(told)})"

    def __getstate__(self) -> dict[str, Any]:
        """Fields alone: what is cached is computed again."""
        return {field.name: getattr(self, field.name) for field in _fields(self)}


@dataclass(frozen=True, eq=False, repr=False)
class States(Valued):
    """States of a contact, with the estimated error of each number; all arrays have the shape of what was asked.

    Attributes
    ----------
    approach, approach_error : array
        In eps.
    load, load_error : array
        In R dgamma, positive in compression.
    central_gap, central_gap_error : array
        H(0) in eps.
    contact_radius, contact_radius_error : array
        In beta, of the edge where the tension is largest, H = 3^(1/6) - 1 by the 3-9 law; nan if H(0) exceeds that,
        its error then infinite if that of H(0) leaves it open.
    """

    approach: Array
    load: Array
    central_gap: Array
    contact_radius: Array
    approach_error: Array
    load_error: Array
    central_gap_error: Array
    contact_radius_error: Array


def same(a: Any, b: Any) -> bool:
    """Whether two values are of one type and hold the same, arrays and what is not a number included."""
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return bool(a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc"))
    if _is_sparse(a):
        return bool(a.shape == b.shape and (a != b).nnz == 0)
    if isinstance(a, float):
        return a == b or (math.isnan(a) and math.isnan(b))
    if isinstance(a, Mapping):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (tuple, list)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, partial):
        return same((a.func, a.args, a.keywords), (b.func, b.args, b.keywords))
    if is_dataclass(a) and not isinstance(a, type):
        return _same_fields(a, b)
    # A library's object, such as an element, that has no comparison of its own is what it was made of.
    return same(vars(a), vars(b)) if "__eq__" not in _methods(a) and hasattr(a, "__dict__") else bool(a == b)


def _methods(value: Any) -> set[str]:
    """Names that a value's classes define, but for those of every object."""
    return {name for base in type(value).__mro__ if base is not object for name in vars(base)}


def shown(value: Any) -> str:
    """Return a value in some sixty characters."""
    if isinstance(value, np.ndarray):
        return f"array{value.tolist()}" if value.size <= FEW else f"array of shape {value.shape}"
    if _is_sparse(value):
        return f"sparse array of shape {value.shape}"
    if isinstance(value, (tuple, list)) and len(value) > FEW:
        return f"{len(value)} times {type(value[0]).__name__}"
    if isinstance(value, (tuple, list)):
        return f"({', '.join(map(shown, value))})"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key}: {shown(item)}' for key, item in value.items())}}}"
    if isinstance(value, Valued):
        return f"{type(value).__name__}(...)"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:60]}..."


def _is_sparse(value: Any) -> bool:
    return hasattr(value, "tocsr")  # asked of what it can: SciPy's sparse part takes long to load


def _same_fields(a: Any, b: Any) -> bool:
    return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a) if f.compare)


def _fields(value: Any) -> tuple[Field[Any], ...]:
    return fields(value)


def keep(part: object, **values: object) -> None:
    """Let a frozen part that is being made hold its values as they were checked, numbers as floats."""
    for name, value in values.items():
        object.__setattr__(part, name, value)


def appended(values: Array, last: float) -> Array:
    """Vector with one more number: NumPy's `append` takes three times as long, which tells where vectors are short."""
    longer = np.empty(values.size + 1)
    longer[:-1] = values
    longer[-1] = last
    return longer


def read_columns(path: Path, fewest: int) -> tuple[Array, Array]:
    """Two columns of a CSV file, the first ascending; lines that are no numbers may come before."""
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")  # letters stand in the header alone
    except OSError as error:
        why = f"{error.strerror}, limit: a file of two columns of numbers; give a CSV file"
        raise InputError(f"{path} cannot be read: {why}") from error
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    first = next((at for at, (_, line) in enumerate(lines) if _numbers(line) is not None), None)
    if lines and first is None:
        number, line = lines[-1]
        limit = "two numbers with a comma between, points in them"
        raise InputError(f"{path}, line {number}: {shown(line)}, limit: {limit}; save it as CSV in UTF-8")
    lines = lines[first:]
    if len(lines) < fewest:
        limit = f"{fewest}, of two numbers with a comma between"
        raise InputError(f"{path} has {len(lines)} rows, limit: {limit}; give more points")
    rows = np.array([_row(path, *line) for line in lines])
    for i in np.flatnonzero(np.diff(rows[:, 0]) <= 0):
        where, (before, here) = f"{path}, line {lines[i + 1][0]}", rows[i : i + 2, 0]
        raise InputError(f"{where}: the first column goes from {before:g} to {here:g}, limit: ascending; sort it")
    return rows[:, 0], rows[:, 1]


def _row(path: Path, number: int, line: str) -> list[float]:
    """Two numbers of a line; raise InputError where they are not."""
    numbers = _numbers(line)
    if numbers is None or not np.isfinite(numbers).all():
        raise InputError(f"{path}, line {number}: {shown(line)}, limit: two finite numbers; mend it or leave it out")
    return numbers


def _numbers(line: str) -> list[float] | None:
    """First two numbers of a line of a CSV file; None if it has fewer."""
    try:
        first, second = map(float, line.split(",")[:2])
    except ValueError:
        return None
    return [first, second]


T = TypeVar("T")


class Recent:
    """What was made last for some owners, as many bytes as there is room for; the rest is made again when asked for.

    An entry is known by its owner and a name, and has a version, of which the latest is kept. It ends with its owner.
    """

    def __init__(self, room: float) -> None:
        self.room = room
        self._entries: dict[tuple[int, str], tuple[weakref.ref[object], Hashable, Any]] = {}

    def get(self, owner: object, name: str, make: Callable[[], T], version: Hashable = None) -> T:
        """Entry of an owner in a version, made unless it is still there; it says its `nbytes`."""
        which = id(owner), name
        known = self._entries.pop(which, None)
        if known is None or known[0]() is not owner or known[1] != version:
            made: Any = make()
            known = weakref.ref(owner), version, made
            self._make_room(made.nbytes)
        self._entries[which] = known
        kept: T = known[2]
        return kept

    def _make_room(self, needed: float) -> None:
        """Let go of what has lost its owner, and of the oldest entries."""
        self._entries = {which: entry for which, entry in self._entries.items() if entry[0]() is not None}
        needed += sum(made.nbytes for *_, made in self._entries.values())
        while needed > self.room and self._entries:
            needed -= self._entries.pop(next(iter(self._entries)))[2].nbytes
