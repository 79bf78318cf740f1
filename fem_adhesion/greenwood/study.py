"""Everything in Greenwood's paper, computed again: the curves of its figures, its tables, its criteria, its claims.

J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297, [G97] in this code.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

import halfspace
from fem_adhesion import convergence
from fem_adhesion.common.fold_birth import FIRST, critical_stiffness, tabor_of
from fem_adhesion.fields import gaps_at
from fem_adhesion.greenwood import facts, tables
from fem_adhesion.greenwood.claims import CLAIMS, Judged, judge
from fem_adhesion.greenwood.criteria import fit
from fem_adhesion.greenwood.facts import Facts, PullOff
from fem_adhesion.greenwood.numerics_1997 import Ripple, attempts, false_rise, ripple
from fem_adhesion.greenwood.settings import FULL, QUICK, Settings
from fem_adhesion.greenwood.tables import Tables
from fem_adhesion.scene import Scene
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import CENTRAL_GAP, CONTACT_RADIUS
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Cycle, Jump, cycle
from halfspace.equilibrium.events import Event, is_fold
from halfspace.laws import LENNARD_JONES
from halfspace.values import Array, Estimate, States, Valued

PROFILE_RADII = np.linspace(0.0, 4.0, 201)  # beta, and closer to the spike at the contact edge:
PROFILE_OFFSETS = np.concatenate([sign * np.geomspace(1e-3, 0.3, 40) for sign in (-1, 1)])


@dataclass(frozen=True, eq=False, repr=False)
class DrawnState(Valued):
    """Shape and pressure of one state.

    Central gap in eps; radii in beta, gap in eps and pressure in dgamma/(mu eps) with their errors, (n,) arrays.
    """

    central_gap: float
    radii: Array
    gap: Array
    pressure: Array
    gap_error: Array
    pressure_error: Array


@dataclass(frozen=True, eq=False, repr=False)
class Greenwood1997(Facts):
    """What claims are measured on, and what else the figures and tables show.

    Curves on the half-space and by finite elements are by Tabor parameter, and `specified` states of prescribed central
    gap; `jumps` are those at mu = 1, by the letters of their ends in Fig. 2a, primed in an apparatus; `folds` all folds
    at mu = 5, in order. There are the `profiles` of Fig. 4, before the jump and after, and `more_profiles` in contact
    and on the way to it. Ripples are curves at mu = 2 on grids that are too coarse, cycles those in apparatus of
    falling stiffness at mu = 2, fixed grips first. The `border` (n, 2) has Tabor parameters below the critical one, and
    the stiffness in R dgamma/eps below which they jump. Claims are those of the paper, each with its verdict. Seconds
    are those of the computation.
    """

    settings: Settings
    curves: Mapping[float, EquilibriumPath]
    elements: Mapping[float, EquilibriumPath]
    specified: Mapping[float, States]
    jumps: Mapping[tuple[str, str], Jump]
    folds: tuple[Event, ...]
    profiles: tuple[DrawnState, ...]
    more_profiles: tuple[DrawnState, ...]
    ripples: tuple[Ripple, ...]
    cycles: tuple[Cycle, ...]
    border: Array
    claims: tuple[Judged, ...]
    seconds: float

    @property
    def quick(self) -> bool:
        """Whether fewer points were taken than can be."""
        return self.settings is not FULL

    def troubles(self) -> Iterator[str]:
        """What failed that should not have, a sentence each."""
        printed = self.tables
        for entry in (*printed.table_1, *printed.table_2, *printed.profile_checks):
            if not abs(entry.deviation) <= tables.CREDIBLE:
                yield f"{entry.row} at {entry.column:g}: {entry.computed.value:.6g}, printed {entry.printed}"
        for p in self.pull_offs:
            if p.finite_element and not p.agree:
                yield f"the solvers disagree in the pull-off load at mu = {p.tabor:g}"
        for subject, found in (("jumps", self.jumps), ("cycles", self.cycles)):
            if not found:
                yield f"no {subject} were found"


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
    """Compute everything; `begin` is called with each of `SUBJECTS`, in order, as its work begins.

    A quick study takes fewer points, and a tolerance of 1e-5 in the tables.
    """
    began, given = time.perf_counter(), QUICK if quick else FULL
    begin("curves")
    traced = {mu: halfspace.trace(mu, rtol=given.rtol, to_load=given.loads.get(mu, COMPRESSION)) for mu in given.drawn}
    drawn = {mu: path.resampled(given.points) for mu, path in traced.items()}
    begin("finite elements")
    elements = {mu: _by_elements(mu) for mu in given.elements}
    begin("criteria")
    jumps_on = {mu: halfspace.trace(mu, rtol=1e-6).events["jump_on"] for mu in given.jumps}
    gaps, approaches = np.array([(jump.central_gap, jump.approach) for jump in jumps_on.values()]).T
    begin("pull-off")
    pull_offs = tuple(_pull_off(mu, given) for mu in sorted({*given.pull_offs, *given.element_pull_offs}))
    begin("false rise")
    ripples = tuple(ripple(drawn[given.ripple_at], spacing, given.ripple_window) for spacing in given.ripples)
    resolved = [halfspace.trace(mu, rtol=1e-4) for mu in given.rising]
    rises = {spacing: false_rise(resolved, spacing) for spacing in given.rises}
    begin("tables")
    paths = {mu: halfspace.trace(mu, rtol=given.table_rtol) for mu in tables.TABORS}
    printed = Tables(tables.table_1(), tables.table_2(paths), tables.profile_checks(), tables.excess_asymptote())
    begin("relaxations")
    relaxations = tuple(attempts(given.most_sweeps))
    begin("devices")
    folding = halfspace.trace(given.devices_at, rtol=given.table_rtol)
    cycles = tuple(found for k in given.stiffnesses if (found := cycle(folding, k)))
    tabors = tabor_of(FIRST) * (1 - np.geomspace(0.999, 1e-3, 40))
    border = np.array([[mu, critical_stiffness(float(mu))] for mu in tabors])
    begin("critical Tabor parameter")
    critical_tabor = Estimate.refined(*(tabor_of(FIRST, rtol=rtol) for rtol in (1e-6, 1e-7)))
    begin("claims")
    known = facts.gathered(
        traced | paths,
        given,
        jumps_on=jumps_on,
        criteria=fit(np.array(given.jumps), gaps, approaches),
        pull_offs=pull_offs,
        tables=printed,
        relaxations=relaxations,
        rises=rises,
        critical_tabor=critical_tabor,
    )
    return Greenwood1997(
        **vars(known),
        settings=given,
        curves=drawn,
        elements=elements,
        specified={mu: traced[mu].at(central_gap=gaps) for mu, gaps in given.specified.items()},
        jumps=_jumps(given),
        folds=tuple(event for name, event in traced[given.winding_at].events.items() if is_fold(name)),
        profiles=_profiles(given, [float(gap) for gap, _ in tables.PROFILE_CHECKS]),
        more_profiles=_profiles(given, given.profile_gaps),
        ripples=ripples,
        cycles=cycles,
        border=border,
        claims=tuple(judge(claim, known) for claim in CLAIMS),
        seconds=time.perf_counter() - began,
    )


def _by_elements(tabor: float) -> EquilibriumPath:
    return convergence.trace(Scene(tabor=tabor), rtol=1e-3)


def _pull_off(tabor: float, given: Settings) -> PullOff:
    by_elements = tabor in given.element_pull_offs
    paths = [halfspace.trace(tabor, rtol=1e-5), *([_by_elements(tabor)] if by_elements else [])]
    return PullOff(tabor, *(path.events["pull_off"].estimate("load") for path in paths))


def _jumps(given: Settings) -> dict[tuple[str, str], Jump]:
    """Jumps by the letters of their ends in [G97] Fig. 2a, primed in an apparatus; none without a fold."""
    path = halfspace.trace(given.jumps_at, rtol=1e-6)
    found: dict[tuple[str, str], Jump] = {}
    for prime, ends in (("", cycle(path)), ("'", cycle(path, given.apparatus))):
        if ends:
            found |= {(f"A{prime}", f"B{prime}"): ends.jump_on, (f"C{prime}", f"D{prime}"): ends.jump_off}
    return found


def _profiles(given: Settings, gaps: Sequence[float]) -> tuple[DrawnState, ...]:
    """States where the curve winds with given central gaps, their errors by comparison with a coarser grid."""
    paths = [halfspace.trace(given.winding_at, rtol=rtol) for rtol in (given.profile_rtol, given.profile_rtol / 100)]
    return tuple(_profile(*(path.states(Condition(CENTRAL_GAP, value=gap))[0] for path in paths)) for gap in gaps)


def _profile(coarse: Located, fine: Located) -> DrawnState:
    """State as a field: the gap is interpolated, the pressure is what the law gives for it."""
    edge = np.nan_to_num(fine.point.observables[CONTACT_RADIUS])
    radii = np.unique(np.concatenate([PROFILE_RADII, np.maximum(edge + np.append(PROFILE_OFFSETS, 0.0), 0.0)]))
    gap, coarse_gap = (gaps_at(state, radii) for state in (fine, coarse))
    tabor = fine.problem.interface.tabor
    pressure, coarse_pressure = (LENNARD_JONES.pressure(values, tabor) for values in (gap, coarse_gap))
    errors = np.abs(gap - coarse_gap), np.abs(pressure - coarse_pressure)
    return DrawnState(fine.point.observables[CENTRAL_GAP], radii, gap, pressure, *errors)
