"""What a held body yields more than the half-space under a load: the linear part of the approach.

A sphere under a load W on a small circle of its surface approaches by W kappa/(E* R) more than the half-space does,

    kappa = kappa_0 + kappa_1 ln(beta/R) + O(beta/R),    kappa_1 = -(1 - 2 nu)^2/(2 pi (1 - nu)).

The logarithm is that of the shell, r^2/2R thick, by which the sphere falls short of the half-space. Boussinesq's load
stretches the surface by (1 - 2 nu) W/(2 pi r^2) along r and compresses it as much across: an energy of
W^2 (1 - 2 nu)^2/(4 pi^2 (1 - nu) E* r^4) per volume, whose integral over the shell is W^2/(2 E* R) times that term.
Here kappa_0 is of the grip, and of how the load is spread: as Hertz's pressure on the circle r < beta of the projected
area. The approach is that of the load, the mean of the deflection weighted with the pressure.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import log, pi

import numpy as np

from fem_adhesion.bodies.body import Discretisation, GripName
from fem_adhesion.bodies.hemisphere import Hemisphere
from fem_adhesion.discretise import sized_body
from fem_adhesion.scene import Scene
from halfspace.elastic import grid
from halfspace.elastic.compliance import ElasticOperator
from halfspace.values import Estimate

SMALL, LARGE = 10.0, 100.0  # R/beta of the spheres that are solved
FINE, COARSE = Discretisation(6), Discretisation(5)
FINEST = 1e-2  # beta: cells at the edge of the pressure, which ends as a square root
HERTZ_MEAN = 0.6  # E* beta/W: approach of the load on the half-space, 3/4 at the pole less 3/8 <r^2>, <r^2> = 2/5


@dataclass(frozen=True)
class Bulk:
    """Coefficients of kappa = constant + logarithm ln(beta/R) + O(beta/R), in 1/(E* R).

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
    value = terms.constant.value - terms.logarithm * log(sphere_radius)
    return Estimate(value, terms.constant.error + terms.linear / sphere_radius)


@cache
def coefficients(grip: GripName, poisson: float) -> Bulk:
    """Coefficients of the bulk compliance, from finite-element solutions at R = 10 and 100 beta."""
    logarithm = -((1 - 2 * poisson) ** 2) / (2 * pi * (1 - poisson))
    small, large = (excess_compliance(grip, poisson, R, FINE) + logarithm * log(R) for R in (SMALL, LARGE))
    coarse = excess_compliance(grip, poisson, LARGE, COARSE) + logarithm * log(LARGE)
    linear = abs(small - large) / (1 / SMALL - 1 / LARGE)
    return Bulk(Estimate(large, abs(large - coarse) + linear / LARGE), logarithm, linear)


def excess_compliance(grip: GripName, poisson: float, sphere_radius: float, how: Discretisation) -> float:
    """Approach under Hertz's pressure on r < beta, less the half-space's, over the load, in 1/(E* R)."""
    operator = _operator(grip, poisson, sphere_radius, how)
    pressure = np.sqrt(np.maximum(1 - operator.radii**2, 0))
    force = operator.weights * pressure
    mean = force @ operator.compliance @ pressure / force.sum() ** 2
    return (float(mean) - HERTZ_MEAN) * sphere_radius


def _operator(grip: GripName, poisson: float, R: float, how: Discretisation) -> ElasticOperator:
    """Compliance of the hemisphere's surface, its cells fine at r = beta."""
    scene = Scene(1.0, Hemisphere(radius_ratio=R**2, grip=grip, poisson=poisson))
    body = sized_body(scene, how)
    lines = grid.graded(body.coordinate.of(1.0), FINEST, float(body.outer[0]), growth=how.growth)
    return body.make(np.concatenate([lines, body.outer[1:]]))[0]
