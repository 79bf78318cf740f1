"""Laws of the tension between two surfaces against their gap.

`law` says what each must know of itself; of the `formulas` the first is the default, Lennard and Jones's for solids;
`tabulated` is read from a file.
"""

from halfspace.laws.formulas import LENNARD_JONES, Dlvo, Dugdale, Exponential, LennardJones, Morse, PowerLaw
from halfspace.laws.law import Law
from halfspace.laws.tabulated import Tabulated

__all__ = ["LENNARD_JONES", "Dlvo", "Dugdale", "Exponential", "Law", "LennardJones", "Morse", "PowerLaw", "Tabulated"]


def __dir__() -> list[str]:
    return __all__
