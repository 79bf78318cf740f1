"""The whole sphere by spherical harmonics on cells along its meridian, for checks of other bodies."""

import numpy as np

from fem_adhesion.harmonics import sphere_compliance
from halfspace.elastic.compliance import collocated
from halfspace.elastic.grid import gauss_points

NODES = 12


def lines_of(R, harmonics):
    """Ends of cells that carry what so many harmonics do."""
    return R * np.sin(np.linspace(0, np.pi / 2, 2 + harmonics // 10))


def sphere_operator(R, poisson, harmonics, lines=None):
    """Operator of a sphere of radius R (beta), E* = 1, on cells between lines if these are given."""
    lines = lines_of(R, harmonics) if lines is None else lines
    compliance = sphere_compliance(R, poisson, lines, NODES, harmonics)
    return collocated(*gauss_points(lines, NODES), compliance, lines)


def surface_deflection(R, poisson, pressure, radii, harmonics=100):
    """Deflection -u_z at some radii under pressure(r) on the projected area."""
    lines = lines_of(R, harmonics)
    places = gauss_points(lines, NODES)[0].ravel()
    return sphere_compliance(R, poisson, lines, NODES, harmonics, radii) @ pressure(places)
