"""A figure as data: axes, lines, and what is to be seen in them. What is drawn is what its CSV file holds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from fem_adhesion.common import style
from fem_adhesion.common.numbers import told
from fem_adhesion.common.page import Table
from fem_adhesion.common.style import DOTTED
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.values import Array, States, Valued

Look = Mapping[str, Any]
Note = tuple[str, tuple[float, float]] | tuple[str, tuple[float, float], tuple[float, float]]
"""A text, the point beside which it stands, and its offset in points."""
HALF_SPACE, ELEMENTS = "half-space", "finite elements"


@dataclass(frozen=True)
class Axis:
    """What is along an axis: quantity and unit, which name the column of the file, and the label.

    The unit is in words joined by underscores, empty if there is none; limits are those of the picture, in that unit.
    """

    quantity: str
    unit: str
    label: str
    limits: tuple[float, ...] = ()
    ticks: Sequence[float] = ()
    logarithmic: bool = False

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns of its values and of their errors."""
        return tuple("_".join(filter(None, (name, self.unit))) for name in (self.quantity, f"{self.quantity}_error"))

    def size(self, tabor: float) -> float:
        """The unit in the paper's own: eps, beta, R dgamma."""
        return {"mu_eps": tabor, "2_pi_R_dgamma": 2 * math.pi}.get(self.unit, 1.0)

    def values(self, states: EquilibriumPath | States, tabor: float) -> tuple[Array, Array]:
        """Numbers of states along the axis, and their errors, (n,) arrays."""
        names = self.quantity, f"{self.quantity}_error"
        value, error = (np.atleast_1d(getattr(states, name)) / self.size(tabor) for name in names)
        return value, error


@dataclass(frozen=True, eq=False, repr=False)
class Line(Valued):
    """A line of a figure: whose it is, at which Tabor parameter if it belongs to one, and its points, (n,) arrays.

    Errors are those of computed numbers; of closed theories there are none. What is `dotted`, a mask (n,), is unstable
    under fixed grips. `label` is that of the legend, where that differs from the name; empty if it has none there. An
    `arrow` leads from its first point to its second.
    """

    curve: str
    tabor: float | None
    x: Array
    y: Array
    look: Look
    x_error: Array | None = None
    y_error: Array | None = None
    dotted: NDArray[np.bool_] | None = None
    label: str | None = None
    arrow: bool = False

    @property
    def key(self) -> str:
        """What the legend says of it."""
        if self.label is not None:
            return self.label
        mu = "" if self.tabor is None else rf"$\mu = {self.tabor:g}$"
        return mu if self.curve == HALF_SPACE and mu else ", ".join(filter(None, (self.curve, mu)))


@dataclass(frozen=True, eq=False, repr=False)
class Plot(Valued):
    """A figure: what is drawn, and sentences on what is to be seen; empty ones are left out.

    The legend is at a place of Matplotlib's, or below. `above` is another scale of the horizontal axis: its label, and
    the factor to it.
    """

    x: Axis
    y: Axis
    lines: Sequence[Line] = ()
    see: Sequence[str] = ()
    notes: Sequence[Note] = ()
    title: str = ""
    legend: str = "upper left"
    above: tuple[str, float] | None = None


# What becomes of a plot


def drawn(plot: Plot) -> Figure:
    """Picture of a plot."""
    figure, (axes,) = style.panels(height=5.8)
    for line in plot.lines:
        _draw(axes, line)
    if any(line.dotted is not None and np.any(line.dotted) for line in plot.lines):
        axes.plot([], [], color="0.3", linewidth=1.9, linestyle=DOTTED, label="unstable under fixed grips")
    for line in (line for line in plot.lines if line.arrow):
        style.arrow(axes, *zip(line.x, line.y, strict=True), **line.look)
    for text, at, *offset in plot.notes:
        style.note(axes, text, at, *(offset or [(7.0, 2.0)]), weight="bold")
    if plot.above:
        label, factor = plot.above
        axes.secondary_xaxis("top", functions=(lambda x: x * factor, lambda x: x / factor)).set_xlabel(label)
    for axis, name in ((plot.x, "x"), (plot.y, "y")):
        axes.set(**{f"{name}scale": "log" if axis.logarithmic else "linear"})
        if axis.limits:
            axes.set(**{f"{name}lim": axis.limits})
        if axis.ticks:
            style.plain_ticks(getattr(axes, f"{name}axis"), axis.ticks)
    style.dress(axes, plot.x.label, plot.y.label, legend=plot.legend)
    axes.set_title(plot.title)
    return figure


def _draw(axes: Any, line: Line) -> None:
    """Line as a whole, or in two: a stable part, and a dotted one that joins it."""
    if line.dotted is None:
        axes.plot(line.x, line.y, label=line.key or None, **line.look)
        return
    for mask, label, look in ((~line.dotted, line.key, {}), (line.dotted, None, {"linestyle": DOTTED})):
        joins = mask | np.append(False, mask[:-1])
        axes.plot(line.x, np.where(joins, line.y, np.nan), label=label, **{**line.look, **look})


def table(stem: str, title: str, plot: Plot) -> Table:
    """Points of a plot: whose they are, their Tabor parameter, both numbers, and their errors where there are any."""
    (x, dx), (y, dy) = plot.x.columns, plot.y.columns
    rows = [row for line in plot.lines for row in _rows(line)]
    known = [n for n in range(len(COMMON) + 4) if n < len(COMMON) + 2 or any(row[n] for row in rows)]
    columns = (*COMMON, x, y, dx, dy)
    return Table(stem, title, "", [columns[n] for n in known], [[row[n] for n in known] for row in rows])


COMMON = ("curve", "mu")  # columns of every file of a figure


def _rows(line: Line) -> Iterator[list[str]]:
    """Rows of a line; points that are no numbers, such as a radius without contact, are left out."""
    mu = "" if line.tabor is None else f"{line.tabor:g}"
    nothing = np.full(np.shape(line.x), np.nan)
    x_error, y_error = (nothing if error is None else error for error in (line.x_error, line.y_error))
    for x, y, *errors in zip(line.x, line.y, x_error, y_error, strict=True):
        if np.isfinite(x) and np.isfinite(y):
            shown = [f"{error:.1e}" if np.isfinite(error) else "" for error in errors]
            yield [line.curve, mu, f"{x:.10g}", f"{y:.10g}", *shown]


# What is to be seen


def elements_beside(lines: Sequence[Line]) -> str:
    """How far finite-element points lie from the half-space's curve at the same Tabor parameter."""
    curves = {line.tabor: line for line in lines if line.curve == HALF_SPACE}
    off = [_farthest(line, curves[line.tabor]) for line in lines if line.curve == ELEMENTS]
    text = f"Finite-element points are within {max(off, default=0):.1e} of the lines, in units of their extent."
    return told(text, np.array(off))


def _farthest(points: Line, line: Line) -> float:
    """Largest distance of points from a line, where that is, in units of their width and height."""
    at, along = (np.stack([one.x, one.y])[:, np.isfinite(one.x) & np.isfinite(one.y)] for one in (points, line))
    low, high = (end(along, axis=1, initial=init)[:, None] for end, init in ((np.min, np.inf), (np.max, -np.inf)))
    at = at[:, np.all((at >= low) & (at <= high), axis=0)]
    if not at.size:
        return math.nan
    n, size = along.shape[1], np.maximum(np.ptp(at, axis=1), 1e-12)
    finer = [np.interp(np.linspace(0, n - 1, 100 * n), np.arange(n), values) for values in along]
    return float(cdist(at.T / size, np.transpose(finer) / size).min(axis=1).max())
