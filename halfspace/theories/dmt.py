"""Theories of Derjaguin, Muller and Toporov: a Hertz contact, its shape untouched by the attraction around it.

There are three, not to be mixed up. They agree where the bodies just touch, with a tension of 2 pi R dgamma, and differ
once pressed together by an approach alpha* > 0:

* thermodynamic (1975): the tension is the derivative of the surface energy by the approach, and falls to pi R dgamma;
* force method (Muller et al. 1983, Pashley 1984): it is the integral of the surface law, and rises, [G97] (4.2a);
* Maugis's (DMT-M): it is 2 pi R dgamma throughout, [G97] (4.2b).

Loads in R dgamma, positive in compression; approaches in eps. Before the bodies touch, alpha* < 0, the sphere keeps its
shape and the load is `halfspace.theories.closed_forms.bradley_load`; the functions here are nan there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from halfspace.laws import LENNARD_JONES
from halfspace.theories.closed_forms import gap_shape, hertz_load, hertz_radius_at
from halfspace.values import Array

# Nodes of the trapezoidal rule in ln z. The integrands decay as z^5 and z^-4 and are analytic for |Im ln z| < pi/3, so
# that a step of 0.15 leaves exp(-2 pi^2/(3 0.15)) = 1e-19.
STEP = 0.15
LOGARITHMS = np.arange(-9.0, 11.0, STEP)


def force_load(approach: ArrayLike, tabor: float) -> Array:
    """Load by the force method, [G97] (4.2a): Hertz's less 2 pi (1 + f(alpha*))."""
    return maugis_load(approach, tabor) - 2 * np.pi * force_excess(approach)


def maugis_load(approach: ArrayLike, tabor: float) -> Array:
    """Load by Maugis's simplification, [G97] (4.2b): Hertz's less 2 pi."""
    return hertz_load(hertz_radius_at(approach, tabor)) - 2 * np.pi


def thermodynamic_load(approach: ArrayLike, tabor: float) -> Array:
    """Load by the thermodynamic method of 1975: Hertz's less `thermodynamic_tension`."""
    return hertz_load(hertz_radius_at(approach, tabor)) - thermodynamic_tension(approach)


def force_excess(approach: ArrayLike) -> Array:
    """Excess f(alpha*) of the tension around a Hertz contact, Ts = 2 pi R dgamma (1 + f), [G97] (4.1) and Table 1."""
    return _tension(approach, lambda z: np.ones_like(z)) / (2 * np.pi) - 1


def thermodynamic_tension(approach: ArrayLike) -> Array:
    """Rate at which the surface energy falls with the approach, in R dgamma: from 2 pi at alpha* = 0 down to pi.

    U = -dgamma pi a^2 + int_a^inf phi(h) 2 pi r dr, where phi' = sigma and phi = -dgamma at the equilibrium spacing:
    the moving edge a = sqrt(alpha R) adds nothing to dU/dalpha. More load moves the surface beside a Hertz contact as
    a flat punch of radius a would, dh/dalpha = -(2/pi) arccos(a/r), so that

        T = -dU/dalpha = int_a^inf sigma(h) (2/pi) arccos(a/r) 2 pi r dr.

    The force method has 1 in place of (2/pi) arccos(a/r), as if the surface kept its shape as it approaches.
    """
    return _tension(approach, lambda z: 2 / np.pi * np.arctan(z))


def _tension(approach: ArrayLike, rate: Callable[[Array], Array]) -> Array:
    """Integral of sigma(h) rate 2 pi r dr around a Hertz contact, in R dgamma.

    With z = sqrt((r/a)^2 - 1) it is 2 pi alpha* int_0^inf sigma(h) rate(z) z dz. The nodes are centred where the gap
    has opened by about eps: H is about (alpha*/pi) times 4/3 z^3 close to the edge, times pi/2 z^2 far from it.
    """
    alpha = np.asarray(approach, float)[..., None]
    alpha = np.where(alpha < 0, np.nan, np.maximum(alpha, 1e-12))  # below, f is lost in the rounding of 1 + f
    z = np.maximum(np.sqrt(2 / alpha), np.cbrt(3 * np.pi / (4 * alpha))) * np.exp(LOGARITHMS)
    sigma = -LENNARD_JONES.pressure(alpha / np.pi * gap_shape(z), 1.0)
    return np.asarray(2 * np.pi * STEP * np.sum(alpha * sigma * rate(z) * z**2, axis=-1))
