"""The chart of the finite sphere: where in the plane of Tabor parameter and R/eps the half-space errs by how much.

Drawn are contours of that error, with real materials placed among them. Along R/eps at each Tabor parameter the
deviation is a power law between neighbouring points, or where its sign changes linear in ln(R/eps). A contour is the
largest R/eps at which the deviation has a given size, above which it is smaller.

Of the materials the work of adhesion and the Hamaker constant A are what is known. The spacing of the surface law
follows, eps^2 = A/(16 pi dgamma), so that law and source have the same attraction from afar: 0.14 to 0.15 nm, near the
cut-off D0 = 0.165 nm between two continua and not the diameter of an atom, of which the law between planes knows
nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.common.page import data_rows, said
from fem_adhesion.common.style import Picture
from fem_adhesion.finite_sphere.cases import CRITICAL
from fem_adhesion.finite_sphere.study import Study
from fem_adhesion.finite_sphere.table import DRAWN, SHOWN, DeviationRow, borders
from halfspace.limits import SMALLEST_SPHERE
from halfspace.scaling import Units, contact_modulus, spacing_of
from halfspace.values import Array, Estimate

# The plane


def in_plane(rows: Iterable[DeviationRow], quantity: str, poisson: float | None) -> list[DeviationRow]:
    """Whole deviations of a quantity at a Poisson's ratio, over the plane of Tabor parameter and R/eps."""
    return [r for r in rows if (r.cause, r.quantity, r.poisson) == ("all", quantity, poisson) and r.radius_ratio]


def contour(plane: Sequence[DeviationRow], level: float) -> tuple[Array, Array]:
    """Tabor parameters (m,), and R/eps at which a deviation has a level; nan if no neighbours have it between."""
    tabors = sorted({row.tabor for row in plane})
    ratios = [_last_crossing([row for row in plane if row.tabor == mu], level) for mu in tabors]
    return np.array(tabors), np.array(ratios)


def _last_crossing(plane: Sequence[DeviationRow], level: float) -> float:
    known = sorted(
        (row.radius_ratio, row.deviation.value) for row in plane if row.known and row.radius_ratio and row.deviation
    )
    ratio, y = np.reshape(known, (-1, 2)).T
    x, size = np.log(ratio), np.abs(y)
    crossed = np.flatnonzero((size[:-1] >= level) & (size[1:] < level))
    if not crossed.size or size[-1] >= level:
        return np.nan
    i = crossed[-1]
    a, b, goal = (y[i], y[i + 1], np.sign(y[i]) * level) if y[i] * y[i + 1] <= 0 else np.log([*size[i : i + 2], level])
    return float(np.exp(x[i] + (x[i + 1] - x[i]) * (goal - a) / (b - a)))


def safe_from(plane: Sequence[DeviationRow], level: float) -> float:
    """Least R/eps of the points from which on all deviations are known to be below a level; nan if the last are not.

    Tabor parameters without any deviation, as those without jumps, do not count.
    """
    known = {row.tabor for row in plane if row.known}
    counted = {(row.radius_ratio or 0.0, row.within(level)) for row in plane if row.tabor in known}
    above = max((ratio for ratio, safe in counted if not safe), default=0.0)
    return min((ratio for ratio, _ in counted if ratio > above), default=math.nan)


def materials() -> Iterator[tuple[str, Units]]:
    """Elastic spheres against a rigid wall, of ``data/materials.csv``: what each is, and how large; its units.

    These have the Tabor parameter, R/eps and the Hamaker constant. The file says where the values are from.
    """
    for line in data_rows("finite_sphere", "materials.csv"):
        poisson, adhesion = float(line["poisson"]), float(line["work_of_adhesion_J_per_m2"])
        modulus = contact_modulus(float(line["young_Pa"]), poisson)
        units = Units(float(line["radius_m"]), modulus, adhesion, spacing_of(float(line["hamaker_J"]), adhesion))
        yield line["name"], units


# The chart

LEFT, RIGHT = 0.028, 25.0  # Tabor parameters of the chart's edges
BOTTOM, TOP = 4.0, 2e5  # R/eps of its edges

LINES: Mapping[float, tuple[str, Any, float, str]] = {  # relative deviations of the contours, and how they look
    0.1: (style.RED, "-", 2.6, "0.80"),
    0.01: (style.BLUE, style.DASHED, 2.2, "0.90"),
    0.001: ("black", style.DOTTED, 2.0, "0.96"),
}
WHITE = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
UNSOLVED: Mapping[str, tuple[str, str]] = {  # by how a contact ended: marker, and what it means
    "ContactTooWide": ("x", "no solution: contact as wide as the sphere"),
    "left out": ("_", rf"not tried: $R < {SMALLEST_SPHERE**0.5:g}\,\beta$"),
    "died": ("X", "not solved: its process died"),
}
ENDED = {"solved", "absent"}  # endings that are not marked
MARKERS: Mapping[str, tuple[str, str]] = {
    "silica": ("o", style.BLUE),
    "gold": ("s", style.ORANGE),
    "mica": ("^", style.GREEN),
    "polystyrene": ("D", style.PINK),
    "toner": ("P", style.RED),
    "PDMS": ("v", "black"),
}


def chart(study: Study) -> Figure:
    """Draw the contours of 0.1, 1 and 10 % for the pull-off force and for the jump-on approach, side by side.

    Above them stands what to know of the whole, as that a part was not solved.
    """
    figure, panels = style.panels(2, height=7.4)
    for axes, quantity in zip(panels, DRAWN, strict=True):
        title = f"half-space's error of the {SHOWN[quantity]}"
        axes.set(xscale="log", yscale="log", xlim=(LEFT, RIGHT), ylim=(BOTTOM, TOP), title=title)
        plane = in_plane(study.rows, quantity, study.poisson)
        _contours(axes, plane)
        _points(axes, plane)
        _materials(axes)
        style.plain_ticks(axes.xaxis, (0.1, 0.3, 1, 3, 10))
        axes.set(xlabel=r"Tabor parameter $\mu$", ylabel=r"radius over spacing $R/\epsilon$", axisbelow=True)
        axes.grid(True, color="0.9", linewidth=0.6)
    _no_jump(panels[1], _begun(study))
    if study.quick or study.failed:
        figure.suptitle(study.headline, fontsize=10.5, color="0.25")
    style.legend_below(figure, panels, columns=5)
    return figure


def _contours(axes: Any, plane: Sequence[DeviationRow]) -> None:
    """Contours, each with its error beside its right end."""
    for level, (colour, dashes, width, shade) in LINES.items():
        tabor, ratio = contour(plane, level)
        known = np.flatnonzero(np.isfinite(ratio))
        if not known.size:
            continue
        axes.fill_between(tabor, BOTTOM, ratio, color=shade, linewidth=0, zorder=level - 1)
        look = {"color": colour, "linestyle": dashes, "linewidth": width, "marker": "_", "markersize": 7}  # if alone
        axes.plot(tabor, ratio, **look, label=f"{100 * level:g} %")
        at = float(tabor[known[-1]]), float(ratio[known[-1]])
        style.note(axes, f"{100 * level:g} %", at, (5, -3), color=colour, fontweight="bold", bbox=WHITE)


def _points(axes: Any, plane: Sequence[DeviationRow]) -> None:
    """Dots where the deviation was solved for, and a marker at every point that was not, by how it ended."""
    marked = {"solved": (".", 4, [row for row in plane if row.known])}
    for ending in sorted({row.ending for row in plane} - ENDED):
        marker, label = UNSOLVED.get(ending, ("*", f"not solved: {ending}"))
        marked[label] = marker, 7, [row for row in plane if row.ending == ending]
    for label, (marker, size, points) in marked.items():
        if points:
            at = [row.tabor for row in points], [row.radius_ratio for row in points]
            axes.plot(*at, marker, color="0.4", markersize=size, zorder=1.8, label=label)


def _begun(study: Study) -> list[tuple[float, Estimate]]:
    """R/eps, ascending and infinite of the half-space, and Tabor parameters from which on they jump."""
    here = [border for border in borders(study.records) if border.case.poisson in (None, study.poisson)]
    begun = [(one.case.radius_ratio or np.inf, tabor) for one in here if (tabor := one.values.get(CRITICAL))]
    return sorted(begun, key=itemgetter(0))


def _no_jump(axes: Any, begun: Sequence[tuple[float, Estimate]]) -> None:
    """Shade where the contact was found not to jump."""
    spheres = [(tabor.value, ratio) for ratio, tabor in begun if np.isfinite(ratio)]
    if not spheres:
        return
    tabor, ratio = np.transpose(spheres)
    axes.fill_betweenx(ratio, LEFT, tabor, color="0.97", linewidth=0, zorder=-2)
    axes.plot(tabor, ratio, color="0.4", linewidth=1.2, marker="|", zorder=1.7, label="jumps begin, fixed grips")
    style.note(axes, "no jump", spheres[-1], (-6, -12), ha="right", color="0.35")


def _materials(axes: Any) -> None:
    """Points with their sizes: of beads beside them, of tips at the left edge, an arrow beyond the right edge."""
    for name, sizes in groupby(materials(), key=lambda material: material[0].split(",")[0]):
        listed = list(sizes)
        marker, colour = MARKERS[name]
        look = {"marker": marker, "color": colour, "markeredgecolor": "black", "markersize": 8, "linewidth": 0.9}
        inside = [units for _, units in listed if units.tabor < RIGHT]
        if inside:
            axes.plot([u.tabor for u in inside], [u.radius_ratio for u in inside], label=name, zorder=3, **look)
        for which, units in listed:
            mu, rho, radius = units.tabor, units.radius_ratio, units.radius
            size = f"{1e9 * radius:g} nm" if radius < 1e-6 else f"{1e6 * radius:g} µm"
            if mu > RIGHT:
                arrow = {"arrowstyle": "-|>", "color": "black"}
                text = f"{name}, {size},\n" rf"$\mu = {mu:.0f}$"
                place = {"xytext": (-104, 0), "textcoords": "offset points", "va": "center", "fontsize": 9.5}
                axes.annotate(text, (RIGHT, rho), arrowprops=arrow, **place)
            elif "tip" not in which:
                style.note(axes, size, (mu, rho), (7, 4), zorder=4)
            elif name == "silica":
                axes.text(LEFT * 1.06, rho, size, color="0.25", fontsize=9.5, va="center")


def _caption(study: Study) -> Iterator[str]:
    """What is to be seen; of where the jumps begin, the smallest sphere, the largest, and the half-space."""
    planes = [in_plane(study.rows, quantity, study.poisson) for quantity in DRAWN]
    crossed = any(np.isfinite(contour(plane, level)[1]).any() for plane in planes for level in LINES)
    levels = ", ".join(f"{100 * level:g}" for level in LINES)
    yield said("finite_sphere", "chart", "lines" if crossed else "no_lines", levels=levels)
    begun = {ratio: plus_minus(tabor) for ratio, tabor in _begun(study)}
    spheres = [ratio for ratio in begun if np.isfinite(ratio)]
    shown = [f"{begun[ratio]} at R/eps = {ratio:g}" for ratio in dict.fromkeys(spheres[:1] + spheres[-1:])]
    shown += [f"{tabor} on the half-space" for ratio, tabor in begun.items() if np.isinf(ratio)]
    if shown:
        yield f"Jumps under fixed grips begin at mu = {', '.join(shown)}."
    if any(row.ending not in ENDED for plane in planes for row in plane):
        yield said("finite_sphere", "chart", "unsolved")
    yield said("finite_sphere", "chart", "materials")


def no_sphere(study: Study) -> str:
    """What is lacking where no sphere was solved, or empty."""
    solved = study.samples("all", "pull_off_load").size
    return "" if solved else "no elastic sphere was solved beside the half-space"


CHART = Picture("chart", said("finite_sphere", "chart", "title"), chart, _caption, no_sphere)
