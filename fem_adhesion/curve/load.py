"""Load and central gap against approach: branches by stability, folds, jumps, load lines, and the closed theories."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_adhesion.common import lines, style
from fem_adhesion.common.lines import Frame, Line
from fem_adhesion.common.numbers import engineering
from fem_adhesion.curve.settings import USUAL
from fem_adhesion.curve.solve import Curves
from fem_adhesion.scene import Scene
from halfspace.equilibrium.devices import reaching
from halfspace.laws import LENNARD_JONES
from halfspace.profiles import Paraboloid, Sphere
from halfspace.profiles.indentation import jkr_approach, jkr_load
from halfspace.scaling import MAUGIS
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Array

KINDS: Mapping[int, dict[str, Any]] = {
    lines.STABLE: {"color": style.BLUE, "linewidth": 2.4, "linestyle": "-"},
    lines.GRIPS_ONLY: {"color": style.SKY, "linewidth": 2.4, "linestyle": style.DASHED},
    lines.UNSTABLE: {"color": style.RED, "linewidth": 1.8, "linestyle": style.DOTTED},
}
THEORIES: Mapping[str, dict[str, Any]] = {
    "JKR": {"color": "0.35", "linewidth": 1.1, "linestyle": style.LONG, "zorder": 1.5},
    "Bradley": {"color": "0.55", "linewidth": 1.1, "linestyle": style.CHAIN, "zorder": 1.5},
    "Maugis-Dugdale": {"color": style.PINK, "linewidth": 1.3, "linestyle": "-", "zorder": 1.4},
}
LEGEND = {"fontsize": 8, "handlelength": 3.2, "framealpha": 0.9, "edgecolor": "none"}
GRIPS: dict[str, Any] = {"color": "black", "linestyle": "-"}
APPARATUS: dict[str, Any] = {"color": style.GREEN, "linestyle": "-"}


@dataclass(frozen=True)
class Look:
    """How a state is drawn: its name, and what tells it from the others."""

    words: str
    color: str
    linestyle: Any
    marker: str


STATES: Mapping[str, Look] = {
    "jump_on": Look("jump on", style.GREEN, style.CHAIN, "^"),
    "jump_off": Look("jump off", style.RED, style.DASHED, "v"),
    "pull_off": Look("pull-off", style.BLUE, "-", "o"),
    "zero_load": Look("zero load", style.ORANGE, style.LONG, "D"),
}


def draw_load(axes: Any, curves: Curves) -> str:
    """Load against approach, with the events enlarged where they would be hard to see; returns the title."""
    highest = min(float(curves.path.load.max()), curves.question.to_load)
    _draw_frame(axes, curves, lines.frame(curves.path, highest))
    style.dress(axes, curves.scales["approach"].label, curves.scales["load"].label, legend=None)
    below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.15), "ncols": 4, "columnspacing": 1.2}
    axes.legend(handles=_seen(axes), **below, **LEGEND | {"handlelength": 2.5})
    close = lines.around_events(curves.path)
    if highest > 3 * close.load[1]:
        inset = axes.inset_axes((0.08, 0.4, 0.42, 0.5))
        _draw_frame(inset, curves, close)
        inset.tick_params(labelsize=7.5)
        inset.set_title("enlarged around the events", fontsize=8)
    body, finite = curves.question.scene.body, curves.question.scene.material.finite
    named = "" if body.endless else f", {body.file.name if body.file else body.name}"
    return f"{contact_words(curves)}{named}{' at finite strain' if finite else ''}; {curves.solver}"


def _seen(axes: Any) -> list[Any]:
    """What has a name and is inside the frame; arrows are, of which the named line has no points."""
    low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
    named = {line: line.get_xydata() for line in axes.get_legend_handles_labels()[0]}
    return [line for line, at in named.items() if not len(at) or np.any(np.all((low <= at) & (at <= high), axis=1))]


def _draw_frame(axes: Any, curves: Curves, frame: Frame) -> None:
    for name, (approach, load) in _theories(curves.question.scene, frame):
        axes.plot(*curves.shown(approach=approach, load=load), label=name, **THEORIES[name])
    line = lines.smooth(reaching(curves.path, curves.question.stiffness))
    draw_line(axes, curves, line)
    _draw_other(axes, curves)
    draw_states(axes, curves)
    _draw_jumps(axes, curves, frame)
    limit(axes, curves, frame)


def limit(axes: Any, curves: Curves, frame: Frame) -> None:
    """Let axes show a frame, with a line at no load."""
    axes.axhline(0, color="0.8", linewidth=0.7, zorder=0)
    xlim, ylim = curves.shown(approach=np.array(frame.approach), load=np.array(frame.load))
    axes.set(xlim=xlim, ylim=ylim)


def _draw_other(axes: Any, curves: Curves) -> None:
    """The half-space beside the finite elements: points on the same contact, a line for another."""
    if curves.other is None:
        return
    if not curves.question.scene.left_out:
        look: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 4, "markerfacecolor": "white"}
        look |= {"color": "black", "markeredgewidth": 0.8, "zorder": 4, "markevery": 0.04}  # of the diagonal
        approach, load = curves.other.approach, curves.other.load
    else:
        line = lines.smooth(curves.other)
        approach, load = line.approach, line.load
        look = {"color": style.ORANGE, "linewidth": 1.5, "linestyle": style.CHAIN, "zorder": 1.8}
    axes.plot(*curves.shown(approach=approach, load=load), label="half-space", **look)


def draw_line(axes: Any, curves: Curves, line: Line, quantity: str = "load") -> None:
    """A quantity against approach, by stability."""
    for kind, values in line.parts(getattr(line, quantity)):
        at = curves.shown(approach=line.approach, **{quantity: values})
        axes.plot(*at, label=lines.KINDS[kind], **KINDS[kind])


def draw_states(axes: Any, curves: Curves, quantity: str = "load") -> None:
    """Markers at the events whose profiles are shown, and of the load at the folds."""
    approach, load = lines.folds(curves.path).T
    if approach.size and quantity == "load":
        square = {"linestyle": "none", "marker": "|", "markersize": 13, "color": "black", "zorder": 4.5}
        axes.plot(*curves.shown(approach=approach, load=load), label="fold", **square)
    for name, look in STATES.items():
        if event := curves.path.event(name):
            marker = {"linestyle": "none", "marker": look.marker, "markersize": 6.5, "color": look.color, "zorder": 5}
            marker |= {"markeredgecolor": "black", "markeredgewidth": 0.7}
            marker |= {"label": look.words} if quantity == "load" else {}
            at = curves.shown(approach=event.approach, **{quantity: getattr(event, quantity)})
            axes.plot(*at, **marker)


def _draw_jumps(axes: Any, curves: Curves, frame: Frame) -> None:
    """Arrows of the jumps, under fixed grips and along the load lines of an apparatus."""
    for cycle, look in ((curves.grips, GRIPS), (curves.apparatus, APPARATUS)):
        jumps = cycle.jumps if cycle else {}
        ends = [[(state.approach, state.load) for state in jump.ends] for jump in jumps.values()]
        seen = list(filter(None, (_clipped(tail, head, frame) for tail, head in ends)))
        for both in seen:
            tail, head = ((*curves.shown(approach=approach, load=load),) for approach, load in both)
            style.arrow(axes, tail, head, linewidth=1.4, mutation_scale=11, **look)
        if cycle and seen:
            k, units, words = cycle.stiffness, curves.question.units, "jumps under fixed grips"
            if math.isfinite(k):
                words = f"jumps, $k = {k:g}\\,R\\Delta\\gamma/\\epsilon$"
                words = f"jumps, $k$ = {engineering(k * units.stiffness, 'N/m')}" if units else words
            axes.plot([], [], label=words, linewidth=1.4, **look)
    # Lines of slope -k, the loads that an apparatus exerts with its base held where it jumps.
    for jump in curves.apparatus.jumps.values() if curves.apparatus else ():
        across, down = curves.shown(approach=1.0, load=-curves.question.stiffness)
        at = curves.shown(approach=jump.take_off.approach, load=jump.take_off.load)
        line = {"color": style.GREEN, "linewidth": 0.8, "linestyle": style.DASHED, "zorder": 1.2}
        axes.axline(at, slope=down / across, **line)


def _clipped(tail: style.Point, head: style.Point, frame: Frame) -> tuple[style.Point, style.Point] | None:
    """Ends of the part of an arrow that is inside the frame, or None if it is outside."""
    first, last = 0.0, 1.0
    for start, end, (low, high) in zip(tail, head, (frame.approach, frame.load), strict=True):
        if start == end:
            continue
        crossings = sorted(((low - start) / (end - start), (high - start) / (end - start)))
        first, last = max(first, crossings[0]), min(last, crossings[1])
    ends = [(tail[0] + t * (head[0] - tail[0]), tail[1] + t * (head[1] - tail[1])) for t in (first, last)]
    return (ends[0], ends[1]) if first < last else None


def _theories(scene: Scene, frame: Frame) -> Iterator[tuple[str, tuple[Array, Array]]]:
    """Approach and load of the closed theories on a half-space under the profile, inside a frame; of layers the rigid.

    Maugis's is that of a paraboloid, and matched with the 3-9 law.
    """
    scales, surface, tabor = scene.scales, scene.surface, scene.tabor
    a = np.linspace(1e-3, min(1.3 * scales.widest_radius(frame.load[1]), 0.99 * surface.end), USUAL.samples)
    if scene.body.layered is None:
        yield "JKR", (tabor * jkr_approach(surface, a), jkr_load(surface, a))
    apart = np.linspace(frame.approach[0], min(0.6, frame.approach[1]), USUAL.samples)
    yield "Bradley", (apart, np.array([scales.rigid_load(value) for value in apart.tolist()]))
    matched = scene.law == LENNARD_JONES and isinstance(scene.shape, Paraboloid | Sphere)
    if scene.body.layered is None and matched and 1e-6 <= MAUGIS.of(tabor) <= 1e6:
        # From where its attraction reaches across, through the disc of tension, to contact.
        theory = MaugisDugdale.matched(tabor)
        c = np.linspace(0, theory.touching_radius, USUAL.samples)
        approach = np.concatenate([theory.separated_approach(c), theory.approach(a)])
        yield "Maugis-Dugdale", (approach, np.concatenate([theory.separated_load(c), theory.load(a)]))


def contact_words(curves: Curves) -> str:
    """Tabor parameter, and the radius of the sphere where it has one."""
    scene, units = curves.question.scene, curves.question.units
    size = f"$R$ = {engineering(units.radius, 'm')}, " if units else ""
    ratio = f", $R/\\epsilon$ = {scene.radius_ratio:.4g}" if scene.radius_ratio else ""
    return f"{size}$\\mu$ = {scene.tabor:.4g}{ratio}"


def draw_central_gap(axes: Any, curves: Curves) -> str:
    """Central gap against approach, along which the unstable branch is easiest to follow; returns the title."""
    line, x, y = lines.smooth(curves.path), curves.scales["approach"], curves.scales["central_gap"]
    draw_line(axes, curves, line, "central_gap")
    draw_states(axes, curves, "central_gap")
    left, right = lines.around_events(curves.path).approach
    style.dress(axes, x.label, y.label, legend=None, xlim=(x.size * left, x.size * right))
    top = 1.1 * float(line.central_gap[line.approach > left].max())
    axes.set_ylim(-0.15 * top * y.size, top * y.size)
    axes.legend(loc="upper right", **LEGEND)
    return "central gap"
