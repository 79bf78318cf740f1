"""Operators on a grid that breathes with the contact: all their arrays are functions of the contact radius a.

A body without a length of its own is homogeneous: radii, weights and compliance on the grid a xi are a, a^2 and a times
those on xi. The compliance of any other body on a grid that follows the edge is still a smooth function of a, so the
polynomial in log a through its values at a few Chebyshev radii serves all others. Either way the spike of tension at
the edge keeps its nodes along the whole path, and the contact radius is one more unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from halfspace.elastic.compliance import ElasticOperator, Operator, SurfaceNodes, barycentric, lagrange
from halfspace.elastic.grid import SurfaceCoordinate, gauss_points
from halfspace.values import Array, Index, Recent, Valued

if TYPE_CHECKING:  # it takes time to load, and few need it
    from scipy import sparse

ROOM = 3e8  # bytes of the store
STORE = Recent(ROOM)
"""Operators at the latest contact radius, and the kernels between which operators are interpolated, in bytes.

With this room the largest scenes stay below 1 GB. Curves and events at usual tolerances take less than a tenth.
"""


@dataclass(frozen=True, eq=False, repr=False)
class Homogeneous(Valued, Operator):
    """A body without a length of its own, by its operator at the contact radius 1."""

    unit: ElasticOperator
    follows_contact = True

    @property
    def axis_row(self) -> Array:
        """Row (q,) that interpolates nodal values on the axis."""
        return self.unit.axis_row

    @cached_property
    def edge_row(self) -> Array:
        """Row (q,) that interpolates nodal values at the contact edge, radius 1 of the unit."""
        return self.unit.interpolation(1.0)

    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""
        return STORE.get(self, "at", partial(self.unit.scaled, scale), scale)

    def nodes(self, scale: float) -> SurfaceNodes:
        """Nodes at a contact radius in beta."""
        return self._nodes.scaled(scale)

    @cached_property
    def _nodes(self) -> SurfaceNodes:
        unit = self.unit
        return SurfaceNodes(unit.radii, unit.weights, unit.cells, unit.cell_nodes)

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure."""
        return self.unit.radii, 2 * scale * self.unit.weights, self.unit.compliance @ pressure

    def root(self, scale: float) -> Array:
        """Square root of the balanced compliance."""
        return np.asarray(np.sqrt(scale) * self.unit.compliance_root)


@dataclass(frozen=True, eq=False, repr=False)
class Piecewise(Valued):
    """Kernels (q, q) at all lengths, in k parts, each of which serves those from one of the ends (k + 1,) to the next.

    In a part they are the polynomial in the logarithm of the length through those at some lengths (m,). `make` gives
    these, (m, q, q), from the lengths. It is asked when they are first needed, and again where they had to make room
    for others.
    """

    ends: Array
    lengths: Sequence[Array]
    make: Callable[[Array], Array]

    def at(self, length: float, derivative: int) -> Array:
        """Kernel (q, q) at a length, or its derivative by the logarithm of that."""
        part = self.part(length)
        nodes = np.log(self.lengths[part])
        weights = lagrange(nodes, barycentric(nodes), float(np.log(length)))[derivative]
        return np.asarray(np.tensordot(weights, self.kernels(part), 1))

    def part(self, length: float) -> int:
        """Number of the part that serves a length."""
        return int(np.searchsorted(self.ends[1:-1], length))

    def kernels(self, part: int, known: Array | None = None) -> Array:
        """Kernels (m, q, q) of a part, which need not be made at first if they are known."""
        make = partial(self.make, self.lengths[part])
        return STORE.get(self, f"kernels {part}", make if known is None else lambda: known)


@dataclass(frozen=True, eq=False, repr=False)
class NearlyHomogeneous(Homogeneous):
    """A homogeneous body and the remainder of another one, on a grid that is scaled with the contact.

    The singular part of the kernel is that of the homogeneous body: only what is smooth, the remainder, over the radius
    and the nodes' weights, is interpolated between contact radii in beta. It is known at some samples (n,) of the
    radius, and at the nodes by rows (q, n), one array for each part of it.
    """

    remainder: Piecewise
    rows: Sequence[sparse.csr_array] = field(compare=False)

    @property
    def served(self) -> tuple[float, float]:
        """Least and widest contact radius that it serves."""
        return float(self.remainder.ends[0]), float(self.remainder.ends[-1])

    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""
        return STORE.get(self, "at", partial(self._made, scale), scale)

    def _made(self, scale: float) -> ElasticOperator:
        rows = self.rows[self.remainder.part(scale)]
        compliance = self.unit.compliance + rows @ (rows @ self.remainder.at(scale, 0).T).T * self.unit.weights
        return replace(self.unit, compliance=compliance).scaled(scale)

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure."""
        radii, weights, _ = super().rates(scale, pressure)
        rows = self.rows[self.remainder.part(scale)]
        rate = rows @ (self.remainder.at(scale, 1) @ (rows.T @ (self.unit.weights * pressure)))
        return radii, weights, self.at(scale).compliance @ pressure / scale + rate

    def root(self, scale: float) -> Array:
        """Square root of the balanced compliance."""
        return self.at(scale).compliance_root


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
        return self.lines_at(np.array(self.coordinate.of(contact_radius)))

    def lines_at(self, edges: Array) -> Array:
        """Cell ends (..., m + 1) at places of the edge (...), x_a."""
        return self.fixed + np.multiply.outer(edges, self.moving)


@dataclass(frozen=True, eq=False, repr=False)
class Interpolated(Valued, Operator):
    """A body with a length, or any other, between the contact radii at which its operator is known.

    With C = A w the compliance, the symmetric kernel max(r_i, r_j) A_ij, of order one at every radius and exact for a
    homogeneous body, is what is interpolated, by the coordinate x_a of the contact edge, on the grid with Gauss's
    points as nodes, k in each cell, whose numbers are `cell_nodes`.
    """

    kernel: Piecewise
    cell_nodes: Index
    grid: MovingGrid
    follows_contact, alike = True, False

    @cached_property
    def scales(self) -> Array:
        """Contact radii (k + 1,) in beta at which parts begin and end."""
        return self.grid.coordinate.radius(self.kernel.ends)[0]

    @property
    def served(self) -> tuple[float, float]:
        """Least and widest contact radius that it serves."""
        return float(self.scales[0]), float(self.scales[-1])

    @cached_property
    def axis_row(self) -> Array:
        """Row (q,) that interpolates nodal values on the axis."""
        return self._first.axis_row

    @cached_property
    def edge_row(self) -> Array:
        """Row (q,) that interpolates nodal values at the contact edge."""
        return self._first.interpolation(float(self.scales[0]))

    @cached_property
    def _first(self) -> SurfaceNodes:
        return self.nodes(float(self.scales[0]))

    def nodes(self, scale: float) -> SurfaceNodes:
        """Nodes at a contact radius in beta."""
        (radii, weights), _ = self._nodes(scale)
        ends = self.grid.coordinate.radius(self.grid.lines(scale))[0]
        return SurfaceNodes(radii, weights, ends, self.cell_nodes, self.grid.coordinate)

    def at(self, scale: float) -> ElasticOperator:
        """Operator at a contact radius in beta."""
        return STORE.get(self, "at", partial(self._made, scale), scale)

    def _made(self, scale: float) -> ElasticOperator:
        nodes, kernel = self.nodes(scale), self.kernel.at(self.grid.coordinate.of(scale), 0)
        compliance = kernel * (nodes.weights / np.maximum.outer(nodes.radii, nodes.radii))
        own = nodes.radii, nodes.weights, nodes.cells, nodes.cell_nodes, nodes.coordinate
        return ElasticOperator(*own, compliance=compliance)

    def rates(self, scale: float, pressure: Array) -> tuple[Array, Array, Array]:
        """Derivatives by the scale of radii, weights and the deflection under a pressure."""
        (radii, weights), (d_radii, d_weights) = self._nodes(scale)
        edge, compliance = self.grid.coordinate.of(scale), self.at(scale).compliance
        kernel = self.kernel.at(edge, 1) * (self.grid.coordinate.rate(scale) / edge)
        by_kernel = (kernel / np.maximum.outer(radii, radii)) @ (weights * pressure)
        farther = np.maximum.outer(np.arange(radii.size), np.arange(radii.size))
        by_radii = (compliance * (d_radii / radii)[farther]) @ pressure
        return d_radii, d_weights, by_kernel - by_radii + compliance @ (d_weights / weights * pressure)

    def _nodes(self, scale: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Radii of Gauss's points of the cells at a scale, and weights of a ring's area; their derivatives by it."""
        grid = self.grid
        x, lengths = self._gauss_points(grid.lines(scale))
        # The rate is nan on the equator: a trial that ends there is refused for it.
        dx, d_lengths = self._gauss_points(grid.moving * grid.coordinate.rate(scale))
        (radii, slope), (ring, bend) = grid.coordinate.radius(x), grid.coordinate.ring(x)
        return (radii, ring * lengths), (slope * dx, bend * dx * lengths + ring * d_lengths)

    def _gauss_points(self, lines: Array) -> tuple[Array, Array]:
        """Places of Gauss's points between lines and 2 pi times their weights."""
        places, weights = gauss_points(lines, self.cell_nodes.shape[1])
        return places.ravel(), 2 * np.pi * weights.ravel()


def nodes_beside(step: float, left: float) -> int:
    """How many lengths of a geometric sequence a polynomial in their logarithm takes on either side of where it is.

    So many that it leaves a part `left` of a kernel at a depth, whose first poles, where the distance vanishes, lie
    pi/2 beside the real axis: in their middle prod x_j^2/(x_j^2 + pi^2/4), x_j from there to the lengths.
    """
    x2 = (step * (np.arange(20) + 0.5)) ** 2  # lengths that are 0.13 apart leave 1e-13 by then
    return 1 + int(np.count_nonzero(np.cumprod(x2 / (x2 + np.pi**2 / 4))[:-1] > left))


def kernels_of(operators: Sequence[ElasticOperator]) -> Array:
    """Kernels max(r_i, r_j) C_ij/w_j of operators."""
    return np.array([np.maximum.outer(o.radii, o.radii) * o.compliance / o.weights for o in operators])


def chebyshev_lengths(least: float, most: float, count: int) -> Array:
    """Lengths, ascending, whose logarithms are the `count` Chebyshev points from one length to another.

    Both ends are among them: polynomials on either side of one meet there.
    """
    t = -np.cos(np.pi * np.arange(count) / (count - 1))
    middle, half = (np.log(most) + np.log(least)) / 2, (np.log(most) - np.log(least)) / 2
    return np.asarray(np.exp(middle + half * t))
