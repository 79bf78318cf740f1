"""The surface of a layered body: the half-space's ring kernel and that of images below it, which is smooth.

With S from `halfspace.elastic.layers` the deflection at r by a ring of pressure at s has the kernel

    2 int_0^inf S(k) J0(k r) J0(k s) dk = G(r, s) + 2 int_0^inf (S - 1) J0(k r) J0(k s) dk,

and S - 1 dies out as the strata hide what is below them. It is fitted by exponentials, each of which is the kernel of
rings at a depth z below the surface, of all the pressure's images one:

    S(k) - 1 = sum_j c_j e^(-k z_j),   2 int_0^inf e^(-k z) J0(k r) J0(k s) dk = 4 K(m)/(pi d),

d^2 = (r + s)^2 + z^2, 1 - m = [(r - s)^2 + z^2]/d^2. That is smooth over the distance z, so that Gauss's points serve
as they are in a cell that is no longer than the first stratum is thick, and a few samples of the radius tell it to all
nodes that are closer together. Where a soft stratum lies between stiffer ones S rises and falls, and depths and
strengths are complex, of which the real part counts; 4 K(m)/(pi d) is then 2/M(d, d (1 - m)^(1/2)), M the
arithmetic-geometric mean, faster than Carlson's R_F.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import partial
from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipkm1

from halfspace.elastic.compliance import ElasticOperator, SurfaceNodes, panels, to_infinity
from halfspace.elastic.grid import gauss_legendre, gauss_points, polynomial
from halfspace.elastic.kernel import near_moments, of_lagrange
from halfspace.elastic.layers import LayeredBody, surface_compliance, total_thickness
from halfspace.elastic.operators import NearlyHomogeneous, Piecewise, chebyshev_lengths, nodes_beside
from halfspace.errors import InputError, NotConverged
from halfspace.values import Array, Index, Mask, Valued

if TYPE_CHECKING:
    from scipy import sparse

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class ImageSettings:
    """Numbers by which images are fitted and their kernels integrated.

    Of the rule near cells that are longer than the first stratum is thick: with 6 nodes a cell a bell of pressure
    deflects the surface to 1e-8 as by a rule of 64 points, q = 5, up to two lengths away, with 8 nodes to 2e-9.
    """

    shallowest: float = 1.0  # thicknesses of the first stratum at which the first image is
    deepest: float = 60.0  # thicknesses of all strata at which the last image is
    deeper: tuple[float, ...] = (1.0, 10.0, 100.0, 1e3)  # times as deep they go if need be: stiff strata spread a load
    spacings: tuple[float, float] = (1.14, 1.1)  # of depths, a ratio, and a twin's: by 1.2 the fit is a decade worse
    close: float = 0.14  # most logarithm of the ratio of lengths between which images are interpolated
    between: float = 1e-4  # of what n nodes a panel leave, 10^-n, what polynomials in the contact radius may: pull-off
    # from a stiff coating errs by 40 times that, and estimates do not know it where finer grids have the same radii
    farther: float = 2.0  # times the half-space's extent, to where all images are integrated
    wide: float = 1.75  # most logarithm of the ratio of contact radii between which a remainder is one polynomial
    wider: float = 10.0  # times the widest contact that is planned for, up to which remainders are known
    samples: int = 500  # wave numbers at which S is fitted
    fitted: float = 3e-8  # misfit at which no deeper images are tried
    at_worst: float = 1e-6  # misfit at which strata are refused
    near: float = 0.5  # lengths of a long cell around it where nodes need a rule of their own
    adjacent: tuple[int, int] = (48, 2)  # points, grading of a rule next to a long cell: 24 leave 5e-6 on 0.01 beta
    apart: float = 0.3  # lengths of a long cell from which Gauss's rule leaves 5e-11 of a kernel
    apart_points: int = 14  # points of that rule
    at_once: int = 10**6  # numbers that are integrated at once
    alike: float = 1e-8  # relative difference of two numbers at which their mean is the arithmetic-geometric one


HOW = ImageSettings()


@dataclass(frozen=True, eq=False, repr=False)
class Images(Valued):
    """Rings below the surface whose kernels, summed, are what a layered body has beside the half-space's.

    The depths z_j are complex, (n,), and so are their strengths c_j, (n,), or (m, n) if m bodies share the depths, each
    with a kernel of its own, (m, ...). The depths, and the first stratum's thickness `smooth`, a distance over which
    the sum hardly changes, are in beta, or in units of a length that differs from body to body.
    """

    depths: Complex
    strengths: Complex
    smooth: float

    def ring(self, r: Array, s: Array, _: Array) -> Array:
        """Ring as of `halfspace.elastic.kernel.near_moments`: the distance does not matter, all is smooth."""
        return self.kernel(r, s) * s

    def kernel(self, r: Array, s: Array) -> Array:
        """Deflection at radius r by all images of a ring of unit pressure times radius at s; arrays broadcast."""
        sums, differences = np.asarray(r + s) ** 2, np.asarray(r - s) ** 2
        rings = np.empty((self.depths.size, *sums.shape), complex if self.depths.imag.any() else float)
        for ring, z in zip(rings, self.depths.tolist(), strict=True):
            ring[...] = _ring(z, sums, differences)
        strengths = self.strengths if np.iscomplexobj(rings) else self.strengths.real
        return np.asarray(np.tensordot(strengths, rings, 1).real)

    def in_units(self, lengths: Array, left: float) -> Images:
        """Return the images in units of each of some lengths (m,), at depths that all share.

        These are a geometric sequence, as the body's own are. Between them an image's kernel is a polynomial in the
        logarithm of its depth that leaves a part `left` of it: few more depths serve all lengths than serve one.
        """
        real, tilted = self.depths.real, self.depths.imag > 0
        ratio = float(np.log(real[1] / real[0]))
        parts = int(np.ceil(ratio / (HOW.close / 2 if tilted.any() else HOW.close)))
        step = ratio / parts
        near = 2 * nodes_beside(step * (2 if tilted.any() else 1), left)
        shallowest = np.log(real[0] / lengths)
        deeper, between = np.divmod((shallowest - shallowest.min()) / step, 1)
        weights = polynomial(np.arange(near, dtype=float) - (near / 2 - 1), between)
        number = parts * np.rint(np.log(real / real[0]) / ratio).astype(int) + deeper.astype(int)[:, None]
        of_a_kind = number.max() + near
        ladder = np.exp(shallowest.min() + step * (np.arange(of_a_kind) - (near / 2 - 1)))
        strengths, each = np.zeros((lengths.size, 2 * of_a_kind), complex), np.arange(lengths.size)[:, None]
        for place in range(near):
            strengths[each, number + place + of_a_kind * tilted] += self.strengths * weights[:, place, None]
        used = strengths.any(axis=0)
        depths = np.append(ladder, (1 + 1j) * ladder)[used]
        return Images(depths, strengths[:, used], self.smooth / float(lengths.max()))


def _ring(z: complex, sums: Array, differences: Array) -> Array | Complex:
    """Kernel of an image of strength 1 from the squares of r + s and r - s; complex at a complex depth."""
    if z.imag:
        return 2 / _mean(np.sqrt(sums + z**2), np.sqrt(differences + z**2))
    d2 = sums + z.real**2
    return np.asarray(4 / np.pi * ellipkm1((differences + z.real**2) / d2) / np.sqrt(d2))


def _mean(a: Complex, b: Complex) -> Complex:
    """Arithmetic-geometric mean of numbers with positive real parts; the digits double from step to step."""
    while np.any(np.abs(a - b) > HOW.alike * np.abs(a)):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return (a + b) / 2


def images_of(body: LayeredBody, spacing: float = HOW.spacings[0]) -> Images:
    """Fit the images of a layered body at depths of a given ratio of neighbours; another one errs otherwise.

    InputError if the body is not made of layers, NotConverged if the strata differ so much in stiffness or thickness
    that no images fit.
    """
    if not isinstance(body, LayeredBody):
        raise InputError(f"body = {body!r}, limit: layers on a base; give Layer, Coated or Layers, or leave it out")
    thin, all_of_it = body.strata[0].thickness, total_thickness(body)
    k = np.geomspace(1e-4 / all_of_it / HOW.deeper[-1], 30 / thin, HOW.samples)
    wanted = surface_compliance(body, k) - 1
    largest = max(1.0, float(np.abs(wanted).max()))
    fits: list[tuple[float, Complex, Complex]] = []
    for tilted, deeper in product((False, True), HOW.deeper):
        if tilted and min(misfit for misfit, *_ in fits) <= HOW.at_worst * largest:
            break
        depths = _depths(HOW.shallowest * thin, HOW.deepest * all_of_it * deeper, spacing, tilted=tilted)
        fits.append(_fitted(k, wanted, depths))
        if fits[-1][0] <= HOW.fitted:
            break
    misfit, depths, strengths = min(fits, key=lambda fit: fit[0])
    if misfit > HOW.at_worst * largest:
        raise NotConverged(
            f"the yield of the strata to waves is missed by {misfit:.1g} of a half-space's, limit "
            f"{HOW.at_worst * largest:.1g}; they differ too much in stiffness or thickness: take thin ones together"
        )
    return Images(depths, strengths, thin)


def _depths(first: float, last: float, spacing: float, *, tilted: bool) -> Complex:
    """Real ones, or as many in all, half of them complex."""
    count = int(np.ceil(np.log(last / first) / np.log(spacing) / (2 if tilted else 1)))
    real = np.geomspace(first, last, 1 + count).astype(complex)
    return np.append(real, (1 + 1j) * real) if tilted else real


def _fitted(k: Array, wanted: Array, depths: Complex) -> tuple[float, Complex, Complex]:
    """Largest misfit, depths and strengths of images at given depths, by least squares."""
    waves, tilted = np.exp(-np.outer(k, depths)), depths.imag > 0
    parts = np.hstack([waves.real, -waves.imag[:, tilted]])
    found = np.asarray(np.linalg.lstsq(parts, wanted, rcond=1e-15)[0], float)
    strengths = found[: depths.size].astype(complex)
    strengths[tilted] += 1j * found[depths.size :]
    return float(np.abs(parts @ found - wanted).max()), depths, strengths


def layered_panels(images: Images, breakpoints: Array, nodes_per_panel: int) -> ElasticOperator:
    """Layered body under pressures that are polynomials between the breakpoints, collocated at Gauss's points.

    The images are the body's; breakpoints (m + 1,), in beta, and nodes are as of `halfspace.elastic.compliance.panels`.
    """
    half_space = panels(breakpoints, nodes_per_panel)
    return replace(half_space, compliance=half_space.compliance + image_compliance(images, half_space))


def panels_of(body: LayeredBody | None, breakpoints: Array, nodes_per_panel: int) -> ElasticOperator:
    """Layered body, or a half-space for None, as of `layered_panels`."""
    if body is None:
        return panels(breakpoints, nodes_per_panel)
    return layered_panels(images_of(body), breakpoints, nodes_per_panel)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LayeredOperator(ElasticOperator):
    """Layered body on the grid of a half-space's operator; the rest is as of `image_compliance`."""

    images: Images
    until: float

    def widened(self, nodes: int, reach: float) -> ElasticOperator:
        """Return the body with other cells beyond its extent, see `halfspace.elastic.compliance.to_infinity`."""
        known = int(np.count_nonzero(self.radii <= self.extent))
        return layered(self.images, to_infinity(self, nodes, reach), self.until, known)


def layered(images: Images, half_space: ElasticOperator, until: float, known: int = 0) -> LayeredOperator:
    """Layered body on the grid of a half-space's panels, the last of which may be infinite; see `image_compliance`."""
    compliance = half_space.compliance + image_compliance(images, half_space, until, known)
    own = {field.name: getattr(half_space, field.name) for field in fields(ElasticOperator)}
    return LayeredOperator(**own | {"compliance": compliance}, images=images, until=until)


def image_compliance(images: Images, body: ElasticOperator, until: float = np.inf, known: int = 0) -> Array:
    """What the images of a layered body deflect the nodes of a half-space's panels by pressures there, (..., q, q)."""
    return image_kernels(images, body, until, known) * body.weights


def image_kernels(
    images: Images, body: ElasticOperator, until: float = np.inf, known: int = 0, samples: Array | None = None
) -> Array:
    """The same but for the weights, between the nodes or at samples (n,) of the radius, long cells' nodes among them.

    Cells that begin beyond a radius, in beta, and an infinite one are integrated by their nodes even where they are
    longer than the first stratum is thick: too stiffly for what is pressed there, if anything is. Between the first
    nodes, so many, where it is known, it is left zero; all finite cells are theirs.
    """
    radii, (left, right) = body.radii if samples is None else samples, (body.cells[:-1], body.cells[1:])
    number, k = np.searchsorted(radii, body.radii), body.cell_nodes.shape[1]
    i, j = np.triu_indices(radii.size)
    i, j = i[j >= known], j[j >= known]
    rules = _near(radii, left, right, (right - left > images.smooth) & (left < until), known)
    values = np.zeros((*images.strengths.shape[:-1], radii.size, radii.size))
    for some in _blocks(i.size, images.depths.size):
        values[..., i[some], j[some]] = images.kernel(radii[i[some]], radii[j[some]]) / (2 * np.pi)
        values[..., j[some], i[some]] = values[..., i[some], j[some]]
    for to, cell, rule in rules:
        for some in _blocks(to.size, images.depths.size * rule[0]):
            nodes = body.cell_nodes[cell[some]]
            moments = near_moments(images.ring, radii[to[some]], left[cell[some]], right[cell[some]], k, rule)
            known_by = of_lagrange(moments, gauss_legendre(k)[0]) / body.weights[nodes]
            values[..., to[some, None], number[nodes]] = known_by
    return values


def nearly_homogeneous(
    images: Images, unit: ElasticOperator, between: tuple[float, float], until: float, left: float
) -> NearlyHomogeneous:
    """Layered body on a half-space's grid about the contact radius 1, scaled with radii between two or wider, in beta.

    Polynomials in the logarithm of the radius leave a part `left` of a kernel at a depth, whose first poles, where the
    distance vanishes, lie pi/2 beside the real axis, or pi/4 at a complex one. The images are integrated up to `until`,
    in beta, or by as much farther as a contact is wider than the wider of the two; the rest is as of `image_kernels`.
    """
    least, widest = between
    ratio = float((widest / least) ** (1 / np.ceil(np.log(widest / least) / HOW.wide)))
    pole = np.pi / (4 if images.depths.imag.any() else 2) / (np.log(ratio) / 2)
    degree = int(np.ceil(np.log(2 / left) / np.arcsinh(pole)))
    ends = least * ratio ** np.arange(np.ceil(np.log(HOW.wider * widest / least) / np.log(ratio)) + 1)
    lengths = [chebyshev_lengths(*part, degree) for part in pairwise(ends.tolist())]
    rows = [_sampled(unit, images, radii, left)[1] for radii in lengths]
    make = partial(_in_units, images, unit, widest, until, left)
    return NearlyHomogeneous(unit, Piecewise(ends, lengths, make), rows)


def _in_units(images: Images, unit: ElasticOperator, widest: float, until: float, left: float, radii: Array) -> Array:
    farthest, scaled = max(radii[-1], widest) + until - widest, images.in_units(radii, left)
    samples, _ = _sampled(unit, images, radii, left)
    return image_kernels(scaled, unit, farthest / float(radii.min()), samples=samples)


def _sampled(body: SurfaceNodes, images: Images, radii: Array, left: float) -> tuple[Array, sparse.csr_array]:
    """Samples (n,) of the radius for images in units of some lengths, and rows (q, n) from these to a body's nodes.

    Images are smooth over a distance. Cells that lie within it together have as many of Gauss's points in common as
    leave a part `left` of a kernel at that depth, whose poles lie two half-lengths beside the real axis; where their
    nodes are no more, these serve. So they do beside long cells, where one rule gives way to the next: what the cells
    deflect is not smooth there.
    """
    from scipy import sparse  # it takes time to load, and few need it

    smooth, count = images.smooth / float(radii.max()), int(np.ceil(np.log(2 / left) / np.arcsinh(2.0)))
    begin, end, length = body.cells[:-1], body.cells[1:], np.diff(body.cells)
    first, last = np.floor(begin / smooth), np.ceil(end / smooth)
    apart = np.maximum(begin - end[:, None], begin[:, None] - end)
    beside = ((apart < HOW.near * length) & (length > smooth)).any(axis=1)
    within = np.where((last - first == 1) & ~beside, first, -1 - np.arange(first.size))
    samples, rows = [], []
    for cells in np.split(np.arange(first.size), 1 + np.flatnonzero(np.diff(within))):
        nodes = body.radii[body.cell_nodes[cells].ravel()]
        points = gauss_points(body.cells[[cells[0], cells[-1] + 1]], count)[0].ravel()
        samples.append(points if cells.size > 1 and points.size < nodes.size else nodes)
        rows.append(polynomial(samples[-1], nodes))
    beyond = body.radii[body.beyond]
    return np.concatenate([*samples, beyond]), sparse.csr_array(sparse.block_diag([*rows, np.eye(beyond.size)]))


def _blocks(count: int, size: int) -> list[slice]:
    """Parts of so many items, of a size each, of no more than `ImageSettings.at_once` in all, or one."""
    several = max(1, HOW.at_once // size)
    return [slice(first, min(first + several, count)) for first in range(0, count, several)]


def _near(
    radii: Array, left: Array, right: Array, long: Mask, known: int
) -> list[tuple[Index, Index, tuple[int, int]]]:
    """Nodes, but for the first that are known, and long cells near them, by their numbers, for each rule."""
    distance = np.maximum(left - radii[:, None], radii[:, None] - right) / (right - left)
    near = (distance < HOW.near) & long & (np.arange(radii.size) >= known)[:, None]
    adjacent, apart = np.nonzero(near & (distance < HOW.apart)), np.nonzero(near & (distance >= HOW.apart))
    return [(adjacent[0], adjacent[1], HOW.adjacent), (apart[0], apart[1], (HOW.apart_points, 1))]
