"""Everything in Greenwood's paper, computed again: the curves of its figures, its tables, its criteria.

J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297, [G97] in this code.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

import halfspace
from fem_adhesion import convergence
from fem_adhesion.greenwood import curves, tables
from fem_adhesion.greenwood.criteria import CriteriaStudy, fit, jump_on
from fem_adhesion.greenwood.curves import DeviceStudy, DrawnState, devices, fine_path
from fem_adhesion.greenwood.numerics_1997 import Attempt, Ripple, Rise, attempts, false_rise, ripple
from fem_adhesion.greenwood.tables import Printed
from fem_adhesion.scene import Scene
from halfspace.accuracy.fold_birth import FIRST, tabor_of
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.conditions import FOLD
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Jump
from halfspace.values import Array, Estimate, Valued

DRAWN = (0.02, 0.1, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0)  # Tabor parameters of the figures' curves
DEEP = {0.02: 20.0}  # load to which a curve goes, Fig. 1c
JUMPS_AT = 2.0  # Fig. 2a
WINDING_AT = 5.0  # Figs 3c and 4
RIPPLE_AT = 2.0
RIPPLES = (0.2, 0.1, 0.05)  # spacings in beta of the rippling curves
RISES = (0.2, 0.1, 0.05, 0.025)  # of the false rise
RIPPLE_WINDOW = 0.4  # beta


@dataclass(frozen=True)
class PullOff:
    """Pull-off load, in R dgamma; finite elements where they were asked."""

    tabor: float
    half_space: Estimate
    finite_element: Estimate | None

    @property
    def agree(self) -> bool:
        """Whether both solvers agree within their errors; not so without finite elements."""
        return self.finite_element is not None and self.half_space.agrees(self.finite_element)


@dataclass(frozen=True)
class Tables:
    """Printed beside computed: both tables, and the pressures printed with Fig. 4.

    `asymptote` has the constants of f = a alpha*^(3/2) - b alpha*^2, with the standard errors of their fit.
    """

    table_1: Sequence[Printed]
    table_2: Sequence[Printed]
    profile_checks: Sequence[Printed]
    asymptote: tuple[Estimate, Estimate]


@dataclass(frozen=True, eq=False, repr=False)
class Greenwood1997(Valued):
    """What the figures and tables show.

    Curves on the half-space and by finite elements are by Tabor parameter; `jumps` are those under fixed grips at mu =
    2, by the letters of their ends; `folds` (n, 4) approach, load, central gap and contact radius at every fold at mu =
    5, in order, where the profiles are of Fig. 4. Pull-offs are by rising Tabor parameter, ripples curves at mu = 2 on
    grids that are too coarse, and rises, by spacing, the false ones of the pull-off force. Relaxations are the
    iterations of 1997 on 200 nodes, devices apparatus of finite stiffness at mu = 2; the critical Tabor parameter is
    where the curve first has a vertical tangent. Seconds are those of the computation; a quick one has fewer points.
    """

    curves: Mapping[float, EquilibriumPath]
    elements: Mapping[float, EquilibriumPath]
    jumps: Mapping[str, Jump]
    folds: Array
    profiles: tuple[DrawnState, ...]
    pull_offs: tuple[PullOff, ...]
    ripples: tuple[Ripple, ...]
    rises: Mapping[float, Rise]
    criteria: CriteriaStudy
    tables: Tables
    relaxations: tuple[Attempt, ...]
    devices: DeviceStudy
    critical_tabor: Estimate
    seconds: float
    quick: bool

    def troubles(self) -> Iterator[str]:
        """What failed that should not have, a sentence each."""
        printed = self.tables
        for entry in (*printed.table_1, *printed.table_2, *printed.profile_checks):
            if not entry.credible:
                yield f"{entry.row} at {entry.column:g}: {entry.computed.value:.6g}, printed {entry.printed}"
        for p in self.pull_offs:
            if p.finite_element and not p.agree:
                yield f"the solvers disagree in the pull-off load at mu = {p.tabor:g}"
        for subject, found in (("jumps", self.jumps), ("cycles", self.devices.cycles)):
            if not found:
                yield f"no {subject} were found"


@dataclass(frozen=True)
class Extent:
    """How much is computed.

    Tabor parameters of finite-element curves, of pull-off loads on the half-space and by finite elements, of true
    jumps, and of the false rise; its spacings; the sweeps allowed to Greenwood's iteration; the tables' relative
    accuracy.
    """

    elements: tuple[float, ...]
    pull_offs: tuple[float, ...]
    element_pull_offs: tuple[float, ...]
    jumps: tuple[float, ...]
    rising: tuple[float, ...]
    rises: tuple[float, ...]
    sweeps: int
    rtol: float


FULL = Extent(
    elements=(0.5, 2.0, 5.0),
    pull_offs=tuple(float(mu) for mu in np.geomspace(0.005, 100, 41)),
    element_pull_offs=(0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0),
    jumps=tuple(float(mu) for mu in np.geomspace(1, 100, 21)),
    rising=tuple(float(mu) for mu in np.geomspace(1, 6, 19)),
    rises=RISES,
    sweeps=20_000,
    rtol=1e-7,
)
QUICK = Extent(
    elements=(2.0,),
    pull_offs=tuple(float(mu) for mu in np.geomspace(0.005, 20, 8)),
    element_pull_offs=(0.5, 2.0),
    jumps=tuple(float(mu) for mu in np.geomspace(1, 30, 7)),
    rising=tuple(float(mu) for mu in np.geomspace(1, 3, 6)),
    rises=RISES[:2],
    sweeps=200,
    rtol=1e-5,
)
SUBJECTS = (
    "curves",
    "finite elements",
    "criteria",
    "pull-off",
    "false rise",
    "tables",
    "relaxations",
    "devices",
    "critical Tabor parameter",
)


def compute(*, quick: bool = False, begin: Callable[[str], None] = lambda _: None) -> Greenwood1997:
    """Compute everything; `begin` is told each of `SUBJECTS`, in order, as its work begins.

    A quick study takes fewer points, and a tolerance of 1e-5 in the tables.
    """
    began = time.perf_counter()
    extent = QUICK if quick else FULL
    begin("curves")
    drawn = {mu: _drawn(mu) for mu in DRAWN}
    begin("finite elements")
    elements = {mu: convergence.trace(Scene(tabor=mu), rtol=1e-3) for mu in extent.elements}
    begin("criteria")
    criteria = fit(jump_on(mu) for mu in extent.jumps)
    begin("pull-off")
    pull_offs = tuple(_pull_off(mu, extent) for mu in sorted({*extent.pull_offs, *extent.element_pull_offs}))
    begin("false rise")
    ripples = tuple(ripple(drawn[RIPPLE_AT], spacing, RIPPLE_WINDOW) for spacing in RIPPLES)
    rises = _rises(extent)
    begin("tables")
    printed = _printed(extent)
    begin("relaxations")
    relaxations = tuple(attempts(extent.sweeps))
    begin("devices")
    apparatus = devices(halfspace.trace(JUMPS_AT, rtol=extent.rtol))
    begin("critical Tabor parameter")
    critical_tabor = Estimate.refined(*(tabor_of(FIRST, rtol=rtol) for rtol in (1e-6, 1e-7)))
    winding = drawn[WINDING_AT]
    folds = np.array([fold.point.observables for fold in winding.states(FOLD)])
    jumps, profiles = curves.jumps(JUMPS_AT), tuple(curves.profiles(winding))
    seconds = time.perf_counter() - began
    parts = drawn, elements, jumps, folds, profiles, pull_offs, ripples, rises, criteria, printed, relaxations
    return Greenwood1997(*parts, apparatus, critical_tabor, seconds, quick)


def _drawn(tabor: float) -> EquilibriumPath:
    steps = curves.FINEST if tabor == WINDING_AT else curves.FINE
    return fine_path(tabor, to_load=DEEP.get(tabor, COMPRESSION), steps=steps)


def _rises(extent: Extent) -> dict[float, Rise]:
    """False rise on each spacing, from curves that are resolved."""
    resolved = [halfspace.trace(mu, rtol=curves.SEEN) for mu in extent.rising]
    return {spacing: false_rise(resolved, spacing) for spacing in extent.rises}


def _printed(extent: Extent) -> Tables:
    paths = {mu: halfspace.trace(mu, rtol=extent.rtol) for mu in tables.TABORS}
    return Tables(tables.table_1(), tables.table_2(paths), tables.profile_checks(), tables.excess_asymptote())


def _pull_off(tabor: float, extent: Extent) -> PullOff:
    asked = tabor in extent.element_pull_offs
    element = convergence.trace(Scene(tabor=tabor), rtol=1e-3) if asked else None
    return PullOff(tabor, _least_load(halfspace.trace(tabor, rtol=1e-5)), _least_load(element) if element else None)


def _least_load(path: EquilibriumPath) -> Estimate:
    return path.events["pull_off"].estimate("load")
