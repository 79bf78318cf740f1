"""Atlas: all that depends on the Tabor parameter alone, for a paraboloid on a half-space under the 3-9 law.

`series` (of one number), `events` (pull-off, zero load, jumps, energies), `curves` (whole curves) read what `build` and
`build_curves` have made of traces: ``python -m halfspace.atlas``. `sphere` has pull-off and jumps of elastic spheres,
which depend on R/eps and Poisson's ratio as well. To read all that takes NumPy alone.
"""

from halfspace.atlas import sphere
from halfspace.atlas.curves import Curve, curve, table
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

__all__ = ["Curve", "Energy", "Jump", "birth_of_folds", "curve", "energy_lost", "energy_released"]
__all__ += ["jump_off", "jump_on", "pull_off", "sphere", "table", "zero_load"]


def __dir__() -> list[str]:
    return __all__
