"""A movie of an experiment under fixed grips: up to the wall, onto it, pressed, pulled and off, stable states only."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from itertools import pairwise
from typing import Any, TextIO

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image
from scipy.spatial import KDTree

from fem_adhesion.curve.load import contact_words
from fem_adhesion.curve.solve import Curves
from fem_adhesion.curve.still import composed, state_words
from fem_adhesion.fields import state_at
from fem_adhesion.paraview.picture import Pixels, solid_image, view_of
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError
from halfspace.values import Array, Index

SIZE = (800, 500)  # of a frame in pixels
FRAMES = 48  # of a movie, about
FADED = 0.04  # load at which the movie begins, in that of pull-off
PRESSED = -0.25  # load at which the wall turns back, in that of pull-off
MOVING, RESTING = 0.1, 0.9  # seconds for which a frame is shown while the wall moves, and at turns and jumps
COLOURS, SAMPLED = 256, 8  # colours of the movie's palette, and frames it is made for
WHITE = np.array([255, 255, 255], np.uint8)  # the background
PACKED = np.array([65536, 256, 1])  # by which the parts of a colour make one number
REPEATED = 3  # times that colours of the palette are moved to the middle of those that they stand for
NEAR = 1e-6  # difference of approaches in eps that is none


@dataclass(frozen=True)
class Shot:
    """A state that is shown, what is said of it, and for how many seconds."""

    state: Located
    words: str
    seconds: float = MOVING


def write_movie(curves: Curves, file: TextIO, size: tuple[int, int] = SIZE) -> None:
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

    They end at the loads `FADED` and `PRESSED`, or where the path does.
    """
    found, loop = path.stages[-1], cycle(path)
    if loop and len(loop.jumps) > 2:
        raise InputError(f"movie of {len(loop.jumps)} jumps, limit: one on and one off; take --render")
    frames = _jumping(path, found["jump_on"], found["jump_off"]) if "jump_on" in found else _smooth(path)
    back = max(number for number, frame in enumerate(frames) if frame.state is found["pull_off"])
    frames[back] = replace(frames[back], words="pull-off", seconds=RESTING)
    return frames


def _smooth(path: EquilibriumPath) -> list[Shot]:
    contact = _contact(path, _states(path, _grid(path, []), lambda _: True))
    return _run(contact, "approaching", last="turning back") + _run(contact[-2::-1], "withdrawing")


def _jumping(path: EquilibriumPath, on: Located, off: Located) -> list[Shot]:
    """Along the separated branch to its fold, onto contact, and back along contact to its own."""
    grid = _grid(path, sorted((_approach(on), _approach(off))))
    separated = _states(path, grid[grid < _approach(on)], lambda s: s < on.point.arclength)
    contact = _states(path, grid[grid > _approach(off)], lambda s: s > off.point.arclength)
    contact = _contact(path, [off, *contact])
    landed = [state for state in contact if _approach(state) > _approach(on) - NEAR]
    left = [state for state in separated if _approach(state) < _approach(off) + NEAR]
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
            frames[number] = replace(frames[number], words=own, seconds=RESTING)
    return frames


def _contact(path: EquilibriumPath, states: Sequence[Located]) -> list[Located]:
    """States in contact with that of the pull-off force, by ascending approach."""
    return sorted([*states, path.stages[-1]["pull_off"]], key=_approach)


def _grid(path: EquilibriumPath, folds: list[float]) -> Array:
    """Approaches in equal steps, nearly, with those of the folds, which ascend, among them."""
    pull_off = path.events["pull_off"].load
    low = _approach(path.states(Condition(LOAD, value=FADED * pull_off))[0])
    pressed = path.states(Condition(LOAD, value=PRESSED * pull_off))
    ends = [low, *folds, _approach(pressed[-1]) if pressed else float(path.approach[-1])]
    step = 2 * (ends[-1] - ends[0]) / FRAMES
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
    """Images in the same few colours, so that none flickers; white stays white."""
    some = np.concatenate(images[:: max(1, len(images) // SAMPLED)])
    palette = _palette(some)
    nearest = KDTree(palette)
    for image in images:
        colours, places = np.unique(image @ PACKED, return_inverse=True)
        numbers = nearest.query(_unpacked(colours))[1].astype(np.uint8)
        indexed = Image.fromarray(np.take(numbers, places).reshape(image.shape[:2]))
        indexed.putpalette(palette.tobytes())
        yield indexed


def _palette(image: Pixels) -> Pixels:
    """Colours (n, 3) for an image, in which each of its own counts once, however little there is of it."""
    every = _unpacked(np.unique(image @ PACKED))
    chosen = Image.fromarray(every[None]).quantize(COLOURS - 1, kmeans=REPEATED).getpalette()
    return np.append(np.array(chosen, np.uint8), WHITE).reshape(-1, 3)


def _unpacked(colours: Index) -> Pixels:
    """Red, green and blue (n, 3) of colours that are one number each."""
    return np.asarray(colours[:, None] // PACKED % 256, np.uint8)


def _approach(state: Located) -> float:
    return float(state.point.observables[APPROACH])
