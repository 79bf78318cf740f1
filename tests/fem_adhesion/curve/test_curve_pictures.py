"""Pictures and movies of the body show its shape, its stress and its wall as they are, and every state its own."""

import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from scipy.interpolate import CubicSpline

from fem_adhesion import Hemisphere
from fem_adhesion.common.files import written_aside
from fem_adhesion.common.lines import smooth
from fem_adhesion.curve import pictures as module
from fem_adhesion.curve.load import KINDS, STATES
from fem_adhesion.curve.solve import Question, solve
from fem_adhesion.paraview import picture as solid_view
from fem_adhesion.paraview.picture import section, surfaces, view_of
from fem_adhesion.scene import Scene
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.scaling import Units

SMALL = (240, 150)
HEMISPHERE = Scene(2.0, Hemisphere(radius_ratio=200.0))


def _solved(scene):
    return solve(Question(scene, solver="fem", rtol=1e-3))


@pytest.fixture(scope="module")
def block():
    return _solved(Scene(2.0))


@pytest.fixture(scope="module")
def sphere():
    return _solved(HEMISPHERE)


@pytest.fixture(scope="module")
def states(block):
    return module.event_states(block)


@pytest.fixture(scope="module")
def pictures(block, tmp_path_factory):
    folder, drawn = tmp_path_factory.mktemp("pictures"), {}
    for event in ("jump_on", "pull_off", "zero_load"):
        path = folder / f"{event}.png"
        with written_aside(path) as file:
            module.write_picture(block, file, event, (480, 300))
        with Image.open(path) as image:
            drawn[event] = np.asarray(image.convert("RGB")).astype(int)
    return drawn


def _approach(frame):
    return frame.state.point.observables[APPROACH]


@pytest.mark.parametrize("name", ["jump_on", "zero_load"])
def test_the_rigid_sphere_over_a_half_space_is_drawn_round(states, name):
    state, view = states[name], view_of(list(states.values()))
    r, z = surfaces(state, view.reach, view.heights)["wall"][:, 1:-1]
    rigid = r**2 / 2 + (1 - state.observables[APPROACH]) / state.scene.tabor
    assert z == pytest.approx(view.heights * rigid, abs=1e-6 * view.reach)


def test_a_wall_is_drawn_flat_and_its_sphere_flattened(sphere):
    states = module.event_states(sphere)
    state, view = states["zero_load"], view_of(list(states.values()))
    shown = surfaces(state, view.reach, view.heights)
    wall = view.heights * (1 - state.observables[APPROACH]) / 2.0
    assert shown["wall"][1, 1:] == pytest.approx(wall, abs=1e-6 * view.reach)
    touching = shown["deformed"][0] < 0.9 * state.observables[3]
    spacing = view.heights / 2.0
    assert np.all(np.abs(wall - shown["deformed"][1, touching] - spacing) < 0.1 * spacing)
    assert np.ptp(shown["undeformed"][1, touching]) > 3 * spacing


def test_the_section_meets_the_surface_with_the_laws_stress(states):
    state, view = states["zero_load"], view_of(list(states.values()))
    shown = section(state, view)
    r, z = shown.points
    order = np.lexsort((z, np.round(r, 9)))
    highest = order[np.append(np.diff(np.round(r, 9)[order]) > 0, True)]
    highest = highest[r[highest] < view.reach]
    assert len(highest) > 30
    line = CubicSpline(*surfaces(state, view.reach, view.heights)["deformed"][:, 1:])
    assert z[highest] == pytest.approx(line(r[highest]), abs=1e-4)
    pressure = CubicSpline(state.surface.radii, state.pressure)(r[highest])
    assert shown.stress[highest] == pytest.approx(-pressure, abs=0.02)
    assert shown.stress.max() == pytest.approx(16 / (9 * np.sqrt(3)) * 2.0, rel=0.02)


def test_a_picture_has_the_size_and_the_colours_of_its_state(pictures):
    red, blue = {}, {}
    for event, image in pictures.items():
        assert image.shape == (300, 480, 3)
        assert len(np.unique(image.reshape(-1, 3), axis=0)) > 1000
        solid = image[60:240, 140:410]
        red[event] = np.sum((solid[..., 0] - solid[..., 2]) > 60)
        blue[event] = np.sum((solid[..., 2] - solid[..., 0]) > 60)
    assert 0 < red["jump_on"] < red["pull_off"] / 2
    assert blue["jump_on"] + blue["pull_off"] < blue["zero_load"] / 4


def test_a_movie_has_stable_states_and_jumps_at_a_fixed_wall(block):
    frames = module.experiment(block.path)
    alpha = np.array([_approach(frame) for frame in frames])
    words = [frame.words for frame in frames]
    assert 40 <= len(frames) <= 60
    for take_off, landing in (("about to jump on", "jumped on"), ("about to jump off", "jumped off")):
        jump = words.index(take_off)
        assert words[jump + 1] == landing
        assert alpha[jump + 1] == pytest.approx(alpha[jump], abs=1e-4)
        loads = [frames[k].state.point.observables[LOAD] for k in (jump, jump + 1)]
        assert abs(loads[1] - loads[0]) > 1
    top = words.index("turning back")
    assert np.all(np.diff(alpha[: top + 1]) > -1e-4)
    assert np.all(np.diff(alpha[top:]) < 1e-4)
    at_rest = [frame.words for frame in frames if frame.seconds == module.USUAL.resting]
    turns = ["about to jump on", "jumped on", "turning back", "pull-off", "about to jump off", "jumped off"]
    assert at_rest == turns
    assert {frame.seconds for frame in frames} == {module.USUAL.moving, module.USUAL.resting}
    resting = [frame.state for frame in frames if frame.words not in ("about to jump on", "about to jump off")]
    assert all(state.problem.negative_directions(state.point.x) == 0 for state in resting)


def test_a_movie_without_jumps_comes_as_it_goes():
    frames = module.experiment(_solved(Scene(0.5)).path)
    alpha = [_approach(frame) for frame in frames]
    assert not any("jump" in frame.words for frame in frames)
    assert alpha == alpha[::-1]
    assert sum(frame.words == "pull-off" for frame in frames) == 1


def test_a_movie_has_every_frame_and_lingers_at_the_jumps(block, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "USUAL", replace(module.USUAL, frames=2))
    frames, path = module.experiment(block.path), tmp_path / "jump.gif"
    monkeypatch.setattr(module, "experiment", lambda _: frames)
    with written_aside(path) as file:
        module.write_movie(block, file, SMALL)
    with Image.open(path) as shown:
        assert (shown.n_frames, shown.size) == (len(frames), SMALL)
        seen = []
        for number, frame in enumerate(frames):
            shown.seek(number)
            assert shown.info["duration"] == round(1000 * frame.seconds)
            seen.append(np.asarray(shown.convert("RGB")).astype(int))
    assert all(tuple(image[0, 120]) == (255, 255, 255) for image in seen)
    jump = [frame.words for frame in frames].index("jumped on")
    before, after = (np.sum((image[:, 70:205, 0] - image[:, 70:205, 2]) > 60) for image in seen[jump - 1 : jump + 1])
    assert after > 2 * before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--at jump_on", "--render FILE.png"),
        ("--render a.jpg", "limit: .png"),
        ("--movie a.mp4", "limit: .gif"),
        ("--movie a.gif --solver half-space", "--solver fem"),
        ("--render a.png --body held-sphere:1000", "hemisphere"),
        ("--render missing/a.png", "missing/a.png cannot be written"),
    ],
)
def test_what_cannot_be_drawn_is_refused_before_any_work(tmp_path, monkeypatch, arguments, words, refused):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("fem_adhesion.curve.solve.solve", lambda *_: pytest.fail("worked"))
    refused("curve --tabor 2", arguments, words=words)
    assert not list(tmp_path.iterdir())


def test_an_event_that_the_curve_has_not_is_refused(tmp_path, refused):
    asked = ("--tabor", 0.5, "--rtol", 1e-2, "--render", tmp_path / "a.png", "--at", "jump_on")
    refused("curve", *asked, words="does not fold; take pull_off")
    assert not list(tmp_path.iterdir())


def test_a_machine_that_cannot_draw_is_told_what_to_install(monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    monkeypatch.setattr(solid_view, "OSMESA", "OfNoName")
    with pytest.raises(ValueError, match="apt-get install libegl1 libgl1-mesa-dri"):
        solid_view.require_drawing()


# --- what is written on a picture ---


def _said(text):
    """Numbers of a caption by their symbols."""
    found = re.findall(r"\$(W|\\alpha\^\*|\\alpha|a)\$ = (-?[\d.]+)(?:\((\d+)\))?", text.replace(module.MINUS, "-"))
    return {symbol.strip("\\^*"): float(value) for symbol, value, _ in found}


@pytest.mark.parametrize("event", ["jump_on", "zero_load"])
def test_caption_and_frame_have_the_events_numbers_by_their_symbols(block, states, event):
    title, numbers = module._caption(block, event)
    assert title == f"$\\mu$ = 2: {STATES[event].words}"
    found, said = block.path.events[event], _said(numbers)
    assert said["W"] == pytest.approx(found.load, abs=2e-2)
    assert said["alpha"] == pytest.approx(found.approach, abs=2e-2)
    assert ("a" in said) == np.isfinite(found.contact_radius)
    if "a" in said:
        assert said["a"] == pytest.approx(found.contact_radius, abs=2e-2)
    frame, numbers = _said(module.state_words(block, states[event])), states[event].observables
    assert [frame["W"], frame["alpha"]] == pytest.approx([numbers[LOAD], numbers[APPROACH]], abs=6e-3)


def test_the_curve_on_a_picture_has_the_state_on_it(block, states):
    state, white = states["jump_off"], np.full((30, 48, 3), 255, np.uint8)
    view = view_of([state])
    figure = module.composed(block, white, state, view, ("title", "numbers"))
    solid, bar, curve = figure.axes
    assert "title" in [text.get_text() for text in figure.texts]
    assert (curve.get_xlabel(), curve.get_ylabel()) == (
        r"approach $\alpha^* = \alpha/\epsilon$",
        r"load $W/R\Delta\gamma$",
    )
    event = block.path.events["jump_off"]
    (mark,) = (line for line in curve.lines if line.get_marker() == "o")
    assert (mark.get_xdata()[0], mark.get_ydata()[0]) == pytest.approx((event.approach, event.load), abs=2e-3)
    looks = {kind: (look["color"], look["linestyle"]) for kind, look in KINDS.items()}
    for kind, load in smooth(block.path).parts(smooth(block.path).load):
        (drawn,) = (line for line in curve.lines if line.get_color() == looks[kind][0])
        np.testing.assert_array_equal(drawn.get_ydata(), load)
    assert "vertical stress" in bar.get_ylabel()
    assert bar.get_title() == "tension"
    ticks = [float(label.get_text().replace(module.MINUS, "-")) for label in bar.get_yticklabels()]
    assert ticks == sorted(ticks)
    assert ticks[-1] == pytest.approx(view.limit, rel=1e-2)
    assert solid.axison is False


def test_a_picture_with_a_material_is_in_si():
    units = Units(100e-9, 1.1e9, 0.05, 0.3e-9)
    curves = solve(Question(Scene(units.tabor), solver="fem", rtol=1e-2, units=units))
    title, numbers = module._caption(curves, "pull_off")
    event = curves.path.events["pull_off"]
    assert title.startswith("$R$ = 100 nm")
    assert _said(numbers)["W"] == pytest.approx(event.load * 5, abs=0.3)
    assert _said(numbers)["alpha"] == pytest.approx(event.approach * 0.3, abs=0.02)
    beta = np.cbrt(1e-14 * 0.05 / 1.1e9) * 1e9
    assert _said(numbers)["a"] == pytest.approx(event.contact_radius * beta, abs=0.1)
    assert numbers.count("nN") == 1
    assert numbers.count("nm") == 2
