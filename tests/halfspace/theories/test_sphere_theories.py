"""Theories of the exact sphere against quadrature, against their expansions, and against the paraboloid's."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from halfspace.laws import LENNARD_JONES
from halfspace.theories import closed_forms
from halfspace.theories.exact_sphere import JKRSphere, RigidSphere

RATIOS = [0.01, 5.0, 1e6]


def _sigma(h):
    return -float(LENNARD_JONES.pressure(np.array(h - 1), 1.0))


def _summed(rho, gap, whole, weight):
    """Tension over 2 pi by quadrature over the polar angle: 2 pi int sigma weight(theta) R^2 sin(theta) dtheta."""
    end = np.pi if whole else np.pi / 2
    width = np.sqrt(2 * gap / rho)
    knots = np.unique(np.minimum(width * np.array([0, 0.3, 1, 3, 10, 100, 1e3, 1e4]), end))

    def density(theta):
        return _sigma(gap + 2 * rho * np.sin(theta / 2) ** 2) * rho * weight(theta) * np.sin(theta)

    spans = zip(knots, np.append(knots[1:], end), strict=True)
    return sum(quad(density, *span, epsabs=1e-14, epsrel=1e-12, limit=200)[0] for span in spans if span[1] > span[0])


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("rho", RATIOS)
def test_rigid_load_is_the_law_summed_over_the_sphere(rho, whole):
    body = RigidSphere(rho, whole)
    for gap in (0.95, 1.0, 1.3, 4.0, 50.0):
        projected = -2 * np.pi * _summed(rho, gap, whole, np.cos)
        surface = -2 * np.pi * _summed(rho, gap, whole, np.ones_like)
        assert float(body.load(1 - gap)) == pytest.approx(projected, rel=1e-8, abs=1e-14 / rho)
        assert float(body.surface_load(1 - gap)) == pytest.approx(surface, rel=1e-8, abs=1e-12)


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("rho", [0.1, 1e4])
def test_rigid_pull_off_is_the_least_load(rho, whole):
    body = RigidSphere(rho, whole)
    for load, state in ((body.load, body.pull_off()), (body.surface_load, body.surface_pull_off())):
        found = minimize_scalar(
            lambda alpha, load=load: float(load(alpha)), bounds=(-1, 0.1), method="bounded", options={"xatol": 1e-10}
        )
        assert state.load == pytest.approx(found.fun, rel=1e-10)
        assert state.approach == pytest.approx(found.x, abs=3e-7)  # the root of what it can resolve
        assert np.isnan(state.contact_radius)


def test_soft_sphere_is_maugis_formula():
    body = JKRSphere(2.0, 50.0)
    X = body.radius
    assert pytest.approx(5.0) == X
    a = np.array([0.5, 2.0, 2.6, 4.0, 4.99])
    L = np.log((X + a) / (X - a))
    np.testing.assert_allclose(
        body.load(a), X * ((X**2 + a**2) / 2 * L - a * X) - np.sqrt(8 * np.pi * a**3), rtol=1e-12, atol=1e-12
    )
    np.testing.assert_allclose(body.approach(a), 2 * (X * a * L / 2 - np.sqrt(2 * np.pi * a)), rtol=1e-12)
    assert np.isnan(body.load(X))
    assert np.isnan(body.approach(1.1 * X))


STATES = ("pull_off", "jump_off", "zero_load", "zero_approach")


@pytest.mark.parametrize("name", STATES)
def test_jkr_is_the_limit_and_the_excess_its_leading_correction(name):
    mu, rho = 3.0, 3e6
    ours, limit = getattr(JKRSphere(mu, rho), name)(), getattr(closed_forms, f"jkr_{name}")(mu)
    X2 = rho / mu
    assert ours.contact_radius == pytest.approx(limit.contact_radius, rel=5 / X2)
    a = limit.contact_radius
    assert (JKRSphere(mu, rho).load(a) - closed_forms.jkr_load(a)) * X2 == pytest.approx(8 * a**5 / 15, rel=1e-4)
    assert (JKRSphere(mu, rho).approach(a) - closed_forms.jkr_approach(a, mu)) * X2 / mu == pytest.approx(
        a**4 / 3, rel=1e-4
    )


def test_the_energy_released_is_the_work_of_adhesion():
    """The elastic energy at a fixed approach, loaded as a punch without adhesion and unloaded as a flat one."""
    body = JKRSphere(1.0, 16.0)
    X = body.radius

    def punch(a):
        L = np.log((X + a) / (X - a))
        return X * ((X**2 + a**2) / 2 * L - a * X), X * a * L / 2

    def energy(a, approach):
        def work(b, step=1e-5):
            return punch(b)[0] * (punch(b + step)[1] - punch(b - step)[1]) / (2 * step)

        load, depth = punch(a)
        loading = quad(work, 1e-4, a, epsrel=1e-11)[0]
        return loading + load * (approach - depth) + a * (approach - depth) ** 2

    for a in (0.7, 2.0, 3.2):
        approach, step = float(body.approach(a)), 1e-3
        stored = (energy(a + step, approach) - energy(a - step, approach)) / (np.pi * 4 * a * step)
        assert stored == pytest.approx(1, rel=1e-4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: RigidSphere(0.0), "radius_ratio = 0 is outside 0.001 <= radius_ratio < inf; give R/eps"),
        (lambda: RigidSphere(float("nan")), "radius_ratio = nan"),
        (lambda: RigidSphere(float("inf")), "take halfspace.theories.closed_forms for the paraboloid"),
        (lambda: JKRSphere(3.0, 2.0), "radius_ratio = 2 is outside 3 <= radius_ratio < inf"),
        (lambda: JKRSphere(-1.0, 2.0), "tabor = -1 is outside 0 < tabor < inf"),
    ],
)
def test_parameters_out_of_range_are_refused_with_a_remedy(make, message):
    with pytest.raises(ValueError, match=message):
        make()
