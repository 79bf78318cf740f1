"""The whole elastic sphere in Legendre polynomials: an operator that shares nothing with the finite elements.

Axisymmetric Navier solutions regular at the centre, A. I. Lur'e, Three-dimensional Problems of the Theory of Elasticity
(1964), for a sphere of radius 1 and each degree n, with x = cos(theta), P = P_n(x) and D = dP_n/dtheta:

    u_r = [A (n + 1)(n - 2 + 4 nu) + B n] P,    sigma_r / 2 G = [A (n + 1)(n^2 - n - 2 - 2 nu) + B n (n - 1)] P,
    u_t = [A (n + 5 - 4 nu) + B] D,             tau_rt / 2 G = [A (n^2 + 2 n - 1 + 2 nu) + B (n - 1)] D.

Vertical tractions that mirror each other in the equator's plane need even n alone; that plane then moves without
friction and with u_z = 0, as the mid-plane of a hemisphere in the sliding grip does.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss

from halfspace.compliance import ElasticOperator

NEIGHBOURS = 8  # nodes through which a value between nodes is interpolated


def sphere_operator(R, poisson, nodes):
    """Operator of a sphere of radius R (beta), E* = 1, at Gauss's points in x, for pressures on the projected area.

    Spectral: the deflection -u_z and the load are exact to rounding for pressures that the nodes resolve.
    """
    x, dx = _upper_half(nodes)
    sine = np.sqrt((1 - x) * (1 + x))
    compliance = R * _deflection(x, *_components(poisson, _expansion(x, dx, 2 * nodes)))
    weights = 2 * np.pi * R**2 * _moments(x, dx)
    return ElasticOperator(R * sine, weights, compliance, *_cells(R * sine, R))


def surface_deflection(R, poisson, pressure, radii, nodes=100):
    """Deflection -u_z at some radii under pressure(r) on the projected area."""
    x, dx = _upper_half(nodes)
    values = pressure(R * np.sqrt((1 - x) * (1 + x)))
    normal, shear = (t @ values for t in _expansion(x, dx, 2 * nodes))
    at = np.sqrt((1 - radii / R) * (1 + radii / R))
    return R * _deflection(at, *_components(poisson, (normal[:, None], shear[:, None])))[:, 0]


def legendre(count, x):
    """P_n and dP_n/dtheta at x = cos(theta) of the even n below an even count, each (count/2, x.size)."""
    P = np.ones((count, x.size))
    P[1] = x
    for n in range(1, count - 1):
        P[n + 1] = ((2 * n + 1) * x * P[n] - n * P[n - 1]) / (n + 1)
    n = np.arange(count)[:, None]
    sine = np.sqrt((1 - x) * (1 + x))
    D = -n * (np.roll(P, 1, axis=0) - x * P) / np.where(sine > 0, sine, 1.0)
    return P[::2], D[::2]


def _expansion(x, dx, count):
    """Coefficients of t_r = -p x^2 by P_n and of t_theta = p x sin(theta) by D_n, for unit p at each node."""
    P, D = legendre(count, x)
    n = 2 * np.arange(len(P))[:, None]
    normal = -(2 * n + 1) * P * dx * x**2
    shear = (2 * n + 1) / np.maximum(n * (n + 1), 1) * D * dx * x * np.sqrt((1 - x) * (1 + x))
    return normal, shear


def _components(poisson, traction):
    """Coefficients of u_r by P_n and of u_theta by D_n, from those of the traction; 2 G = 1 - nu."""
    normal, shear = traction
    nu, n = poisson, 2.0 * np.arange(1, len(normal))[:, None]
    a, b = (n + 1) * (n**2 - n - 2 - 2 * nu), n * (n - 1)
    c, d = n**2 + 2 * n - 1 + 2 * nu, n - 1
    A = (d * normal[1:] - b * shear[1:]) / (a * d - b * c)
    B = (a * shear[1:] - c * normal[1:]) / (a * d - b * c)
    uniform = normal[:1] * (1 - 2 * nu) / (1 + nu)  # n = 0: hydrostatic
    radial = np.concatenate([uniform, A * (n + 1) * (n - 2 + 4 * nu) + B * n])
    polar = np.concatenate([0 * uniform, A * (n + 5 - 4 * nu) + B])
    return radial / (1 - nu), polar / (1 - nu)


def _deflection(x, radial, polar):
    """-u_z = -u_r cos(theta) + u_theta sin(theta) at x = cos(theta)."""
    P, D = legendre(2 * len(radial), x)
    return -(P * x).T @ radial + (D * np.sqrt((1 - x) * (1 + x))).T @ polar


def _moments(x, dx):
    """Weights of int_0^1 p x dx for an even p: its Legendre series is integrated term by term."""
    count = 2 * x.size
    P = legendre(count, x)[0]
    n = 2 * np.arange(len(P))
    half = np.zeros(count + 2)  # int_0^1 P_m dx, odd m, from (2 m + 1) P_m = (P_(m+1) - P_(m-1))'
    half[1] = 0.5
    for m in range(3, count + 2, 2):
        half[m] = -half[m - 2] * (m - 2) / (m + 1)
    terms = (n + 1) * half[n + 1] + n * half[np.maximum(n - 1, 0)]  # (2 n + 1) int_0^1 x P_n dx
    return terms @ P * dx


def _upper_half(nodes):
    """Gauss's points and weights of (-1, 1) that lie above the equator, from the pole down."""
    x, dx = leggauss(2 * nodes)
    return x[nodes:][::-1], dx[nodes:][::-1]


def _cells(radii, R):
    """Cells between the nodes, each with the neighbours that interpolate in it."""
    ends = np.concatenate([[0.0], radii[1:-1], [R]])
    first = np.clip(np.arange(radii.size - 1) - NEIGHBOURS // 2 + 1, 0, radii.size - NEIGHBOURS)
    return ends, first[:, None] + np.arange(NEIGHBOURS)
