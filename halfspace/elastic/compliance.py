"""Elastic operators: the linear map from surface pressure to surface deflection, and the half-space's."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from scipy.linalg import eigh

from halfspace.elastic import grid
from halfspace.elastic.grid import FLAT, SurfaceCoordinate
from halfspace.elastic.kernel import band_deflection, before_equator, panel_integrals, require_room, stereographic_ring
from halfspace.errors import InputError
from halfspace.values import Array, Index, Valued


class Operator(ABC):
    """What a contact problem needs to know of a body."""

    follows_contact: ClassVar[bool] = False
    """Whether the scale is the contact radius in beta; if not, it is 1."""

    alike: ClassVar[bool] = True
    """Whether the cells on both sides of the contact edge are, as on a grid that stands still or is scaled."""

    @property
    def served(self) -> tuple[float, float]:
        """Least and widest contact radius that it serves, in beta."""
        return 0.0, np.inf

    @property
    @abstractmethod
    def axis_row(self) -> Array:
        """Row (q,) that interpolates nodal values on the axis."""

    @abstractmethod
    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""

    @abstractmethod
    def nodes(self, scale: float) -> SurfaceNodes:
        """Nodes at a contact radius in beta, without the work that a compliance may take."""

    def root(self, scale: float) -> Array:
        """L, (q, m), with L L^T the symmetric part of w^(1/2) C w^(-1/2)."""
        return self.at(scale).compliance_root

    # Of a grid that follows the contact

    @property
    def edge_row(self) -> Array:
        """Row (q,) that interpolates nodal values at the contact edge."""
        raise NotImplementedError("the grid does not follow the contact; use interpolation at its radius")

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure, each (q,)."""
        raise NotImplementedError("the grid does not follow the contact; use interpolation at its radius")


@dataclass(frozen=True, eq=False, repr=False)
class SurfaceNodes(Valued):
    """Nodes of a surface, cut into rings, the `cells`: in each, values are polynomials through those at its nodes.

    Attributes
    ----------
    radii : (q,) array
        Radii of the surface nodes, ascending, in beta; those past the last cell are of an infinite one, see
        `to_infinity`.
    weights : (q,) array
        Quadrature weights of the area element 2 pi u du, or of that on a sphere itself where the pressure is per that:
        ``weights @ P`` is the load in R dgamma.
    cells : (m + 1,) array
        Radii between which one interpolation polynomial holds, from 0 outwards.
    cell_nodes : (m, k) int array
        The k nodes whose values define the polynomial in each cell.
    coordinate : SurfaceCoordinate
        What of the radius values are polynomials of: under a sphere its own, since nodes crowd at the equator, where a
        polynomial of the radius runs wild between the nodes of a long cell.
    """

    radii: Array
    weights: Array
    cells: Array
    cell_nodes: Index
    coordinate: SurfaceCoordinate = FLAT

    @property
    def extent(self) -> float:
        """Radius in beta at which the last finite cell ends."""
        return float(self.cells[-1])

    @cached_property
    def beyond(self) -> Index:
        """Nodes past the extent, none where the surface law acts only up to it."""
        return np.flatnonzero(self.radii > self.extent)

    def scaled(self, factor: float) -> Self:
        """Return the same blown up by a factor."""
        return replace(self, radii=self.radii * factor, weights=self.weights * factor**2, cells=self.cells * factor)

    def cell_of(self, radius: float) -> int:
        """Index of the cell that holds `radius`."""
        return min(max(int(self.cells.searchsorted(radius, side="right")) - 1, 0), self.cells.size - 2)

    def interpolation(self, radius: float) -> Array:
        """Row (q,) that interpolates nodal values at `radius`."""
        row = np.zeros(self.radii.size)
        nodes, row[nodes], _ = self._lagrange(self.cell_of(radius), radius)
        return row

    def continuous(self, radius: float) -> tuple[Array, Array]:
        """Row as of `interpolation`, and its derivative by the radius, of a function continuous where two cells meet.

        Polynomials through nodes inside their cells leap there by their error; so between the last node of a cell and
        the first of the next, the one goes over into the other in proportion.
        """
        cell, (row, rate) = self.cell_of(radius), np.zeros((2, self.radii.size))
        cell -= cell > 0 and radius < self.radii[self.cell_nodes[cell, 0]]
        left, value, slope = self._lagrange(cell, radius)
        row[left], rate[left] = value, slope
        if cell + 1 < len(self.cell_nodes) and radius > self.radii[left[-1]]:
            right, other, other_slope = self._lagrange(cell + 1, radius)
            width = float(self.radii[right[0]] - self.radii[left[-1]])
            part = float(radius - self.radii[left[-1]]) / width
            row[left], rate[left] = (1 - part) * value, (1 - part) * slope - value / width
            row[right], rate[right] = part * other, part * other_slope + other / width
        return row, rate

    def continuous_value(self, radius: float, values: Array) -> tuple[float, float]:
        """Value and slope at a radius of that function through nodal values."""
        row, rate = self.continuous(radius)
        return float(row @ values), float(rate @ values)

    def _lagrange(self, cell: int, radius: float) -> tuple[Index, Array, Array]:
        """Nodes of a cell, and the values and slopes at a radius of the Lagrange polynomials through them."""
        nodes = self.cell_nodes[cell]
        values, slopes = lagrange(self._places[nodes], self._barycentric[cell], self.coordinate.of(radius))
        return nodes, np.array(values), np.array(slopes) * self.coordinate.rate(radius)

    def values_at(self, radii: Array, values: Array) -> Array:
        """Interpolate nodal values (q,) at many radii (n,) within the extent."""
        cells = np.clip(np.searchsorted(self.cells, radii, side="right") - 1, 0, self.cells.size - 2)
        nodes = self.cell_nodes[cells]
        offset = self.coordinate.along(radii)[:, None] - self._places[nodes]
        hit = offset == 0
        weights = np.where(hit.any(axis=1, keepdims=True), hit, self._barycentric[cells] / np.where(hit, 1.0, offset))
        return np.asarray(np.einsum("nk,nk->n", weights, values[nodes]) / weights.sum(axis=1))

    def values_beyond(self, radii: Array, values: Array) -> Array:
        """Interpolate nodal values (q,) that die out at infinity at radii (n,) past the extent, in t = extent/r."""
        t = self.extent / self.radii[self.beyond][::-1]
        known = np.append(0.0, values[self.beyond][::-1])
        return np.asarray(np.interp(self.extent / radii, np.append(0.0, t), known))

    @cached_property
    def axis_row(self) -> Array:
        """Row (q,) that interpolates nodal values on the axis.

        In the squares of the radii the nodes lie near to it. A polynomial in the radius, which is not even, misses the
        value there by the same on grids that differ in all else.
        """
        row = np.zeros(self.radii.size)
        row[self.cell_nodes[0]] = self.near_axis(np.zeros(1))[0]
        return row

    def near_axis(self, radii: Array) -> Array:
        """Rows (n, k) that interpolate values at the nodes of the first cell at radii in it, in squares of places."""
        return grid.polynomial(self._places[self.cell_nodes[0]] ** 2, self.coordinate.along(radii) ** 2)

    @cached_property
    def _places(self) -> Array:
        """Nodes (q,) in the surface's coordinate."""
        return self.coordinate.along(self.radii)

    @cached_property
    def _barycentric(self) -> Array:
        """Weights 1/prod (x_j - x_m) of the nodes of each cell, (m, k)."""
        return barycentric(self._places[self.cell_nodes])


@dataclass(frozen=True, eq=False, repr=False)
class ElasticOperator(SurfaceNodes, Operator):
    """Elastic half of a contact problem, whatever body or method it comes from.

    Pressure, deflection and gap are known at the nodes of the surface. Dimensionless: lengths in beta, E* = 1.

    Attributes
    ----------
    compliance : (q, q) array
        Deflection into the body (positive when pressed) at the nodes is ``compliance @ P`` for nodal
        pressures P, positive in compression.
    """

    compliance: Array = field(kw_only=True)

    @property
    def nbytes(self) -> int:
        """Bytes of its compliance."""
        return self.compliance.nbytes

    @property
    def finite(self) -> ElasticOperator:
        """The operator without the nodes past its extent."""
        inside = self.radii <= self.extent
        compliance = self.compliance[np.ix_(inside, inside)]
        return replace(self, radii=self.radii[inside], weights=self.weights[inside], compliance=compliance)

    def widened(self, nodes: int, reach: float) -> ElasticOperator:
        """Return the body with other cells beyond its extent, see `to_infinity`."""
        return to_infinity(self, nodes, reach)

    def at(self, scale: float) -> ElasticOperator:  # noqa: ARG002 (the same at every contact radius)
        """Return the operator itself, whatever the contact radius."""
        return self

    def nodes(self, scale: float) -> SurfaceNodes:  # noqa: ARG002
        """Return the operator itself: its nodes are the same at every contact radius."""
        return self

    @cached_property
    def compliance_root(self) -> Array:
        """L of `root`; the rank m falls short of q where the nodes outnumber the freedoms of the surface.

        A node without weight bears no load, and its row is zero.
        """
        root = np.sqrt(self.weights)
        balanced = self.compliance * (root[:, None] / np.where(root > 0, root, np.inf))
        values, vectors = eigh((balanced + balanced.T) / 2)
        kept = values > 1e-13 * values[-1]
        return np.asarray(vectors[:, kept] * np.sqrt(values[kept]))

    def scaled(self, factor: float) -> Self:
        """Return the operator of the same body blown up by a factor: compliance is homogeneous of degree one."""
        return replace(super().scaled(factor), compliance=self.compliance * factor)


def barycentric(nodes: Array) -> Array:
    """Weights 1/prod (x_j - x_m), (..., k), of nodes (..., k)."""
    differences = nodes[..., :, None] - nodes[..., None, :] + np.eye(nodes.shape[-1])
    return np.asarray(1 / differences.prod(axis=-1))


def lagrange(nodes: Array, barycentric: Array, x: float) -> tuple[list[float], list[float]]:
    """Values and derivatives at x of the Lagrange polynomials through k nodes.

    Each is the product of all x - x_m but one: the products of those before it and of those after it, so that no
    factor is divided out and x may be a node.
    """
    factors = [x - node for node in nodes.tolist()]
    before = _running_products(factors)
    after = _running_products(factors[::-1])[::-1]
    weights = barycentric.tolist()
    values = [b * p * s for b, (p, _), (s, _) in zip(weights, before, after, strict=True)]
    slopes = [b * (dp * s + p * ds) for b, (p, dp), (s, ds) in zip(weights, before, after, strict=True)]
    return values, slopes


def _running_products(factors: list[float]) -> list[tuple[float, float]]:
    """Product, and its derivative by x, of the factors before each."""
    product, slope, running = 1.0, 0.0, []
    for factor in factors:
        running.append((product, slope))
        product, slope = product * factor, slope * factor + product
    return running


def panels(lines: Array, nodes_per_panel: int, R: float = np.inf) -> ElasticOperator:
    """Half-space under pressures that are polynomials between lines, collocated at Gauss's points.

    The lines (m + 1,) are the panels' ends from 0 outwards, in beta. With k nodes in a panel, 1 to 16 or InputError,
    the pressure has degree k - 1 there and may jump from panel to panel. Under a sphere of radius R, up to its equator,
    it is a polynomial of the coordinate x = 2 R tan(theta/2), and the lines are in that, from 0 to 2 R: at the equator
    the gap rises as the root of the distance, but smoothly by x; see `halfspace.elastic.kernel.stereographic_ring`.
    """
    return stacked_panels(lines[None], nodes_per_panel, R)[0]


def stacked_panels(lines: Array, nodes_per_panel: int, R: float = np.inf) -> list[ElasticOperator]:
    """Half-spaces as of `panels`, integrated all at once, one for each row of lines (n, m + 1)."""
    if not 1 <= nodes_per_panel <= 16:
        raise InputError(f"nodes_per_panel {nodes_per_panel} is outside 1 to 16; use more panels instead")
    points, _ = grid.gauss_legendre(nodes_per_panel)
    x, w = grid.gauss_points(lines, nodes_per_panel)
    compliance = panel_integrals(x.reshape(len(lines), -1), lines, points, stereographic_ring(R))
    if np.isfinite(R):
        compliance[:, -points.size :, -1] = before_equator(x[:, -1], lines, points, R)
    p = 1 + (x / (2 * R)) ** 2
    parts = zip(x / p, (2 - p) / p**2 * w, compliance, lines / (1 + (lines / (2 * R)) ** 2), strict=True)
    return [collocated(*part) for part in parts]


def collocated(radii: Array, lengths: Array, compliance: Array, cells: Array) -> ElasticOperator:
    """Operator on Gauss's points of cells (m + 1,): radii and weights (m, k), and a compliance of their numbers."""
    q, number = radii.size, np.arange(radii.size).reshape(radii.shape)
    weights = (2 * np.pi * radii * lengths).ravel()
    return ElasticOperator(radii.ravel(), weights, cells, number, compliance=compliance.reshape(q, q))


def to_infinity(operator: ElasticOperator, nodes: int, reach: float = 1.0) -> ElasticOperator:
    """Let the surface law act on a half-space beyond the extent U of an operator, in cells up to infinity.

    Inversion s = U/t maps them on the disc t < 1 and the ring kernel on itself, G(U/tau, U/t) = (tau t/U) G(tau, t), so
    that a pressure deflects the surface at r = U/tau by

        int_U^inf P G(r, s) s ds = U tau int_0^1 (P/t^3) G(tau, t) t dt.

    P/t^3 falls as t^3 for the 3-9 law on a paraboloid; it is a polynomial through Gauss's points in each cell. The
    operator is from any discretisation; how a pressure inside deflects what is beyond follows by reciprocity. Where it
    reaches to infinity already, the cells beyond its extent are made anew, of 1 to 16 nodes each. The infinite cell
    begins at `reach`, in extents; up to there the cells grow threefold at most.
    """
    ends = np.append(0.0, grid.equal_ratios(1 / reach, 1.0, most=3.0))
    t, w = (part.ravel() for part in grid.gauss_points(ends, nodes))
    U, inner = operator.extent, operator.finite
    radii, weights = U / t, 2 * np.pi * U**2 * w / t**3
    tau = U / np.append(np.maximum(inner.radii, 1e-9 * U), radii)  # inversion maps the axis to infinity
    integrals = panel_integrals(tau, ends, grid.gauss_legendre(nodes)[0]).reshape(tau.size, t.size)
    order = np.argsort(radii)
    deflection = (U * tau[:, None] * integrals / t**3)[:, order]
    radii, weights = radii[order], weights[order]
    inward, own = deflection[: inner.radii.size], deflection[inner.radii.size :][order]
    outward = (inner.weights[:, None] * inward / weights).T
    return replace(
        inner,
        radii=np.append(inner.radii, radii),
        weights=np.append(inner.weights, weights),
        compliance=np.block([[inner.compliance, inward], [outward, own]]),
    )


def triangles(nodes: Array) -> ElasticOperator:
    """Half-space under overlapping triangles of pressure, [G97] section 2a.

    The nodes (q,) are their apices from 0 outwards, in beta; the pressure is linear between them.
    """
    ends = np.array([-1.0, 1.0])
    halves = panel_integrals(nodes, nodes, ends)
    compliance = np.zeros((nodes.size, nodes.size))
    compliance[:, :-1] += halves[:, :, 0]
    compliance[:, 1:] += halves[:, :, 1]
    a, b = nodes[:-1], nodes[1:]
    weights = np.zeros(nodes.size)
    weights[:-1] += np.pi / 3 * (b - a) * (2 * a + b)
    weights[1:] += np.pi / 3 * (b - a) * (a + 2 * b)
    return ElasticOperator(nodes, weights, nodes, _neighbours(nodes.size), compliance=compliance)


def bands(edges: Array) -> ElasticOperator:
    """Half-space under bands of uniform pressure, in closed form at their mid-radii, [G97] App. B as corrected.

    The edges (q + 1,) are the bands' ends from 0 outwards, in beta.
    """
    middle = (edges[1:] + edges[:-1]) / 2
    require_room(middle.size, edges.size)
    compliance = np.diff(band_deflection(middle[:, None], edges), axis=1)
    weights = np.pi * np.diff(edges**2)
    cells = np.concatenate([[0], middle[1:-1], edges[-1:]])
    return ElasticOperator(middle, weights, cells, _neighbours(middle.size), compliance=compliance)


def _neighbours(count: int) -> Index:
    """Pairs of neighbouring nodes: linear interpolation."""
    return np.stack([np.arange(count - 1), np.arange(1, count)], axis=1)
