"""The fourth level: what both solvers share, against closed forms and against a weak form that shares nothing."""

from copy import copy
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from families import TOGETHER as SCENES
from scenes import pair

import fem_adhesion
from fem_adhesion import Layer, Scene, scene
from fem_adhesion.crosscheck import definitions, from_scratch, weak_bodies
from fem_adhesion.crosscheck.comparison import CLOSED_FORM, WEAK_FORM
from fem_adhesion.crosscheck.references import elements_of, radius_of, reference_for
from fem_adhesion.crosscheck.weak_bodies import contacts, displaced, half_space, law_of, scaled
from fem_adhesion.weak_form.contact import Contact, lennard_jones
from fem_adhesion.weak_form.newton import at_approach, at_load, newton
from halfspace.accuracy import refinement, trace
from halfspace.equilibrium import conditions, search
from halfspace.equilibrium.acting import Acting
from halfspace.equilibrium.conditions import FOLD
from halfspace.equilibrium.contact import LOAD, ContactProblem
from halfspace.errors import NotConverged
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Paraboloid, Power, RoundedPunch

# --- the weak form ---


@pytest.fixture(scope="module")
def box():
    return half_space(0.04, 60.0, 4, 0.3)


@pytest.mark.parametrize("law", [PowerLaw(), PowerLaw(20, 60), Dlvo(0.3, 1.0)], ids=str)
def test_tension_and_slope_are_those_of_the_potential_alone(law):
    """At the gaps at which they count; the 3-9 law's potential is a formula of its own."""
    found, H = law_of(Scene(1.0, law=law)), np.array([-0.05, 0.0, 0.3, 3.0])
    np.testing.assert_allclose(found.potential(1 + H), law.energy(H, 1.0), rtol=1e-12)
    np.testing.assert_allclose(found.tension(1 + H), -law.pressure(H, 1.0), rtol=1e-7, atol=1e-7 * law.strength)
    np.testing.assert_allclose(found.slope(1 + H), -law.slope(H, 1.0), rtol=1e-5, atol=1e-5 * law.stiffness)
    assert (found.potential is lennard_jones) == (law == PowerLaw())


@pytest.mark.parametrize("poisson", [0.0, 0.499])
def test_the_box_is_a_half_space(poisson):
    """Under the pressure (1 + r^2)^-3, whose work is 945 pi^3/24576, and under Hertz's, whose deflection is known."""
    body = half_space(0.04, 60.0, 4, poisson)
    pressure = (1 + body.radii**2) ** -3
    work = body.integral(pressure * body.rise(displaced(body, pressure)))
    assert work == pytest.approx(945 * np.pi**3 / 24576, rel=3e-5)
    inside = body.radii < 0.9
    hertz = body.rise(displaced(body, np.sqrt(np.maximum(1 - body.radii**2, 0))))
    np.testing.assert_allclose(hertz[inside], np.pi / 4 * (2 - body.radii[inside] ** 2), rtol=1e-3)


@pytest.fixture(scope="module")
def in_contact(box):
    contact = Contact(scaled(box, 2.0), 1.0)
    start = np.append(1 + np.maximum(contact.body.radii**2 / 2 - 1.5, 0.0), 1.0)
    return newton(contact, start, at_approach(start[-1]))


def test_an_equilibrium_balances_and_its_load_is_its_slope(in_contact):
    contact, h = in_contact.contact, in_contact.y[:-1]
    np.testing.assert_allclose(contact.left_by(in_contact.u, 1.0), h, rtol=0, atol=1e-8)
    u = displaced(contact.body, contact.tabor * contact.law.tension(h))
    np.testing.assert_allclose(contact.left_by(u, 1.0), h, rtol=0, atol=1e-8)
    d = 1e-3
    before, after = (in_contact.nearby(at_approach(1.0 + step)) for step in (-d, d))
    energies = [contact.energy(state.u, state.approach) for state in (before, after)]
    assert np.diff(energies) / (2 * d) == pytest.approx(in_contact.load, rel=1e-5)
    assert (after.load - before.load) / (2 * d) == pytest.approx(in_contact.stiffness, rel=1e-4)
    near = np.append(contact.body.yields, True)  # gaps far away are so large that a step is rounded off
    np.testing.assert_allclose(((after.y - before.y) / (2 * d))[near], in_contact.rate[near], rtol=0, atol=1e-4)
    assert newton(contact, in_contact.y, at_load(contact, after.load)).approach == pytest.approx(1.0 + d, rel=1e-7)


def test_newton_says_when_it_ends_without_an_equilibrium(box):
    contact = Contact(box, 1.0)
    with pytest.raises(NotConverged, match="no equilibrium in 20 Newton steps"):
        newton(contact, np.append(1 + box.radii**2, 0.0), at_load(contact, -50.0))


def test_newton_follows_a_law_that_ends_by_a_step():
    """A tangent kept from where the step stood let it wander: no equilibrium was found in 20 steps."""
    contact = contacts(Scene(3.0, law=Dugdale(0.363)))[0](2.0, 2.0)
    start = np.append(1 + np.maximum(0.75 * (contact.body.radii**2 - 4), 0.0), 3.0)
    found = newton(contact, start, at_approach(start[-1]))
    np.testing.assert_allclose(contact.left_by(found.u, 3.0), found.y[:-1], rtol=0, atol=1e-7)


def test_cells_are_finest_at_a_small_sharp_contact():
    """0.07 beta wide, within an attraction of 0.44: with cells finest there the gaps were off by 4e-4 eps.

    They converged so slowly that the jump was off by as much as the change from body to body.
    """
    scene = Scene(5.93, Layer(0.0816, "sliding", poisson=0.4999), law=Exponential(1.31))
    event = reference_for(scene).trace(rtol=1e-4).stages[-1]["jump_off"]
    coarse, fine = (from_scratch._state(on(*from_scratch._places(event)), event) for on in contacts(scene)[:2])
    assert abs(coarse.balance) < 5e-5
    assert abs(fine.balance) < abs(coarse.balance) / 5


# --- the rows ---

RTOL = 1e-3  # the fourth level looks for mistakes


def test_the_fourth_level_agrees():
    """With folds ``make compare`` shows it, at six Tabor parameters."""
    scene = Scene(0.02)
    rows = from_scratch.events(scene, fem_adhesion.trace(scene, rtol=1e-5))
    assert {row.quantity: row.verdict for row in rows if row.verdict != "agree"} == {}
    assert {row.between for row in rows} == {WEAK_FORM}
    assert len(rows) == 10


def test_a_finer_body_is_taken_where_two_differ(monkeypatch):
    scene, bodies = Scene(0.5), ((2, 3.0), (3, 10.0), (4, 30.0))
    path = fem_adhesion.trace(scene, rtol=1e-3)

    def doubt(count):
        monkeypatch.setattr(weak_bodies, "USUAL", replace(weak_bodies.USUAL, fineness=bodies[:count]))
        return max(row.first.error / row.budget for row in from_scratch.events(scene, path))

    assert doubt(2) > 1 > doubt(3)


def test_what_changes_between_stages_is_no_mistake():
    """A stiff law makes of a ripple of the gaps a deflection of its own; what both stages share is a mistake."""
    scene = Scene(0.5)
    path = fem_adhesion.trace(scene, rtol=1e-3)
    smooth = path.stages[-1]["zero_load"]
    wave = 0.02 * np.cos(6 * smooth.problem.operator_at(smooth.point.x).radii)
    x = smooth.point.x + np.append(wave, [0.0, 0.0])
    rippled = replace(smooth, point=replace(smooth.point, x=x))

    def verdict(*stages):
        told = SimpleNamespace(events=path.events, stages=[{"zero_load": stage} for stage in stages])
        balance, *_ = from_scratch._of_event("zero_load", scene, told, *contacts(scene)[:2])
        return balance.row(from_scratch.USUAL.least).verdict

    assert verdict(smooth, smooth) == "agree"
    assert verdict(smooth, rippled) == "inconclusive"
    assert verdict(rippled, rippled) == "disagree"


def test_the_work_of_adhesion_is_that_of_laws_made_to_do_it():
    for law in (PowerLaw(2.1, 2.5), Morse(20), Exponential(0.5, 4), Dlvo(-1.0, 0.3), Dugdale(0.07)):
        work = definitions.numbers(lambda h, law=law: -law.pressure(h - 1, 1.0)).work
        assert abs(work.value - 1) <= work.error + 1e-10 < 1e-9


def test_closed_forms_agree():
    rows = from_scratch.closed_forms()
    assert [row.verdict for row in rows] == ["agree"] * 3
    assert {row.between for row in rows} == {CLOSED_FORM}
    assert [row.first.value for row in rows] == pytest.approx([1, -2 * np.pi, -1.5 * np.pi])


# --- defects that both solvers share ---


def _changed(owner, name, change):
    """A method or property whose result goes through a function."""

    def inject(monkeypatch):
        original = owner.__dict__[name]
        if callable(original):
            monkeypatch.setattr(owner, name, lambda self, *args: change(original(self, *args)))
        else:
            of = original.func if hasattr(original, "func") else original.fget
            monkeypatch.setattr(owner, name, property(lambda self: change(of(self))))

    return inject


def _scaled(owner, name, factor):
    return _changed(owner, name, lambda value: factor * value)


def _unchecked(monkeypatch):
    """Let a law pass that would be refused before any work."""
    for module in (scene, trace):
        monkeypatch.setattr(module, "require_law", lambda law: law)


def _slope_of_the_load(factor):
    parts = np.where(np.arange(4) == LOAD, factor, 1.0)

    def inject(monkeypatch):
        gradient = ContactProblem.gradient
        monkeypatch.setattr(ContactProblem, "gradient", lambda self, x, weights: gradient(self, x, weights * parts))

    return inject


def _jumps_on_a_spring(monkeypatch):
    soft = replace(FOLD, compliance=0.02)
    for module in (search, conditions):
        monkeypatch.setattr(module, "FOLD", soft)


def _elastic_term(monkeypatch):
    residual = ContactProblem.residual

    def stiffer(self, x):
        F = residual(self, x)
        F[:-1] -= 0.01 * self.tabor * (self.operator_at(x).compliance @ self.pressure(x))
        return F

    monkeypatch.setattr(ContactProblem, "residual", stiffer)


def _events(change):
    """Events of a stage as a function of them and the curve's segments has them."""

    def inject(monkeypatch):
        find = search.find_events
        monkeypatch.setattr(refinement, "find_events", lambda segments: change(find(segments), segments))

    return inject


def _jump_off_is_jump_on(events, _):
    return events | {"jump_off": events["jump_on"]} if "jump_on" in events else events


def _another_last_state(events, segments):
    """The energy's last state at another approach."""
    other = replace(conditions.Condition(0), value=0.1)
    return events | {"zero_approach": search._state(search.brackets_of(segments, other)[-1], other)}


LIMITS = ("integral of tension", "Bradley pull_off load", "JKR pull_off load")
SHARED = {  # what is injected, and the rows that show it
    "law": (
        [_unchecked, _scaled(PowerLaw, "amplitude", 1.01)],
        {"equations: load", *(f"limit: {name}" for name in LIMITS)},
    ),
    "profile": (
        [_scaled(Paraboloid, name, 1.01) for name in ("height", "slope")],
        {"equations: residual", "apart: zero_load balance"},
    ),
    "load": (
        [_scaled(Acting, "load", 1.01), _slope_of_the_load(1.01)],
        {"equations: load", "apart: pull_off attraction"},
    ),
    "spring": ([_jumps_on_a_spring], {"apart: jump_on load"}),
    "slope of the load": ([_slope_of_the_load(0.99)], {"equations: load's slope"}),
    "elastic term": ([_elastic_term], {"equations: residual"}),
    "contact edge": ([_scaled(PowerLaw, "edge_gap", 1.02)], {"law: edge"}),
    "contact radius": ([_scaled(Acting, "contact_radius", 1.02)], {"apart: zero_load contact_radius"}),
    "central gap": (
        [_changed(Acting, "central_gap", lambda gap: gap + 0.01)],
        {"apart: pull_off central_gap", "apart: zero_load central_gap"},
    ),
    "jump_off is jump_on": ([_events(_jump_off_is_jump_on)], {"apart: jump_off stable side"}),
    "energy's last state": ([_events(_another_last_state)], {"apart: energy released"}),
}


LEVELS = {
    "limit": lambda _: from_scratch.closed_forms(),
    "law": definitions.rows,
    "equations": lambda scene: from_scratch.equations(scene, elements_of(scene, RTOL)[-2:], radius_of(scene)),
    "apart": lambda scene: from_scratch.events(scene, fem_adhesion.trace(scene, rtol=RTOL)),
}


@pytest.mark.parametrize("defect", SHARED)
def test_a_shared_defect_is_rejected_by_the_row_that_should(defect, monkeypatch):
    injected, shown_by = SHARED[defect]
    for inject in injected:
        inject(monkeypatch)
    scene = Scene(1.0 if any(name.startswith("apart: jump") for name in shown_by) else 0.5)
    rows = [row for level in {name.split(":")[0] for name in shown_by} for row in LEVELS[level](scene)]
    assert shown_by <= {row.quantity for row in rows if row.verdict == "disagree"}


# --- parameters of laws, profiles and pairs ---


def test_sound_scenes_have_the_numbers_of_their_definitions():
    """Of those that ``tests/estimates`` compares on all levels."""
    found = {each: [row.quantity for row in definitions.rows(each) if row.verdict != "agree"] for each in SCENES}
    assert {each: names for each, names in found.items() if names} == {}


@pytest.mark.parametrize("place", [28, 42], ids=lambda place: str(SCENES[place].law))
def test_a_sound_scene_of_any_law_profile_and_body_agrees(place):
    """On layers: an exponential law under a power, DLVO's under a punch."""
    rows = from_scratch.events(SCENES[place], fem_adhesion.trace(SCENES[place], rtol=1e-4))
    assert {row.quantity: row.verdict for row in rows if row.verdict != "agree"} == {}


PARAMETERS = [
    (PowerLaw(), "attraction"),
    (PowerLaw(), "repulsion"),
    (Morse(3.0), "k"),
    (Exponential(3.0), "k"),
    (Exponential(3.0, 9), "core"),
    (Dlvo(0.3, 1.0), "charge"),
    (Dlvo(0.3, 1.0), "screening"),
    (Dugdale(0.2), "width"),
    (Power(3.0), "k"),
    (Hyperboloid(1.0), "b"),
    (RoundedPunch(0.6), "flat"),
]


@pytest.mark.parametrize(("part", "name"), PARAMETERS, ids=lambda value: str(value))
def test_a_parameter_that_acts_with_another_value_is_rejected(part, name, monkeypatch):
    """2 % off, or a whole power more, where the formulas take it, while the part tells the one that was given."""
    kind, is_law = type(part), hasattr(part, "pressure")
    for method in ("pressure", "slope", "energy", "edge_gap", "height"):
        original = kind.__dict__.get(method)
        if original is None:
            continue
        of = original if callable(original) else getattr(original, "func", getattr(original, "fget", None))

        def wrong(self, *args, of=of):
            other = copy(self)
            for known in ("_step_at_rest", "amplitude"):
                vars(other).pop(known, None)
            value = getattr(self, name)
            object.__setattr__(other, name, value + 1 if name == "core" else 1.02 * value)
            return of(other, *args)

        monkeypatch.setattr(kind, method, wrong if callable(original) else property(wrong))
    monkeypatch.setattr(scene, "require_law", lambda law: law)
    monkeypatch.setattr(scene, "require_profile", lambda profile: profile)
    rows = definitions.rows(Scene(1.0, law=part) if is_law else Scene(1.0, profile=part))
    rejecting = {row.quantity for row in rows if row.verdict == "disagree"}
    assert rejecting >= ({"law: stiffness", "law: range"} if is_law else {"profile: height"}) - (
        {"law: stiffness"} if name == "core" else set()
    )


DEFECTS_OF_LENGTHS = {"R/beta": ("sphere_radius", lambda R: 1.01 * R), "shares": ("shares", lambda both: both[::-1])}


@pytest.mark.parametrize("defect", DEFECTS_OF_LENGTHS)
def test_the_weak_form_has_lengths_of_its_own(defect, monkeypatch):
    name, wrong = DEFECTS_OF_LENGTHS[defect]
    of = getattr(Scene, name).fget
    monkeypatch.setattr(Scene, name, property(lambda self: wrong(of(self))))
    one = pair(1.0, 30.0, 0.3, 0.45, 2.0)
    rows = from_scratch.equations(one, elements_of(one, 1e-4), radius_of(one))
    assert "equations: residual" in {row.quantity for row in rows if row.verdict == "disagree"}
