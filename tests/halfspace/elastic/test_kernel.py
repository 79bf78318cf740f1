from functools import cache

import mpmath
import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.integrate import quad
from scipy.special import ellipkm1

from halfspace.elastic import compliance
from halfspace.elastic.kernel import band_deflection, panel_integrals, ring_kernel


def test_ring_kernel_is_symmetric_homogeneous_and_known_on_the_axis_and_far_away():
    r, s = np.array([0.3, 1.0, 2.0]), np.array([1.7, 1.0001, 0.1])
    np.testing.assert_allclose(ring_kernel(r, s), ring_kernel(s, r), rtol=1e-11)
    np.testing.assert_allclose(ring_kernel(7 * r, 7 * s), ring_kernel(r, s) / 7, rtol=1e-11)

    assert ring_kernel(np.array(0.0), np.array(2.0)) == pytest.approx(1.0, rel=1e-14)  # 2/s
    assert ring_kernel(np.array(1e6), np.array(1.0)) == pytest.approx(2 / 1e6, rel=1e-11)  # 2 pi s/(pi r) per s


def test_bands_have_the_values_that_correct_the_misprint():
    assert band_deflection(0.5, 1.0) * np.pi / 4 == pytest.approx(1.4674622093, abs=1e-10)
    assert band_deflection(1.0, 0.5) * np.pi / 4 == pytest.approx(0.2031494432, abs=1e-10)


@pytest.mark.parametrize(
    ("left", "right", "radius", "count"),
    [(0, 1, 1e-6, 2), (0, 1, 1 + 1e-8, 16), (0, 1, 1.05, 16), (0, 1, 2.001, 16), (1, 1.3, 0.9, 2), (1, 1.3, 1.15, 16)],
)
def test_panel_integrals_agree_with_thirty_digits(left, right, radius, count):
    nodes = leggauss(count)[0]
    ours = panel_integrals(np.array([radius]), np.array([left, right], float), nodes)[0, 0]
    for j in {0, count // 2}:
        assert ours[j] == pytest.approx(_by_mpmath(left, right, radius, nodes, j), abs=1e-12)


def _by_mpmath(left, right, radius, nodes, j):
    """Integrate G(r, s) s l_j(s) by mpmath, on intervals that shrink towards the singularity."""
    with mpmath.workdps(30):
        a, b, r = (mpmath.mpf(v) for v in (left, right, radius))
        own, others = mpmath.mpf(float(nodes[j])), [mpmath.mpf(float(n)) for i, n in enumerate(nodes) if i != j]
        scale = mpmath.fprod(own - n for n in others)

        def integrand(s):
            x = (2 * s - a - b) / (b - a)
            return _weighted_kernel(r, s) * mpmath.fprod(x - n for n in others) / scale

        graded = {r + sign * (b - a) * mpmath.mpf(8) ** -i for i in range(1, 16) for sign in (1, -1)} | {r}
        return float(mpmath.quad(integrand, sorted({a, b} | {p for p in graded if a < p < b})))


@cache
def _weighted_kernel(r, s):
    """G(r, s) s, the same for all nodes: of a panel every polynomial is integrated by the same quadrature."""
    k = min(min(r, s) / max(r, s), 1 - mpmath.mpf(10) ** -28)
    return 4 / (mpmath.pi * max(r, s)) * mpmath.ellipk(k**2) * s


def test_a_triangle_is_the_integral_of_its_bands():
    a, b, c = 0.5, 0.8, 1.2
    for r in (0.1, 0.62, 0.8, 1.1, 2.0):

        def band(t, r=r):
            return float(band_deflection(r, c - t * (c - b)) - band_deflection(r, a + t * (b - a)))

        kinks = [t for t in ((r - a) / (b - a), (c - r) / (c - b)) if 0 < t < 1]
        stacked = quad(band, 0, 1, points=kinks or None, epsabs=1e-13, limit=200)[0]
        halves = panel_integrals(np.array([r]), np.array([a, b, c]), np.array([-1.0, 1.0]))[0]
        assert halves[0, 1] + halves[1, 0] == pytest.approx(stacked, abs=1e-11)


@pytest.mark.parametrize("count", [7, 16])
def test_panels_under_a_sphere_deflect_as_rings_do(count):
    """The pressure jumps there, and a node's image beyond it is near: by rules of 80 points from all of them."""
    R, power = 2.0, 3
    operator = compliance.panels(R * np.array([0, 0.3, 0.7, 1.2, 2.0]), count, R)
    x, w = leggauss(80)
    t, w = ((1 + x) / 2) ** 5, w / 2 * 5 * ((1 + x) / 2) ** 4
    for r, found in zip(operator.radii, operator.compliance @ (operator.radii / R) ** power, strict=True):
        theta, expected = np.arcsin(r / R), 0.0
        for end in (0.0, np.pi / 2):
            middle = (theta + end) / 2
            for first in (theta, end):
                way = (middle - first) * t
                s = R * np.sin(first + way)
                apart = 2 * R * np.sin((first - theta + way) / 2) * np.cos((first + theta + way) / 2)
                kernel = 4 / np.pi / (r + s) * ellipkm1((apart / (r + s)) ** 2)
                expected += w @ (kernel * (s / R) ** power * s * R * np.cos(first + way)) * abs(middle - first)
        assert found == pytest.approx(expected, rel=0, abs=3 * 5.0**-count + 1e-11)
    assert operator.weights.sum() == pytest.approx(np.pi * R**2, rel=1e-12)
