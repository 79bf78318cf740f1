"""The page about a curve shows what was computed, told apart by more than colour."""

import io
import itertools
from dataclasses import replace

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from fem_adhesion import Hemisphere, LinearElastic, NeoHookean
from fem_adhesion.common import lines as curve_lines
from fem_adhesion.common import style
from fem_adhesion.curve import figure as curve_figure
from fem_adhesion.curve import load as load_panel
from fem_adhesion.curve.solve import Question, solve
from fem_adhesion.fields import state_at
from fem_adhesion.scene import Scene
from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.equilibrium.charts import trace_charts
from halfspace.equilibrium.contact import LOAD
from halfspace.equilibrium.path import Steps
from halfspace.laws import LENNARD_JONES
from halfspace.scales import Scales
from halfspace.scaling import Units

UNITS = Units(100e-9, 1.1e9, 0.05, 0.3e-9)


@pytest.fixture(scope="module")
def curves():
    asked = {tabor: Question(Scene(tabor), rtol=1e-4) for tabor in (0.3, 2.0, 5.0)}
    return {tabor: solve(question) for tabor, question in asked.items()}


@pytest.fixture(scope="module")
def elements():
    return solve(Question(Scene(2.0), solver="both", rtol=1e-3))


@pytest.fixture(scope="module")
def real():
    question = Question(Scene(UNITS.tabor), rtol=1e-3, units=UNITS, stiffness=5 / UNITS.stiffness)
    return solve(question)


DRAWN = {}  # pages, each beside its curves, which its key is the identity of


def _drawn(curves):
    """Page of some curves, which is drawn once."""
    if id(curves) not in DRAWN:
        with rc_context(curve_figure.LOOK):
            DRAWN[id(curves)] = curves, curve_figure.draw(curves)
            DRAWN[id(curves)][1].draw_without_rendering()
    return DRAWN[id(curves)][1]


def _panel(figure, name):
    return dict(zip(("load", "pressure", "gap", "spike", "body"), figure.axes, strict=False))[name]


def _lines(axes):
    return {line.get_label(): line for line in axes.lines}


def _arrows(axes):
    return [note for note in axes.texts if getattr(note, "arrow_patch", None)]


@pytest.mark.parametrize(("tabor", "jumps", "folds"), [(0.3, 0, 0), (2.0, 2, 2), (5.0, 2, 4)])
def test_arrows_are_the_jumps_and_marks_the_folds(curves, tabor, jumps, folds):
    axes = _panel(_drawn(curves[tabor]), "load")
    arrows = _arrows(axes)
    assert len(arrows) == jumps
    if jumps:
        cycle = curves[tabor].grips
        for arrow, jump in zip(arrows, (cycle.jump_on, cycle.jump_off), strict=True):
            assert arrow.xyann == pytest.approx((jump.take_off.approach, jump.take_off.load))
            assert arrow.xy == pytest.approx((jump.landing.approach, jump.landing.load))
    marked = _lines(axes)["fold"].get_xdata().size if folds else 0
    assert marked == folds
    assert ("fold" in _lines(axes)) == bool(folds)


@pytest.mark.parametrize("tabor", [0.3, 2.0, 5.0])
def test_branches_and_theories_differ_in_dashes_and_in_colour(curves, tabor):
    lines = _lines(_panel(_drawn(curves[tabor]), "load"))
    branches = set(curve_lines.KINDS.values()) if tabor > 1 else set(list(curve_lines.KINDS.values())[:2])
    assert branches <= set(lines)
    assert {"JKR", "Bradley", "Maugis-Dugdale"} <= set(lines)
    shown = [lines[name] for name in branches]
    for looks in ([line._unscaled_dash_pattern for line in shown], [line.get_color() for line in shown]):
        assert all(a != b for a, b in itertools.combinations(looks, 2))


def test_the_drawn_line_is_the_curve_between_its_points(curves):
    """Against points ten times closer, each solved for."""
    charts = half_space_charts(Scales(2.0), resolution_for(Scales(2.0), 1e-4))
    close = [p.observables for s in trace_charts(charts, steps=Steps(longest=0.05)) for p in s.points]
    line = curve_lines.smooth(curves[2.0].path)
    drawn = np.stack([line.approach, line.load])
    nearest = [_distance(drawn, point[: LOAD + 1]) for point in close if point[LOAD] <= line.load[-1]]
    assert len(close) > 3 * len(curves[2.0].path.points)
    assert max(nearest) < 0.01


def _distance(line, point):
    """Distance of a point from a polygon."""
    a, d = line[:, :-1], np.diff(line)
    length = np.maximum(np.sum(d**2, axis=0), 1e-30)
    t = np.clip(np.sum((point[:, None] - a) * d, axis=0) / length, 0, 1)
    return np.hypot(*(a + t * d - point[:, None])).min()


def test_an_apparatus_adds_two_arrows_along_its_load_lines(real):
    axes = _panel(_drawn(real), "load")
    assert len(_arrows(axes)) == 4
    for arrow in _arrows(axes)[2:]:
        (x, y), (x_end, y_end) = arrow.xyann, arrow.xy
        assert (y_end - y) / (x_end - x) == pytest.approx(-5, rel=1e-5)  # N/m are nN/nm
    assert sum(line.get_label().startswith("jumps, $k$ = 5 N/m") for line in axes.lines) == 1


def test_the_mesh_is_drawn_with_the_deformation_of_its_surface(elements):
    """On the surface gap, deflection and the height of the sphere add up."""
    found = elements.path.stages[-1]["pull_off"]
    state = state_at(Scene(2.0), found.problem, found.point, how=curve_figure.MESH)
    places, moved = (a.reshape(-1, 2) for a in curve_figure.outlines(state, 3.0))
    top = (places[:, 1] == 0) & (places[:, 0] < 3)
    r, u_z = places[top, 0], moved[top, 1]
    gap = state.problem.operator.at(1.0).values_at(r, state.gap)
    np.testing.assert_allclose(curve_figure._sphere(state, r) - u_z, (gap + 1) / 2, atol=2e-3)
    assert gap.min() > -1
    assert np.abs(LENNARD_JONES.pressure(gap, 2.0)).max() > 1.9
    body = _panel(_drawn(elements), "body")
    assert len(body.collections[0].get_paths()) > 50
    assert "rigid sphere" in _lines(body)


def test_both_solvers_are_in_one_picture(elements):
    lines = _lines(_panel(_drawn(elements), "load"))
    dots = lines["half-space"]
    assert dots.get_marker() == "o"
    assert set(dots.get_ydata()) <= set(elements.other.load)


def test_events_that_would_be_too_small_are_enlarged():
    figure = _drawn(solve(Question(Scene(2.0), rtol=1e-3, to_load=100.0)))
    (inset,) = _panel(figure, "load").child_axes
    assert inset.get_ylim()[1] < 5
    assert len(_arrows(inset)) == 2


def _small():
    """A figure that is drawn at once."""
    figure, panels = style.panels(2)
    for axes in panels:
        axes.plot([0.0, 1.0], [0.0, 1e-3], label="a line")
        style.dress(axes, "approach", "load", legend="below")
    return figure, panels


@pytest.mark.parametrize("form", ["svg", "png", "pdf"])
def test_each_format_is_written_the_same_twice(form, tmp_path):
    files = [tmp_path / f"{n}.{form}" for n in ((1,) if form == "pdf" else (1, 2))]  # a PDF has the time in it
    for file in files:
        with file.open("w") as opened:
            style.write(lambda: _small()[0], opened, form, curve_figure.LOOK)
    assert files[0].stat().st_size > 5_000
    assert len({file.read_bytes() for file in files}) == 1


# --- labels of the axes against the data drawn ---

LABELS = {
    "load": (r"approach $\alpha^* = \alpha/\epsilon$", r"load $W/R\Delta\gamma$"),
    "pressure": (r"radius $u = r/\beta$", r"pressure $P = \mu\epsilon p/\Delta\gamma$"),
    "gap": (r"radius $u = r/\beta$", r"gap $H = h/\epsilon - 1$"),
    "spike": (r"radius $u = r/\beta$", r"pressure $P = \mu\epsilon p/\Delta\gamma$"),
    "body": (r"approach $\alpha^* = \alpha/\epsilon$", "central gap $H(0)$"),
}
SI_LABELS = {
    "load": (r"approach $\alpha$, nm", "load $W$, nN"),
    "pressure": ("radius $r$, nm", "pressure $p$, MPa"),
    "gap": ("radius $r$, nm", r"gap $h - \epsilon$, nm"),
    "spike": ("radius $r$, nm", "pressure $p$, MPa"),
    "body": (r"approach $\alpha$, nm", r"central gap $h(0) - \epsilon$, nm"),
}
IN_SI = {
    "approach": UNITS.spacing * 1e9,
    "central_gap": UNITS.spacing * 1e9,
    "load": UNITS.radius * UNITS.work_of_adhesion * 1e9,
    "radius": np.cbrt(UNITS.radius**2 * UNITS.work_of_adhesion / UNITS.modulus) * 1e9,
    "pressure": np.cbrt(UNITS.modulus**2 * UNITS.work_of_adhesion / UNITS.radius) * 1e-6,  # dgamma/(mu eps)
}


@pytest.mark.parametrize("material", [False, True])
def test_each_axis_is_labelled_with_what_is_drawn_along_it(curves, real, material):
    """In each panel a state is found whose numbers are known, at the place that the labels say."""
    asked, labels = (real, SI_LABELS) if material else (curves[2.0], LABELS)
    size = IN_SI if material else dict.fromkeys(IN_SI, 1.0)
    figure, path = _drawn(asked), asked.path
    for name, (x, y) in labels.items():
        assert (_panel(figure, name).get_xlabel(), _panel(figure, name).get_ylabel()) == (x, y)
    words = {"pull_off": "pull-off", "jump_on": "jump on", "jump_off": "jump off", "zero_load": "zero load"}
    load, body = _lines(_panel(figure, "load")), _panel(figure, "body")
    gaps, pressures = _lines(_panel(figure, "gap")), _lines(_panel(figure, "pressure"))
    marks = [line for line in body.lines if len(line.get_xdata()) == 1]
    assert len(marks) == len(path.events)
    for event, mark in zip((path.event(name) for name in load_panel.STATES), marks, strict=True):
        x, y = event.approach * size["approach"], event.load * size["load"]
        assert load[words[event.name]].get_xydata()[0] == pytest.approx((x, y), rel=1e-6, abs=1e-9)
        assert mark.get_xydata()[0] == pytest.approx((x, event.central_gap * size["central_gap"]), rel=1e-6)
        r, gap = gaps[words[event.name]].get_xydata().T
        assert (r[0], gap[0]) == (0, pytest.approx(event.central_gap * size["central_gap"], rel=1e-3, abs=1e-4))
        r, p = pressures[words[event.name]].get_xydata().T
        law = LENNARD_JONES.pressure(np.array([event.central_gap]), path.tabor)[0]
        assert (r[0], p[0]) == (0, pytest.approx(law * size["pressure"], rel=1e-2))
        if np.isfinite(event.contact_radius):  # where the tension is largest
            assert r[p.argmin()] == pytest.approx(event.contact_radius * size["radius"], rel=1e-2)
            assert p.min() == pytest.approx(-16 / (9 * np.sqrt(3)) * path.tabor * size["pressure"], rel=1e-2)
    nodes = _lines(_panel(figure, "spike"))["nodes of the grid"]
    r, p = nodes.get_xdata() / size["radius"], nodes.get_ydata() / size["pressure"]
    assert r.size > 30
    np.testing.assert_allclose(curve_figure.profile(path, "jump_off", r)["pressure"], p, atol=1e-9)
    radius = path.event("jump_off").contact_radius * size["radius"]
    assert nodes.get_xdata()[nodes.get_ydata().argmin()] == pytest.approx(radius, rel=2e-2)


# --- what is on the page ---


def test_the_legend_of_stability_is_that_of_the_curve(curves):
    """Each line that is named after a stability passes through states of that stability, and through no others."""
    path, lines = curves[5.0].path, _lines(_panel(_drawn(curves[5.0]), "load"))
    for at in range(len(path.points)):
        kind = curve_lines.UNSTABLE if not path.stable[at] else curve_lines.GRIPS_ONLY
        kind = curve_lines.STABLE if path.stable_under_dead_load[at] else kind
        drawn = lines[curve_lines.KINDS[kind]].get_xydata()
        place = np.array([path.approach[at], path.load[at]])
        assert np.nanmin(np.hypot(*(drawn - place).T)) < 1e-9


PAGES = {
    "sphere": Question(Scene(2.0, Hemisphere(radius_ratio=60.0)), "both", 1e-2, stiffness=3.0),
    "rigid": Question(Scene(1e-8), rtol=1e-2),
}


def test_the_title_tells_finite_strain(elements):
    """As the terminal does: the same body at small strain has another curve."""
    for material, told in ((NeoHookean(0.3), "hemisphere at finite strain; "), (LinearElastic(0.3), "hemisphere; ")):
        scene = Scene(2.0, Hemisphere(radius_ratio=100.0, material=material))
        named = replace(elements, question=Question(scene, "fem", 1e-3))
        _, title = load_panel.draw_load(Figure().subplots(), named).split(" = 100, ")
        assert title.startswith(told)
        assert curve_figure.has_mesh(named) != material.finite


@pytest.fixture(scope="module", params=["no jump", "four folds", "both solvers", "material", *PAGES])
def made(request, curves, elements, real):
    known = {"no jump": curves[0.3], "four folds": curves[5.0], "both solvers": elements, "material": real}
    return _drawn(known[request.param] if request.param in known else solve(PAGES[request.param]))


def test_nothing_is_cut_off_and_legends_name_what_is_to_be_seen(made):
    titles = [axes._left_title.get_window_extent() for axes in made.axes]
    assert not any(a.overlaps(b) for a, b in itertools.combinations(titles, 2))
    for axes in made.axes:
        shown = [text for text in (axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label) if text.get_text()]
        for box in [axes.get_tightbbox(), *(text.get_window_extent() for text in shown)]:
            assert made.bbox.x0 <= box.x0 <= box.x1 <= made.bbox.x1
            assert made.bbox.y0 <= box.y0 <= box.y1 <= made.bbox.y1
        low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
        lines = _lines(axes)
        for text in axes.get_legend().get_texts() if axes.get_legend() else ():
            line = lines[text.get_text()]
            if text.get_text().startswith("jumps"):
                assert any(note.arrow_patch.get_edgecolor() == to_rgba(line.get_color()) for note in _arrows(axes))
            elif text.get_text() == "edge of contact":  # across the panel
                along = 1 if np.ptp(line.get_ydata()) == 0 else 0
                at = (line.get_xdata(), line.get_ydata())[along][0]
                assert low[along] <= at <= high[along]
            else:
                at = line.get_xydata()
                assert np.any(np.all((low <= at) & (at <= high), axis=1)), text.get_text()


def test_a_gap_is_smooth_up_to_the_equator_of_a_sphere(made):
    for line in _panel(made, "gap").lines:
        if line.get_label() in {look.words for look in load_panel.STATES.values()}:
            rise = np.diff(line.get_ydata())
            far = line.get_xdata()[:-1] > 0.95 * line.get_xdata().max()
            assert np.all(rise[far] > 0)


def test_axes_have_the_same_places_in_every_format():
    figure, panels = _small()
    before = [axes.get_position().bounds for axes in panels]
    assert style.laid_out(figure) is figure
    places = [axes.get_position().bounds for axes in panels]
    assert all(np.ptp([one, other], axis=0).max() > 0.01 for one, other in zip(before, places, strict=True))
    for form, dpi in (("svg", 72), ("pdf", 72), ("png", 30)):
        figure.savefig(io.BytesIO(), format=form, dpi=dpi)
        assert [axes.get_position().bounds for axes in panels] == places
        figure.set_dpi(dpi)
        for axes in panels:
            box = axes.get_tightbbox()
            assert -2 <= box.x0 <= box.x1 <= figure.bbox.x1 + 2
            assert -2 <= box.y0 <= box.y1 <= figure.bbox.y1 + 2
