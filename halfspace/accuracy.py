"""The half-space's load-approach curve to an accuracy asked for.

See `halfspace.ladder` for how the error is estimated.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np

from halfspace import compliance, grid
from halfspace.breathing import FlatCoordinate, Homogeneous
from halfspace.contact import ContactProblem, spike_width
from halfspace.curve import COMPRESSION, Chart, EquilibriumPath
from halfspace.ladder import Charted, Rung, climb
from halfspace.limits import require_counter_radius, require_load, require_radius_ratio, require_rtol, require_tabor
from halfspace.profiles import Profile, between_spheres
from halfspace.sized import WINDOW, AroundEvents, Made, SizedBody, to_equator
from halfspace.theories import jkr_radius
from halfspace.values import Valued

FINER = 30  # ratio of the errors of two successive rungs
TWIN = (0.75, 0.87)  # finest cells and growth of a twin, in those of its sibling: no cell of the two is the same


@dataclass(frozen=True)
class Resolution:
    """How finely the half-space is discretised.

    Attributes
    ----------
    nodes : int
        Nodes per panel; the error falls about a decade a node.
    finest : float
        Length of the panels at the contact edge, in widths of the spike of tension there.
    growth : float
        Ratio of neighbouring panels.
    extent : float
        Outer end of the grid, in units of beta/sqrt(mu), the width of a rigid paraboloid's attraction.
    """

    nodes: int
    finest: float
    growth: float
    extent: float


def resolution_for(tabor: float, rtol: float, level: int = 0) -> Resolution:
    """Resolution whose events are right to about `rtol` at level 0, and some 30 times better at each level above it."""
    nodes = int(np.clip(np.ceil(3.5 - 0.75 * np.log10(rtol)) + 2 * level, 5, 16))
    return Resolution(nodes, finest=0.6, growth=3.0, extent=extent_for(tabor, rtol) * FINER ** (level / 4))


def extent_for(tabor: float, rtol: float) -> float:
    """Outer end of the surface law, in beta/sqrt(mu).

    The load left out beyond it, 11 pi/extent^4, is kept below rtol of the load at jump_on, about 2 mu^(-6/7), and
    below a per cent of it for any rtol, lest it decide whether the curve folds.
    """
    return float(2.5 * min(rtol, 0.01) ** -0.25 * max(1.0, tabor) ** (6 / 28))


@dataclass(frozen=True, eq=False, repr=False)
class Rings(Valued):
    """Breakpoints of two charts: centred on the axis up to a contact radius, then on the edge, whose radius is 1."""

    centred: grid.Array
    edge: grid.Array
    until: float


def rings(tabor: float, finest: float, growth: float, extent: float, to_load: float = COMPRESSION) -> Rings:
    """Breakpoints fine enough for the spike of tension at every contact radius up to that under the load `to_load`.

    `finest` is in widths of the spike, `extent` in beta/sqrt(mu), as in `Resolution`.
    """
    length = finest * spike_width(tabor) / 2
    outer = extent / np.sqrt(tabor)
    widest = widest_radius(tabor, to_load)
    return Rings(
        grid.graded(0.0, length, outer, growth=growth),
        grid.graded(1.0, 2 * length / widest, outer / length, growth=growth),
        until=length,
    )


def widest_radius(tabor: float, to_load: float) -> float:
    """Contact radius in beta that a curve up to a load hardly exceeds: a soft and a rigid contact's together."""
    return float(np.hypot(jkr_radius(to_load), 0.7 / np.sqrt(tabor)))


def half_space_charts(tabor: float, resolution: Resolution, to_load: float = COMPRESSION) -> tuple[Chart, Chart]:
    """Panel grids centred on the axis and following the contact edge."""
    lines = rings(tabor, resolution.finest, resolution.growth, resolution.extent, to_load)
    centred = compliance.panels(lines.centred, resolution.nodes)
    edge = compliance.panels(lines.edge, resolution.nodes)
    return (
        Chart(ContactProblem(centred, tabor), centred.radii.size, lines.until),
        Chart(ContactProblem(Homogeneous(edge), tabor), edge.radii.size),
    )


def trace(
    tabor: float,
    *,
    rtol: float = 1e-6,
    to_load: float = COMPRESSION,
    radius_ratio: float | None = None,
    counter_radius: float = math.inf,
) -> EquilibriumPath:
    """Trace the load-approach curve of a rigid paraboloid or sphere on the adhesive half-space and solve for events.

    Parameters
    ----------
    tabor : float
        Tabor parameter mu, mu^3 = R dgamma^2/(E*^2 eps^3).
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-9 to 1e-1.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.
    radius_ratio : float, optional
        rho = R/eps of a true sphere, R/beta = sqrt(rho/tabor); a paraboloid unless given.
    counter_radius : float
        Of a second true sphere in radii of the first, 1 or more; R is that of the pair then, 1/R = 1/R1 + 1/R2.

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
    require_tabor(tabor)
    require_rtol(rtol)
    require_load(to_load)
    require_counter_radius(counter_radius, radius_ratio)
    if radius_ratio is not None:
        gap = between_spheres(math.sqrt(require_radius_ratio(radius_ratio, tabor) / tabor), counter_radius)
        return climb(rtol, partial(_sphere_rung, tabor, gap, rtol, to_load), to_load=to_load)

    def rung(level: int) -> Rung:
        resolution, below = (resolution_for(tabor, rtol, max(n, 0)) for n in (level, level - 1))
        curve = partial(half_space_charts, tabor, resolution, to_load)
        if not level:
            return Rung(curve, (), asdict(resolution))
        wider = replace(below, extent=resolution.extent)
        twin = replace(wider, finest=TWIN[0] * below.finest, growth=TWIN[1] * below.growth)
        stages = [Charted(half_space_charts(tabor, r, to_load)) for r in (wider, resolution, twin)]
        return Rung(curve, (stages[0], stages[1]), asdict(resolution), stages[2])

    return climb(rtol, rung, to_load=to_load)


def _sphere_rung(tabor: float, gap: Profile, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level for a sphere or two, whose surface ends at the smaller one's equator."""
    resolution, below = (resolution_for(tabor, rtol, max(n, 0)) for n in (level, level - 1))
    twin = replace(below, finest=TWIN[0] * below.finest, growth=TWIN[1] * below.growth)
    fine, other = (_under_sphere(tabor, gap, r) for r in (resolution, twin))
    window = WINDOW / 2**level
    settings = {"nodes": resolution.nodes, "finest": resolution.finest, "growth": resolution.growth}
    return Rung(
        partial(fine.curve, to_load),
        (AroundEvents(fine, window),),
        settings,
        AroundEvents(other, 2 * window) if level else None,
    )


def _under_sphere(tabor: float, gap: Profile, resolution: Resolution) -> SizedBody:
    make = partial(_made, resolution.nodes)
    return SizedBody(tabor, gap, make, resolution.finest, resolution.growth, to_equator(gap.end), FlatCoordinate())


def _made(nodes: int, lines: compliance.Array) -> Made:
    return compliance.panels(lines, nodes), nodes * (lines.size - 1)
