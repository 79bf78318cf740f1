"""Elements of high degree cut into cells of the second order, fine enough for what is drawn of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree
from skfem.refdom import RefTri

from fem_adhesion.elasticity.space import Space
from fem_adhesion.elasticity.stress import positions, sampled
from halfspace.values import Array, Index

QUAD9 = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [1, 1]])
"""Steps to the nodes of a quadrilateral from its first, in VTK's order: corners, middles of sides, centre."""

TRIANGLE6 = np.array([[0, 0], [2, 0], [0, 2], [1, 0], [1, 1], [0, 1]])
"""The same of a triangle."""

MOST_CUTS = 12
"""Into which a side of an element is ever cut."""

SAME = 1e-3
"""Of the shortest distance between two nodes of a cell, within which points are one."""


@dataclass(frozen=True)
class Lattice:
    """A reference element cut into n by n cells of the second order.

    Parameters
    ----------
    cuts : int
        n.
    triangular : bool
        Whether the element is a triangle, and so the cells.
    """

    cuts: int
    triangular: bool

    @cached_property
    def steps(self) -> Index:
        """Nodes (k, 2) counted along the sides, in halves of cells."""
        m = 2 * self.cuts
        every = product(range(m + 1), repeat=2)
        return np.array([(i, j) for i, j in every if not self.triangular or i + j <= m])

    @cached_property
    def places(self) -> Array:
        """Nodes (2, k) in the reference element."""
        return np.ascontiguousarray(self.steps.T / (2 * self.cuts))

    @cached_property
    def cells(self) -> Index:
        """Nodes of each cell, (cells, 6 or 9), in VTK's order."""
        m, shape = 2 * self.cuts, TRIANGLE6 if self.triangular else QUAD9
        firsts = [np.array(first) for first in product(range(0, m, 2), repeat=2)]
        cells = [first + shape for first in firsts if not self.triangular or first.sum() < m]
        if self.triangular:
            cells += [first + 2 - shape for first in firsts if first.sum() < m - 2]
        number = {tuple(step): k for k, step in enumerate(self.steps.tolist())}
        return np.array([[number[tuple(step)] for step in cell] for cell in np.array(cells).tolist()])


@dataclass(frozen=True)
class Cut:
    """A body's elements cut into cells of the second order.

    Attributes
    ----------
    space : Space
        Mesh and element.
    lattice : Lattice
        How each element is cut.
    error : float
        Largest distance of what the cells show from the field it was cut for, relative to that field's maximum.
    """

    space: Space
    lattice: Lattice
    error: float

    @cached_property
    def numbers(self) -> Index:
        """Number of each element's nodes among those of the whole body, (elements, k)."""
        r, z = positions(self.space, self.lattice.places)
        points = np.stack([r.ravel(), z.ravel()], axis=1)
        pairs = KDTree(points).query_pairs(SAME * self._shortest(r, z), output_type="ndarray")
        links = coo_array((np.ones(len(pairs)), pairs.T), shape=2 * (len(points),))
        numbers: Index = connected_components(links, directed=False)[1].reshape(r.shape).astype(np.intp)
        return numbers

    @cached_property
    def firsts(self) -> Index:
        """Where each node of the body first stands among those of all elements, (nodes,)."""
        return np.unique(self.numbers, return_index=True)[1]

    @property
    def cells(self) -> Index:
        """Nodes of each cell, (cells, 6 or 9), in VTK's order."""
        return np.concatenate(list(self.numbers[:, self.lattice.cells]))

    @property
    def points(self) -> Array:
        """Radius and height of the nodes in beta, (2, nodes)."""
        return self._merged(positions(self.space, self.lattice.places))

    def values(self, coefficients: Array) -> Array:
        """Values (m, nodes) of fields given by the coefficients (m, functions) of the space."""
        return self._merged(sampled(self.space, coefficients, self.lattice.places))

    def _merged(self, values: Array) -> Array:
        return np.asarray(values.reshape(len(values), -1)[:, self.firsts])

    def _shortest(self, r: Array, z: Array) -> float:
        cells = self.lattice.cells
        sides = [np.hypot(*(x[:, cells[:, 0]] - x[:, cells[:, k]] for x in (r, z))).min() for k in (1, 2)]
        return float(min(sides)) / 2


def cut_for(space: Space, fields: Array, tolerance: float) -> Cut:
    """Cut elements as coarsely as fields and the shape of the body allow.

    Parameters
    ----------
    space : Space
        Mesh and element.
    fields : (m, functions) array
        Coefficients of the fields, which are taken together: components of a vector.
    tolerance : float
        Largest error between the nodes, relative to the largest absolute value; for the shape, to the body's size.
    """
    triangular = space.element.refdom is RefTri
    lattice = Lattice(1, triangular)
    error = _shown_error(space, fields, lattice)
    while error > tolerance and lattice.cuts < MOST_CUTS:
        wanted = int(np.ceil(lattice.cuts * np.cbrt(error / tolerance)))  # the error falls as their third power
        lattice = Lattice(min(max(wanted, lattice.cuts + 1), MOST_CUTS), triangular)
        error = _shown_error(space, fields, lattice)
    return Cut(space, lattice, error)


def _shown_error(space: Space, fields: Array, lattice: Lattice) -> float:
    """Error of the cells' polynomials at points half-way between their nodes."""
    places, shapes = _between(lattice)
    errors = []
    for values, wanted in (
        (sampled(space, fields, lattice.places), sampled(space, fields, places)),
        (positions(space, lattice.places), positions(space, places)),
    ):
        shown = np.einsum("fesn,cn->fesc", values[:, :, lattice.cells], shapes).reshape(wanted.shape)
        errors.append(np.abs(shown - wanted).max() / np.abs(wanted).max())
    return float(max(errors))


def _between(lattice: Lattice) -> tuple[Array, Array]:
    """Points of the reference element half-way between nodes of the cells, cell by cell, and shapes (c, n) there."""
    shape = TRIANGLE6 if lattice.triangular else QUAD9
    steps = np.array([*product((0.5, 1.0, 1.5), repeat=2), (0.0, 0.5), (0.0, 1.5), (0.5, 0.0), (1.5, 0.0)])
    kept = steps.sum(axis=1) <= 2 if lattice.triangular else slice(None)
    shapes = _powers(steps[kept], lattice.triangular) @ np.linalg.inv(_powers(shape, lattice.triangular))
    nodes = lattice.places[:, lattice.cells]
    return (nodes @ shapes.T).reshape(2, -1), shapes


def _powers(steps: Array | Index, triangular: bool) -> Array:
    """Monomials of a cell's polynomials at points (points, 2), (points, 6 or 9)."""
    x, y = steps.T
    powers = [(i, j) for i, j in product(range(3), repeat=2) if not triangular or i + j <= 2]
    return np.stack([x**i * y**j for i, j in powers], axis=1)
