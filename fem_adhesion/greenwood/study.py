"""Everything in Greenwood's paper, computed again: the curves of its figures, its tables, its criteria, its claims.

J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297, [G97] in this code.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

import halfspace
from fem_adhesion import convergence
from fem_adhesion.common.fold_birth import FIRST, critical_stiffness, tabor_of
from fem_adhesion.fields import gaps_at
from fem_adhesion.greenwood import tables
from fem_adhesion.greenwood.facts import FULL, QUICK, DrawnState, Facts, OtherCore, PullOff, Settings
from fem_adhesion.greenwood.numerics_1997 import attempts, false_rise, ripple, without_singular_point
from fem_adhesion.greenwood.tables import fit
from fem_adhesion.scene import Scene
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import CENTRAL_GAP, CONTACT_RADIUS
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Jump, cycle
from halfspace.laws import LENNARD_JONES
from halfspace.values import Estimate

PROFILE_RADII = np.linspace(0.0, 4.0, 201)  # beta, and closer to the spike at the contact edge:
PROFILE_OFFSETS = np.concatenate([sign * np.geomspace(1e-3, 0.3, 40) for sign in (-1, 1)])


SUBJECTS = (
    *("curves", "finite elements", "criteria", "pull-off", "false rise"),
    *("tables", "relaxations", "devices", "claims"),
)


def compute(*, quick: bool = False, begin: Callable[[str], None] = lambda _: None) -> Facts:
    """Compute everything; `begin` is called with each of `SUBJECTS`, in order, as its work begins.

    A quick study takes fewer points, and a tolerance of 1e-5 in the tables.
    """
    began, given = time.perf_counter(), QUICK if quick else FULL
    begin("curves")
    traced = {mu: halfspace.trace(mu, rtol=given.rtol, to_load=given.loads.get(mu, COMPRESSION)) for mu in given.drawn}
    curves = {mu: path.resampled(given.points) for mu, path in traced.items()}
    begin("finite elements")
    elements = {mu: _by_elements(mu) for mu in given.elements}
    begin("criteria")
    jumps_on = {mu: halfspace.trace(mu, rtol=1e-6).events["jump_on"] for mu in given.jumps}
    gaps, approaches = np.array([(jump.central_gap, jump.approach) for jump in jumps_on.values()]).T
    begin("pull-off")
    pull_offs = tuple(_pull_off(mu, given) for mu in sorted({*given.pull_offs, *given.element_pull_offs}))
    begin("false rise")
    resolved = [halfspace.trace(mu, rtol=1e-4) for mu in given.rising]
    rises = {spacing: false_rise(resolved, spacing) for spacing in given.rises}
    begin("tables")
    printed = {mu: halfspace.trace(mu, rtol=given.table_rtol) for mu in tables.TABORS}
    begin("relaxations")
    relaxations = tuple(attempts(given.most_sweeps))
    begin("devices")
    folding = halfspace.trace(given.devices_at, rtol=given.table_rtol)
    tabors = tabor_of(FIRST) * (1 - np.geomspace(0.999, 1e-3, 10 if quick else 40))
    begin("claims")
    paths, loads = traced | printed, {given.claimed[0]: given.deepest_load}
    paths |= {
        mu: halfspace.trace(mu, rtol=given.table_rtol, to_load=loads.get(mu, COMPRESSION))
        for mu in given.claimed
        if mu not in paths
    }
    omitting = [paths[mu] for mu in given.omitted]
    wrong = {(mu, wide): false_rise([paths[mu]], wide, window=1.5, steps=8) for mu, wide in given.coarse}
    return Facts(
        settings=given,
        paths=paths,
        curves=curves,
        elements=elements,
        grips={mu: loop for mu in given.cycled if (loop := cycle(paths[mu]))},
        cycles=tuple(found for k in given.stiffnesses if (found := cycle(folding, k))),
        jumps_on=jumps_on,
        criteria=fit(np.array(given.jumps), gaps, approaches),
        jumps=_jumps(given),
        pull_offs=pull_offs,
        profiles=_profiles(given, [float(gap) for gap, _ in tables.PROFILE_CHECKS]),
        more_profiles=_profiles(given, given.profile_gaps),
        table_1=tables.table_1(),
        table_2=tables.table_2(printed),
        profile_checks=tables.profile_checks(),
        asymptote=tables.excess_asymptote(),
        relaxations=relaxations,
        ripples=tuple(ripple(curves[given.ripple_at], spacing, given.ripple_window) for spacing in given.ripples),
        rises=rises,
        omitted=(
            false_rise(omitting, given.omitted_spacing, without_singular_point),
            false_rise(omitting, given.omitted_spacing),
        ),
        coarse={place: -ripples[0].pull_off for place, ripples in wrong.items() if ripples},
        critical_tabor=Estimate.refined(*(tabor_of(FIRST, rtol=rtol) for rtol in (1e-6, 1e-7))),
        border=np.array([[mu, critical_stiffness(float(mu))] for mu in tabors]),
        cores=_cores(paths[5.0], given),
        seconds=time.perf_counter() - began,
    )


def _by_elements(tabor: float) -> EquilibriumPath:
    return convergence.trace(Scene(tabor=tabor), rtol=1e-3)


def _pull_off(tabor: float, given: Settings) -> PullOff:
    by_elements = tabor in given.element_pull_offs
    paths = [halfspace.trace(tabor, rtol=1e-5), *([_by_elements(tabor)] if by_elements else [])]
    return PullOff(tabor, *(path.events["pull_off"].estimate("load") for path in paths))


def _cores(path: EquilibriumPath, given: Settings) -> dict[float, Estimate]:
    """How far the jump-on of laws with another core is from that of a path of the 3-9 law.

    By the gap below which they differ: that of the jump-on itself, and the one that the paper has for it.
    """
    jump, more, found = path.events["jump_on"], given.more_work, {}
    for gap in (jump.central_gap, float(tables.PROFILE_CHECKS[0][0])):
        law = OtherCore(gap, more)
        other = halfspace.trace(path.tabor * (1 + more) ** (2 / 3), rtol=given.table_rtol, law=law)
        found[gap] = other.events["jump_on"].estimate("approach") - jump.estimate("approach")
    return found


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
