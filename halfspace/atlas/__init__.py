"""Atlas: all that depends on the Tabor parameter alone, for a paraboloid on a half-space under the 3-9 law."""

from halfspace.atlas.curves import Curve, curve
from halfspace.atlas.events import (
    Energy,
    Jump,
    birth_of_folds,
    energy_lost,
    energy_released,
    jump_off,
    jump_on,
    pull_off,
    zero_load,
)

__all__ = [
    "Curve",
    "Energy",
    "Jump",
    "birth_of_folds",
    "curve",
    "energy_lost",
    "energy_released",
    "jump_off",
    "jump_on",
    "pull_off",
    "zero_load",
]
