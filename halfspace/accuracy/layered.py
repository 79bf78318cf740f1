"""The ladder of a layered body, whose operator is the half-space's and that of its images.

On the grids of the half-space all cells that follow the contact scale with it, so that one chart serves the whole curve
and its events, see `halfspace.elastic.layered.Images.in_units`. A surface that ends, or one that is fine throughout,
does not scale with the contact: it is discretised as any body with a length.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from halfspace.accuracy.finite_bodies import (
    EVENTS_LEAVE,
    TIGHT,
    Made,
    SizedBody,
    at_equator,
    at_tip,
    least_along,
    sized_rung,
    step_above,
)
from halfspace.accuracy.grids import Grids, Resolution, resolutions_for, rule_for
from halfspace.accuracy.stages import LeavesEarly, Rung
from halfspace.elastic.grid import FLAT
from halfspace.elastic.layered import Images, images_of, layered, layered_panels, nearly_homogeneous
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.contact import contact_of
from halfspace.scales import Scales
from halfspace.values import Array

FAR = 100.0  # of the last cell of a surface that ends, in extents: the energy left out is 1e-10 R dgamma eps
# Of what n nodes a panel leave, 10^-n, what polynomials in the contact radius may leave of a layer's images. On a stiff
# coating pull-off's approach errs by 40 times that; estimates do not know it where finer grids have the same radii.
BETWEEN = 1e-4
THIN = 0.05  # beta: strata on which most of what is wrong is their images'
IMAGES = (1.14, 1.17)  # ratios of the depths of a layered body's images, and of its twin's
WIDER = 2  # times the half-space's extent, to where all images are integrated


def layered_rungs(scales: Scales, body: LayeredBody, rtol: float, to_load: float) -> Callable[[int], Rung]:
    """Rungs, by their levels, of a layered body under any surface."""
    images = [images_of(body, spacing) for spacing in IMAGES]
    return partial(_rung, scales, images, _doubt_of_images(body, rtol), rtol, to_load)


def _rung(scales: Scales, images: Sequence[Images], doubt: int, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level, which errs so many times as much as it changes."""
    resolutions = resolutions_for(scales, rtol, level)
    rule = replace(rule_for(scales, resolutions, level, doubt), steps=scales.steps)
    if math.isfinite(scales.profile.end) or scales.law.outermost:
        fine, other = (layered_body(scales, *both, to_load) for both in zip(images, resolutions, strict=True))
        return sized_rung(fine, other, rtol, level, resolutions[0].cells, rule)
    stage = _charted(scales, images[0], resolutions[0], to_load)
    twin = _charted(scales, images[1], resolutions[1], to_load) if level else None
    return Rung(partial(tuple, stage.charts), (stage,), resolutions[0].cells, twin, rule)


def _doubt_of_images(body: LayeredBody, rtol: float) -> int:
    """How many times as large as by the change from twin to twin what is left may be: that of images, who err alike.

    Under a sharp tip on strata 0.01 beta thin it was 2.8 times at every tolerance, on thicker ones at tight ones alone.
    """
    if body.strata[0].thickness < THIN:
        return 4
    return 2 if rtol < TIGHT else 1


def _charted(scales: Scales, images: Images, resolution: Resolution, to_load: float) -> LeavesEarly:
    leave = EVENTS_LEAVE * scales.edge_cell(resolution.finest)
    return LeavesEarly(layered_charts(scales, images, resolution, to_load), leave)


def layered_charts(
    scales: Scales, images: Images, resolution: Resolution, to_load: float = COMPRESSION
) -> tuple[Chart, Chart]:
    """Charts of a layered body as fine as the half-space's, fine on the axis and following the contact.

    The cells end at twice the half-space's extent, to where all images are integrated: what is pressed farther out, in
    the infinite cell, is too little to deflect a layer. Those that follow the contact do past the
    widest one: a sharp tip's is wider than that.
    """
    how = replace(resolution, extent=WIDER * resolution.extent)
    half_space, outer = Grids.of(scales, how, to_load), scales.outer_radius(how.extent**2 / 2)
    edge, widest = half_space.edge.unit, step_above(scales.widest_radius(to_load))
    least = min(least_along(half_space.until, widest), EVENTS_LEAVE * scales.edge_cell(how.finest))
    following = nearly_homogeneous(images, edge, (least, widest), outer + widest, BETWEEN * 10.0**-how.nodes)
    standing = layered(images, half_space.centred, outer)
    return (
        Chart(contact_of(scales, standing), standing.radii.size, half_space.until),
        Chart(contact_of(scales, following), edge.radii.size),
    )


def layered_body(scales: Scales, images: Images, resolution: Resolution, to_load: float = COMPRESSION) -> SizedBody:
    """Layered body under a surface that ends, or is fine throughout, on cells of its own at each contact radius."""
    R, nodes = scales.profile.end, resolution.nodes
    ends = math.isfinite(R)
    outer = R if ends else scales.whole_radius((FAR * resolution.extent) ** 2 / 2)
    return SizedBody(
        scales,
        partial(_made, images, nodes),
        resolution.finest,
        resolution.growth,
        np.array([outer]),
        FLAT,
        at_equator(scales.tabor, scales.profile, nodes) if ends else math.inf,
        to_load,
        at_tip(scales.profile, nodes),
    )


def _made(images: Images, nodes: int, lines: Array) -> Made:
    return layered_panels(images, lines, nodes), nodes * (lines.size - 1)
