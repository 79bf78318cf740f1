"""A figure as data: axes, lines, and what is to be seen in them. What is drawn is what its CSV file holds.

Each Tabor parameter and each theory has a look of its own; a figure shows no two Tabor parameters in the same look.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from fem_adhesion.common import style
from fem_adhesion.common.numbers import told
from fem_adhesion.common.page import Table
from fem_adhesion.common.style import BLUE, CHAIN, DASHED, DOTTED, GREEN, LONG, ORANGE, PINK, RED, SKY
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Jump
from halfspace.equilibrium.states import States
from halfspace.values import Array, Valued

Look = Mapping[str, Any]
OF_TABOR = {
    0.02: SKY, 0.05: SKY, 0.1: BLUE, 0.2: GREEN, 0.5: ORANGE, 0.7: SKY, 1.0: RED, 2.0: BLUE, 3.0: PINK, 5.0: GREEN,
}  # fmt: skip
DASHES_OF_TABOR = dict(zip(OF_TABOR, ("-", "-", DASHED, CHAIN, LONG, DASHED, "-", DASHED, CHAIN, LONG), strict=True))
THEORIES: Mapping[str, Look] = {
    "Bradley": {"color": "black", "linestyle": DOTTED, "linewidth": 1.8},
    "JKR": {"color": "black", "linestyle": DASHED, "linewidth": 1.5},
    "Hertz": {"color": "0.45", "linestyle": CHAIN, "linewidth": 1.5},
    "DMT-M": {"color": "black", "linestyle": LONG, "linewidth": 1.1},
    "DMT force method": {"color": PINK, "linestyle": DASHED, "linewidth": 1.5},
    "DMT thermodynamic": {"color": RED, "linestyle": CHAIN, "linewidth": 1.5},
}
MARKS: Look = {"linestyle": "none", "marker": "o", "markersize": 5, "markerfacecolor": "white"}
HALF_SPACE, ELEMENTS = "half-space", "finite elements"


@dataclass(frozen=True)
class Axis:
    """What is along an axis: quantity and unit, which name the column of the file, and the label.

    The unit is in words joined by underscores, empty if there is none; limits are those of the picture, in that unit.
    """

    quantity: str
    unit: str
    label: str
    limits: tuple[float, float] | None = None
    ticks: Sequence[float] = ()
    logarithmic: bool = False

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns of its values and of their errors."""
        return tuple("_".join(filter(None, (name, self.unit))) for name in (self.quantity, f"{self.quantity}_error"))

    def within(self, low: float, high: float) -> Axis:
        """The same, of which this range is shown."""
        return replace(self, limits=(low, high))

    def values(self, states: EquilibriumPath | States, tabor: float) -> tuple[Array, Array]:
        """Numbers of states along the axis, and their errors, (n,) arrays."""
        size = {"mu_eps": tabor, "2_pi_R_dgamma": 2 * math.pi}.get(self.unit, 1.0)
        names = self.quantity, f"{self.quantity}_error"
        value, error = (np.atleast_1d(getattr(states, name)) / size for name in names)
        return value, error


LOAD = Axis("load", "R_dgamma", r"load $W/R\Delta\gamma$")
LOAD_OF_RIGID = Axis("load", "2_pi_R_dgamma", r"load $W/2\pi R\Delta\gamma$")
APPROACH = Axis("approach", "eps", r"approach $\alpha^*$")
SCALED_APPROACH = Axis("approach", "mu_eps", r"scaled approach $\alpha^*/\mu$")
CENTRAL_GAP = Axis("central_gap", "eps", r"central gap $H(0)$")
CONTACT_RADIUS = Axis("contact_radius", "beta", r"contact radius $a^* = a/\beta$")
RADIUS = Axis("radius", "beta", r"radius $u = r/\beta$")
TABOR = Axis("tabor", "", r"Tabor parameter $\mu$", logarithmic=True)


@dataclass(frozen=True, eq=False, repr=False)
class Line(Valued):
    """A line of a figure: whose it is, at which Tabor parameter if it belongs to one, and its points, (n,) arrays.

    Errors are those of computed numbers; of closed theories there are none. What is `dotted`, a mask (n,), is unstable
    under fixed grips. `label` is that of the legend, where that differs from the name; empty if it has none there.
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

    @property
    def key(self) -> str:
        """What the legend says of it."""
        if self.label is not None:
            return self.label
        mu = "" if self.tabor is None else rf"$\mu = {self.tabor:g}$"
        return mu if self.curve == HALF_SPACE and mu else ", ".join(filter(None, (self.curve, mu)))


@dataclass(frozen=True)
class Arrow:
    """An arrow from point to point, in the units of the axes."""

    tail: tuple[float, float]
    head: tuple[float, float]
    look: Look


@dataclass(frozen=True)
class Note:
    """A text beside a point, offset in points."""

    text: str
    at: tuple[float, float]
    offset: tuple[float, float] = (7.0, 2.0)


@dataclass(frozen=True, eq=False, repr=False)
class Plot(Valued):
    """A figure: what is drawn, and sentences on what is to be seen; empty ones are left out.

    The legend is at a place of Matplotlib's, or below. `above` is another scale of the horizontal axis: its label, and
    the factor to it.
    """

    x: Axis
    y: Axis
    lines: Sequence[Line]
    see: Sequence[str] = ()
    arrows: Sequence[Arrow] = ()
    notes: Sequence[Note] = ()
    title: str = ""
    legend: str = "upper left"
    above: tuple[str, float] | None = None


def points(curve: str, states: EquilibriumPath | States, tabor: float, x: Axis, y: Axis, look: Look = MARKS) -> Line:
    """States of a curve, as markers unless they look otherwise."""
    (u, u_error), (v, v_error) = x.values(states, tabor), y.values(states, tabor)
    return Line(curve, tabor, u, v, {"color": OF_TABOR[tabor], **look}, u_error, v_error)


def half_space(path: EquilibriumPath, x: Axis, y: Axis) -> Line:
    """A computed curve; stretches that are unstable under fixed grips are dotted."""
    look = {"linestyle": DASHES_OF_TABOR[path.tabor], "linewidth": 1.9}
    return replace(points(HALF_SPACE, path, path.tabor, x, y, look), dotted=~path.stable)


def theory(name: str, x: Array, y: Array, tabor: float | None = None, **look: Any) -> Line:
    """Curve of a closed theory, in the units of the axes."""
    return Line(name, tabor, x, y, {**THEORIES.get(name, {}), **look})


def ends(name: str, tabor: float, jump: Jump, look: Look, label: str = "") -> tuple[Line, Arrow]:
    """A jump as a line and as the arrow over it."""
    columns = [(s.approach, s.load, s.approach_error, s.load_error) for s in jump.ends]
    approach, load, dx, dy = np.transpose(columns)
    line = Line(name, tabor, approach, load, look, dx, dy, label=label)
    return line, Arrow(columns[0][:2], columns[1][:2], look)


# What becomes of a plot


def drawn(plot: Plot) -> Figure:
    """Picture of a plot."""
    figure, (axes,) = style.panels(height=5.8)
    for line in plot.lines:
        _draw(axes, line)
    if any(line.dotted is not None and np.any(line.dotted) for line in plot.lines):
        axes.plot([], [], color="0.3", linewidth=1.9, linestyle=DOTTED, label="unstable under fixed grips")
    for arrow in plot.arrows:
        style.arrow(axes, arrow.tail, arrow.head, **arrow.look)
    for note in plot.notes:
        style.note(axes, note.text, note.at, note.offset, weight="bold")
    if plot.above:
        label, factor = plot.above
        axes.secondary_xaxis("top", functions=(lambda x: x * factor, lambda x: x / factor)).set_xlabel(label)
    for axis, name in ((plot.x, "x"), (plot.y, "y")):
        if axis.logarithmic:
            axes.set(**{f"{name}scale": "log"})
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
    """Largest distance of points from a polygon, where that is, in units of their width and height."""
    at, corners = (np.stack([one.x, one.y])[:, np.isfinite(one.x) & np.isfinite(one.y)] for one in (points, line))
    if corners.shape[1] < 2:
        return math.nan
    low, high = corners.min(axis=1)[:, None], corners.max(axis=1)[:, None]
    at = at[:, np.all((at >= low) & (at <= high), axis=0)]
    if at.size == 0:
        return math.nan
    size = np.maximum(np.ptp(at, axis=1), 1e-12)[:, None]
    at, corners = at / size, corners / size
    start, step = corners[:, :-1], np.diff(corners)
    length = np.maximum(np.sum(step**2, axis=0), 1e-30)
    offsets = at[:, :, None] - start[:, None]
    t = np.clip(np.sum(offsets * step[:, None], axis=0) / length, 0, 1)
    return float(np.hypot(*(offsets - t * step[:, None])).min(axis=1).max())
