"""A picture of the deformed body, cut open, with its stress and the wall, and where on the curve it stands."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from typing import TextIO

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from fem_adhesion.common.numbers import with_error
from fem_adhesion.curve import lines
from fem_adhesion.curve.figure import LOOK
from fem_adhesion.curve.load import KINDS, contact_words
from fem_adhesion.curve.profiles import STATES
from fem_adhesion.curve.scales import scales
from fem_adhesion.curve.solve import Curves
from fem_adhesion.fields import State, state_at
from fem_adhesion.paraview.picture import COLOURS, Pixels, View, solid_image, view_of
from fem_adhesion.registry import name_of
from fem_adhesion.scene import Scene
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.errors import InputError

SIZE = (1600, 1000)  # of a picture in pixels
WIDTH = 8.0  # of a picture in inches
MINUS = "\N{MINUS SIGN}"  # for the hyphen of Python's numbers
DIGITS = 6  # significant ones of a number, at most


def write_picture(curves: Curves, file: TextIO, at: str = "pull_off", size: tuple[int, int] = SIZE) -> None:
    """Draw the body at an event and write it as png of a size in pixels to a file of `written_aside`.

    The curves' first path is of finite elements. InputError if it has no such event, or as `require_drawing`.
    """
    require_event(curves, at)
    states = event_states(curves)
    view = view_of(list(states.values()))
    solid = solid_image(states[at], view, size)
    picture = composed(curves, solid, states[at], view, _caption(curves, at))
    png = BytesIO()
    picture.savefig(png, format="png")
    file.buffer.write(png.getbuffer())


def require_event(curves: Curves, at: str) -> None:
    """Raise InputError unless a curve has an event."""
    if curves.path.event(at) is None:
        raise InputError(
            f"at = {at} is not on the curve at tabor = {curves.path.tabor:g}, which does not fold; take pull_off"
        )


def event_states(curves: Curves) -> dict[str, State]:
    """Fields inside the body at the events of a curve, by name."""
    scene, found = curves.question.scene, curves.path.stages[-1]
    return {
        name: state_at(scene, found[name].problem, found[name].point, name=name) for name in STATES if name in found
    }


def composed(curves: Curves, solid: Pixels, state: State, view: View, words: tuple[str, str]) -> Figure:
    """Solid with a title and a line below it, colour bar, and the load-approach curve with the state on it."""
    height, width = solid.shape[:2]
    with rc_context(LOOK):
        figure = Figure(figsize=(WIDTH, WIDTH * height / width), dpi=width / WIDTH)
        FigureCanvasAgg(figure)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.imshow(solid, aspect="auto")
        axes.set_axis_off()
        figure.text(0.02, 0.97, words[0], va="top", fontsize=13, weight="bold")
        figure.text(0.02, 0.915, words[1], va="top", fontsize=11)
        figure.text(0.34, 0.02, _key(curves, view), va="bottom", fontsize=9, color="0.25")
        _add_bar(figure, curves, view)
        _add_curve(figure, curves, state)
    return figure


def _caption(curves: Curves, at: str) -> tuple[str, str]:
    """Which contact and event, and its numbers with their errors."""
    event, units, numbers = curves.path.events[at], scales(curves), {}
    for name in SYMBOLS:
        if (at, name) == ("zero_load", "load"):
            numbers[name] = "0"
        elif np.isfinite((found := event.estimate(name)).value):
            numbers[name] = with_error(found, units[name].size, DIGITS)
    return f"{contact_words(curves)}: {STATES[at].words}", _listed(curves, numbers)


def state_words(curves: Curves, state: State) -> str:
    """Load and approach of a state, to the digits that a glance takes in."""
    units, values = scales(curves), {"load": state.observables[LOAD], "approach": state.observables[APPROACH]}
    return _listed(curves, {name: f"{value * units[name].size:.2f}" for name, value in values.items()})


def _listed(curves: Curves, numbers: Mapping[str, str]) -> str:
    """Numbers by quantity with their symbols and units."""
    parts = []
    for name, number in numbers.items():
        symbol, unit = SYMBOLS[name]
        if curves.question.units:
            symbol, unit = symbol.replace("^*", ""), scales(curves)[name].unit
        parts.append(f"{symbol} = {number} {unit}".replace("-", MINUS).strip())
    return ",  ".join(parts)


SYMBOLS: Mapping[str, tuple[str, str]] = {
    "load": ("$W$", r"$R\Delta\gamma$"),
    "approach": (r"$\alpha^*$", ""),
    "contact_radius": ("$a$", r"$\beta$"),
}
"""Of the quantities in the caption, and their units in the paper."""


def _key(curves: Curves, view: View) -> str:
    """What is drawn, and how."""
    scene, units = curves.question.scene, curves.question.units
    R = units.radius / units.length if units else scene.sphere_radius
    factor = view.heights * R
    if np.isinf(factor):
        how = f"heights magnified, $\\beta^2/R$ drawn as {view.heights:.2g} $\\beta$"
    else:
        how = "to scale" if abs(factor - 1) < 1e-9 else f"heights $\\times\\,${factor:.3g}"
    return f"{_body(scene)}, a quarter cut away\n{how}; green: undeformed surface"


def _body(scene: Scene) -> str:
    """What is drawn: the rigid side has the shape that the body lacks."""
    looks = scene.body.looks
    if scene.counter is not None:
        return f"{looks} under an elastic counter-body"
    if np.isinf(scene.body.size):
        return f"{looks} under a rigid sphere"
    wall = "flat wall" if scene.shape == scene.body.shape else f"wall, gap of a {name_of(scene.shape)}"
    return f"{looks} under a rigid {wall}"


def _add_bar(figure: Figure, curves: Curves, view: View) -> None:
    pressure = scales(curves)["pressure"]
    limit = view.limit * pressure.size
    axes = figure.add_axes((0.89, 0.2, 0.018, 0.6))
    bar = figure.colorbar(ScalarMappable(Normalize(-limit, limit), COLOURS), cax=axes, extend="both")
    ticks = np.linspace(-limit, limit, 5)
    bar.set_ticks(ticks.tolist(), labels=[f"{tick:.3g}".replace("-", MINUS) for tick in ticks])
    unit = f", {pressure.unit}" if curves.question.units else r"$\;\mu\epsilon/\Delta\gamma$"
    bar.set_label(f"vertical stress $\\sigma_{{zz}}${unit}", fontsize=10)
    axes.set_title("tension", fontsize=9, pad=14)
    axes.text(0.5, -0.09, "compression", transform=axes.transAxes, fontsize=9, ha="center", va="top")


def _add_curve(figure: Figure, curves: Curves, state: State) -> None:
    """Load against approach around the events, and the state on it."""
    units, frame, line = scales(curves), lines.around_events(curves.path), lines.smooth(curves.path)
    x, y = units["approach"], units["load"]
    axes = figure.add_axes((0.07, 0.11, 0.2, 0.25))
    for kind, load in line.parts(line.load):
        axes.plot(x.of(line.approach), y.of(load), **KINDS[kind])
    at = state.observables[[APPROACH, LOAD]]
    axes.plot(*(at * [x.size, y.size]), marker="o", markersize=9, color="black", zorder=5)
    axes.axhline(0, color="0.8", linewidth=0.7, zorder=0)
    axes.set(xlim=x.of(np.array(frame.approach)), ylim=y.of(np.array(frame.load)))
    axes.set_xlabel(x.label, fontsize=9)
    axes.set_ylabel(y.label, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.patch.set_alpha(0.8)
