"""Everything in Greenwood's paper, computed again: the curves of its figures, its tables, its criteria.

J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297, [G97] in this code.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

import halfspace
from fem_adhesion import convergence
from fem_adhesion.common.fold_birth import FIRST, critical_stiffness, tabor_of
from fem_adhesion.fields import gaps_at
from fem_adhesion.greenwood import claims, facts, tables
from fem_adhesion.greenwood.claims import Claims
from fem_adhesion.greenwood.criteria import CriteriaStudy, fit, jump_on
from fem_adhesion.greenwood.numerics_1997 import Attempt, Ripple, Rise, attempts, false_rise, ripple
from fem_adhesion.greenwood.tables import Tables
from fem_adhesion.scene import Scene
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import CENTRAL_GAP, CONTACT_RADIUS
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, Jump, cycle
from halfspace.equilibrium.events import Event, is_fold
from halfspace.equilibrium.states import States
from halfspace.laws import LENNARD_JONES
from halfspace.values import Array, Estimate, Valued

RTOL = 1e-5  # relative accuracy of the events of what is drawn; points carry their own errors
POINTS = 300  # of a curve: a polygon through them looks smooth
DRAWN = (0.02, 0.05, 0.1, 0.2, 0.5, 0.7, 1.0, 2.0, 3.0, 5.0)  # Tabor parameters of the figures' curves
DEEP = {0.02: 50.0}  # load to which a curve goes, Fig. 1c

# Central gaps prescribed for Fig. 3, by Tabor parameter, and where the curve winds.
WINDING_AT = 5.0  # Fig. 4, too
GAPS = np.array([4, 3, 2.5, 2, 1.5, 1, 0.7, 0.4, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0, -0.005, -0.01])
SPECIFIED = {1.0: GAPS, 2.0: GAPS, 3.0: GAPS, WINDING_AT: np.linspace(1.4, 0.05, 120)}

JUMPS_AT = 1.0  # Fig. 2a
APPARATUS = 3.0  # its stiffness in R dgamma/eps, of the primed letters
DEVICES_AT = 2.0
STIFFNESSES = (math.inf, 100.0, 10.0, 3.0, 1.0, 0.3, 0.1)  # R dgamma/eps, of an apparatus

# States of Fig. 4, before and after the jump, and others beyond it, by the central gap.
PRINTED_GAPS = (2.554, -0.0036)
PROFILE_GAPS = (1.0, 0.3, 0.02, 0.0, -0.01)
PROFILE_RADII = np.linspace(0.0, 4.0, 201)  # beta, and closer to the spike at the contact edge:
PROFILE_OFFSETS = np.concatenate([sign * np.geomspace(1e-3, 0.3, 40) for sign in (-1, 1)])
CHECKED = 1e-5  # relative accuracy of the curve whose profiles tell the errors of those at a hundredth of it

RIPPLE_AT = 2.0
RIPPLES = (0.2, 0.1, 0.05)  # spacings in beta of the rippling curves
RISES = (0.2, 0.1, 0.05, 0.025)  # of the false rise
RIPPLE_WINDOW = 0.4  # beta


@dataclass(frozen=True, eq=False, repr=False)
class DrawnState(Valued):
    """Shape and pressure of one state.

    Central gap and approach in eps, load in R dgamma, contact radius in beta, nan where the central gap exceeds 3^(1/6)
    eps; radii in beta, gap in eps and pressure in dgamma/(mu eps) with their errors, (n,) arrays.
    """

    central_gap: float
    approach: float
    load: float
    contact_radius: float
    radii: Array
    gap: Array
    pressure: Array
    gap_error: Array
    pressure_error: Array


def jumps(tabor: float) -> dict[tuple[str, str], Jump]:
    """Jumps by the letters of their ends in [G97] Fig. 2a, primed in an apparatus; none without a fold."""
    path = halfspace.trace(tabor, rtol=1e-6)
    grips, apparatus = cycle(path), cycle(path, APPARATUS)
    found = {("A", "B"): grips.jump_on, ("C", "D"): grips.jump_off} if grips else {}
    return found | ({("A'", "B'"): apparatus.jump_on, ("C'", "D'"): apparatus.jump_off} if apparatus else {})


def profiles(gaps: Sequence[float]) -> tuple[DrawnState, ...]:
    """States at mu = 5 with given central gaps, their errors by comparison with a coarser grid."""
    paths = [halfspace.trace(WINDING_AT, rtol=rtol) for rtol in (CHECKED, CHECKED / 100)]
    return tuple(_profile(*(path.states(Condition(CENTRAL_GAP, value=gap))[0] for path in paths)) for gap in gaps)


def _profile(coarse: Located, fine: Located) -> DrawnState:
    """State as a field: the gap is interpolated, the pressure is what the law gives for it."""
    edge = np.nan_to_num(fine.point.observables[CONTACT_RADIUS])
    radii = np.unique(np.concatenate([PROFILE_RADII, np.maximum(edge + np.append(PROFILE_OFFSETS, 0.0), 0.0)]))
    gap, coarse_gap = (gaps_at(state, radii) for state in (fine, coarse))
    pressure, coarse_pressure = (
        LENNARD_JONES.pressure(values, fine.problem.interface.tabor) for values in (gap, coarse_gap)
    )
    approach, load, central_gap, radius = fine.point.observables
    errors = np.abs(gap - coarse_gap), np.abs(pressure - coarse_pressure)
    return DrawnState(central_gap, approach, load, radius, radii, gap, pressure, *errors)


@dataclass(frozen=True, eq=False, repr=False)
class DeviceStudy(Valued):
    """Cycles at a Tabor parameter by falling stiffness, fixed grips first, and the border of jumping and following.

    `border` (n, 2) has Tabor parameters below the critical one, and the stiffness in R dgamma/eps below which they
    jump.
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


@dataclass(frozen=True)
class PullOff:
    """Pull-off load, in R dgamma; finite elements where they were asked."""

    tabor: float
    half_space: Estimate
    finite_element: Estimate | None = None

    @property
    def agree(self) -> bool:
        """Whether both solvers agree within their errors; not so without finite elements."""
        return self.finite_element is not None and self.half_space.agrees(self.finite_element)


@dataclass(frozen=True, eq=False, repr=False)
class Greenwood1997(Valued):
    """What the figures and tables show.

    Curves on the half-space and by finite elements are by Tabor parameter, and `specified` states of prescribed central
    gap; `jumps` are those at mu = 1, by the letters of their ends; `folds` all folds at mu = 5, in order. There are the
    `profiles` of Fig. 4, before the jump and after, and `more_profiles` in contact and on the way to it. Pull-offs are
    by rising Tabor parameter, ripples curves at mu = 2 on grids that are too coarse, and rises, by spacing, the false
    ones of the pull-off force. Relaxations are the iterations of 1997 on 200 nodes, devices apparatus of finite
    stiffness at mu = 2; the critical Tabor parameter is where the curve first has a vertical tangent. Claims are those
    of the paper, each with its verdict. Seconds are those of the computation; a quick one has fewer points.
    """

    curves: Mapping[float, EquilibriumPath]
    elements: Mapping[float, EquilibriumPath]
    specified: Mapping[float, States]
    jumps: Mapping[tuple[str, str], Jump]
    folds: tuple[Event, ...]
    profiles: tuple[DrawnState, ...]
    more_profiles: tuple[DrawnState, ...]
    pull_offs: tuple[PullOff, ...]
    ripples: tuple[Ripple, ...]
    rises: Mapping[float, Rise]
    criteria: CriteriaStudy
    tables: Tables
    relaxations: tuple[Attempt, ...]
    devices: DeviceStudy
    critical_tabor: Estimate
    claims: Claims
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
    "claims",
)


def compute(*, quick: bool = False, begin: Callable[[str], None] = lambda _: None) -> Greenwood1997:
    """Compute everything; `begin` is told each of `SUBJECTS`, in order, as its work begins.

    A quick study takes fewer points, and a tolerance of 1e-5 in the tables.
    """
    began = time.perf_counter()
    extent = QUICK if quick else FULL
    begin("curves")
    traced = {mu: halfspace.trace(mu, rtol=RTOL, to_load=DEEP.get(mu, COMPRESSION)) for mu in DRAWN}
    drawn = {mu: path.resampled(POINTS) for mu, path in traced.items()}
    specified = {mu: traced[mu].at(central_gap=gaps) for mu, gaps in SPECIFIED.items()}
    begin("finite elements")
    elements = {mu: _by_elements(mu) for mu in extent.elements}
    begin("criteria")
    criteria = fit(jump_on(mu) for mu in extent.jumps)
    begin("pull-off")
    pull_offs = tuple(_pull_off(mu, extent) for mu in sorted({*extent.pull_offs, *extent.element_pull_offs}))
    begin("false rise")
    ripples = tuple(ripple(drawn[RIPPLE_AT], spacing, RIPPLE_WINDOW) for spacing in RIPPLES)
    resolved = [halfspace.trace(mu, rtol=1e-4) for mu in extent.rising]
    rises = {spacing: false_rise(resolved, spacing) for spacing in extent.rises}
    begin("tables")
    paths = {mu: halfspace.trace(mu, rtol=extent.rtol) for mu in tables.TABORS}
    printed = Tables(tables.table_1(), tables.table_2(paths), tables.profile_checks(), tables.excess_asymptote())
    begin("relaxations")
    relaxations = tuple(attempts(extent.sweeps))
    begin("devices")
    apparatus = devices(halfspace.trace(DEVICES_AT, rtol=extent.rtol))
    begin("critical Tabor parameter")
    critical_tabor = Estimate.refined(*(tabor_of(FIRST, rtol=rtol) for rtol in (1e-6, 1e-7)))
    begin("claims")
    forces = {p.tabor: p.half_space for p in pull_offs}
    known = facts.gathered(traced | paths, extent.rtol, criteria, forces, printed, relaxations, rises, critical_tabor)
    examined = claims.examined(known)
    folds = tuple(event for name, event in traced[WINDING_AT].events.items() if is_fold(name))
    states = jumps(JUMPS_AT), folds, profiles(PRINTED_GAPS), profiles(PROFILE_GAPS)
    seconds = time.perf_counter() - began
    parts = drawn, elements, specified, *states, pull_offs, ripples, rises, criteria, printed, relaxations
    return Greenwood1997(*parts, apparatus, critical_tabor, examined, seconds, quick)


def _pull_off(tabor: float, extent: Extent) -> PullOff:
    by_elements = tabor in extent.element_pull_offs
    paths = [halfspace.trace(tabor, rtol=1e-5), *([_by_elements(tabor)] if by_elements else [])]
    return PullOff(tabor, *(path.events["pull_off"].estimate("load") for path in paths))


def _by_elements(tabor: float) -> EquilibriumPath:
    return convergence.trace(Scene(tabor=tabor), rtol=1e-3)
