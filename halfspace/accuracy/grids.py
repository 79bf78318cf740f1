"""Grids of the half-space: how fine they are, and what is left as error from one to the next."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from halfspace.accuracy.finite_bodies import CHARTS, Made, SizedBody, at_tip
from halfspace.elastic import compliance, grid
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.elastic.operators import Homogeneous
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.contact import contact_of
from halfspace.errors import InputError
from halfspace.scales import Scales
from halfspace.values import Array


@dataclass(frozen=True)
class GridSettings:
    """How fine grids are, and what their errors leave.

    From a tip u^k cells grow faster than elsewhere: the nearer to the axis they are, the less there is of it. In the
    first cell n nodes leave n^(-2k), so that its radius is n^2 times that at which u^k is all left.
    """

    extent: float = 8.0  # of the finite cells, in widths of a rigid attraction: the infinite one is then as good
    most_nodes: int = 16  # of a panel
    tip: float = 1.5  # times as fast as elsewhere; with 2 or 3 two of 427 numbers were outside their estimates
    before: float = 0.2  # of the change before the last, what may be left: an error was 2.45 estimates without it
    most_widths: int = 60  # of a spike of tension that are resolved at once
    twin: tuple[float, ...] = (0.75, 0.87, 0.8)  # finest cells, growth, extent, in its sibling's: no cell is the same


GRIDS = GridSettings()


@dataclass(frozen=True)
class Resolution:
    """How finely the half-space is discretised, in nodes per panel; the error falls about a decade a node.

    `finest` is the length of the panels at the contact edge, in widths of the spike of tension there, `growth` the
    ratio of neighbouring panels. The extent of the finite cells is in widths of a rigid paraboloid's attraction,
    beta/sqrt(mu), or where another profile is as high; beyond it is one cell more, see
    `halfspace.elastic.compliance.to_infinity`.
    """

    nodes: int
    finest: float
    growth: float
    extent: float


def resolution_for(scales: Scales, rtol: float, level: int = 0) -> Resolution:
    """Resolution whose events are right to about `rtol` at level 0 and five to ten times better with each node more.

    The first level above it has one more, the second two more than that, and so on.
    """
    nodes = max(math.ceil(2 - math.log10(rtol) - 1e-9), 5) + level * (level + 1) // 2
    shorter = 10.0 ** min(1 - nodes / GRIDS.most_nodes, 0.0)  # cells in the place of nodes that there cannot be
    return Resolution(min(nodes, GRIDS.most_nodes), 0.6 * shorter, 1 + 2 * shorter, GRIDS.extent * scales.widened)


def resolutions_for(scales: Scales, rtol: float, level: int) -> tuple[Resolution, ...]:
    """Resolution of a level, that of the level below, and one with a node less."""
    here, below = (resolution_for(scales, rtol, n) for n in (level, max(level - 1, 0)))
    return here, below, replace(below, nodes=below.nodes - 1)


def twin_of(resolution: Resolution) -> Resolution:
    """Resolution as fine as another, with other cells."""
    finest, growth, extent = GRIDS.twin
    return replace(
        resolution,
        finest=finest * resolution.finest,
        growth=growth * resolution.growth,
        extent=extent * resolution.extent,
    )


def rings(scales: Scales, how: Resolution, to_load: float = COMPRESSION) -> tuple[Array, float, Array | None]:
    """Breakpoints fine enough for the spike of tension at every contact radius up to that under the load `to_load`.

    They are those of two charts: centred on the axis, up to a contact radius, and then on the edge, whose radius is 1.
    There is no second chart where the first is fine wherever a contact may end.
    """
    outer, growth = scales.radius_at(how.extent**2 / 2), scales.growth(how.growth)
    if scales.law.outermost:
        return _fine_throughout(scales, how.finest, growth, outer, to_load), math.inf, None
    length, widest = scales.edge_cell(how.finest), scales.widest_radius(to_load)
    first = at_tip(scales.profile, how.nodes)
    towards = GRIDS.tip * growth if scales.profile.pointed else growth
    equal, leave = CHARTS.equal, CHARTS.leave
    reach = math.floor(equal * scales.flat) * length  # that carries a contact there at once
    centred = grid.graded(0.0, length, outer, growth=growth, until=reach)
    edge = grid.graded(1.0, 2 * length / widest, outer / (leave * equal * length), growth=growth)  # as wide at first
    edge = grid.towards_axis(edge, first / widest, towards)
    return grid.towards_axis(centred, first, towards), leave * reach, edge


def _fine_throughout(scales: Scales, finest: float, growth: float, outer: float, to_load: float) -> Array:
    """Breakpoints as fine as at a contact edge wherever one may stand, by a law whose tension has several largest."""
    reach = float(np.hypot(scales.widest_radius(to_load), scales.radius_at(scales.law.outermost)))
    width = scales.least_width
    if reach > GRIDS.most_widths * width:
        raise InputError(
            f"{scales.law}: the tension rises again at H = {scales.law.outermost:.3g}, so that what varies over "
            f"{width:.2g} beta may stand anywhere up to {reach:.3g} beta, {reach / width:.0f} times as far, limit: "
            f"{GRIDS.most_widths}; take a smaller tabor than {scales.tabor:g}, a smaller to_load or a smoother law"
        )
    spacing = finest * width
    return grid.graded(0.0, spacing, max(outer, reach + spacing), growth=growth, until=reach)


MakeOperator = Callable[[int, float, Array], Made]
"""Makes an operator from the nodes in a cell, `Scales.tail_reach` and the ends of the cells, and tells its unknowns."""


def endless(nodes: int, reach: float, breaks: Array) -> Made:
    """Operator of the half-space on panels of so many nodes, the last of which is infinite, see `Scales.tail_reach`."""
    operator = compliance.to_infinity(compliance.panels(breaks, nodes), nodes, reach)
    return operator, operator.radii.size


def half_space_charts(
    scales: Scales, resolution: Resolution, *, to_load: float = COMPRESSION, make: MakeOperator = endless
) -> tuple[Chart, ...]:
    """Charts of the half-space: centred on the axis and, unless that is fine throughout, following the contact edge."""
    lines, until, further = rings(scales, resolution, to_load)
    centred, unknowns = make(resolution.nodes, scales.tail_reach, lines)
    leave = until / CHARTS.leave  # the end of the equal cells
    first = Chart(contact_of(scales, centred), unknowns, until, leave)
    if further is None:
        return (first,)
    edge, unknowns = make(resolution.nodes, scales.tail_reach, further)
    return first, Chart(contact_of(scales, Homogeneous(edge)), unknowns)


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
    return [(operator, operator.radii.size) for operator in compliance.stacked_panels(lines, nodes, R)]
