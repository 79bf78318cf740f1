"""Functions on an element's reference cell: at its quadrature points, and sums over these of products of two.

Of quadrilaterals the sums are factorised. The functions of degree p on the reference square are products f(x) g(y) of
p + 1 functions along each side, and its quadrature points a grid. Summed along one side at a time, along y first, a
matrix of n = (p + 1)^2 functions costs of the order of n^2 p instead of n^3. S. A. Orszag, J. Comput. Phys. 37 (1980)
70-92.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import product
from typing import Any

import numpy as np
from skfem import ElementLinePp
from skfem.quadrature import get_quadrature

from halfspace.values import Array, Index, Valued


@lru_cache(maxsize=100)
def quadrature(domain: Any, order: int) -> tuple[Array, Array]:
    """Points and weights on an element's reference cell, or on a reference side; kept, and not to be written to."""
    rule = get_quadrature(domain, order)
    for numbers in rule:
        numbers.flags.writeable = False
    return rule[0], rule[1]


def reference_functions(element: Any, points: Array) -> tuple[Array, Array]:
    """Values (n, q) and derivatives (n, 2, q) of an element's functions at points (2, q) of the reference cell.

    They are kept, and not to be written to: all meshes of the same element ask for the same.
    """
    return _functions(element, points.shape, points.tobytes())


@lru_cache(maxsize=100)
def _functions(element: Any, shape: tuple[int, ...], places: bytes) -> tuple[Array, Array]:
    points = np.frombuffer(places).reshape(shape)
    count = (
        element.refdom.nnodes * element.nodal_dofs + element.refdom.nfacets * element.facet_dofs + element.interior_dofs
    )
    found = [element.lbasis(points, i) for i in range(count)]
    values = np.array([np.broadcast_to(value, points.shape[1:]) for value, _ in found])
    slopes = np.array([np.broadcast_to(slope, points.shape) for _, slope in found])
    values.flags.writeable = slopes.flags.writeable = False
    return values, slopes


# Products of two functions

VALUE, BY_X, BY_Y = range(3)  # of a function: a product f g, f' g or f g'
TERMS = (
    ((VALUE, VALUE), (VALUE, BY_Y), (BY_Y, VALUE), (BY_Y, BY_Y)),
    ((VALUE, BY_X), (BY_Y, BY_X)),
    ((BY_X, VALUE), (BY_X, BY_Y)),
    ((BY_X, BY_X),),
)
"""Products of two functions, by what stands along x: f f, f f', f' f and f' f'."""
FIRST, SECOND = np.transpose([term for terms in TERMS for term in terms])


@dataclass(frozen=True, eq=False, repr=False)
class Products(Valued):
    """Products of two of the k functions along a side at its q points.

    For each group of `TERMS`, along_y has an array (terms q, k^2) of each term in it; along_x (k^2, q 4) is for each
    group. `places` (2 n, 2 n) are where those of two of the n = k^2 functions of the square, of u_r and then of u_z,
    are among the k^2 k^2 products along x and y for u_r with u_r, u_z with u_r and u_z with u_z.
    """

    along_y: tuple[Array, ...]
    along_x: Array
    places: Index


@cache
def products(element: Any, order: int) -> Products:
    """Products of the functions of an ElementQuadP at the points of its quadrature of an order."""
    line, k = ElementLinePp(element.p), element.p + 1
    f, slopes = reference_functions(line, quadrature(line, order)[0])
    slope = slopes[:, 0]
    pairs = [(g[:, None] * h).reshape(k * k, -1).T for g, h in product((f, slope), repeat=2)]
    along_y = tuple(np.concatenate([pairs[2 * (m == BY_Y) + (n == BY_Y)] for m, n in terms]) for terms in TERMS)
    along_x = np.stack(pairs, axis=1).reshape(-1, k * k).T.copy()
    values, _ = reference_functions(element, quadrature(element, order)[0])  # y runs fastest
    grid = np.einsum("ix,jy->ijxy", f, f).reshape(k * k, -1)
    i, j = np.divmod(np.argmin(np.abs(values[:, None] - grid).sum(axis=-1), axis=1), k)
    own = (i[:, None] * k + i) * k * k + j[:, None] * k + j
    return Products(along_y, along_x, np.block([[own, own.T + k**4], [own + k**4, own + 2 * k**4]]))


def integrated(coefficients: Array, functions: Products) -> Array:
    """Matrices (cells, 2 n, 2 n) of u_r and u_z: sums over the points of the square.

    The coefficients (3, 3, 3, cells, q^2), for u_r with u_r, u_z with u_r and u_z with u_z, are of the products of
    value, slope by x and slope by y of two functions at the points, with their weights.
    """
    (size, along), cells = functions.along_x.shape, coefficients.shape[3]
    q = along // len(TERMS)
    by_terms = coefficients[:, FIRST, SECOND].reshape(3, len(FIRST), cells, q, q).transpose(2, 0, 3, 1, 4)
    by_terms, summed, first = by_terms.reshape(-1, len(FIRST) * q), np.empty((cells * 3 * q, len(TERMS), size)), 0
    for group, table in enumerate(functions.along_y):
        np.matmul(by_terms[:, first : first + len(table)], table, out=summed[:, group])
        first += len(table)
    both = functions.along_x @ summed.reshape(cells, 3, along, size)
    return both.reshape(cells, -1).take(functions.places, axis=1)
