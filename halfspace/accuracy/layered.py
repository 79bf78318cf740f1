"""The ladder of a layered body, whose operator is the half-space's and that of its images.

On the grids of the half-space all cells that follow the contact scale with it, so that one chart serves the whole curve
and its events, see `halfspace.elastic.layered.Images.in_units`. A surface that ends does not scale with the contact: it
is discretised as any body with a length.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from halfspace.accuracy.finite_bodies import CHARTS, Made, SizedBody, at_equator, at_tip, step_above
from halfspace.accuracy.grids import Resolution, half_space_charts
from halfspace.accuracy.stages import Discretised, charted
from halfspace.accuracy.standing import sized
from halfspace.elastic.grid import FLAT
from halfspace.elastic.layered import HOW, Images, images_of, layered_panels, nearly_homogeneous
from halfspace.elastic.layered import layered as with_images
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.contact import contact_of
from halfspace.scales import Scales
from halfspace.values import Array


def discretise(
    images: Sequence[Images], scales: Scales, to_load: float, resolution: Resolution, which: int
) -> Discretised:
    """Layered body at a resolution, under any surface, by one of its images: its twin has others."""
    if math.isfinite(scales.profile.end):
        return sized(layered_body(scales, images[which], resolution, to_load), resolution.nodes)
    return charted(layered_charts(scales, images[which], resolution, to_load))


def layered(body: LayeredBody) -> Callable[[Scales, float, Resolution, int], Discretised]:
    """Discretises a layered body."""
    return partial(discretise, [images_of(body, spacing) for spacing in HOW.spacings])


def layered_charts(
    scales: Scales, images: Images, resolution: Resolution, to_load: float = COMPRESSION
) -> tuple[Chart, ...]:
    """Charts of a layered body as fine as the half-space's, fine on the axis and following the contact.

    The cells end at twice the half-space's extent, to where all images are integrated: what is pressed farther out, in
    the infinite cell, is too little to deflect a layer. Those that follow the contact do past the
    widest one: a sharp tip's is wider than that.
    """
    how = replace(resolution, extent=HOW.farther * resolution.extent)
    outer = scales.radius_at(how.extent**2 / 2)
    first, *rest = half_space_charts(scales, how, to_load=to_load)
    operator = first.problem.interface.operator.at(1.0)
    leave = CHARTS.events * scales.edge_cell(how.finest)
    charts = [replace(first, problem=contact_of(scales, with_images(images, operator, outer)), leave=leave)]
    for chart in rest:
        unit, widest = chart.problem.interface.operator.at(1.0), step_above(scales.widest_radius(to_load))
        left = HOW.between * 10.0**-how.nodes
        following = nearly_homogeneous(images, unit, (min(leave, widest / 2), widest), outer + widest, left)
        charts.append(Chart(contact_of(scales, following), chart.unknowns))
    return tuple(charts)


def layered_body(scales: Scales, images: Images, resolution: Resolution, to_load: float = COMPRESSION) -> SizedBody:
    """Layered body under a surface that ends, on cells of its own at each contact radius."""
    R, nodes = scales.profile.end, resolution.nodes
    return SizedBody(
        scales,
        partial(_made, images, nodes),
        resolution.finest,
        resolution.growth,
        np.array([R]),
        FLAT,
        at_equator(scales.tabor, scales.profile, nodes),
        to_load,
        at_tip(scales.profile, nodes),
        strip=np.pi / 2,
    )


def _made(images: Images, nodes: int, lines: Array) -> Made:
    return layered_panels(images, lines, nodes), nodes * (lines.size - 1)
