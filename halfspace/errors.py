"""How a computation may end without a result: by what the user can mend, or by the solver's honest end.

Every other exception is a defect of the program, and shows its traceback.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeVar, final

T = TypeVar("T")


class InputError(ValueError):
    """What was asked for cannot be; the message gives the value, the limit and the remedy."""


class NotConverged(RuntimeError):
    """A solver ended without a solution; the message says how, and what to try."""


class ContactTooWide(NotConverged):
    """The contact spreads over so much of the body that its elasticity is no longer that of small slopes."""


class IllPosed(NotConverged):
    """Nothing holds waves as short as the cells: what is computed belongs to them, on finer ones too."""


class GridTooLarge(NotConverged):
    """The matrices on a grid take more memory than a computation may; the message says how much."""


class GridTooCoarse(NotConverged):
    """The grid cannot carry the spike of tension at the contact edge; the message says where and by how much.

    Attributes
    ----------
    radius, length, limit : float
        Where it is too coarse, the length of its cell there and the longest that would do, in beta.
    """

    def __init__(self, message: str, radius: float = math.nan, length: float = math.nan, limit: float = math.nan):
        super().__init__(message, radius, length, limit)
        self.radius, self.length, self.limit = radius, length, limit

    def __str__(self) -> str:
        """Return the message alone."""
        return str(self.args[0])


@final
@dataclass(frozen=True)
class Unsolved:
    """What a solver returns in the place of a solution: the reason why there is none, with the remedy.

    It is false, so that ``first or second`` is the second where the first is not solved. Where no other way is left to
    try `required` raises it as NotConverged.
    """

    reason: str

    def __bool__(self) -> Literal[False]:
        return False


def required(outcome: T | Unsolved) -> T:
    """Return a solution, or raise NotConverged with the reason why there is none."""
    if isinstance(outcome, Unsolved):
        raise NotConverged(outcome.reason)
    return outcome
