"""Attempts at bodies and meshes that are hard for finite elements: nearly incompressible, badly shaped, too coarse."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.special import j0, kv
from skfem import ElementQuadP, ElementTriP1, ElementTriP2, ElementTriP3, MeshTri

import halfspace
from fem_adhesion import convergence
from fem_adhesion.elasticity.cells import projected_stiffness
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import (
    block_grid,
    graded_size,
    quarter_disc,
    tensor_grid,
    with_named_boundaries,
)
from fem_adhesion.scene import Scene
from halfspace.accuracy.refinement import climb
from halfspace.accuracy.stages import Charts, Rung
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.equilibrium.charts import COMPRESSION, Chart, trace_charts
from halfspace.equilibrium.contact import ContactProblem
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import InputError
from halfspace.values import Array
from hard.measured import Measured, compare_events
from hard.references import charted_rung, taylor_hood

INDEPENDENT = "half-space"
POISSON = 0.3


def solved(scene: Scene, *, rtol: float = 1e-4, to_load: float = COMPRESSION) -> Measured:
    """Trace a scene by finite elements, and the same contact on the half-space."""
    return _compare(convergence.trace(scene, rtol=rtol, to_load=to_load), scene.tabor, rtol)


def _compare(path: EquilibriumPath, tabor: float, rtol: float) -> Measured:
    return compare_events(path, halfspace.trace(tabor, rtol=max(rtol / 100, 1e-9)), INDEPENDENT)


# Badly shaped meshes: a curve on elements of two degrees and blocks of two sizes


def stretched(aspect: float, *, tabor: float = 1.0) -> Measured:
    """Trace a curve on cells that are `aspect` times as wide as deep all along the surface."""

    def mesh(length: float) -> Any:
        fine = 0.15
        depths = grid.graded(0.0, fine / aspect, length, until=fine / aspect)
        return tensor_grid(grid.graded(0.0, fine, length, until=2.5), depths)

    return _on_meshes(mesh, (ElementQuadP(3), ElementQuadP(4)), tabor)


def obtuse(angle: float, *, tabor: float = 1.0, radius: float = 1.0) -> Measured:
    """Trace a curve on triangles of which one, where the contact edge passes, has an angle near pi."""

    def mesh(length: float) -> Any:
        return flattened(quarter_disc(length, graded_size(0.15, 2.5, 0.3)), radius, angle)

    return _on_meshes(mesh, (ElementTriP2(), ElementTriP3()), tabor)


def flattened(mesh: Any, radius: float, angle: float) -> Any:
    """Press the triangle that rests on the surface at a radius flat, until its angle below is as given.

    Raises
    ------
    InputError
        If that turns a neighbouring triangle over.
    """
    surface = mesh.facets[:, mesh.boundaries["contact"]]
    base = surface[:, np.argmin(np.abs(mesh.p[0, surface].mean(axis=0) - radius))]
    cell = mesh.t[:, np.isin(mesh.t, base).sum(axis=0) == 2]
    apex = np.setdiff1d(cell, base)
    points, (a, b) = mesh.p.copy(), mesh.p[0, base]
    points[:, apex] = np.array([[(a + b) / 2], [-abs(b - a) / 2 / np.tan(angle / 2)]])
    if np.any(_areas(points, mesh.t) * _areas(mesh.p, mesh.t) <= 0):
        raise InputError(f"an angle of {angle:g} at radius {radius:g} turns a neighbouring triangle over; move it")
    return with_named_boundaries(MeshTri(points, mesh.t))


def _areas(points: Array, cells: Any) -> Array:
    a, b, c = (points[:, vertex] for vertex in cells)
    u, v = b - a, c - a
    return np.asarray(u[0] * v[1] - u[1] * v[0]) / 2


def _on_meshes(mesh: Callable[[float], Any], elements: tuple[Any, Any], tabor: float) -> Measured:
    rtol = 1e-2

    def charts(length: float, element: Any) -> Charts:
        return (_chart(Space(mesh(length), element), tabor),)

    def rung(level: int) -> Rung:
        if level == 0:
            return charted_rung(charts(20.0, elements[0]))
        return charted_rung(charts(40.0, elements[0]), charts(40.0, elements[1]))

    return _compare(climb(rtol, rung, most_rungs=1), tabor, rtol)


def _chart(space: Space, tabor: float) -> Chart:
    body = condense(space, POISSON)
    return Chart(ContactProblem(body.operator, tabor), body.unknowns)


def too_coarse(factor: float, *, tabor: float = 2.0) -> Measured:
    """Trace a curve on a mesh coarser by a factor than the spike of tension at the contact edge allows."""
    element, limit = ElementQuadP(3), 0.1 * tabor**-2
    fine = factor * limit * (element.facet_dofs + 2)
    space = Space(
        tensor_grid(grid.graded(0.0, fine, 20.0, until=2.5), grid.graded(0.0, fine, 20.0, until=fine)), element
    )
    trace_charts((_chart(space, tabor),))
    return Measured("spacing", factor, 1.0, "resolution guard")


# Locking


@dataclass(frozen=True)
class Locking:
    """Largest error of the deflection under a smooth pressure of unit height, in beta, as in E* beta = 1.

    Attributes
    ----------
    poisson : float
        Poisson's ratio.
    element, remedy : str
        Displacement element, and what is added to it.
    error, remedied : float
        Without the remedy, and with it on the same mesh.
    """

    poisson: float
    element: str
    remedy: str
    error: float
    remedied: float


def locking(poissons: tuple[float, ...] = (0.3, 0.45, 0.49, 0.499, 0.4999)) -> Iterator[Locking]:
    """Measure how displacement elements lock on fixed meshes, with and without remedy; exact: Hankel's transform."""
    triangles = quarter_disc(50.0, graded_size(0.125, 2.0, 0.2))
    cells = block_grid(0.3, 3.0, 50.0)
    for poisson in poissons:
        space = Space(triangles, ElementTriP2())
        mixed = taylor_hood(space, poisson, ElementTriP1())
        yield Locking(poisson, "P2", "Taylor-Hood P2-P1", _plain_error(space, poisson), _deflection_error(mixed))
        for degree in (3, 4, 6):
            space = Space(cells, ElementQuadP(degree))
            projected = condense(space, poisson, stiffness=projected_stiffness).operator
            error = _plain_error(space, poisson)
            yield Locking(poisson, f"Q{degree}", "projected dilatation", error, _deflection_error(projected))


def _plain_error(space: Space, poisson: float) -> float:
    return _deflection_error(condense(space, poisson).operator)


def _deflection_error(operator: ElasticOperator) -> float:
    r = operator.radii
    error = operator.compliance @ smooth_pressure(r) - smooth_deflection(r)
    return float(np.max(np.abs(error[r < 2.0])))


def smooth_pressure(r: Array) -> Array:
    """P = (1 + r^2)^-3, with a tail as that of adhesion."""
    return (1.0 + r**2) ** -3.0


def smooth_deflection(r: Array) -> Array:
    """Deflection under `smooth_pressure`, whose Hankel transform is k^2 K_2(k)/8; the half-space answers it by 2/k."""
    x, w = leggauss(200)
    k = 20.0 * (x + 1.0)
    return np.asarray((40.0 * w * k**2 * kv(2, k) / 8.0) @ j0(np.outer(k, r)))
