"""The half-space's load-approach curve to an accuracy asked for.

See `halfspace.accuracy.refinement` for how the error is estimated.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property, partial

import numpy as np

from halfspace.accuracy.finite_bodies import (
    APART,
    AROUND,
    EQUAL,
    LEAVE,
    TIGHT,
    WINDOW,
    AroundEvents,
    Made,
    SizedBody,
    apart_for_events,
    at_equator,
    at_tip,
    surroundings,
)
from halfspace.accuracy.refinement import climb
from halfspace.accuracy.stages import Charted, Rung
from halfspace.accuracy.windows import Windows
from halfspace.elastic import compliance, grid
from halfspace.elastic.grid import FLAT, SurfaceCoordinate
from halfspace.elastic.layered import Images, image_kernels, images_of, layered, layered_panels
from halfspace.elastic.layers import LayeredBody
from halfspace.elastic.operators import Homogeneous, NearlyHomogeneous
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.contact import contact_of
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import REMAINING, ErrorRule
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import require_load, require_rtol, require_tabor
from halfspace.profiles import PARABOLOID, Profile, require_profile
from halfspace.scales import Scales
from halfspace.values import Array, Valued

EXTENT = 8.0  # of the finite cells, in widths of a rigid attraction: the infinite one is then as good as they are
MOST_NODES = 16  # of a panel
# Cells on the axis after which an event has its own that end at its contact edge: on those of the axis the estimates of
# folds were up to a thousand times too large. By finite elements they were not; a fifth of the time is saved there.
EVENTS_LEAVE = 1.0
FAR = 100.0  # of the last cell on a layered body by itself, in extents: the energy left out is 1e-10 R dgamma eps
# Times as fast as elsewhere cells grow from a tip u^k: the nearer to the axis they are, the less there is to be left of
# it. In the first cell n nodes leave n^(-2k) of it, so that its radius is n^2 times that at which u^k is all left. With
# 2 or 3 in the place of 1.5 two of 427 numbers were outside their estimates.
TIP = 1.5
# Found by trial; what each decides at half and at double is in tests/constants.py.
ONE_NODE = 2.0  # of the change by one node more, what may be left: it errs less, but not always by as much
MOST_CELLS = 100  # of one length
TWIN = (0.75, 0.87, 0.8)  # finest cells, growth and extent of a twin, in those of its sibling: no cell is the same
# Of what n nodes a panel leave, 10^-n, what polynomials in the contact radius may leave of a layer's images. On a stiff
# coating pull-off's approach errs by 40 times that; estimates do not know it where finer grids have the same radii.
BETWEEN = 1e-4
THIN = 0.05  # beta: strata on which most of what is wrong is their images'
IMAGES = (1.14, 1.17)  # ratios of the depths of a layered body's images, and of its twin's


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
    return Resolution(min(nodes, MOST_NODES), finest=0.6, growth=3.0, extent=EXTENT * scales.widened)


@dataclass(frozen=True, eq=False, repr=False)
class Rings(Valued):
    """Breakpoints of two charts: centred on the axis up to a contact radius, then on the edge, whose radius is 1."""

    centred: Array
    edge: Array
    until: float


def rings(
    scales: Scales,
    finest: float,
    growth: float,
    extent: float,
    to_load: float = COMPRESSION,
    nodes: int = MOST_NODES,
) -> Rings:
    """Breakpoints fine enough for the spike of tension at every contact radius up to that under the load `to_load`.

    `finest` is in widths of the spike, `extent` in those of the attraction, as in `Resolution`.
    """
    length = scales.edge_cell(finest)
    outer = scales.outer_radius(extent**2 / 2)
    widest, first = scales.widest_radius(to_load), at_tip(scales.profile, nodes)
    growth = scales.growth(growth)
    reach = EQUAL * length
    until = LEAVE * reach
    centred = grid.graded(0.0, length, outer, growth=growth, until=reach)
    if scales.law.outermost:
        return Rings(_fine_throughout(scales, finest, growth, outer, to_load), centred, math.inf)
    edge = grid.graded(1.0, 2 * length / widest, outer / until, growth=growth)  # as wide from the first
    inwards = _inwards(scales, growth)
    return Rings(grid.towards_axis(centred, first, inwards), grid.towards_axis(edge, first / widest, inwards), until)


def _inwards(scales: Scales, growth: float) -> float:
    """Ratio of neighbouring cells towards the axis."""
    return TIP * growth if scales.profile.pointed else growth


def _fine_throughout(scales: Scales, finest: float, growth: float, outer: float, to_load: float) -> Array:
    """Breakpoints as fine as at a contact edge wherever one may stand, by a law whose tension has several largest."""
    reach = float(np.hypot(scales.widest_radius(to_load), scales.radius_at(scales.law.outermost)))
    spacing = finest * scales.spike_width
    cells = reach / spacing
    if cells > MOST_CELLS:
        raise InputError(
            f"{scales.law}: the tension rises again at H = {scales.law.outermost:.3g}, so that {cells:.0f} cells of "
            f"{spacing:.2g} beta are needed up to {reach:.3g} beta, limit: {MOST_CELLS}; take a smaller tabor than "
            f"{scales.tabor:g}, or a smaller to_load"
        )
    return grid.graded(0.0, spacing, max(outer, reach + spacing), growth=growth, until=reach)


@dataclass(frozen=True, eq=False, repr=False)
class Grids(Valued):
    """The half-space on two grids: one centred on the axis, up to a contact radius in beta, and one that follows it."""

    centred: compliance.ElasticOperator
    edge: Homogeneous
    until: float

    @classmethod
    def of(cls, scales: Scales, resolution: Resolution, to_load: float = COMPRESSION) -> Grids:
        """Panels as fine as a contact of these scales needs them, up to a load."""
        lines, half_space = _to_infinity(scales, resolution, to_load)
        return cls(half_space(lines.centred), Homogeneous(half_space(lines.edge)), lines.until)

    def charts(self, scales: Scales) -> tuple[Chart, Chart]:
        """Both grids under a contact of these scales, or of stiffer ones that need no finer cells."""
        return (
            Chart(contact_of(scales, self.centred), self.centred.radii.size, self.until),
            Chart(contact_of(scales, self.edge), self.edge.unit.radii.size),
        )


def half_space_charts(scales: Scales, resolution: Resolution, to_load: float = COMPRESSION) -> tuple[Chart, Chart]:
    """Panel grids centred on the axis and following the contact edge."""
    return Grids.of(scales, resolution, to_load).charts(scales)


def _to_infinity(
    scales: Scales, resolution: Resolution, to_load: float
) -> tuple[Rings, Callable[[Array], compliance.ElasticOperator]]:
    """Breakpoints, and what makes the half-space's operator of those of either chart."""
    nodes, reach = resolution.nodes, scales.tail_reach
    lines = rings(scales, resolution.finest, resolution.growth, resolution.extent, to_load, nodes)
    return lines, partial(_endless, nodes, reach)  # no function of its own, as what is pickled holds it


def _endless(nodes: int, reach: float, breaks: Array) -> compliance.ElasticOperator:
    return compliance.to_infinity(_cut(nodes, breaks), nodes, reach)


def _cut(nodes: int, breaks: Array) -> compliance.ElasticOperator:
    return compliance.panels(breaks, nodes)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LayeredHalfSpace(SizedBody):
    """Layered body on the grids of the half-space, with what its images have beside that.

    The cells end at twice the half-space's extent, to where all images are integrated: what is pressed farther out, in
    the infinite cell, is too little to deflect a layer. Those that follow the contact scale with it, all of them, so
    that one chart serves the whole curve and its events, see `Images.in_units`.
    """

    images: Images
    rings: Rings
    half_space: Callable[[Array], compliance.ElasticOperator]
    nodes: int

    def lines(self, edge: float = 0.0) -> Array:  # noqa: ARG002 (those of an edge are its multiples)
        """Ends of all finite cells of the chart fine on the axis."""
        return self.rings.centred

    def centred(self) -> Chart:
        """Chart fine on the axis."""
        return self._charts[0]

    def around(self, radius: float, window: float = WINDOW, count: int = AROUND) -> Chart:  # noqa: ARG002
        """Chart that follows the contact, the same at all radii."""
        return self._charts[1]

    def curve(self, apart: float = APART) -> tuple[Chart, Chart]:  # noqa: ARG002 (as above)
        """Charts for the whole curve."""
        return self._charts

    @cached_property
    def _charts(self) -> tuple[Chart, Chart]:
        edge, (least, widest) = self.half_space(self.rings.edge), self.radii_of_curve
        least = min(least, EVENTS_LEAVE * self.length)
        scales, past, images = self.images.in_units(least, widest, BETWEEN * 10.0**-self.nodes)
        operator = NearlyHomogeneous(edge, scales, past, *image_kernels(images, edge, float(self.outer[0]) / least))
        return super().centred(), Chart(contact_of(self.scales, operator), edge.radii.size)


def layered_half_space(
    scales: Scales, images: Images, resolution: Resolution, to_load: float = COMPRESSION
) -> LayeredHalfSpace:
    """Layered body with charts as fine as a half-space's."""
    how = replace(resolution, extent=2 * resolution.extent)
    lines, half_space = _to_infinity(scales, how, to_load)
    outer = scales.outer_radius(how.extent**2 / 2)
    make = partial(_made_layered, images, half_space, outer)
    return LayeredHalfSpace(
        scales,
        make,
        how.finest,
        how.growth,
        np.array([outer]),
        FLAT,
        to_load=to_load,
        images=images,
        rings=lines,
        half_space=half_space,
        nodes=how.nodes,
    )


def _made_layered(
    images: Images, half_space: Callable[[Array], compliance.ElasticOperator], until: float, breaks: Array
) -> Made:
    operator = layered(images, half_space(breaks), until)
    return operator, operator.radii.size


def trace(
    tabor: float,
    *,
    law: Law = LENNARD_JONES,
    profile: Profile = PARABOLOID,
    body: LayeredBody | None = None,
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
    if body is not None or math.isfinite(scales.profile.end):
        images = [images_of(body, spacing) if body is not None else None for spacing in IMAGES]
        return climb(rtol, partial(_sized_rung, scales, images, rtol, to_load), to_load=to_load)

    if scales.step_gap and not scales.law.outermost:
        return climb(rtol, partial(_stepped_rung, scales, rtol, to_load), to_load=to_load)
    charts = partial(half_space_charts, scales, to_load=to_load)
    return climb(rtol, partial(half_space_rung, scales, rtol, charts), to_load=to_load)


def half_space_rung(
    scales: Scales, rtol: float, charts: Callable[[Resolution], tuple[Chart, Chart]], level: int
) -> Rung:
    """Rung of a level for a half-space under an endless surface, whose charts are made of a resolution."""
    resolution, below = (resolution_for(scales, rtol, max(n, 0)) for n in (level, level - 1))
    curve = partial(charts, resolution)
    if not level:
        return Rung(curve, (), asdict(resolution))
    fine, twin = (Charted(charts(r)) for r in (resolution, _twin(below)))
    return Rung(curve, (fine,), asdict(resolution), twin, _rule(level))


def _stepped_rung(scales: Scales, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level for a half-space under a law that ends by a step."""
    resolutions = resolution_for(scales, rtol, level), _twin(resolution_for(scales, rtol, max(level - 1, 0)))
    fine, twin = (_windows(scales, resolution, to_load) for resolution in resolutions)
    return Rung(fine.curve, (fine,), asdict(resolutions[0]), twin if level else None, _rule(level))


def _windows(scales: Scales, resolution: Resolution, to_load: float) -> Windows:
    outer = scales.outer_radius(resolution.extent**2 / 2)
    nodes, cut = resolution.nodes, math.isinf(scales.law.decay)  # it acts no farther than the cells
    half_space = partial(_cut, nodes) if cut else partial(_endless, nodes, scales.tail_reach)
    tip, inwards = at_tip(scales.profile, nodes), _inwards(scales, resolution.growth)
    return Windows(scales, resolution.finest, resolution.growth, outer, half_space, tip, inwards, to_load)


def _rule(level: int, doubt: int = 1) -> ErrorRule:
    """How errors are told from the change by one node more, or by two and more, and so many times as large.

    Where a profile's derivatives leap inside a cell an error falls as a power of the nodes: a pair more leaves as much
    there as elsewhere one.
    """
    return ErrorRule(doubt * (ONE_NODE if level == 1 else REMAINING))


def _twin(resolution: Resolution) -> Resolution:
    """Return a resolution as fine, with other cells."""
    finest, growth, extent = TWIN
    return replace(
        resolution,
        finest=finest * resolution.finest,
        growth=growth * resolution.growth,
        extent=extent * resolution.extent,
    )


def _sized_rung(scales: Scales, images: Sequence[Images | None], rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level for a surface that ends, as a sphere's does at its equator, or a body that has a length."""
    resolutions = resolution_for(scales, rtol, level), _twin(resolution_for(scales, rtol, max(level - 1, 0)))
    fine, other = (_sized_body(scales, *both, to_load) for both in zip(images, resolutions, strict=True))
    resolution = resolutions[0]
    doubt = _doubt_of_images(scales.body, rtol) if scales.body else 1
    settings = {"nodes": resolution.nodes, "finest": resolution.finest, "growth": resolution.growth}
    if not level and images[0] is None and (apart := apart_for_events(fine, rtol)):
        lowest = AroundEvents(fine, *surroundings(rtol, level), EVENTS_LEAVE, apart=apart)
        return Rung(lowest.by_curve, (lowest,), settings)
    return Rung(
        fine.curve,
        (AroundEvents(fine, *surroundings(rtol, level), EVENTS_LEAVE),),
        settings,
        AroundEvents(other, *surroundings(rtol, level - 1), EVENTS_LEAVE) if level else None,
        _rule(1 if scales.profile.pieced else level, doubt),
    )


def _doubt_of_images(body: LayeredBody, rtol: float) -> int:
    """How many times as large as by the change from twin to twin what is left may be: that of images, who err alike.

    Under a sharp tip on strata 0.01 beta thin it was 2.8 times at every tolerance, on thicker ones at tight ones alone.
    """
    if body.strata[0].thickness < THIN:
        return 4
    return 2 if rtol < TIGHT else 1


def _sized_body(
    scales: Scales, images: Images | None, resolution: Resolution, to_load: float = COMPRESSION
) -> SizedBody:
    """Body whose surface ends, or a layered one."""
    ends = math.isfinite(scales.profile.end)
    if images and not ends and not scales.law.outermost:  # by such a law the half-space's grid does not scale
        return layered_half_space(scales, images, resolution, to_load)
    first = at_tip(scales.profile, resolution.nodes)
    how = resolution.finest, resolution.growth
    if images is None:
        R = scales.profile.end
        under = R, resolution.nodes
        return SizedBody(
            scales,
            partial(_made_under_sphere, *under),
            *how,
            np.array([2 * R]),
            SurfaceCoordinate(R),
            to_load=to_load,
            first=first,
            together=partial(_all_under_sphere, *under),
        )
    last = at_equator(scales.tabor, scales.profile, resolution.nodes) if ends else math.inf
    outer = np.array([scales.profile.end if ends else scales.whole_radius((FAR * resolution.extent) ** 2 / 2)])
    made = partial(_made, images, resolution.nodes)
    return SizedBody(scales, made, *how, outer, FLAT, last, to_load, first)


def _made_under_sphere(R: float, nodes: int, lines: Array) -> Made:
    return _all_under_sphere(R, nodes, lines[None])[0]


def _all_under_sphere(R: float, nodes: int, lines: Array) -> list[Made]:
    return [(operator, operator.radii.size) for operator in compliance.stacked_panels(lines, nodes, R)]


def _made(images: Images, nodes: int, lines: Array) -> Made:
    return layered_panels(images, lines, nodes), nodes * (lines.size - 1)
