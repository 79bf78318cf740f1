"""Apparatus of any stiffness: what a softer one loses in a cycle, and from what stiffness a contact jumps at all."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from halfspace.accuracy.fold_birth import FIRST, critical_stiffness, tabor_of
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, cycle
from halfspace.values import Array, Valued

STIFFNESSES = (math.inf, 100.0, 10.0, 3.0, 1.0, 0.3, 0.1)  # R dgamma/eps


@dataclass(frozen=True, eq=False, repr=False)
class DeviceStudy(Valued):
    """Cycles by stiffness, and the border between jumping and following.

    Attributes
    ----------
    tabor : float
        Of the cycles.
    cycles : tuple of Cycle
        From fixed grips to the softest apparatus.
    border : (n, 2) array
        Tabor parameter below the critical one, and the stiffness in R dgamma/eps below which that contact jumps.
    """

    tabor: float
    cycles: tuple[Cycle, ...]
    border: Array


def devices(path: EquilibriumPath) -> DeviceStudy:
    """Cycles on a traced curve, which must fold, and the border at every Tabor parameter."""
    cycles = (cycle(path, stiffness) for stiffness in STIFFNESSES)
    critical = tabor_of(FIRST)
    tabors = critical * (1 - np.geomspace(0.999, 1e-3, 40))
    border = np.array([[tabor, critical_stiffness(float(tabor))] for tabor in tabors])
    return DeviceStudy(path.tabor, tuple(c for c in cycles if c is not None), border)
