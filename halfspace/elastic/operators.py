"""Operators on a grid that breathes with the contact: all their arrays are functions of the contact radius a.

A body without a length of its own is homogeneous: radii, weights and compliance on the grid a xi are a, a^2 and a times
those on xi. The compliance of any other body on a grid that follows the edge is still a smooth function of a, so the
polynomial in log a through its values at a few Chebyshev radii serves all others. Either way the spike of tension at
the edge keeps its nodes along the whole path, and the contact radius is one more unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from halfspace.elastic.compliance import ElasticOperator, Operator, barycentric, lagrange
from halfspace.elastic.grid import SurfaceCoordinate, gauss_points
from halfspace.values import Array, Index, Recent, Valued

# Of all grids there are: an equilibrium asks several times for the operator of a state and of the trial beside it.
_SCALED = Recent[ElasticOperator](3)
_AT_SCALES: Recent[_AtScale] = Recent(3)
# Kernels between which operators are interpolated, with places or nodes of theirs, in bytes: the largest scenes stay
# below 1 GB with it. Curves and events at usual tolerances take less than a tenth.
_KERNELS = Recent[tuple[Array, Index]](3e8, lambda kept: kept[0].nbytes + kept[1].nbytes)


@dataclass(frozen=True, eq=False, repr=False)
class Homogeneous(Valued, Operator):
    """A body without a length of its own, by its operator at the contact radius 1."""

    unit: ElasticOperator
    follows_contact = True

    @property
    def axis_row(self) -> Array:
        """Row (q,) that interpolates nodal values on the axis."""
        return self.unit.axis_row

    @property
    def edge_row(self) -> Array:
        """Row (q,) that interpolates nodal values at the contact edge."""
        return self.unit.unit_row

    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""
        return _SCALED.get(self, scale, partial(self.unit.scaled, scale))

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure."""
        return self.unit.radii, 2 * scale * self.unit.weights, self.unit.compliance @ pressure

    def root(self, scale: float) -> Array:
        """Square root of the balanced compliance."""
        return np.asarray(np.sqrt(scale) * self.unit.compliance_root)


@dataclass(frozen=True, eq=False, repr=False)
class _Logarithmic(Valued):
    """Polynomials in the logarithm of a length through their values at some, log x (m,)."""

    nodes: Array

    def at(self, x: float) -> tuple[Array, Array]:
        """Weights of the values at x, and of those in its derivative by log x, each (m,)."""
        values, slopes = lagrange(self.nodes, self._barycentric, float(np.log(x)))
        return np.array(values), np.array(slopes)

    @cached_property
    def _barycentric(self) -> Array:
        return barycentric(self.nodes)


@dataclass(frozen=True, eq=False, repr=False)
class Beside(Valued):
    """What a body has beside a homogeneous one, a polynomial in the logarithm of the contact radius through some.

    `make` gives it at the radii `scales` (m,), over these and the nodes' weights: values (m, n), a number for all
    entries of the compliance of which places (q, q) are alike. It is asked when one is first needed, and again where
    these had to make room for others.
    """

    scales: Array
    make: Callable[[], tuple[Array, Index]]

    def at(self, scale: float, derivative: int) -> Array:
        """What it is at a contact radius, or its derivative by the logarithm of that, (q, q)."""
        values, places = _KERNELS.get(self, "values", self.make)
        return np.asarray((self._logarithmic.at(scale)[derivative] @ values)[places])

    @cached_property
    def _logarithmic(self) -> _Logarithmic:
        return _Logarithmic(np.log(self.scales))


@dataclass(frozen=True, eq=False, repr=False)
class NearlyHomogeneous(Homogeneous):
    """A homogeneous body and what another one has beside it, on a grid that is scaled with the contact.

    Each of the parts (k,) serves contact radii from one of the ends (k + 1,), ascending, in beta, to the next. The
    singular part of the kernel is that of the homogeneous body: only what is smooth is interpolated.
    """

    ends: Array
    parts: Sequence[Beside]

    @property
    def least_radius(self) -> float:
        """Least contact radius that it serves."""
        return float(self.ends[0])

    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""
        return _SCALED.get(self, scale, partial(self._made, scale))

    def _made(self, scale: float) -> ElasticOperator:
        return replace(self.unit, compliance=self.unit.compliance + self._beside(scale, 0)).scaled(scale)

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure."""
        radii, weights, _ = super().rates(scale, pressure)
        rate = self._beside(scale, 1) @ pressure
        return radii, weights, self.at(scale).compliance @ pressure / scale + rate

    def root(self, scale: float) -> Array:
        """Square root of the balanced compliance."""
        return self.at(scale).compliance_root

    def _beside(self, scale: float, derivative: int) -> Array:
        """What it has beside at a contact radius, or its derivative by the logarithm of that."""
        part = self.parts[int(np.searchsorted(self.ends[1:-1], scale))]
        return part.at(scale, derivative) * self.unit.weights


@dataclass(frozen=True, eq=False, repr=False)
class _Nodes(Valued):
    """Radii and weights of the nodes, and their derivatives by the contact radius."""

    radii: Array
    weights: Array
    d_radii: Array
    d_weights: Array


@dataclass(frozen=True, eq=False, repr=False)
class MovingGrid(Valued):
    """Cells that move with the contact edge: their ends are x = fixed + x_a moving, x_a the edge's coordinate.

    The cells' ends, fixed and moving (m + 1,), are in the surface's coordinate, in which nodes keep their places within
    their cells.
    """

    fixed: Array
    moving: Array
    coordinate: SurfaceCoordinate

    def lines(self, contact_radius: float) -> Array:
        """Cell ends (m + 1,) at a contact radius in beta."""
        return self.fixed + self.edge(contact_radius) * self.moving

    def edge(self, contact_radius: float) -> float:
        """x_a."""
        return self.coordinate.of(contact_radius)

    def edge_rate(self, contact_radius: float) -> float:
        """Derivative of x_a by the contact radius."""
        rate = float(self.coordinate.radius(np.array(self.edge(contact_radius)))[1])
        return 1 / rate if rate else np.nan  # on the equator: a trial that ends there is refused for it


@dataclass(frozen=True, eq=False, repr=False)
class Interpolated(Valued, Operator):
    """A body with a length, or any other, between the contact radii at which its operator is known.

    With C = A w the compliance, the symmetric kernel max(r_i, r_j) A_ij, of order one at every radius and exact for a
    homogeneous body, is what is interpolated.

    The scales (m,) are the contact radii in beta, positive and distinct, see `chebyshev_radii`, at which operators are
    known on the grid, with Gauss's points as nodes, k in each cell, whose numbers are `cell_nodes`. `make` gives these
    operators; it is asked again where their kernels had to make room for others.
    """

    scales: Array
    cell_nodes: Index
    grid: MovingGrid
    make: Callable[[], Sequence[ElasticOperator]]
    follows_contact, alike = True, False

    @property
    def least_radius(self) -> float:
        """Least contact radius that it serves, a little below those at which it is known; of wide ones any."""
        return float(self.scales.min()) / OUTSIDE

    @cached_property
    def axis_row(self) -> Array:
        """Row (q,) that interpolates nodal values on the axis."""
        return self._first.axis_row

    @cached_property
    def edge_row(self) -> Array:
        """Row (q,) that interpolates nodal values at the contact edge."""
        return self._first.interpolation(float(self.scales[0]))[0]

    @cached_property
    def _first(self) -> ElasticOperator:
        """Nodes and cells at the first scale, without a compliance."""
        return self._on_cells(float(self.scales[0]), np.empty((0, 0)))

    def _on_cells(self, scale: float, compliance: Array) -> ElasticOperator:
        """Operator with a compliance on the cells at a scale."""
        nodes, ends = self._nodes(scale), self.grid.coordinate.radius(self.grid.lines(scale))[0]
        return ElasticOperator(nodes.radii, nodes.weights, compliance, ends, self.cell_nodes)

    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""
        return self._at(scale).operator

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure."""
        here = self._at(scale)
        nodes, body = here.nodes, here.operator
        by_kernel = here.kernel_rate @ (nodes.weights * pressure)
        farther = np.maximum.outer(np.arange(nodes.radii.size), np.arange(nodes.radii.size))
        by_radii = (body.compliance * (nodes.d_radii / nodes.radii)[farther]) @ pressure
        by_weights = body.compliance @ (nodes.d_weights / nodes.weights * pressure)
        return nodes.d_radii, nodes.d_weights, by_kernel - by_radii + by_weights

    def _at(self, scale: float) -> _AtScale:
        return _AT_SCALES.get(self, scale, partial(_AtScale, self, scale))

    def _nodes(self, scale: float) -> _Nodes:
        """Gauss's points of the cells at a scale: w = 2 pi r dr/dx dx."""
        grid = self.grid
        x, lengths = self._gauss_points(grid.lines(scale))
        dx, d_lengths = self._gauss_points(grid.moving * grid.edge_rate(scale))
        (radii, slope), (ring, bend) = grid.coordinate.radius(x), grid.coordinate.ring(x)
        return _Nodes(radii, ring * lengths, slope * dx, bend * dx * lengths + ring * d_lengths)

    def _gauss_points(self, lines: Array) -> tuple[Array, Array]:
        """Places of Gauss's points between lines and 2 pi times their weights."""
        places, weights = gauss_points(lines, self.cell_nodes.shape[1])
        return places.ravel(), 2 * np.pi * weights.ravel()

    def _rows(self, scale: float) -> tuple[Array, Array]:
        """Weights of the operators at a scale, and their derivatives by the scale."""
        x = self.grid.edge(scale)
        values, slopes = self._by_edge.at(x)
        return values, slopes * (self.grid.edge_rate(scale) / x)

    def _combined(self, weights: Array) -> Array:
        """Weighted sum of the kernels, (q, q)."""
        q = self.cell_nodes.size
        return np.asarray((weights @ self._kernels).reshape(q, q))

    @property
    def _kernels(self) -> Array:
        """Kernels max(r_i, r_j) C_ij/w_j, (m, q^2)."""
        return self._taken_from(self.make)

    def knowing(self, operators: Sequence[ElasticOperator]) -> Interpolated:
        """The same, which need not make its operators at first: they are there."""
        self._taken_from(lambda: operators)
        return self

    def _taken_from(self, make: Callable[[], Sequence[ElasticOperator]]) -> Array:
        """Kernels kept, or those of operators, (m, q^2)."""

        def kernels() -> tuple[Array, Index]:
            known = [(np.maximum.outer(o.radii, o.radii) * o.compliance / o.weights).ravel() for o in make()]
            return np.array(known), self.cell_nodes

        return _KERNELS.get(self, "kernels", kernels)[0]

    @cached_property
    def _by_edge(self) -> _Logarithmic:
        return _Logarithmic(np.log([self.grid.edge(float(scale)) for scale in self.scales]))


@dataclass(frozen=True, eq=False, repr=False)
class _AtScale(Valued):
    """All that an interpolated operator has at one contact radius, each when it is first asked for."""

    body: Interpolated
    scale: float

    @cached_property
    def nodes(self) -> _Nodes:
        return self.body._nodes(self.scale)

    @cached_property
    def _rows(self) -> tuple[Array, Array]:
        return self.body._rows(self.scale)

    @cached_property
    def operator(self) -> ElasticOperator:
        body, nodes = self.body, self.nodes
        compliance = body._combined(self._rows[0]) * (nodes.weights / np.maximum.outer(nodes.radii, nodes.radii))
        return body._on_cells(self.scale, compliance)

    @cached_property
    def kernel_rate(self) -> Array:
        """Derivative of the kernel by the scale, but for that of the radii, (q, q)."""
        return self.body._combined(self._rows[1]) / np.maximum.outer(self.nodes.radii, self.nodes.radii)


MOST_BESIDE = 20  # lengths on either side: 0.13 apart they leave 1e-13
OUTSIDE = 1.3  # of the least radius: as far as the curve's own are apart there, and a step more


def nodes_beside(step: float, left: float) -> int:
    """How many lengths of a geometric sequence a polynomial in their logarithm takes on either side of where it is.

    So many that it leaves a part `left` of a kernel at a depth, whose first poles, where the distance vanishes, lie
    pi/2 beside the real axis: in their middle prod x_j^2/(x_j^2 + pi^2/4), x_j from there to the lengths.
    """
    x2 = (step * (np.arange(MOST_BESIDE) + 0.5)) ** 2
    return 1 + int(np.count_nonzero(np.cumprod(x2 / (x2 + np.pi**2 / 4))[:-1] > left))


def chebyshev_radii(least: float, most: float, count: int) -> Array:
    """Radii, descending, whose logarithms are the `count` Chebyshev points between those of two radii."""
    t = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    middle, half = (np.log(most) + np.log(least)) / 2, (np.log(most) - np.log(least)) / 2
    return np.asarray(np.exp(middle + half * t))
