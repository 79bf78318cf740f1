"""What a held body yields as a whole, beside the half-space: measured by finite elements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import log, pi

import numpy as np

from fem_adhesion.bodies.body import Discretisation, GripName
from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.discretise import sized_body
from fem_adhesion.scene import Scene
from halfspace.elastic import grid
from halfspace.values import Estimate


@dataclass(frozen=True)
class Bulk:
    """What a held body yields more than the half-space under a load: the linear part of the approach.

    A sphere under a load W on a small circle of its surface approaches by W kappa/(E* R) more than the half-space does,

        kappa = kappa_0 + kappa_1 ln(beta/R) + O(beta/R),    kappa_1 = -(1 - 2 nu)^2/(2 pi (1 - nu)).

    The logarithm is that of the shell, r^2/2R thick, by which the sphere falls short of the half-space. Boussinesq's
    load stretches the surface by (1 - 2 nu) W/(2 pi r^2) along r and compresses it as much across: an energy of
    W^2 (1 - 2 nu)^2/(4 pi^2 (1 - nu) E* r^4) per volume, whose integral over the shell is W^2/(2 E* R) times that term.
    Here kappa_0 is of the grip, and of how the load is spread: as Hertz's pressure on the circle r < beta of the
    projected area. The approach is that of the load, the mean of the deflection weighted with the pressure.

    The constant kappa_0 is measured, its error by the order of the elements and by what is left of the linear term,
    whose coefficient is measured where beta/R is 0.1. The logarithm's, kappa_1, is exact.
    """

    constant: Estimate
    logarithm: float
    linear: float


def bulk_compliance(grip: GripName, poisson: float, sphere_radius: float) -> Estimate:
    """What a hemisphere of R/beta yields more than the half-space, per load: kappa in 1/(E* R).

    It is positive if the body is the softer one, and without its part that vanishes with beta/R, which is in the error.
    As an approach in eps it is kappa mu W/(R/beta). InputError if grip or poisson is out of range.
    """
    terms = coefficients(grip, poisson)
    return terms.constant - terms.logarithm * log(sphere_radius) + Estimate(0.0, terms.linear / sphere_radius)


@cache
def coefficients(grip: GripName, poisson: float) -> Bulk:
    """Coefficients of the bulk compliance, from finite-element solutions at R = 10 and 100 beta."""
    logarithm = -((1 - 2 * poisson) ** 2) / (2 * pi * (1 - poisson))
    small, large, coarse = (
        excess_compliance(grip, poisson, R, degree) + logarithm * log(R)
        for R, degree in ((10.0, 6), (100.0, 6), (100.0, 5))
    )
    linear = abs(small - large) / (1 / 10.0 - 1 / 100.0)
    return Bulk(Estimate(large, abs(large - coarse) + linear / 100.0), logarithm, linear)


def excess_compliance(grip: GripName, poisson: float, sphere_radius: float, degree: int = 6) -> float:
    """Approach under Hertz's pressure on r < beta, less the half-space's, over the load, in 1/(E* R).

    On the half-space it is 0.6 W/(E* beta): 3/4 at the pole less 3/8 <r^2>, where <r^2> = 2/5. The elements are of a
    degree, and fine, 0.01 beta, at the edge of the pressure, which ends as a square root.
    """
    how = Discretisation(degree)
    scene = Scene(1.0, Hemisphere(radius_ratio=sphere_radius**2, grip=grip, poisson=poisson))
    body = sized_body(scene, how)
    lines = grid.graded(body.coordinate.of(1.0), 1e-2, float(body.outer[0]), growth=how.growth)
    operator = body.make(np.concatenate([lines, body.outer[1:]]))[0]
    pressure = np.sqrt(np.maximum(1 - operator.radii**2, 0))
    force = operator.weights * pressure
    mean = force @ operator.compliance @ pressure / force.sum() ** 2
    return (float(mean) - 0.6) * sphere_radius
