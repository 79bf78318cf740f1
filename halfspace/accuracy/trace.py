"""The half-space's load-approach curve to an accuracy asked for.

See `halfspace.accuracy.refinement` for how the error is estimated.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict
from functools import partial

import numpy as np

from halfspace.accuracy.finite_bodies import (
    EQUAL,
    EVENTS_LEAVE,
    AroundEvents,
    Made,
    SizedBody,
    apart_for_events,
    at_tip,
    sized_rung,
    surroundings,
)
from halfspace.accuracy.grids import Resolution, endless, inwards, resolutions_for, rule_for
from halfspace.accuracy.kernels import KERNELS, require_kernel
from halfspace.accuracy.layered import layered_rungs
from halfspace.accuracy.refinement import climb
from halfspace.accuracy.stages import LeavesEarly, Rung
from halfspace.accuracy.windows import Windows
from halfspace.elastic.compliance import panels, stacked_panels
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import require_load, require_rtol, require_tabor
from halfspace.profiles import PARABOLOID, Profile, require_profile
from halfspace.scales import Scales
from halfspace.values import Array


def trace(
    tabor: float,
    *,
    law: Law = LENNARD_JONES,
    profile: Profile = PARABOLOID,
    body: LayeredBody | None = None,
    kernel: str = "panels",
    rtol: float = 1e-6,
    to_load: float = COMPRESSION,
) -> EquilibriumPath:
    """Trace the load-approach curve of a rigid body on an adhesive half-space, or a layer, and solve for its events.

    Parameters
    ----------
    tabor : float
        Tabor parameter mu, mu^3 = R dgamma^2/(E*^2 eps^3), 1e-12 to 300.
    law : Law
        Of the tension between the surfaces against their gap, see `halfspace.laws`.
    profile : Profile
        Shape of the rigid body, see `halfspace.profiles`.
    body : LayeredBody, optional
        Layers on a base or a coating, see `halfspace.elastic.layers`, in the place of the half-space; E*, in the Tabor
        parameter and beta, is that of the first stratum.
    kernel : str
        How the pressure is represented: ``panels`` (polynomials, the fastest), ``triangles`` (overlapping triangles,
        [G97] section 2a) or ``bands`` (uniform bands, [G97] App. B), see `halfspace.accuracy.kernels`.
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-9 to 1e-1; of approaches, which have no natural zero, in
        parts of eps and the range of those of all events.
    to_load : float
        Compressive load at which the curve ends, in R dgamma, up to 1000.

    Returns
    -------
    EquilibriumPath
        The curve, its events and their error estimates.

    Raises
    ------
    InputError
        If an input is out of range.
    halfspace.errors.NotConverged
        If the curve cannot be traced.
    """
    tabor, rtol, to_load = require_tabor(tabor), require_rtol(rtol), require_load(to_load)
    scales = Scales(tabor, require_law(law), require_profile(profile).surface(tabor), body)
    how = require_kernel(kernel, scales, rtol)
    if body is not None:
        return climb(rtol, layered_rungs(scales, body, rtol, to_load), to_load=to_load)
    if math.isfinite(scales.profile.end):
        return climb(rtol, partial(_sphere_rung, scales, rtol, to_load), to_load=to_load)
    if scales.step_gap and not scales.law.outermost and kernel == "panels":
        return climb(rtol, partial(_stepped_rung, scales, rtol, to_load), to_load=to_load)
    charts = partial(how.charts, scales, to_load=to_load)
    rung = partial(half_space_rung, scales, rtol, charts, kernel=kernel)
    return climb(rtol, rung, to_load=to_load, most_rungs=how.most_rungs)


def half_space_rung(
    scales: Scales,
    rtol: float,
    charts: Callable[[Resolution], tuple[Chart, Chart]],
    level: int,
    *,
    kernel: str = "panels",
) -> Rung:
    """Rung of a level for a half-space under an endless surface, whose charts are made of a resolution."""
    how = KERNELS[kernel]
    resolution, below = how.resolutions(scales, rtol, level)
    curve, settings = partial(charts, resolution), {"kernel": kernel, **asdict(resolution)}
    if not level:
        return Rung(curve, (), settings)
    fine, twin = (LeavesEarly(charts(r), _leave(scales, r)) for r in (resolution, below))
    return Rung(curve, (fine,), settings, twin, how.rule(scales, (resolution, below), level))


def _leave(scales: Scales, resolution: Resolution) -> float:
    """Contact radius from which an event has the grid around its edge, unless one is fine throughout for the law."""
    return math.inf if scales.law.outermost else EQUAL * scales.edge_cell(resolution.finest)


def _stepped_rung(scales: Scales, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level for a half-space under a law that ends by a step."""
    resolutions = resolutions_for(scales, rtol, level)
    fine, twin = (_windows(scales, resolution, to_load) for resolution in resolutions)
    rule = rule_for(scales, resolutions, level)
    return Rung(fine.curve, (fine,), asdict(resolutions[0]), twin if level else None, rule)


def _windows(scales: Scales, resolution: Resolution, to_load: float) -> Windows:
    outer = scales.outer_radius(resolution.extent**2 / 2)
    nodes, cut = resolution.nodes, math.isinf(scales.law.decay)  # it acts no farther than the cells
    half_space = partial(panels, nodes_per_panel=nodes) if cut else partial(endless, nodes, scales.tail_reach)
    tip, towards_axis = at_tip(scales.profile, nodes), inwards(scales, resolution.growth)
    return Windows(scales, resolution.finest, resolution.growth, outer, half_space, tip, towards_axis, to_load)


def _sphere_rung(scales: Scales, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level for a half-space under a surface that ends, as a sphere's does at its equator."""
    resolutions = resolutions_for(scales, rtol, level)
    fine, other = (under_sphere(scales, resolution, to_load) for resolution in resolutions)
    settings = resolutions[0].cells
    if not level and (apart := apart_for_events(fine, rtol)):
        lowest = AroundEvents(fine, *surroundings(rtol, level), EVENTS_LEAVE, apart=apart)
        return Rung(lowest.by_curve, (lowest,), settings)
    return sized_rung(fine, other, rtol, level, settings, rule_for(scales, resolutions, level))


def under_sphere(scales: Scales, resolution: Resolution, to_load: float = COMPRESSION) -> SizedBody:
    """Half-space under a surface that ends, on cells of its own at each contact radius."""
    R, nodes = scales.profile.end, resolution.nodes
    return SizedBody(
        scales,
        partial(_made, R, nodes),
        resolution.finest,
        resolution.growth,
        np.array([2 * R]),
        SurfaceCoordinate(R),
        to_load=to_load,
        first=at_tip(scales.profile, nodes),
        together=partial(_all_made, R, nodes),
    )


def _made(R: float, nodes: int, lines: Array) -> Made:
    return _all_made(R, nodes, lines[None])[0]


def _all_made(R: float, nodes: int, lines: Array) -> list[Made]:
    return [(operator, operator.radii.size) for operator in stacked_panels(lines, nodes, R)]
