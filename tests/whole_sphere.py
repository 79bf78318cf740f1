"""The whole sphere by spherical harmonics on cells along its meridian, for checks of other bodies."""

import numpy as np

from fem_adhesion.harmonics import Cells, sphere_compliance


def cells_of(R, harmonics):
    """Cells that carry what so many harmonics do."""
    return Cells(R * np.sin(np.linspace(0, np.pi / 2, 2 + harmonics // 10)), 12)


def sphere_operator(R, poisson, harmonics, lines=None):
    """Operator of a sphere of radius R (beta), E* = 1, on cells between lines if these are given."""
    cells = cells_of(R, harmonics) if lines is None else Cells(lines, 12)
    return cells.operator(sphere_compliance(R, poisson, cells, harmonics))


def surface_deflection(R, poisson, pressure, radii, harmonics=100):
    """Deflection -u_z at some radii under pressure(r) on the projected area."""
    cells = cells_of(R, harmonics)
    return sphere_compliance(R, poisson, cells, harmonics, radii) @ pressure(cells.places.ravel())
