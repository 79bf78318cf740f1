"""One page about a curve: load against approach with its jumps, and the states at its events."""

from __future__ import annotations

from typing import Any, TextIO

from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.curve.load import draw_central_gap, draw_load
from fem_adhesion.curve.mesh import draw_mesh, is_drawn
from fem_adhesion.curve.profiles import STATES, draw_gap, draw_pressure, draw_spike
from fem_adhesion.curve.solve import FINITE_ELEMENTS, Curves

LOOK = {**style.LOOK, "font.size": 9.5}
SIZE = (7.3, 10.0)  # inches


def write(curves: Curves, file: TextIO, form: str) -> None:
    """Write the page to a file, in a format of `fem_adhesion.common.style.require_suffix`."""
    style.write(lambda: draw(curves), file, form, LOOK)


def has_mesh(curves: Curves) -> bool:
    """Whether the page shows the mesh, and not the central gap."""
    return curves.solver == FINITE_ELEMENTS and is_drawn(curves.question.scene)


def states(curves: Curves) -> list[str]:
    """Names of the events whose profiles the page shows."""
    return [look.words for name, look in STATES.items() if curves.path.event(name)]


def named(figure: Figure) -> list[str]:
    """What the legend of the page's curve names."""
    legend = figure.axes[0].get_legend()
    return [text.get_text() for text in legend.get_texts()] if legend else []


def draw(curves: Curves) -> Figure:
    """Page with the curve on top, the profiles of its states, the edge spike, and the mesh or the central gap."""
    figure = Figure(figsize=SIZE, layout="constrained")
    rows = [["load", "load"], ["pressure", "gap"], ["spike", "body"]]
    areas: dict[str, Any] = figure.subplot_mosaic(rows, height_ratios=[1.6, 1, 1])  # type: ignore[arg-type]
    painters = {
        "load": draw_load,
        "pressure": draw_pressure,
        "gap": draw_gap,
        "spike": draw_spike,
        "body": draw_mesh if has_mesh(curves) else draw_central_gap,
    }
    for letter, (name, paint) in zip("abcde", painters.items(), strict=True):
        words = paint(areas[name], curves)
        areas[name].set_title(f"({letter}) {words}", loc="left", fontsize=9.5)
    return figure
