"""Laws of the tension between two surfaces against their gap, one a module.

`law` says what each must know of itself; `power_law` is the default, Lennard and Jones's for solids; `morse` is
exponential, `dugdale` constant up to a range, `tabulated` read from a file.
"""

from halfspace.laws.dlvo import Dlvo
from halfspace.laws.dugdale import Dugdale
from halfspace.laws.exponential import Exponential
from halfspace.laws.law import Law
from halfspace.laws.morse import Morse
from halfspace.laws.power_law import LENNARD_JONES, LennardJones, PowerLaw
from halfspace.laws.tabulated import Tabulated

__all__ = ["LENNARD_JONES", "Dlvo", "Dugdale", "Exponential", "Law", "LennardJones", "Morse", "PowerLaw", "Tabulated"]
