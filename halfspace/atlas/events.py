"""Events of the curves and their energies, at any Tabor parameters: read from series, none solved for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from halfspace.atlas.series import require_tabors, series, stored
from halfspace.values import Array, Estimate, States, Valued


@dataclass(frozen=True, eq=False, repr=False)
class Jump(Valued):
    """Jumps under fixed grips: the states before and after, and the energy set free.

    Attributes
    ----------
    take_off, landing : States
        Both at the same approach.
    energy, energy_error : array
        In R dgamma eps.
    """

    take_off: States
    landing: States
    energy: Array
    energy_error: Array


@dataclass(frozen=True, eq=False, repr=False)
class Energy(Valued):
    """Energies in R dgamma eps, with their errors."""

    energy: Array
    energy_error: Array


def birth_of_folds() -> Estimate:
    """Tabor parameter below which no curve folds, so that fixed grips do not jump."""
    return Estimate(*stored()["birth"])


def pull_off(tabor: ArrayLike, *, derivative: int = 0) -> States:
    """Pull-off: where the load is least.

    Parameters
    ----------
    tabor : array_like
        Tabor parameters, 0.01 to 300, of a paraboloid on a half-space under the 3-9 law.
    derivative : int
        1 for the derivatives of all numbers by the Tabor parameter, and their errors, in the place of the numbers.

    Returns
    -------
    States
        Approach, load, central gap and contact radius with their errors, each of the shape of `tabor`.

    Raises
    ------
    InputError
        If a Tabor parameter is outside the atlas.
    """
    return _states("pull_off", tabor, derivative)


def zero_load(tabor: ArrayLike, *, derivative: int = 0) -> States:
    """Contact under no load; parameters as of `pull_off`."""
    return _states("zero_load", tabor, derivative)


def jump_on(tabor: ArrayLike, *, derivative: int = 0) -> Jump:
    """Jump into contact under fixed grips, nan below `birth_of_folds`; parameters as of `pull_off`."""
    return _jump("jump_on", tabor, derivative)


def jump_off(tabor: ArrayLike, *, derivative: int = 0) -> Jump:
    """Jump out of contact under fixed grips, nan below `birth_of_folds`; parameters as of `pull_off`."""
    return _jump("jump_off", tabor, derivative)


def energy_released(tabor: ArrayLike, *, derivative: int = 0) -> Energy:
    """Potential energy released from far separation to zero approach in contact; parameters as of `pull_off`."""
    return Energy(*_number("energy_released", require_tabors(tabor), derivative))


def energy_lost(tabor: ArrayLike, *, derivative: int = 0) -> Energy:
    """Energy lost in a cycle under fixed grips, 0 where curves do not fold; parameters as of `pull_off`."""
    tabors = require_tabors(tabor)
    on, off = (np.array(_number(f"{jump}.energy", tabors, derivative)) for jump in ("jump_on", "jump_off"))
    return Energy(*np.where(tabors < birth_of_folds().value, 0.0, on + off))


def _jump(name: str, tabor: ArrayLike, derivative: int) -> Jump:
    take_off, landing = (_states(f"{name}.{end}", tabor, derivative) for end in ("take_off", "landing"))
    return Jump(take_off, landing, *_number(f"{name}.energy", require_tabors(tabor), derivative))


def _states(event: str, tabor: ArrayLike, derivative: int) -> States:
    """States of an event."""
    tabors = require_tabors(tabor)
    numbers = [
        _number(f"{event}.{name}", tabors, derivative) for name in ("approach", "load", "central_gap", "contact_radius")
    ]
    return States(*(value for value, _ in numbers), *(error for _, error in numbers))


def _number(name: str, tabor: Array, derivative: int) -> tuple[Array, Array]:
    """Value and error of a number, or of its derivative, of the shape of the Tabor parameters."""
    name = name.replace("landing.approach", "take_off.approach")
    if name not in stored()["series"]:  # the load under no load, and the radius without contact
        nothing = np.full(tabor.shape, 0.0 if name == "zero_load.load" else np.nan)[()]
        return nothing, nothing
    value, error = series(name)(np.atleast_1d(tabor), derivative)
    return value.reshape(tabor.shape)[()], error.reshape(tabor.shape)[()]
