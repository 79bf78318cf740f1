"""Pictures of the deformed body, cut open, with its stress and the wall, and where on the curve it stands.

A movie is of an experiment under fixed grips: up to the wall, onto it, pressed, pulled and off, stable states only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from itertools import pairwise
from typing import Any, TextIO

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from PIL import Image
from scipy.spatial import KDTree

from fem_adhesion.common import lines, style
from fem_adhesion.common.numbers import with_error
from fem_adhesion.curve.figure import LOOK
from fem_adhesion.curve.load import STATES, contact_words, draw_line, limit
from fem_adhesion.curve.settings import USUAL
from fem_adhesion.curve.solve import Curves
from fem_adhesion.fields import State, state_at
from fem_adhesion.paraview.picture import COLOURS, Pixels, View, solid_image, view_of
from fem_adhesion.registry import name_of
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError
from halfspace.values import Array, Index

MINUS = "\N{MINUS SIGN}"  # for the hyphen of Python's numbers


def write_picture(curves: Curves, file: TextIO, at: str = "pull_off", size: tuple[int, int] = USUAL.picture) -> None:
    """Draw the body at an event and write it as png of a size in pixels to a file of `written_aside`.

    The curves' first path is of finite elements. InputError if it has no such event, or as `require_drawing`.
    """
    if curves.path.event(at) is None:
        raise InputError(
            f"at = {at} is not on the curve at tabor = {curves.path.tabor:g}, which does not fold; take pull_off"
        )
    states = event_states(curves)
    view = view_of(list(states.values()))
    solid = solid_image(states[at], view, size)
    picture = composed(curves, solid, states[at], view, _caption(curves, at))
    style.write(lambda: picture, file, "png", dpi=picture.dpi)


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
        figure = Figure(figsize=(8, 8 * height / width), dpi=width / 8)
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
    event, units, numbers = curves.path.events[at], curves.scales, {}
    for name in SYMBOLS:
        if (at, name) == ("zero_load", "load"):
            numbers[name] = "0"
        elif np.isfinite((found := event.estimate(name)).value):
            numbers[name] = with_error(found, units[name].size)
    return f"{contact_words(curves)}: {STATES[at].words}", _listed(curves, numbers)


def state_words(curves: Curves, state: State) -> str:
    """Load and approach of a state, to the digits that a glance takes in."""
    load, approach = curves.shown(load=state.observables[LOAD], approach=state.observables[APPROACH])
    return _listed(curves, {"load": f"{load:.2f}", "approach": f"{approach:.2f}"})


def _listed(curves: Curves, numbers: Mapping[str, str]) -> str:
    """Numbers by quantity with their symbols and units."""
    parts = []
    for name, number in numbers.items():
        symbol, unit = SYMBOLS[name]
        if curves.question.units:
            symbol, unit = symbol.replace("^*", ""), curves.scales[name].unit
        parts.append(f"{symbol} = {number} {unit}".replace("-", MINUS).strip())
    return ",  ".join(parts)


SYMBOLS: Mapping[str, tuple[str, str]] = {
    "load": ("$W$", r"$R\Delta\gamma$"),
    "approach": (r"$\alpha^*$", ""),
    "contact_radius": ("$a$", r"$\beta$"),
}
"""Of the quantities in the caption, and their units in the paper."""


def _key(curves: Curves, view: View) -> str:
    """What is drawn, and how; the rigid side has the shape that the body lacks."""
    scene, units = curves.question.scene, curves.question.units
    factor = view.heights * (units.radius / units.length if units else scene.sphere_radius)
    if np.isinf(factor):
        how = f"heights magnified, $\\beta^2/R$ drawn as {view.heights:.2g} $\\beta$"
    else:
        how = "to scale" if abs(factor - 1) < 1e-9 else f"heights $\\times\\,${factor:.3g}"
    above = "a rigid flat wall" if scene.shape == scene.body.shape else f"a rigid wall, gap of a {name_of(scene.shape)}"
    if scene.counter is not None or np.isinf(scene.body.size):
        above = "an elastic counter-body" if scene.counter is not None else "a rigid sphere"
    interfaces = ", grey: interfaces" if len(scene.body.regions) > 1 else ""
    return f"{scene.body.looks} under {above}, a quarter cut away{interfaces}\n{how}; green: undeformed surface"


def _add_bar(figure: Figure, curves: Curves, view: View) -> None:
    pressure = curves.scales["pressure"]
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
    frame, line = lines.around_events(curves.path), lines.smooth(curves.path)
    axes = figure.add_axes((0.07, 0.11, 0.2, 0.25))
    draw_line(axes, curves, line)
    at = curves.shown(approach=state.observables[APPROACH], load=state.observables[LOAD])
    axes.plot(*at, marker="o", markersize=9, color="black", zorder=5)
    limit(axes, curves, frame)
    axes.set_xlabel(curves.scales["approach"].label, fontsize=9)
    axes.set_ylabel(curves.scales["load"].label, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.patch.set_alpha(0.8)


# The movie


@dataclass(frozen=True)
class Shot:
    """A state that is shown, what is said of it, and for how many seconds."""

    state: Located
    words: str
    seconds: float = USUAL.moving


def write_movie(curves: Curves, file: TextIO, size: tuple[int, int] = (800, 500)) -> None:
    """Draw the body along the curve through its jumps and write it as gif; raise as `write_picture` or NotConverged."""
    frames = experiment(curves.path)
    images = list(_images(curves, frames, size))
    first, *rest = _with_one_palette(images)
    seconds = [round(1000 * frame.seconds) for frame in frames]
    gif = BytesIO()
    first.save(gif, "GIF", save_all=True, append_images=rest, duration=seconds, loop=0)
    file.buffer.write(gif.getbuffer())


def experiment(path: EquilibriumPath) -> list[Shot]:
    """States that a contact passes under fixed grips, up to the wall and back, the wall moving steadily.

    They end at the loads `USUAL.faded` and `USUAL.pressed`, or where the path does.
    """
    found, loop = path.stages[-1], cycle(path)
    if loop and len(loop.jumps) > 2:
        raise InputError(f"movie of {len(loop.jumps)} jumps, limit: one on and one off; take --render")
    if "jump_on" in found:
        frames = _jumping(path, found["jump_on"], found["jump_off"])
    else:
        contact = sorted([*_states(path, _grid(path, []), lambda _: True), found["pull_off"]], key=_approach)
        frames = _run(contact, "approaching", last="turning back") + _run(contact[-2::-1], "withdrawing")
    back = max(number for number, frame in enumerate(frames) if frame.state is found["pull_off"])
    frames[back] = replace(frames[back], words="pull-off", seconds=USUAL.resting)
    return frames


def _jumping(path: EquilibriumPath, on: Located, off: Located) -> list[Shot]:
    """Along the separated branch to its fold, onto contact, and back along contact to its own."""
    grid = _grid(path, sorted((_approach(on), _approach(off))))
    separated = _states(path, grid[grid < _approach(on)], lambda s: s < on.point.arclength)
    contact = _states(path, grid[grid > _approach(off)], lambda s: s > off.point.arclength)
    contact = sorted([off, *contact, path.stages[-1]["pull_off"]], key=_approach)
    landed = [state for state in contact if _approach(state) > _approach(on) - USUAL.near]
    left = [state for state in separated if _approach(state) < _approach(off) + USUAL.near]
    return [
        *_run([*separated, on], "approaching", last="about to jump on"),
        *_run(landed, "loading", first="jumped on", last="turning back"),
        *_run(contact[-2::-1], "unloading", last="about to jump off"),
        *_run(left[::-1], "withdrawing", first="jumped off"),
    ]


def _run(states: Sequence[Located], words: str, *, first: str = "", last: str = "") -> list[Shot]:
    """Frames of states in turn, of which the first and the last may rest and have words of their own."""
    frames = [Shot(state, words) for state in states]
    for number, own in ((0, first), (-1, last)):
        if own and frames:
            frames[number] = replace(frames[number], words=own, seconds=USUAL.resting)
    return frames


def _grid(path: EquilibriumPath, folds: list[float]) -> Array:
    """Approaches in equal steps, nearly, with those of the folds, which ascend, among them."""
    pull_off = path.events["pull_off"].load
    low = _approach(path.states(Condition(LOAD, value=USUAL.faded * pull_off))[0])
    pressed = path.states(Condition(LOAD, value=USUAL.pressed * pull_off))
    ends = [low, *folds, _approach(pressed[-1]) if pressed else float(path.approach[-1])]
    step = 2 * (ends[-1] - ends[0]) / USUAL.frames
    parts = [np.linspace(a, b, int(np.ceil((b - a) / step)), endpoint=False) for a, b in pairwise(ends)]
    return np.concatenate([*parts, ends[-1:]])


def _states(path: EquilibriumPath, approaches: Array, kept: Callable[[float], bool]) -> list[Located]:
    """States at approaches whose arclength is kept."""
    found = [path.states(Condition(APPROACH, value=float(alpha))) for alpha in approaches]
    return [state for roots in found for state in roots if kept(state.point.arclength)]


def _images(curves: Curves, frames: Sequence[Shot], size: tuple[int, int]) -> Iterator[Pixels]:
    """Frames as they are shown; a state that is passed twice is solved for and drawn once."""
    scene = curves.question.scene
    every = {id(frame.state): frame.state for frame in frames}
    states = {key: state_at(scene, found.problem, found.point) for key, found in every.items()}
    view = view_of(list(states.values()))
    solids = {key: solid_image(state, view, size) for key, state in states.items()}
    for frame in frames:
        state = states[id(frame.state)]
        words = f"{contact_words(curves)}: {frame.words}", state_words(curves, state)
        canvas: Any = FigureCanvasAgg(composed(curves, solids[id(frame.state)], state, view, words))
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _with_one_palette(images: Sequence[Pixels]) -> Iterator[Image.Image]:
    """Images in the same few colours, so that none flickers; white stays white, which Pillow's own mapping changes."""
    colours = _colours(np.concatenate(images[:: max(1, len(images) // 8)]))[0]
    chosen = Image.fromarray(colours[None]).quantize(255, kmeans=3).getpalette()  # each colour counts once
    palette = np.append(np.array(chosen, np.uint8), np.full(3, 255, np.uint8)).reshape(-1, 3)
    nearest = KDTree(palette)
    for image in images:
        own, places = _colours(image)
        indexed = Image.fromarray(np.asarray(nearest.query(own)[1], np.uint8)[places].reshape(image.shape[:2]))
        indexed.putpalette(palette.tobytes())
        yield indexed


def _colours(image: Pixels) -> tuple[Pixels, Index]:
    """Colours (n, 3) of an image, each once, and which each pixel has."""
    packed, places = np.unique(image @ np.array([65536, 256, 1]), return_inverse=True)
    return np.asarray(packed[:, None] // np.array([65536, 256, 1]) % 256, np.uint8), places


def _approach(state: Located) -> float:
    return float(state.point.observables[APPROACH])
