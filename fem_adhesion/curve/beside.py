"""Curves by several laws of equal work of adhesion and equal largest tension beside each other: how far they collapse.

With R, E*, dgamma and the largest tension s dgamma/eps held, s the strength of a law, eps is as s and Tabor's parameter
as 1/s. What all of them share are R dgamma for loads and beta^2/R = mu eps for approaches.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion import registry
from fem_adhesion.common import lines, style
from fem_adhesion.common.facts import plain
from fem_adhesion.common.jobs import Progress, unheard
from fem_adhesion.curve.solve import PAPER, Curves, trace
from fem_adhesion.scene import Scene
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import InputError
from halfspace.laws import Law
from halfspace.values import Estimate

LOOKS = (
    (style.BLUE, "-"),
    (style.RED, style.DASHED),
    (style.GREEN, style.CHAIN),
    (style.ORANGE, style.LONG),
    (style.PINK, "-"),
    (style.SKY, style.DASHED),
)
MARKERS = {"pull_off": "o", "jump_on": "^", "jump_off": "v"}
COMPARED = {
    "pull-off": [("pull_off", "load")],
    "jumps": [(name, quantity) for name in ("jump_on", "jump_off") for quantity in ("approach", "load")],
}


LawCurves = Sequence[tuple[Law, EquilibriumPath]]
"""Curves by several laws, all as strong as the first, which is what was asked."""


def apart(curves: LawCurves, subject: str) -> Estimate | None:
    """Largest relative difference from the first curve in the pull-off force or in the jumps, and its error.

    Of a load in the pull-off force, of an approach in the spacing and range of those of the first curve. None where
    one law's curve folds and another's does not, or none does.
    """
    (_, first), *others = curves
    found = [_difference(first, path, *what) for _, path in others for what in COMPARED[subject]]
    known = [one for one in found if one is not None]
    return max(known, key=lambda one: one.value) if known and len(known) == len(found) else None


def told(curves: LawCurves) -> str:
    """Which laws, and how far their curves collapse."""
    named = "; ".join(_name(law, path) for law, path in curves)
    parts = (f"{_told(apart(curves, subject))} in {subject}" for subject in COMPARED)
    return f"equally strong laws, {named}: curves differ by {', '.join(parts)} at most"


def record(curves: LawCurves) -> dict[str, Any]:
    """The laws with their Tabor parameters, and how far the curves are apart, as plain data."""
    laws = [{"law": plain(registry.record_of(law)), "tabor": path.tabor} for law, path in curves]
    return {"laws": laws, "largest_relative_difference": {name: plain(apart(curves, name)) for name in COMPARED}}


def _difference(first: EquilibriumPath, other: EquilibriumPath, name: str, quantity: str) -> Estimate | None:
    a, b = first.event(name), other.event(name)
    if a is None or b is None:
        return None
    ours, theirs = a.estimate(quantity), b.estimate(quantity)
    if quantity == "load":
        return abs(theirs - ours) / abs(first.events["pull_off"].load)
    size = first.approach_scale / first.tabor
    return abs(theirs / other.tabor - ours / first.tabor) / size  # approaches in the unit that all curves share


def _told(part: Estimate | None) -> str:
    if part is None:
        return "what cannot be told, as not all fold,"
    return f"{100 * part.value:.3g} +- {100 * part.error:.1g} %"


def _name(law: Law, path: EquilibriumPath) -> str:
    return f"{registry.words_of(law)} at tabor {path.tabor:.4g}"


def solve(curves: Curves, laws: Sequence[Law], progress: Progress = unheard) -> LawCurves:
    """Trace the curves by other laws, that `require` lets in, with the solver of the first, or raise NotConverged."""
    question, found = curves.question, [(curves.question.scene.law, curves.path)]
    for number, law in enumerate(laws):
        progress(registry.words_of(law), number, len(laws))
        tabor = question.scene.tabor * question.scene.law.strength / law.strength  # the same largest tension
        scene = replace(question.scene, law=law, tabor=tabor)
        found.append((law, trace(replace(question, scene=scene), curves.solver)))
    return found


def require(scene: Scene, laws: Sequence[Law]) -> None:
    """Refuse what cannot be laid beside each other, before any work."""
    if scene.sized or scene.radius_ratio:
        raise InputError(
            f"other_laws with body = {scene.body.name}, limit: a body and profile without R/eps; leave it out"
        )
    if len(laws) >= len(LOOKS):
        raise InputError(f"other_laws = {len(laws)} laws, limit: {len(LOOKS) - 1}; give fewer")


def draw(curves: LawCurves) -> Figure:
    """Loads against approaches in units that all share, and the laws, each with its largest tension as 1."""
    figure, (left, right) = style.panels(2, 5.6)
    frames = []
    for (color, dashes), (law, path) in zip(LOOKS, curves, strict=False):
        line, frame = lines.smooth(path), lines.around_events(path)
        x, (stable, unstable) = line.approach / path.tabor, line.stretches(line.load)
        look = {"color": color, "linewidth": 1.9}
        left.plot(x, stable, linestyle=dashes, label=_name(law, path), **look)
        left.plot(x, unstable, color=color, linewidth=1.1, linestyle=style.DOTTED)
        for name, marker in MARKERS.items():
            if event := path.event(name):
                left.plot(event.approach / path.tabor, event.load, marker, color=color, zorder=4)
        gaps = np.linspace(-0.4, 6.0, 1200) / law.strength
        gaps = gaps[gaps > -0.5]  # a law with a core has none below
        right.plot(gaps * law.strength, -law.pressure(gaps, 1.0) / law.strength, linestyle=dashes, **look)
        frames.append((*(value / path.tabor for value in frame.approach), *frame.load))
    low, high = np.min(frames, axis=0), np.max(frames, axis=0)
    approaches, loads = (low[0], high[1]), (low[2], high[3])
    style.dress(left, r"approach $\delta R/\beta^2$", PAPER["load"].label, legend=None, xlim=approaches, ylim=loads)
    left.plot([], [], color="0.3", linewidth=1.1, linestyle=style.DOTTED, label="unstable")
    style.dress(
        right, r"gap less its equilibrium, $\Delta\gamma/\sigma_\mathrm{max}$", "tension over the largest", legend=None
    )
    right.set_ylim(-1.0, 1.1)
    parts = [f"{_told(off)} in {subject}" for subject in COMPARED if (off := apart(curves, subject))]
    left.set_title(f"differ from the first by {', '.join(parts)} at most", loc="left", fontsize=9.5)
    right.set_title("laws of equal work and largest tension", loc="left", fontsize=9.5)
    style.legend_below(figure, [left], 2)
    return figure
