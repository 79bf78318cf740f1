"""Layers and coatings of finite elements, held against the integral equation, which shares no operator with them."""

import dataclasses
import json
from functools import cache

import numpy as np
import pytest
from agreement import differing

import fem_adhesion
import halfspace
from fem_adhesion import Coated, HalfSpace, Layer, Layers, Scene, fields
from fem_adhesion.bodies import layers as bodies_layers
from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.cli import main
from fem_adhesion.crosscheck import scenes as comparisons
from fem_adhesion.discretise import discretise, sized_body
from fem_adhesion.materials import LinearElastic
from fem_adhesion.paraview import picture
from fem_adhesion.paraview.arrays import inside
from fem_adhesion.paraview.cells import Cut, lattice
from halfspace import Stratum, Substrate
from halfspace.elastic import grid
from halfspace.elastic.layered import images_of, layered_panels
from halfspace.elastic.operators import kernels_of
from halfspace.errors import ContactTooWide, InputError, NotConverged
from halfspace.laws import Dlvo, PowerLaw
from halfspace.profiles import Hyperboloid, Power, RoundedPunch, Sphere

STIFF = Coated(2.0, 10.0, poisson=0.3)
PLIES = Stratum(0.3, 0.3), Stratum(1.0, 0.45, 0.2), Stratum(0.5, 0.3, 3.0)
STACK = Layers([Stratum(0.4, 0.3), Stratum(0.5, 0.45, 0.2), Stratum(3, 0.2, 2.0)], Substrate(5.0, 0.1))


@cache
def traced(scene, rtol):
    return fem_adhesion.trace(scene, rtol=rtol)


@pytest.mark.parametrize(
    ("scene", "rtol"),
    [
        (Scene(1.0, Layer(0.1, poisson=0.4999)), 1e-4),
        # What is pressed out of the contact goes on beyond the edge, and a steep tip's attraction ends before the layer
        # has hidden its base.
        (Scene(0.5, Layer(0.5, "sliding"), law=PowerLaw(2.5, 9.5), profile=Power(4)), 1e-4),
        (Scene(1.0, Layer(0.5, "sliding", poisson=0.4999), profile=Power(10)), 1e-4),
        (Scene(1.0, Layer(1000.0, "sliding")), 1e-3),
        (Scene(1.0, STIFF), 1e-4),
        (Scene(1.0, Coated(0.01, 10.0, poisson=0.3)), 1e-3),  # bends over a tenth of a half-space's spike
        (Scene(0.562, Layer(3.76, "sliding", poisson=0.47), Hyperboloid(1.79), law=Dlvo(-0.03, 4.73)), 1e-4),  # to 1e9
        (Scene(1.0, Layers([Stratum(0.2, 0.3), Stratum(0.2, 0.4999, 0.02)], "sliding")), 1e-3),  # complex images
        # The attraction reaches to 4e9 beta: cells as long, 0.0855 deep, made the stiffness singular.
        (Scene(1.17, Coated(0.0855, 0.351, 0.4999, poisson=0.01), profile=Hyperboloid(0.416)), 1e-2),
        (
            Scene(0.831, Layer(83.0, poisson=0.0), Hyperboloid(0.207), law=PowerLaw(4.95, 19.19)),
            1e-2,
        ),  # changes fall slowly
        # Where a grid that stands still turned pull-off, that of the next rung did by less, and it erred by more.
        (Scene(9.15, Layer(50.7, "sliding", poisson=0.0), RoundedPunch(0.399)), 0.062),
        # On a flat tip the load turns so sharply that the path went back where it had come from, and was lost.
        (Scene(0.0722, Coated(13.1, 0.0855, 0.43, poisson=0.01), Power(4.54), law=PowerLaw(5.49, 10.27)), 1e-2),
    ],
    ids=str,
)
def test_both_solvers_have_the_same_events_on_a_layer(scene, rtol):
    elements = traced(scene, rtol)
    integral = halfspace.trace(scene.tabor, body=scene.body.layered, law=scene.law, profile=scene.shape, rtol=rtol / 10)
    assert elements.met
    assert elements.energy.agrees(integral.energy)
    assert differing(elements, integral) == []


def test_an_event_that_a_grid_turned_follows_the_contact_on_all():
    """Where one that stands still turned pull-off, that of the next rung does by less, and it errs by more."""
    path = traced(Scene(9.15, Layer(50.7, "sliding", poisson=0.0), RoundedPunch(0.399)), 0.062)
    assert [stage["pull_off"].followed for stage in path.stages] == [True] * len(path.stages)


def test_a_state_between_events_is_held_by_its_estimate():
    """Interpolated as if only the surface had images, operators on thin strata all erred by 7 estimates of its gap."""
    layer, law, profile = Layer(0.916, poisson=0.4999), Dlvo(-0.66, 3.24), Power(2.29)
    elements = traced(Scene(0.644, layer, profile, law=law), 4.5e-4)
    integral = halfspace.trace(0.644, body=layer.layered, law=law, profile=profile, rtol=1e-6)
    found, true = (path.at(load=-0.669279, branch="contact") for path in (elements, integral))
    for quantity in ("approach", "central_gap", "contact_radius"):
        bar = getattr(found, f"{quantity}_error") + getattr(true, f"{quantity}_error")
        assert abs(getattr(found, quantity) - getattr(true, quantity)) < bar, quantity


@pytest.mark.parametrize(("poisson", "scatter"), [(0.3, 5e-9), (0.4999, 1e-6)])
def test_compliances_under_a_wide_contact_are_smooth_in_its_radius(poisson, scatter):
    """On cells as thin as at its edge but long, elimination left 30 times as much, and more in their differences."""
    coating = Coated(0.914, 4.64, poisson, poisson=poisson)
    body = sized_body(Scene(12.2, coating, Hyperboloid(0.556)), Discretisation(4))
    cells = body.around(150.0, 1e-7)[2].problem.interface.operator.grid
    found = [body.make(cells.lines(150.0 * np.exp(0.001 * n)))[0] for n in range(6)]
    under = found[0].radii < 150.0
    kernels = np.array([kernel[under][:, under] for kernel in kernels_of(found)])
    assert np.abs(np.diff(kernels, 5, axis=0)).max() < scatter * np.abs(kernels).max()


@pytest.mark.parametrize("body", [HalfSpace(), Layer(2.0, poisson=0.3)], ids=str)
def test_under_a_small_sphere_a_degree_leaves_a_tenth_where_the_surface_ends(body):
    """On longer cells there each degree left a half: the half-space's radius was 1.5 times outside its estimate.

    On cells as deep below as at the contact edge it would be 0.8 times its estimate off.
    """
    scene = Scene(1.0, body, Sphere(3.0))
    event, other = (
        path.event("zero_load") for path in (traced(scene, 1e-4), halfspace.trace(**scene.for_half_space, rtol=1e-6))
    )
    assert abs(event.contact_radius - other.contact_radius) <= event.contact_radius_error / 2
    assert abs(event.approach - other.approach) < 3e-7


@pytest.mark.parametrize(
    ("theirs", "ours"),
    [
        (halfspace.Layer(2.0, 0.4, "sliding"), Layer(2.0, "sliding", poisson=0.4)),
        (halfspace.Coated(1.0, 10.0, 0.4, 0.2), Coated(1.0, 10.0, 0.2, poisson=0.4)),
        (halfspace.Layers(PLIES, "sliding"), Layers(PLIES, "sliding")),
        (halfspace.Layers(STACK.strata, STACK.base), STACK),
    ],
    ids=str,
)
def test_layers_are_the_same_bodies_in_both_packages(theirs, ours):
    assert Scene(1.0, body=theirs).body == ours
    assert ours.layered == theirs
    assert (ours.strata, ours.base) == (theirs.strata, theirs.base)


# --- operators ---


def test_strata_are_replaced_with_their_material():
    others = [Stratum(1.0, 0.45)]
    with pytest.raises(InputError, match=r"limit: that of the first, 0\.45; .* by LinearElastic\(0\.45\)"):
        dataclasses.replace(STACK, strata=others)
    assert dataclasses.replace(STACK, strata=others, material=LinearElastic(0.45)) == Layers(others, STACK.base)


BODIES = [
    Coated(0.5, 100.0, 0.499, poisson=0.0),
    Coated(0.5, 0.01, 0.0, poisson=0.4999),
    STACK,
    Layers(PLIES, "sliding"),
]


def far_from(known, found):
    """Difference near the axis, of the largest deflection, under a pressure that ends smoothly at 1."""
    one, other = (each.compliance @ np.maximum(1 - each.radii**2, 0) ** 2.5 for each in (found, known))
    off = (one - known.values_at(found.radii, other))[found.radii < 3]
    return np.abs(off).max() / other.max()


@pytest.mark.parametrize("body", BODIES, ids=str)
def test_strata_deflect_as_their_waves_say(body):
    lines = grid.graded(1.0, 0.2, Scene(1.0, body).surface.end, growth=2.5)
    found = discretise(Scene(1.0, body), lines, Discretisation(5)).operator
    known = layered_panels(images_of(body), lines, 9)
    assert far_from(known, found) < 2e-4


def test_sliding_strata_go_on_with_the_stiffness_of_all(monkeypatch):
    """So that the edge may be near: with the first stratum's alone the deflection is off by 2e-4."""
    monkeypatch.setattr(bodies_layers, "STRATA", bodies_layers.StrataSettings(died_out=3.0))
    body = Layers([Stratum(0.4, 0.0), Stratum(0.8, 0.45, 0.1)], "sliding")
    lines = grid.graded(1.0, 0.2, 3.0, growth=2.0)
    found = discretise(Scene(1.0, body), lines, Discretisation(5)).operator
    assert far_from(layered_panels(images_of(body), lines, 9), found) < 2e-5


def test_a_half_space_under_a_stiff_film_ends_far_enough_out():
    """At a tenth of that it misses 2e-8 of the deflection, and the pull-off of a long contact three times its error."""
    scene = Scene(4.48, Coated(0.0562, 92.4, 0.0, poisson=0.31), RoundedPunch(0.305), law=Dlvo(-0.01, 0.334))
    lines = grid.graded(1.0, 0.2, scene.radii[0], growth=1.8)
    found = discretise(scene, lines, Discretisation(8, growth=1.8)).operator
    assert far_from(layered_panels(images_of(scene.body), lines, 16), found) < 4e-9


# --- fields ---


@pytest.fixture(scope="module")
def inside_coated():
    """State of a coated half-space at zero load, and a cut through it."""
    scene, event = Scene(1.0, STIFF), traced(Scene(1.0, STIFF), 1e-4).stages[-1]["zero_load"]
    state = fields.state_at(scene, event.problem, event.point)
    return state, Cut(state.space, lattice(1, triangular=False))


def test_stresses_jump_at_an_interface_where_they_must(inside_coated):
    """What pulls across is continuous; what does not differs by the moduli of the strains that both sides have."""
    state, cut = inside_coated
    (r, z), region = cut.points, cut.node_regions
    sides = [np.flatnonzero((np.abs(z + 2) < 1e-9) & (r < 3) & (region == n)) for n in (0, 1)]
    above, below = (side[np.argsort(r[side])] for side in sides)
    assert above.size > 5
    assert r[above] == pytest.approx(r[below], abs=1e-9)
    rr, zz, hoop, rz = cut.values(state.stress)
    largest = np.abs(zz).max()
    for across in (zz, rz):
        assert across[above] == pytest.approx(across[below], abs=2e-3 * largest)
    strains = [
        ((s_rr - nu * (s_zz + s_hoop)) / E)
        for (s_rr, s_zz, s_hoop), (nu, E) in (
            ((rr[above], zz[above], hoop[above]), (0.3, 1.0)),
            ((rr[below], zz[below], hoop[below]), (0.3, 0.1)),
        )
    ]
    assert strains[0] == pytest.approx(strains[1], abs=5e-3 * np.abs(strains[0]).max())
    assert np.abs(rr[above] - rr[below]).max() > 0.1 * np.abs(rr[above]).max()
    density = inside(state, cut, 1.0)["strain_energy_density"]
    for side, E in ((above, 1.0), (below, 0.1)):
        squares, trace = rr**2 + zz**2 + hoop**2 + 2 * rz**2, rr + zz + hoop
        wanted = (1.3 * squares - 0.3 * trace**2)[side] / (2 * E * (1 - 0.3**2))
        assert density[side] == pytest.approx(wanted, rel=1e-9)


# --- compare and the command line ---


def test_an_interface_is_drawn_and_written(inside_coated):
    state, cut = inside_coated
    view = picture.view_of([state])
    region, heights = inside(state, cut, 1.0)["region"], cut.points[1]
    assert heights[region == 0].min() == heights[region == 1].max() == -2
    (line,) = picture.section(state, view).interfaces
    on_axis, far = line[1][[0, np.searchsorted(line[0], 5 * view.reach)]]
    assert on_axis < far == pytest.approx(-2, abs=0.2 * (far - on_axis))  # pressed in under the contact


def test_compare_agrees_on_the_command_line(tmp_path):
    record, body = tmp_path / "record.json", "layers:0.4,0.3/0.5,0.45,0.2/sliding"
    assert main(["compare", "--tabor", "0.3", "--body", body, "--rtol", "1e-3", "--json", str(record)]) == 0
    rows = json.loads(record.read_text())["cases"][0]["comparison"]
    between = {tuple(row["between"]) for row in rows}
    assert {("half-space", "finite elements"), ("weak form", "finite elements")} <= between
    assert all(row["verdict"] == "agree" for row in rows)


@pytest.mark.usefixtures("two_solvers")
@pytest.mark.parametrize(
    ("asked", "wrong"), [(STIFF, {"thickness": 2.1}), (STIFF, {"substrate_poisson": 0.35})], ids=str
)
def test_compare_rejects_another_body(asked, wrong):
    """The integral equation is asked for other layers than the elements, whose curve is that of the right ones."""
    own = {field.name: getattr(asked, field.name) for field in dataclasses.fields(asked) if field.name != "material"}
    other = type(asked)(**{"poisson": 0.3} | own | wrong)
    solved = traced(Scene(1.0, asked), 1e-4)
    case = fem_adhesion.compare(Scene(1.0, body=other), rtol=1e-3, solve=lambda *_, **__: solved)
    assert case.verdict == "disagree"


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("layer", "body = layer, limit: layer:thickness,bonded|sliding; give thickness, beta"),
        (
            "layers",
            "limit: layers:thickness,poisson,modulus/.../BASE, BASE being bonded|sliding|substrate:modulus,poisson;",
        ),
        ("layers:1,0.3,1,2", "strata = stratum:1,0.3,1,2, limit: stratum:thickness,poisson,modulus; leave out 2"),
        ("layers:1,0.4 --poisson 0.3", "poisson = 0.3 with strata, limit: that of the"),
        ("layers:1/glued", "base = glued, limit: one of substrate; take one of these"),
        ("layers:1/substrate", "base = substrate, limit: substrate:modulus,poisson; give modulus, E of the first"),
        ("layered:2", "meshed; did you mean layer:thickness,bonded|sliding?"),
    ],
    ids=str,
)
def test_what_a_body_lacks_or_does_not_heed_is_one_line(body, words, refused):
    refused("curve --tabor 1 --body", body, words=words)


def test_a_stratum_by_its_thickness_is_else_like_the_first(monkeypatch):
    asked = []

    def run(scenes, **_):
        asked.extend(scenes)
        raise NotConverged("asked")

    monkeypatch.setattr(comparisons, "run", run)
    for words, strata in (
        (["layers:0.4/0.5", "--poisson", "0.2"], [Stratum(0.4, 0.2), Stratum(0.5, 0.2)]),
        (["layers:0.4/0.5,0.1"], [Stratum(0.4, 0.3), Stratum(0.5, 0.1)]),
        (["layers:0.4,0.2/0.5,0.1"], [Stratum(0.4, 0.2), Stratum(0.5, 0.1)]),
    ):
        main(["compare", "--tabor", "1", "--body", *words])
        assert asked.pop() == Scene(1.0, Layers(strata))


def test_the_integral_equation_takes_layers_of_the_elements():
    ours, theirs = (halfspace.trace(1.0, body=body(2.0, poisson=0.3), rtol=1e-3) for body in (Layer, halfspace.Layer))
    assert ours.events == theirs.events
    with pytest.raises(InputError, match=r"body = HalfSpace\(.*\), limit: layers on a base; give Layer, Coated or"):
        halfspace.trace(1.0, body=HalfSpace())


def test_loads_that_hardly_fall_are_refused_on_a_layer():
    with pytest.raises(InputError, match=r"falls as r\^-0.1 alone, limit on layers: r\^-1; take a law"):
        fem_adhesion.trace(Scene(1.0, Layer(thickness=1.0), profile=Hyperboloid(5.0), law=PowerLaw(2.1, 9.0)))


@pytest.mark.parametrize(
    "scene", [Scene(1e-2, Layer(0.01), Hyperboloid(0.05)), Scene(1e-4, Layer(0.1), Hyperboloid(0.3))]
)
def test_a_contact_too_wide_for_thin_strata_is_refused(scene):
    with pytest.raises(ContactTooWide, match=r"^contact radius = .* beta, limit: \S+, beyond which .* as rigid; take"):
        fem_adhesion.trace(scene, rtol=1e-2)


def test_what_pulls_beyond_the_mesh_is_little_under_a_cone():
    """The load beyond r falls as r^-1/2 there: cells up to 800 widths of the attraction left 2.5e-4 of it out."""
    scene = Scene(1.0, Layer(thickness=1.0), profile=Hyperboloid(5.0), law=PowerLaw(2.5, 9.5))
    elements, waves = fem_adhesion.trace(scene, rtol=1e-4), halfspace.trace(**scene.for_half_space, rtol=1e-6)
    pull_off = elements.event("pull_off")
    assert abs(pull_off.load - waves.event("pull_off").load) < pull_off.load_error < 2e-4
    assert abs((elements.energy - waves.energy).value) < elements.energy.error < 2e-4  # that load over the whole way
