"""What is computed and how finely: the settings of the study, as data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from halfspace.values import Array, Valued


def _spaced(first: float, last: float, number: int) -> tuple[float, ...]:
    """Numbers of equal ratios."""
    return tuple(float(value) for value in np.geomspace(first, last, number))


FEW = np.array([4, 3, 2.5, 2, 1.5, 1, 0.7, 0.4, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0, -0.005, -0.01])


@dataclass(frozen=True, eq=False, repr=False)
class Settings(Valued):
    """What is computed: Tabor parameters, spacings in beta of wrong grids, stiffnesses in R dgamma/eps, accuracies."""

    # Figures
    drawn: tuple[float, ...] = (0.02, 0.05, 0.1, 0.2, 0.5, 0.7, 1.0, 2.0, 3.0, 5.0)  # Tabor parameters of curves
    loads: Mapping[float, float] = field(default_factory=lambda: {0.02: 50.0})  # load where a curve ends, if not 5
    rtol: float = 1e-5  # relative accuracy of the events of curves; their points carry their own errors
    points: int = 300  # points of a drawn curve; a polygon through 150 shows corners
    specified: Mapping[float, Array] = field(  # central gaps prescribed, eps: Fig. 3
        default_factory=lambda: {1.0: FEW, 2.0: FEW, 3.0: FEW, 5.0: np.linspace(1.4, 0.05, 120)}
    )
    jumps_at: float = 1.0  # Tabor parameter of Fig. 2a
    apparatus: float = 3.0  # stiffness of the apparatus of Fig. 2a
    winding_at: float = 5.0  # Tabor parameter of Fig. 4
    profile_gaps: tuple[float, ...] = (1.0, 0.3, 0.02, 0.0, -0.01)  # central gaps of further profiles, eps
    profile_rtol: float = 1e-5  # accuracy of a curve whose profiles estimate the errors of those at a hundredth of it
    devices_at: float = 2.0  # Tabor parameter of the cycles in apparatus
    stiffnesses: tuple[float, ...] = (math.inf, 100.0, 10.0, 3.0, 1.0, 0.3, 0.1)
    # Finite elements
    elements: tuple[float, ...] = (0.5, 2.0, 5.0)  # Tabor parameters of curves
    element_pull_offs: tuple[float, ...] = (0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
    # Tables and criteria
    table_rtol: float = 1e-7
    pull_offs: tuple[float, ...] = _spaced(0.005, 100, 41)
    jumps: tuple[float, ...] = _spaced(1, 100, 21)  # Tabor parameters of the true jumps that criteria are fitted to
    # Numerics of 1997
    ripple_at: float = 2.0
    ripples: tuple[float, ...] = (0.2, 0.1, 0.05)  # spacings of the rippling curves
    ripple_window: float = 0.4  # beta on each side of the contact radius at pull-off
    rising: tuple[float, ...] = _spaced(1, 6, 19)  # Tabor parameters of the false rise
    rises: tuple[float, ...] = (0.2, 0.1, 0.05, 0.025)  # spacings of the false rise
    most_sweeps: int = 20_000
    # Claims
    claimed: tuple[float, ...] = (0.02, 0.05, 0.1, 0.2, 0.5, 0.9, 1.0, 1.25, 2.0, 3.0, 5.0, 6.0, 6.7)
    cycled: tuple[float, ...] = (0.02, 0.05, 0.1, 0.2, 0.5, 0.9, 1.0, 2.0, 3.0, 5.0)  # with cycles under fixed grips
    deepest_load: float = 25.0  # load to which the curve of the least Tabor parameter goes, if not drawn farther
    more_work: float = 0.5  # part by which another core raises the work of adhesion
    coarse: tuple[tuple[float, float], ...] = (  # Tabor parameters and spacings of forces that are wrong on purpose
        *((3.0, 0.02), (5.0, 0.02), (5.0, 0.01)),  # 300 and 600 nodes up to 6 beta
        *((0.5, 0.5), (0.9, 0.5), (1.0, 0.5), (1.25, 0.5)),  # 12 nodes
    )
    omitted: tuple[float, ...] = (0.2, 0.5, 1.0)  # Tabor parameters of a sum without the singular point
    omitted_spacing: float = 0.025  # 240 nodes


FULL = Settings()
QUICK = replace(
    FULL,
    points=100,
    elements=(2.0,),
    element_pull_offs=(0.5, 2.0),
    table_rtol=1e-5,
    pull_offs=_spaced(0.005, 20, 8),
    jumps=_spaced(1, 30, 7),
    rising=_spaced(1, 3, 6),
    rises=FULL.rises[:2],
    most_sweeps=200,
)
