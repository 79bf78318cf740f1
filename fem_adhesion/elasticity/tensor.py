"""Matrices of quadrilaterals by sum factorisation: products of functions are integrated along y first, then along x.

The functions of degree p on the reference square are products f(x) g(y) of p + 1 functions along each side, and its
quadrature points a grid. Summed along one side at a time, a matrix of n = (p + 1)^2 functions costs of the order of
n^2 p instead of n^3. S. A. Orszag, J. Comput. Phys. 37 (1980) 70-92.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from skfem import ElementLinePp
from skfem.quadrature import get_quadrature

from halfspace.values import Array, Index, Valued

VALUE, BY_X, BY_Y = range(3)  # of a function: a product f g, f' g or f g'
TERMS = (
    ((VALUE, VALUE), (VALUE, BY_Y), (BY_Y, VALUE), (BY_Y, BY_Y)),
    ((VALUE, BY_X), (BY_Y, BY_X)),
    ((BY_X, VALUE), (BY_X, BY_Y)),
    ((BY_X, BY_X),),
)
"""Products of two functions, by what stands along x: f f, f f', f' f and f' f'."""


@dataclass(frozen=True, eq=False, repr=False)
class Products(Valued):
    """Products of two of the k functions along a side at its q points.

    For each group of `TERMS`, along_y has an array (terms q, k^2) of each term in it; along_x (4 q, k^2) is for each
    group. `places` (n^2,) are where those of two functions of the square are among the k^2 k^2 products along y and x.
    """

    along_y: tuple[Array, ...]
    along_x: Array
    places: Index


@cache
def products(element: Any, order: int) -> Products:
    """Products of the functions of an ElementQuadP at the points of its quadrature of an order."""
    line, k = ElementLinePp(element.p), element.p + 1
    x, _ = get_quadrature(line, order)
    found = [line.lbasis(x, i) for i in range(k)]
    f, slope = np.array([value for value, _ in found]), np.array([np.ravel(slope) for _, slope in found])
    pairs = [(g[:, None] * h).reshape(k * k, -1).T for g, h in product((f, slope), repeat=2)]
    along_y = tuple(np.concatenate([pairs[2 * (m == BY_Y) + (n == BY_Y)] for m, n in terms]) for terms in TERMS)
    points, _ = get_quadrature(element, order)  # y runs fastest
    values = np.array([element.lbasis(points, i)[0] for i in range(k * k)])
    grid = np.einsum("ix,jy->ijxy", f, f).reshape(k * k, -1)
    i, j = np.divmod(np.argmin(np.abs(values[:, None] - grid).sum(axis=-1), axis=1), k)
    places = (j[:, None] * k + j) * k * k + i[:, None] * k + i
    return Products(along_y, np.concatenate(pairs), places.ravel())


def integrated(coefficients: Array, functions: Products) -> Array:
    """Sums (..., n, n) over the points, of coefficients times products of two functions or slopes of the square.

    The coefficients (..., 3, 3, q, q) are of the products of value, slope by x and slope by y, at the points, with
    their weights.
    """
    (*many, q, _), size = (*coefficients.shape[:-4], *coefficients.shape[-2:]), functions.along_x.shape[1]
    summed = np.empty((*many, len(TERMS), q, size))
    for group, (terms, table) in enumerate(zip(TERMS, functions.along_y, strict=True)):
        along = np.stack([coefficients[..., m, n, :, :] for m, n in terms], axis=-2)
        summed[..., group, :, :] = along.reshape(*many, q, -1) @ table
    both = summed.reshape(*many, -1, size).swapaxes(-1, -2) @ functions.along_x
    return both.reshape(*many, -1).take(functions.places, axis=-1).reshape(*many, size, size)
