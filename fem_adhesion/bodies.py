"""Meshes of bodies with a length: the hemisphere, graded towards the contact.

The stereographic map m(Z) = Z/(1 + i Z/2R) of the complex plane Z = x - i d takes the half-plane of depths d >= 0 to
the disc of radius R that touches it at the origin, the sphere's meridian section: the axis to the axis, the surface to
the circle, and the quarter disc |Z| < 2R to the quarter disc of the hemisphere. It is conformal, so cells well shaped
for a flat block are so for the sphere, and is the identity near the pole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_adhesion.curved import Block, joined
from halfspace.compliance import Array, Index

CORE, DEPTH = 1.7, 0.9
"""Radius and depth of the tensor grid about the pole, in R on the flat plane; its corner stays inside that of 2R."""

LAYERS = 2
"""Cells between the tensor grid and the mid-plane."""


@dataclass(frozen=True)
class Stereographic:
    """Coordinate x along a sphere's surface, the radius on the flat plane: r = x/(1 + k x^2), k = 1/4R^2.

    Parameters
    ----------
    R : float
        Radius of the sphere in beta.
    area : {"projected", "surface"}
        Which area the density of a ring's is: that on the plane of the contact, or that on the sphere.
    """

    R: float
    area: str = "projected"

    def of(self, radius: float) -> float:
        """Coordinate 2 R tan(theta/2) at the radius R sin(theta)."""
        s = radius / self.R
        return float(2 * self.R * s / (1 + np.sqrt((1 - s) * (1 + s))))

    def radius(self, x: Array) -> tuple[Array, Array]:
        """Radius r at x and dr/dx."""
        t = (x / (2 * self.R)) ** 2
        return np.asarray(x / (1 + t)), np.asarray((1 - t) / (1 + t) ** 2)

    def ring(self, x: Array) -> tuple[Array, Array]:
        """Density r dr/dx of a ring's area, or r ds/dx with ds/dx = 1/(1 + t), and its derivative by x."""
        t = (x / (2 * self.R)) ** 2
        if self.area == "surface":
            return np.asarray(x / (1 + t) ** 2), np.asarray((1 - 3 * t) / (1 + t) ** 3)
        return np.asarray(x * (1 - t) / (1 + t) ** 3), np.asarray((1 - 8 * t + 3 * t**2) / (1 + t) ** 4)


def hemisphere(R: float, lines: Array, depths: Array, along: Callable[[Array], Array] | None = None) -> Any:
    """Mesh the hemisphere z >= -R of the sphere that touches z = 0 from below.

    Parameters
    ----------
    R : float
        Radius in beta.
    lines, depths : (m + 1,) and (n + 1,) array
        Lines of the core, a tensor grid on the flat plane, from 0 to CORE R and DEPTH R, in beta.
    along : callable, optional
        The coordinate x as a function of another one in which the lines and the cells between them are given instead.

    Returns
    -------
    CurvedQuads
        With the boundaries "axis", "contact" (the sphere) and "far" (the mid-plane).
    """
    along = along or (lambda x: x)
    m, n = len(lines), len(depths)
    core = np.arange(m * n).reshape(m, n)
    beside = m * n + np.arange(n * LAYERS).reshape(n, LAYERS)
    below = m * n + n * LAYERS + np.arange((m - 1) * LAYERS).reshape(m - 1, LAYERS)
    vertices = [
        core,
        np.column_stack([core[-1], beside]),
        np.column_stack([core[:, -1], np.concatenate([below, beside[-1:]])]),
    ]
    # Neighbours run along their common side in the same direction, as elements of degree 3 and more must.
    layers = np.linspace(0, 1, LAYERS + 1)
    blocks = [
        Block(lines, depths, lambda s, d: stereographic(along(s) - 1j * d, R)),
        Block(depths, layers, lambda d, t: stereographic(_outwards(along(lines[-1]) - 1j * d, t, R), R)),
        Block(lines, layers, lambda s, t: stereographic(_outwards(along(s) - 1j * depths[-1], t, R), R)),
    ]
    return _named(
        joined(blocks, vertices),
        axis=[core[0], below[0]],
        contact=[core[:, 0], beside[0]],
        far=[beside[:, -1], below[:, -1]],
    )


def stereographic(Z: Array, R: float) -> Array:
    """Return r and z of points of the flat plane: Z/(1 + i Z/2R)."""
    image = Z / (1 + 0.5j * Z / R)
    return np.array([image.real, image.imag])


def _outwards(Z: Array, t: Array, R: float) -> Array:
    """Points between a side of the core (t = 0) and the circle 2R (t = 1)."""
    return np.asarray(Z + t * (2 * R * Z / np.abs(Z) - Z))


def with_contact_to(mesh: Any, radius: float) -> Any:
    """Return a mesh with its boundary "contact" cut off at a radius where cells end; beyond, its surface is free."""
    facets = mesh.boundaries["contact"]
    inside = np.all(mesh.p[0, mesh.facets[:, facets]] <= radius * (1 + 1e-9), axis=0)
    return mesh.with_boundaries({"contact": facets[inside]})


def named_block(mesh: Any) -> Any:
    """Name the boundaries of a block under z = 0: "axis", "contact" and "far"."""
    p, facets = mesh.p, mesh.boundary_facets()
    ends = mesh.facets[:, facets]
    axis, contact = (np.all(p[k, ends] == 0.0, axis=0) for k in (0, 1))
    return mesh.with_boundaries({"axis": facets[axis], "contact": facets[contact], "far": facets[~(axis | contact)]})


def _named(mesh: Any, **vertices: list[Index]) -> Any:
    """Name the boundary facets whose two ends are among the given vertices."""
    facets = mesh.boundary_facets()

    def on(numbers: Index) -> Any:
        return facets[np.isin(mesh.facets[:, facets], numbers).all(axis=0)]

    return mesh.with_boundaries({name: on(np.concatenate(parts)) for name, parts in vertices.items()})
