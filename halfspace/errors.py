"""How a computation may end without a result: by what the user can mend, or by the solver's honest end.

Every other exception is a defect of the program, and shows its traceback.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, final

T = TypeVar("T")


class InputError(ValueError):
    """What was asked for cannot be; the message gives the value, the limit and the remedy."""


class NotConverged(RuntimeError):
    """A solver ended without a solution; the message says how, and what to try."""


class ContactTooWide(NotConverged):
    """The contact spreads over so much of the body that its elasticity is no longer that of small slopes."""


class HeldApart(NotConverged):
    """The law holds the surfaces apart, by a barrier or a second minimum, up to the load at which the curve ends."""


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


def nearest(word: str, known: Iterable[str]) -> str | None:
    """Which known word is near to one that is not, to be named in the remedy, if there is one."""
    from difflib import get_close_matches  # here, as it takes a third of what the program's help does

    return next(iter(get_close_matches(word, list(known), n=1)), None)


@final
@dataclass(frozen=True)
class Unsolved:
    """What a solver returns in the place of a solution: the reason why there is none, and the kind of its error.

    It is false, so that ``first or second`` is the second where the first is not solved. Where no other way is left to
    try `required` raises it.
    """

    reason: str
    kind: type[InputError | NotConverged] = NotConverged

    def __bool__(self) -> Literal[False]:
        return False


def required(outcome: T | Unsolved) -> T:
    """Return a solution, or raise an error of its kind with the reason why there is none."""
    if isinstance(outcome, Unsolved):
        raise outcome.kind(outcome.reason)
    return outcome


def tried(solve: Callable[..., T], *given: Any, refusals: bool = False, **how: Any) -> T | Unsolved:
    """Solve a whole case, or say why it was not solved, so that a study goes on with the next.

    With `refusals` a case that is outside what the solver serves, an InputError, is one of these as well.
    """
    try:
        return solve(*given, **how)
    except (InputError, NotConverged) as error:
        if isinstance(error, InputError) and not refusals:
            raise
        return Unsolved(str(error), type(error))
