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
from fem_adhesion.greenwood.facts import FULL, QUICK, DrawnState, Facts, OtherCore
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


SUBJECTS = ("curves", "finite elements", "jumps on", "pull-off", "false rise", "relaxations", "devices", "claims")


def compute(*, quick: bool = False, begin: Callable[[str], None] = lambda _: None) -> Facts:
    """Compute everything; `begin` is called with each of `SUBJECTS`, in order, as its work begins.

    A quick study takes fewer points, and a tolerance of 1e-5.
    """
    began, given = time.perf_counter(), QUICK if quick else FULL
    begin("curves")
    paths = {
        mu: halfspace.trace(mu, rtol=given.rtol, to_load=given.loads.get(mu, COMPRESSION))
        for mu in (*given.drawn, *given.not_drawn)
    }
    curves = {mu: paths[mu].resampled(given.points) for mu in given.drawn}
    begin("finite elements")
    elements = {mu: convergence.trace(Scene(tabor=mu), rtol=1e-3) for mu in given.elements}
    begin("jumps on")
    jumps_on = {mu: halfspace.trace(mu, rtol=1e-6).events["jump_on"] for mu in given.jumps}
    gaps, approaches = np.array([(jump.central_gap, jump.approach) for jump in jumps_on.values()]).T
    begin("pull-off")
    pull_offs = {
        mu: halfspace.trace(mu, rtol=1e-5).events["pull_off"].estimate("load")
        for mu in sorted({*given.pull_offs, *given.elements})
    }
    begin("false rise")
    resolved = [halfspace.trace(mu, rtol=1e-4) for mu in given.rising]
    rises = {spacing: false_rise(resolved, spacing) for spacing in given.rises}
    begin("relaxations")
    relaxations = tuple(attempts(given.most_sweeps))
    begin("devices")
    cycles = tuple(found for k in given.stiffnesses if (found := cycle(paths[given.devices_at], k)))
    critical_tabor = Estimate.refined(*(tabor_of(FIRST, rtol=rtol) for rtol in (1e-6, 1e-7)))
    below = critical_tabor.value * (1 - np.geomspace(0.999, 1e-3, given.border))
    begin("claims")
    winding = halfspace.trace(given.winding_at, rtol=10 * given.rtol), paths[given.winding_at]
    omitting = [paths[mu] for mu in given.omitted]
    wrong = {(mu, wide): false_rise([paths[mu]], wide, window=1.5, steps=8) for mu, wide in given.coarse}
    return Facts(
        settings=given,
        paths=paths,
        curves=curves,
        elements=elements,
        grips={mu: found for mu, path in paths.items() if (found := cycle(path))},
        cycles=cycles,
        jumps_on=jumps_on,
        criteria=fit(np.array(given.jumps), gaps, approaches),
        jumps=_jumps(paths[given.jumps_at], given.apparatus),
        pull_offs=pull_offs,
        profiles=_profiles(winding, [float(gap) for gap, _ in tables.PROFILE_CHECKS]),
        more_profiles=_profiles(winding, given.profile_gaps),
        table_1=tables.table_1(),
        table_2=tables.table_2(paths),
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
        critical_tabor=critical_tabor,
        border=np.array([[mu, critical_stiffness(mu)] for mu in below.tolist()]),
        cores=_cores(paths[5.0], given.more_work),
        seconds=time.perf_counter() - began,
    )


def _cores(path: EquilibriumPath, more: float) -> dict[float, Estimate]:
    """How far the jump-on of laws with another core is from that of a path of the 3-9 law.

    By the gap below which they differ: that of the jump-on itself, and the one that the paper has for it.
    """
    jump, found = path.events["jump_on"], {}
    for gap in (jump.central_gap, float(tables.PROFILE_CHECKS[0][0])):
        other = halfspace.trace(path.tabor * (1 + more) ** (2 / 3), rtol=path.rtol, law=OtherCore(gap, more))
        found[gap] = other.events["jump_on"].estimate("approach") - jump.estimate("approach")
    return found


def _jumps(path: EquilibriumPath, apparatus: float) -> dict[tuple[str, str], Jump]:
    """Jumps by the letters of their ends in [G97] Fig. 2a, primed in an apparatus; none without a fold."""
    found: dict[tuple[str, str], Jump] = {}
    for prime, ends in (("", cycle(path)), ("'", cycle(path, apparatus))):
        if ends:
            found |= {(f"A{prime}", f"B{prime}"): ends.jump_on, (f"C{prime}", f"D{prime}"): ends.jump_off}
    return found


def _profiles(paths: Sequence[EquilibriumPath], gaps: Sequence[float]) -> tuple[DrawnState, ...]:
    """States with given central gaps on the last of two paths, their errors by the other's coarser grid."""
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
