"""Layers: the yield of their surface to waves, its images, and the limits of Hertz and JKR on a layer."""

from dataclasses import replace

import numpy as np
import pytest
from agreement import differing
from scipy.integrate import quad_vec
from scipy.optimize import minimize_scalar
from scipy.special import j0

from halfspace import trace
from halfspace.accuracy.grids import resolution_for
from halfspace.accuracy.layered import layered_charts
from halfspace.elastic import compliance, grid, layered
from halfspace.elastic.layered import image_compliance, images_of, layered_panels, nearly_homogeneous
from halfspace.elastic.layers import Coated, Layer, Layers, Stratum, Substrate, stiff_as, surface_compliance
from halfspace.errors import InputError, NotConverged
from halfspace.laws import LENNARD_JONES
from halfspace.profiles import Hyperboloid
from halfspace.scales import Scales
from halfspace.theories.layered import OnLayers

WAVES = np.geomspace(1e-3, 25, 300)
POISSON = [0.0, 0.3, 0.45, 0.499999]
STACK = Layers([Stratum(0.4, 0.3), Stratum(0.5, 0.45, 0.2), Stratum(3, 0.2, 2.0)], Substrate(5.0, 0.1))
SOFT_BETWEEN = Layers([Stratum(0.2, 0.3), Stratum(0.2, 0.4999, 0.02)], "sliding")  # images at real depths leave 6e-5
BODIES = [Layer(2, 0.3), Layer(0.5, 0.4999, "sliding"), Coated(1, 10), Coated(1, 0.01, 0.4999), STACK, SOFT_BETWEEN]


@pytest.mark.parametrize("poisson", POISSON)
def test_a_layer_yields_to_waves_by_its_closed_form(poisson):
    x, k = WAVES, 3 - 4 * poisson
    upper = k * np.sinh(2 * x) - 2 * x
    bonded = upper / (k * np.cosh(2 * x) + 2 * x**2 + 5 - 12 * poisson + 8 * poisson**2)
    sliding = (np.cosh(2 * x) - 1) / (np.sinh(2 * x) + 2 * x)
    for foundation, closed in (("bonded", bonded), ("sliding", sliding)):
        found = surface_compliance(Layer(0.05, poisson, foundation), x / 0.05)
        assert found == pytest.approx(closed, rel=0, abs=1e-12)


def test_a_coating_like_its_half_space_is_the_half_space():
    assert surface_compliance(Coated(1, 1.0, 0.3, 0.3), WAVES) == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize("poisson", [0.0, 0.499999])
def test_a_coating_on_something_stiff_is_a_bonded_layer(poisson):
    """Linearly in the ratio of moduli, by which it is extrapolated."""
    near, nearer = (surface_compliance(Coated(2.0, ratio, poisson, 0.2), WAVES / 2) for ratio in (2e-3, 1e-3))
    rigid = surface_compliance(Layer(2.0, poisson), WAVES / 2)
    waves = WAVES > 0.3  # longer ones press it in by as much as the half-space, whatever its modulus
    assert (2 * nearer - near)[waves] == pytest.approx(rigid[waves], rel=0, abs=1e-4)
    assert not np.allclose(nearer[waves], rigid[waves], rtol=0, atol=1e-4)


def test_long_waves_see_the_base_short_ones_the_stratum():
    body = Coated(2, modulus_ratio=10, poisson=0.3, substrate_poisson=0.2)
    long, short = surface_compliance(body, np.array([1e-7, 20.0]))
    assert long == pytest.approx(10 * (1 - 0.2**2) / (1 - 0.3**2), rel=1e-5)
    assert short == pytest.approx(1, rel=1e-12)


def test_a_thin_stiff_film_bends_as_a_plate():
    """A plate on a half-space: E t^3/(12 l^4) + E_2/(2 l) = E/(2 l_0)."""
    t, modulus, bends = 0.01, 0.01, 0.04
    stiffness = t**3 / 12 / bends**4 + modulus / bends / 2
    assert stiff_as(Coated(t, 1 / modulus), 1 / stiffness / 2) == pytest.approx(bends, rel=0.1)
    for body in (Coated(0.5, 0.01), Layer(0.05, 0.3), Coated(1.0, 1.0), Coated(5.0, 100.0)):
        assert stiff_as(body, 0.1) == pytest.approx(0.1, rel=2e-3)


@pytest.mark.parametrize("body", BODIES, ids=repr)
def test_images_have_the_kernel_of_hankels_integral(body):
    r, s = np.array([[0.0, 0.7, 1.0, 3.0], [0.3, 1.3, 1.0, 0.5]])

    def integrand(k):
        yields = 2 * (surface_compliance(body, np.array([k]))[0] - 1)
        return yields * np.append(j0(k * r) * j0(k * s), 1.0)  # the last at both on the axis, where it is largest

    *wanted, scale = quad_vec(integrand, 1e-9, 20 / body.strata[0].thickness, epsabs=1e-9, epsrel=1e-9)[0]
    assert images_of(body).kernel(r, s) == pytest.approx(np.array(wanted), rel=0, abs=1e-6 * abs(scale))


@pytest.mark.parametrize("thickness", [0.05, 20.0])
def test_a_bell_deflects_a_layer_as_hankels_integral(thickness):
    """P = e^(-r^2) has the transform e^(-k^2/4)/2; cells are longer and shorter than the layer is thick."""
    body = Layer(thickness, 0.3)
    operator = layered_panels(images_of(body), grid.graded(1.0, 0.05, 60.0, growth=3.0), 10)
    found = operator.compliance @ np.exp(-(operator.radii**2))
    k, w = grid.gauss_legendre(600)
    k, w = 6 * (1 + k), 6 * w
    waves = surface_compliance(body, k) * np.exp(-(k**2) / 4) * w
    inside = operator.radii < 30
    wanted = j0(np.outer(operator.radii[inside], k)) @ waves
    assert found[inside] == pytest.approx(wanted, abs=3e-8)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Layer(0.001), "thickness = 0.001 is outside 0.01 <= thickness"),
        (lambda: Layer(1.0, 0.5), "poisson = 0.5 is outside"),
        (lambda: Layer(1.0, 0.3, "glued"), "foundation = 'glued' is not one of bonded, sliding"),
        (lambda: Coated(1.0, 0.0), "modulus_ratio = 0 is outside 0.001 <= modulus_ratio <= 100"),
        (lambda: Layers([]), "limit: one stratum or more"),
        (lambda: Layers([Stratum(1.0, 0.3, 2.0)]), "modulus = 2 of the first stratum"),
        (lambda: Substrate(1e4, 0.3), "modulus = 10000, in units of the first stratum's, is outside"),
    ],
)
def test_what_is_no_layer_is_refused_when_it_is_made(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_strata_too_unlike_are_refused_with_the_misfit():
    soft, *stiff = Stratum(0.44, 0.3, 0.09), Stratum(2.2, 0.499, 410), Stratum(0.46, 0.499, 570)
    unlike = Layers([Stratum(0.2, 0.499), stiff[0], soft, stiff[1], Stratum(0.19, 0.3, 280)], Substrate(0.013, 0.3))
    with pytest.raises(NotConverged, match="is missed by"):
        images_of(unlike)


def test_pull_off_from_a_layer_hits_the_reference():
    """Tabor 1, bonded layer of 2 beta, poisson 0.3: known to 1e-9 and 1e-8."""
    event, rtol = trace(1.0, body=Layer(2, 0.3), rtol=1e-8).events["pull_off"], 1e-8
    assert abs(event.approach - -0.095053503) <= event.approach_error + 1e-9
    assert abs(event.load - -5.681629017) <= event.load_error + 1e-8
    assert event.approach_error <= rtol * 3
    assert event.load_error <= rtol * 6


@pytest.mark.parametrize(
    ("body", "alike"),
    [(Coated(1.0, 1.0, 0.2, 0.2), None), (Layers([Stratum(0.6, 0.3), Stratum(1.4, 0.3)]), Layer(2, 0.3))],
    ids=["half-space", "layer"],
)
def test_bodies_that_are_the_same_have_the_same_events(body, alike):
    one, other = (trace(1.0, body=made, rtol=1e-6) for made in (body, alike))
    assert differing(one, other) == []


def test_a_stiff_coating_is_known_between_its_radii():
    """Against images integrated where the contact is; what they bend by is a hundred times the coating's own yield."""
    for body in (Coated(0.5, 100.0), Coated(0.5, 10.0), Coated(0.5, 0.1)):
        scales, images = Scales(3.0, body=body), images_of(body)
        operator = layered_charts(scales, images, resolution_for(scales, 1e-3))[1].problem.operator
        for a in np.concatenate([np.sqrt(known[1:] * known[:-1])[::4] for known in operator.remainder.lengths]):
            here = operator.at(a)
            alone = replace(here, compliance=operator.unit.scaled(a).compliance)
            exact = alone.compliance + image_compliance(images, alone)
            pressure = np.exp(-((here.radii / a) ** 2))
            off = np.abs((here.compliance - exact) @ pressure).max()
            assert off < 1e-8 * np.abs(exact @ pressure).max()


SOFT, THEORY = Layer(2, 0.3), OnLayers(Layer(2, 0.3))


def test_a_layer_goes_over_into_jkrs_as_ln_mu_over_mu_squared():
    """With the factor that theory has, and after terms in mu^-2 and mu^-3 into JKR's.

    What a law of the tension adds to JKR's energy is d(E) = -B a mu^-2 ln mu, from two logarithms of the distance d
    from the edge, cut off at the spike, d ~ mu^-2: within, tensions p with p^2 = 1/(pi d) stretch the contact, which is
    as stiff as the law at equilibrium, H = P/(mu f'), by -(1/2) int p^2/(mu^2 f') dA; without, surfaces that open as
    h^2 = 16 d/pi are left the energy of a tail (8/3) H^-3. So B = 2/f' + pi^2/3, and dgamma acts as one that is
    1 + B mu^-2 ln mu/(2 pi a).
    """
    a = minimize_scalar(lambda a: THEORY.jkr(a).load, bounds=(0.8, 2.0), method="bounded", options={"xatol": 1e-9}).x
    jkr = THEORY.jkr(a).load
    factor = (2 / LENNARD_JONES.stiffness + np.pi**2 / 3) / (4 * np.pi * a) * (jkr - THEORY.hertz(a).load) / jkr
    mu = np.array([20.0, 40.0, 80.0])
    off = np.array([trace(tabor, body=SOFT, rtol=1e-5).event("pull_off").load for tabor in mu]) / jkr - 1
    measured = np.linalg.solve(np.stack([np.log(mu), mu**0, 1 / mu], axis=1), mu**2 * off)[0]
    assert measured == pytest.approx(factor, rel=0.01)
    beyond = np.linalg.solve(np.stack([mu**0, mu**-2, mu**-3], axis=1), off - factor * np.log(mu) / mu**2)[0]
    assert abs(beyond) < 1e-6


@pytest.mark.parametrize("body", [Layer(2.0, 0.3), SOFT_BETWEEN, Coated(0.1, 100.0)], ids=repr)
def test_images_in_units_of_the_contact_deflect_alike(body):
    """From the least contact to one wider than was planned; the rule for long cells is that of the part's widest."""
    images = images_of(body)
    rounded = 1e-15 * np.abs(images.strengths).sum()  # up to 1e6 each, of either sign
    unit = compliance.panels(grid.graded(1.0, 1e-4, 20.0, growth=2.0), 8)
    pressure = np.exp(-(unit.radii**2))
    operator = nearly_homogeneous(images, unit, (0.3, 3.0), np.inf, 1e-12)
    assert operator.rows[0].shape[1] < unit.radii.size
    for a in (operator.served[0], 0.95, 2.999, 7.0):
        widest = operator.remainder.lengths[operator.remainder.part(a)].max()
        own = replace(images, smooth=images.smooth * a / widest)
        wanted = a * unit.compliance + image_compliance(own, unit.scaled(a))
        found, wanted = (each @ pressure for each in (operator.at(a).compliance, wanted))
        assert found == pytest.approx(wanted, rel=0, abs=(1e-10 + rounded) * np.abs(wanted).max())
    assert operator.served[0] == pytest.approx(0.3)


@pytest.mark.parametrize("rtol", [1e-2, 1e-4])
def test_images_serve_a_contact_wider_than_the_attraction(rtol):
    """Under a load a cone on a thin layer is forty times as wide as it attracts; there deflections were of any size."""
    body, profile = Layer(0.05, 0.3), Hyperboloid(0.05).surface(300.0)
    scales, images = Scales(300.0, profile=profile, body=body), images_of(body)
    operator = layered_charts(scales, images, resolution_for(scales, rtol), 1000.0)[1].problem.operator
    pressure = np.sqrt(np.maximum(1 - operator.unit.radii**2, 0))
    for radius in scales.widest_radius(1000.0) * np.array([1.0, 0.1]):
        own = layered.layered(images, operator.unit.scaled(radius), np.inf)
        found, wanted = (each.compliance @ pressure for each in (operator.at(radius), own))
        inside = operator.unit.radii < 1.0
        assert found[inside] == pytest.approx(wanted[inside], rel=0, abs=1e-5 * np.abs(wanted).max())


def test_a_central_gap_is_read_off_an_even_polynomial():
    """By one in the radius it was 1.2e-5 and 5.4e-7 off, the latter told as 4.7e-7: its coefficients fall unevenly."""
    paths = (trace(0.1, body=Layer(0.1, 0.4999), rtol=rtol) for rtol in (1e-5, 1e-8))
    gap, exact = (path.event("zero_load").estimate("central_gap") for path in paths)
    assert abs(gap.value - exact.value) < min(gap.error + exact.error, 2e-7)


def test_estimates_hold_what_images_of_a_thin_layer_leave():
    """By finite elements, which have none, at 1e-4 and 1e-6 alike to ten digits."""
    path = trace(1.0, body=Layer(0.01, 0.3), profile=Hyperboloid(0.2), rtol=1e-5)
    for name, value in (("zero_load", 0.6010980289), ("pull_off", 0.2212462660)):
        found = path.event(name).estimate("approach")
        assert abs(found.value - value) < found.error < 1e-7
