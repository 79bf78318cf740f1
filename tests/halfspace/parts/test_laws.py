"""Laws and profiles as parts: what each states of itself, and what a contact makes of it, against closed forms."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from agreement import differing
from page_tables import rows_of
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.special import beta

import fem_adhesion
import halfspace
from fem_adhesion.scene import Scene
from halfspace.equilibrium import newton
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Dlvo, Dugdale, Exponential, Law, LennardJones, Morse, PowerLaw
from halfspace.laws.law import require_law
from halfspace.profiles import PARABOLOID, Endless, Hyperboloid, Paraboloid, Power, RoundedPunch
from halfspace.profiles.indentation import hertz_approach, hertz_load, hertz_radius, jkr_approach, jkr_load, jkr_radius
from halfspace.scales import Scales
from halfspace.theories import closed_forms
from halfspace.theories.maugis import TENSION_TO_MAUGIS, MaugisDugdale

LAWS = [
    LennardJones(),
    PowerLaw(2.1, 2.5),
    PowerLaw(2.5, 9.5),
    PowerLaw(4, 10),
    PowerLaw(20, 60),
    Morse(0.3),
    Morse(3),
    Morse(20),
    Exponential(3),
    Exponential(0.5, 4),
    Dlvo(0.3, 1.0),
    Dlvo(-0.5, 0.3),
    Dugdale(0.2),
]
named = pytest.mark.parametrize("law", LAWS, ids=str)


def tension(law, H):
    return -float(law.pressure(np.array(H), 1.0))


@named
def test_a_law_adheres_with_dgamma(law):
    ends = (0, 0.1, 1, 10, 100, np.inf)
    work = sum(quad(lambda H: tension(law, H), a, b, epsabs=0, epsrel=1e-10)[0] for a, b in pairwise(ends))
    assert work == pytest.approx(1, rel=1e-8)
    assert law.energy(np.array(0.0), 2.5) == pytest.approx(-2.5, rel=1e-12)
    assert require_law(law) is law


@named
def test_the_contact_ends_where_the_tension_is_largest(law):
    found = minimize_scalar(lambda H: -tension(law, H), bounds=(0, 20 * law.edge_gap), method="bounded")
    assert tension(law, law.edge_gap) == pytest.approx(-found.fun, rel=1e-9)
    assert law.strength == tension(law, law.edge_gap)
    assert law.slope(np.array(law.edge_gap), 1.0) == pytest.approx(0, abs=1e-9 * law.stiffness)
    assert -law.energy(np.array(law.range(0.01)), 1.0) == pytest.approx(0.01, rel=1e-8)


def test_the_default_is_lennard_jones():
    assert PowerLaw() == LENNARD_JONES == LennardJones() == PowerLaw(attraction=3, repulsion=9)
    assert LENNARD_JONES.decay == pytest.approx(3, rel=1e-12)
    assert LENNARD_JONES.stiffness == pytest.approx(16, rel=1e-14)
    assert LENNARD_JONES.range(0.01) == pytest.approx(Law.range(LENNARD_JONES, 0.01), rel=1e-12)
    assert Law.edge_gap.func(LENNARD_JONES) == pytest.approx(LENNARD_JONES.edge_gap, rel=1e-12)
    assert np.isinf(Morse(1).decay)


@dataclass(frozen=True)
class Yukawa(Law):
    """A law of one's own: screened attraction and core, c (e^(-H) - e^(-3 H)), 1/c = 1 - 1/3, and ways to be wrong.

    A dent of the potential about H = 0.17 lies between the gaps at which laws are looked at.
    """

    work: float = 1.0
    slip: float = 0.0
    drift: float = 0.0
    dent: float = 0.0

    def pressure(self, gap, tabor):
        """P."""
        return 1.5 * self.work * tabor * (np.exp(-3 * gap) - np.exp(-gap)) + self.drift * tabor

    def slope(self, gap, tabor):
        """dP/dH."""
        return 1.5 * self.work * (1 + self.slip) * tabor * (np.exp(-gap) - 3 * np.exp(-3 * gap))

    def energy(self, gap, tabor):
        """Phi."""
        dented = 1 - self.dent * np.exp(-(((gap - 0.17) / 0.03) ** 2))
        return 1.5 * self.work * tabor * (np.exp(-3 * gap) / 3 - np.exp(-gap)) * dented

    def room(self, gap):
        """No core."""
        return np.maximum(gap + 1, 1.0)


@dataclass(frozen=True)
class Own(Endless):
    """A profile of one's own: a paraboloid that is lifted, bends as a quartic, or tells another slope."""

    lift: float = 0.0
    bend: float = 0.0
    steeper: float = 1.0

    def height(self, radii):
        """In beta^2/R."""
        return self.lift + radii**2 / 2 - self.bend * radii**4

    def slope(self, radii):
        """Its derivative."""
        return self.steeper * radii - 4 * self.bend * radii**3


BLUNT = Own(bend=-0.05)


def by(law):
    return lambda: halfspace.trace(1.0, law=law)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PowerLaw(2, 9), "attraction = 2 of the power law is outside 2 < attraction"),
        (lambda: PowerLaw(4, 4), "repulsion = 4 of the power law is outside attraction = 4 < repulsion <= 60"),
        (lambda: Morse(0), "k = 0 of Morse's law is outside 0.1 <= k <= 50"),
        (lambda: Exponential(3, 2.5), "core = 2.5 of the exponential law is outside a whole number, 2 <= core <= 60"),
        (lambda: Dlvo(0.5, 1.0), "charge = 0.5 leaves no work of adhesion, limit: charge < 0.429 at this screening"),
        (lambda: Dlvo(-100, 8.5), "charge = -100 leaves no work of adhesion, limit: charge > -51 at this screening"),
        (lambda: Dlvo(2, 1.0), "charge = 2 leaves no core"),
        (lambda: Dlvo(0.1, 0), "screening = 0 is outside 0.02 <= screening <= 50"),
        (lambda: Dugdale(0.01), "width = 0.01 of Dugdale's law is outside 0.07 <= width <= 0.5; extrapolate from"),
        (lambda: Power(1), "k = 1 of the profile is outside 1.5 <= k <= 10; round a cone's tip"),
        (lambda: RoundedPunch(20), "flat = 20 beta of the punch is outside 0.1 <= flat <= 5"),
        (lambda: Hyperboloid(0), "b = 0 of the hyperboloid is outside 0.01 <= b < inf"),
        (by(Yukawa(work=0.9)), "the energy at H = 0 is -0.9 dgamma, limit: -1; divide the law by it"),
        (by(Yukawa(work=-1)), "the largest tension is 1e-09 dgamma/eps, limit: above 0; let the surfaces attract"),
        (by(Yukawa(slip=0.01)), "the slope is off by 0.0099 from the pressure's, limit: 0.0001; mend either"),
        (by(Yukawa(drift=-0.01)), "the pressure at H = 0 is -0.01 dgamma/eps, limit: 0; move its gaps"),
        (by(Yukawa(dent=0.02)), "from the energy's derivative"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_part_that_cannot_be_is_refused_in_one_line(make, message):
    with pytest.raises(InputError) as refused:
        make()
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


REFERENCES = rows_of(Path(__file__).parents[2] / "data" / "laws_events.csv")
PARTS = {
    "power n=4 m=10": {"law": PowerLaw(4, 10)},
    "power n=3 m=9": {},
    "Morse k=3": {"law": Morse(3)},
    "r^4/4 (height in beta^2/R)": {"profile": Power(4)},
    "paraboloid": {},
}


def by_elements(tabor, *, rtol, **parts):
    return fem_adhesion.trace(Scene(tabor, **parts), rtol=rtol)


@pytest.mark.parametrize(
    ("rtol", "solve"), [(1e-6, halfspace.trace), (1e-5, by_elements)], ids=["half-space", "elements"]
)
@pytest.mark.parametrize(("law", "profile"), sorted({(row["law"], row["profile"]) for row in REFERENCES}))
def test_other_laws_and_profiles_hit_the_references(law, profile, solve, rtol):
    path = solve(1.0, **PARTS[law], **PARTS[profile], rtol=rtol)
    rows = [row for row in REFERENCES if (row["law"], row["profile"]) == (law, profile)]
    assert len(rows) == 3
    for row in rows:
        event = path.event(row["event"])
        off = abs(event.approach - float(row["approach"])), abs(event.load - float(row["load"]))
        known = float(row["uncertainty_approach"]), float(row["uncertainty_load"])
        assert off[0] <= min(rtol * path.approach_scale, event.approach_error + known[0])
        assert off[1] <= min(rtol * abs(event.load), event.load_error + known[1])


def test_morse_knows_k_and_tabor_by_their_product_alone():
    """Gaps in ranges of the potential in the place of eps: neither eps nor k is in the equations any more."""
    ours, unit = halfspace.trace(3.0, law=Morse(0.1)), halfspace.trace(0.3, law=Morse(1))
    assert differing(ours, unit, ["load"]) == []
    for name, event in ours.events.items():
        assert event.estimate("approach").agrees(unit.event(name).estimate("approach") * 10.0)


def test_a_quadratic_power_is_a_paraboloid():
    paraboloid = halfspace.trace(0.8)
    assert differing(halfspace.trace(0.8, profile=Power(2)), paraboloid) == []
    wide = halfspace.trace(0.8, profile=Hyperboloid(1e5))
    assert wide.event("pull_off").load == pytest.approx(paraboloid.event("pull_off").load, rel=1e-6)


@pytest.mark.parametrize(
    ("law", "profile"),
    [(Dlvo(0.3, 1.0), PARABOLOID), (LENNARD_JONES, RoundedPunch(1)), (PowerLaw(2.5, 9.5), Hyperboloid(0.3))],
    ids=str,
)
def test_a_rigid_profile_adheres_with_the_integral_of_the_law(law, profile):
    """At pull-off and on either side; of the last a thousandth lies beyond eight extents of the cells."""
    tabor = 1e-9
    path = halfspace.trace(tabor, law=law, profile=profile, rtol=1e-6)
    middle = np.log(Scales(tabor, law, profile).radius_at(1.0))

    def load(approach):
        def ring(t):
            r = np.exp(t)
            return 2 * np.pi * r**2 * float(law.pressure(tabor * profile.height(r) - approach, tabor))

        return sum(quad(ring, middle + t, middle + t + 5, epsrel=1e-11, limit=400)[0] for t in range(-30, 200, 5))

    for state in (path.event("pull_off"), path.at(approach=-3.0), path.at(approach=-0.5)):
        assert float(state.load) == pytest.approx(load(float(state.approach)), rel=1e-6)


@pytest.mark.parametrize(("law", "profile"), [(PowerLaw(2.5, 9.5), PARABOLOID), (LENNARD_JONES, Power(4))], ids=str)
def test_a_soft_contact_is_jkrs_by_any_law_on_any_profile(law, profile):
    """Pull-off under dead load and least approach, as the Tabor parameter grows, with the order seen at three."""
    least = minimize_scalar(lambda a: jkr_load(profile, a), bounds=(0.1, 4), method="bounded", options={"xatol": 1e-10})
    nearest = minimize_scalar(lambda a: jkr_approach(profile, a), bounds=(0.05, 4), method="bounded")
    off = []
    for tabor in (8.0, 16.0, 32.0):
        path = halfspace.trace(tabor, law=law, profile=profile, rtol=1e-5)
        fold = path.event("jump_off").approach / tabor
        off.append([path.event("pull_off").load / least.fun - 1, fold / nearest.fun - 1])
    first, second, third = np.array(off)
    assert np.all(np.abs(third) < 0.05)
    assert np.all(np.abs(third) < 0.75 * np.abs(second))
    assert np.all(np.abs(second) < 0.75 * np.abs(first))


def test_dugdales_law_tends_to_maugiss_as_its_steps_narrow():
    """Pull-off, and the approach under no load, by terms in w^2 and w^4 to a part in ten thousand; radii as w^(2/3)."""
    widths = 0.16 * 2.0 ** -np.array([0.0, 0.5, 1.0])
    paths = [halfspace.trace(1.0, law=Dugdale(width)) for width in widths]
    theory = MaugisDugdale(TENSION_TO_MAUGIS, 1.0)
    radius = brentq(theory.load, 1, 3, xtol=1e-14)
    found = [[path.event("pull_off").load, path.event("zero_load").approach] for path in paths]
    by_squares = np.linalg.solve(widths[:, None] ** [0, 2, 4], found)[0]
    assert by_squares == pytest.approx([theory.pull_off().load, float(theory.approach(radius))], rel=1e-4)
    off = np.array([path.event("zero_load").contact_radius for path in paths]) - radius
    np.testing.assert_allclose(off[1:] / off[:-1], 2 ** (-1 / 3), rtol=0.03)


def test_states_are_known_along_a_curve_of_many_charts():
    """A stretch that was traced on one chart is solved for on one; cells towards a tip depend on the nodes in each."""
    path, fine = (halfspace.trace(1.0, law=Dugdale(0.1), profile=Power(1.5), rtol=rtol) for rtol in (1e-4, 1e-5))
    folds = [name for name in path.events if name.startswith(("jump", "fold"))]
    assert len(path.branches("approach")) == len(folds) + 1
    for gap in (0.1, 0.7, 2.0):
        ours, truth = (one.at(central_gap=gap) for one in (path, fine))
        for name in ("approach", "load"):
            budget = getattr(ours, f"{name}_error") + getattr(truth, f"{name}_error")
            assert abs(getattr(ours, name) - getattr(truth, name)) <= budget < 1e-3


def test_the_energys_derivative_is_the_load():
    """Along the contact branch, by differences of the energy over the approach on one grid."""
    segment = halfspace.trace(0.5, law=PowerLaw(2.1, 2.5), rtol=1e-8).segments[-1]
    problem, x, h = segment.problem, segment.points[-3].x, 1e-3
    states = [newton.solve(problem, x, newton.approach(x[-2] + h * n)).x for n in (-2, -1, 1, 2)]
    before, less, more, after = (problem.energy(state) for state in states)
    assert (before - 8 * less + 8 * more - after) / (12 * h) == pytest.approx(problem.load(x), rel=1e-6)


def test_contact_with_a_profile_against_closed_forms():
    """Sneddon's integrals: Hertz's and JKR's on the paraboloid, Galin's on powers."""
    for a in (0.3, 1.7):
        assert hertz_load(PARABOLOID, a) == pytest.approx(4 * a**3 / 3, rel=1e-13)
        assert jkr_load(PARABOLOID, a) == pytest.approx(float(closed_forms.jkr_load(a)), rel=1e-12)
        assert jkr_approach(PARABOLOID, a) == pytest.approx(float(closed_forms.jkr_approach(a, 1.0)), rel=1e-12)
        for k in (1.5, 1.7, 3, 10):
            assert hertz_load(Power(k), a) == pytest.approx(beta((k + 2) / 2, 0.5) * a ** (k + 1), rel=1e-12)
            assert hertz_approach(Power(k), a) == pytest.approx(beta(k / 2, 0.5) / 2 * a**k, rel=1e-12)
    for load in (0.0, 5.0, 100.0):
        assert jkr_radius(PARABOLOID, load) == pytest.approx(float(closed_forms.jkr_radius(load)), rel=1e-13)


@pytest.mark.parametrize("softness", [0.1, 9.9])
def test_contacts_of_a_softer_body_are_in_its_own_lengths(softness):
    """Whose beta is wider by s^(1/3); by that alone a cone's contact was taken for a quarter of what it is."""
    wider = np.cbrt(softness)
    for k in (1.5, 2.0, 7.0):
        factor = wider ** (k - 2)  # of the same profile's heights, in its own lengths
        for a in (0.5, 3.0):
            own = factor * hertz_load(Power(k), a) - np.sqrt(8 * np.pi * a**3)
            assert jkr_load(Power(k), a * wider, softness) == pytest.approx(own, rel=1e-12)
    assert jkr_radius(PARABOLOID, 5.0, softness) == pytest.approx(wider * jkr_radius(PARABOLOID, 5.0), rel=1e-12)
    assert hertz_radius(PARABOLOID, 5.0, softness) == pytest.approx(wider * hertz_radius(PARABOLOID, 5.0), rel=1e-12)


@pytest.mark.parametrize(
    "profile", [Paraboloid(), Power(1.5), Power(7), Hyperboloid(0.3), RoundedPunch(2), BLUNT], ids=str
)
def test_a_profiles_slope_is_that_of_its_height(profile):
    r = np.geomspace(0.01, 20, 40)
    by_differences = (profile.height(r * (1 + 1e-6)) - profile.height(r * (1 - 1e-6))) / (2e-6 * r)
    np.testing.assert_allclose(profile.slope(r), by_differences, rtol=1e-8)
    assert 0.7 * profile.height(Scales(0.7, profile=profile).radius_at(3.0)) == pytest.approx(3.0, rel=1e-12)
    assert Scales(0.7, profile=profile).radius_at(0.0) == 0


@pytest.mark.parametrize(
    ("tabor", "parts"),
    [(1.0, {"law": Yukawa(), "profile": BLUNT}), (0.3, {"law": Exponential(3), "profile": Hyperboloid(0.3)})],
    ids=["own", "exponential"],
)
def test_both_solvers_agree_on_any_law_and_profile(tabor, parts):
    """Of one's own, too: nothing but a class with its formulas."""
    ours, theirs = halfspace.trace(tabor, **parts), by_elements(tabor, rtol=1e-4, **parts)
    assert not ours.missed
    assert not theirs.missed
    assert differing(ours, theirs, ["approach", "load"]) == []


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"lift": 0.3}, "the height on the axis is 0.3 beta"),
        ({"bend": 0.02}, "the height falls by"),
        ({"steeper": 1.01}, "the slope is off by 0.00"),
    ],
)
def test_a_profile_of_ones_own_is_checked_as_laws_are(wrong, message):
    for ask in (lambda: halfspace.trace(1.0, profile=Own(**wrong)), lambda: Scene(1.0, profile=Own(**wrong))):
        with pytest.raises(InputError, match=message):
            ask()


def test_a_scene_tells_the_3_9_law_as_strong_and_as_stiff():
    """Morse's law is as stiff at k = sqrt 8 and as strong at k/2 = 16/(9 sqrt 3), with which both are told."""
    told = Scene(2.0, law=Morse(np.sqrt(8))).words[-1]
    strength = 2 * np.sqrt(2) / (16 / 9 / np.sqrt(3))
    assert told == f"law morse k 2.82843, as strong as the 3-9 law at tabor {strength:.4g}, as stiff at 2"
    assert Scene(2.0).words == ["tabor 2", "poisson 0.3"]
