"""Attempts at spheres that are hard: as large as a half-space, as small as their contact, nearly incompressible."""

from __future__ import annotations

import halfspace
from fem_adhesion import Hemisphere
from fem_adhesion.convergence import trace
from fem_adhesion.scene import Scene
from halfspace.profiles import Sphere
from hard.measured import Measured, compare_events

RTOL = 1e-4


def against_half_space(radius_ratio: float) -> Measured:
    """Trace a sphere so large that it is a half-space to the accuracy asked for."""
    path = trace(Scene(1.0, Hemisphere(radius_ratio=radius_ratio)), rtol=RTOL)
    return compare_events(path, halfspace.trace(1.0), "half-space")


def against_integral(radius_ratio: float) -> Measured:
    """Trace a half-space of finite elements under a true sphere, whose surface is vertical at its equator."""
    path = trace(Scene(1.0, profile=Sphere(radius_ratio)), rtol=RTOL)
    reference = halfspace.trace(1.0, profile=Sphere(radius_ratio))
    return compare_events(path, reference, "half-space under the sphere")


def against_tighter(*, tabor: float = 1.0, radius_ratio: float = 100.0, poisson: float = 0.3) -> Measured:
    """Trace a sphere, and again two decades tighter."""
    scene = Scene(tabor, Hemisphere(radius_ratio=radius_ratio, poisson=poisson))
    return compare_events(trace(scene, rtol=RTOL), trace(scene, rtol=RTOL / 100), "two decades tighter")
