"""The speed study on paper: a table of all rungs, error against wall time, and a page that says what accuracy costs.

A figure for each quantity has half-space and finite elements side by side, on log-log axes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.page import Table, markdown, write_csv
from fem_adhesion.common.style import Picture, draw
from fem_adhesion.speed.methods import QUANTITIES, Family, Method
from fem_adhesion.speed.result import EXPONENTS, Earlier, SpeedStudy, Timing, best, cheapest, pareto_front
from fem_adhesion.speed.study import RTOL, TABOR

CAPTION = "Error against wall time: half-space left, finite elements right."
FAMILIES: tuple[Family, ...] = ("half-space", "finite elements")
TITLES = {
    "pull_off": "Pull-off load",
    "jump_on": "Approach at which the surfaces jump on",
    "hysteresis": "Energy lost in a cycle of approach and separation",
}
ERRORS = {
    "pull_off": "relative error of the pull-off load",
    "jump_on": "error of the jump-on approach, over spacing and range of approaches",
    "hysteresis": "relative error of the energy lost",
}
COLOURS = (style.ORANGE, style.SKY, style.GREEN, style.BLUE, style.RED, style.PINK)  # black is adaptive
STYLES = tuple(zip(COLOURS, "XPs^vD", strict=True))
ADAPTIVE = {"adaptive": ("#000000", "o"), "hp": ("#000000", "o")}
LINES = {"": "-", "clamped": "--", "monolithic": ":"}
FRONT: dict[str, Any] = {
    "color": "0.85",
    "linewidth": 9,
    "solid_capstyle": "round",
    "solid_joinstyle": "round",
    "zorder": 0,
}
BESIDE: dict[str, Any] = {"color": "0.3", "linewidth": 1.5, "linestyle": (0, (6, 2, 1, 2)), "zorder": 1}
FLOOR: dict[str, Any] = {"color": "0.4", "linewidth": 1, "dashes": (1, 3)}
HIDDEN: dict[str, Any] = {"color": "0.4", "linestyle": "none", "marker": r"$\downarrow$", "markersize": 11}


def pictures(study: SpeedStudy) -> list[Picture[SpeedStudy]]:
    """A figure for each quantity that the study has."""
    return [
        Picture(quantity, TITLES[quantity], partial(error_against_time, quantity=quantity), lambda _: [CAPTION])
        for quantity in study.quantities
    ]


def error_against_time(study: SpeedStudy, quantity: str) -> Figure:
    """Figure of one quantity: a panel for each family, with the Pareto front of both families behind.

    A method without this quantity has no line and no place in the legend; an arrow downwards hangs on every error that
    is no more than the uncertainty of the truth.
    """
    figure = Figure(figsize=(11.5, 7.2), layout="constrained")
    quick = ", quick run" if study.quick else ""
    figure.suptitle(f"{TITLES[quantity]}: error against wall time at Tabor parameter {study.tabor:g}{quick}")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes, family in zip(panels, FAMILIES, strict=True):
        _draw_front(axes, pareto_front(study.rungs, quantity), quantity, 1.0, "Pareto front, all methods", FRONT)
        if study.earlier:
            front = pareto_front(study.earlier.rungs, quantity)
            _draw_front(axes, front, quantity, study.yardstick, "that of the earlier run, in yardsticks", BESIDE)
        axes.axhline(study.uncertainty(family, quantity), label="uncertainty of the truth", **FLOOR)
        for method in study.methods:
            if method.family == family:
                _draw_method(axes, study, method, quantity)
        _draw_hidden(axes, study, family, quantity)
        _dress(axes, f"{family}, judged by the {study.truths[family].family}")
    panels[0].set_ylabel(ERRORS[quantity])
    return figure


def _draw_front(
    axes: Any, front: Sequence[Timing], quantity: str, unit: float, label: str, look: dict[str, Any]
) -> None:
    """A line behind the points that no other beats in both time, in units of so many seconds, and error."""
    if not front:
        return
    seconds, errors = [unit * rung.seconds for rung in front], [rung.error(quantity) for rung in front]
    axes.loglog(seconds, errors, label=label, drawstyle="steps-post", **look)


def _draw_method(axes: Any, study: SpeedStudy, method: Method, quantity: str) -> None:
    """One method's ladder; markers of what departs from the family's usual are hollow."""
    rungs = [rung for rung in study.of(method.name) if np.isfinite(rung.error(quantity))]
    if not rungs:
        return
    colour, marker = _style(study, method)
    axes.loglog(
        [rung.seconds for rung in rungs],
        [rung.error(quantity) for rung in rungs],
        LINES[method.variant],
        color=colour,
        marker=marker,
        markersize=7,
        markerfacecolor="white" if method.variant else colour,
        label=method.name,
    )


def _draw_hidden(axes: Any, study: SpeedStudy, family: Family, quantity: str) -> None:
    """Arrows at the errors that the truth cannot tell."""
    names = {method.name for method in study.methods if method.family == family}
    hidden = [rung for rung in study.rungs if rung.method in names and rung.hidden(quantity)]
    if hidden:
        places = [rung.seconds for rung in hidden], [0.75 * rung.error(quantity) for rung in hidden]
        axes.loglog(*places, label="within that uncertainty", **HIDDEN)


def _style(study: SpeedStudy, method: Method) -> tuple[str, str]:
    """Colour and marker, the same for all variants of a basis."""
    bases = dict.fromkeys(m.basis for m in study.methods if m.family == method.family and m.basis not in ADAPTIVE)
    return ADAPTIVE.get(method.basis) or STYLES[list(bases).index(method.basis)]


def _dress(axes: Any, title: str) -> None:
    axes.set_title(title)
    axes.tick_params(labelleft=True)
    style.dress(axes, "wall time from set-up to events, s", axes.get_ylabel(), legend="below", columns=2)


TOLERANCES = (1e-3, 1e-6)
GROWTH_COLUMNS = ("solver", "grows", "at", "seconds", "yardsticks")
UNITS = {"pull_off": "R dgamma", "jump_on": "eps", "hysteresis": "R dgamma eps"}
COLUMNS = ("tabor", "method", "setting", "unknowns", "seconds", "yardsticks", "peak_mebibytes")
ERROR_COLUMNS = tuple(f"{quantity}_{what}" for quantity in QUANTITIES for what in ("error", "truth_uncertainty"))


def write(study: SpeedStudy, directory: Path) -> None:
    """Write ``speed.csv``, ``growth.csv``, ``speed.md`` and plots of each quantity, SVG and PNG, into a directory.

    Give it one made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none.
    """
    rows = [[f"{study.tabor!r}", *_cells(rung, study.yardstick)] for rung in study.rungs]
    write_csv(Table("speed", "", "", (*COLUMNS, *ERROR_COLUMNS, "outcome", "reason"), rows), directory)
    write_csv(Table("growth", "", "", GROWTH_COLUMNS, list(_growth_cells(study))), directory)
    (directory / "speed.md").write_text("\n".join(markdown(list(parts(study)))) + "\n")
    draw(pictures(study), study, directory)


def _cells(rung: Timing, yardstick: float) -> list[str]:
    """Row of the table; what is not known is left empty."""
    errors = [
        _number(value, "{:.3e}")
        for quantity in QUANTITIES
        for value in (rung.error(quantity), rung.floors.get(quantity, math.nan))
    ]
    return [
        rung.method,
        rung.setting,
        "" if rung.unknowns is None else str(rung.unknowns),
        _number(rung.seconds, "{:.4f}"),
        _number(rung.seconds / yardstick, "{:.0f}"),
        _number(rung.memory, "{:.1f}"),
        *errors,
        rung.status,
        rung.reason,
    ]


def _number(value: float, form: str) -> str:
    return form.format(value) if math.isfinite(value) else ""


def parts(study: SpeedStudy) -> Iterator[str | Table]:
    """Lines and tables of the page."""
    yield f"# Error against wall time at Tabor parameter {study.tabor:g}{', quick run' if study.quick else ''}"
    yield ""
    yield from verdict(study)
    yield ""
    yield from (f"* {key}: {value}" for key, value in (machine() | versions()).items())
    yield f"* yardstick, one dgesv of n = 200: {study.yardstick * 1e3:.2f} ms"
    yield _truths(study)
    yield _costs(study, "What it costs to have every quantity that a method gives", None)
    yield from (_costs(study, f"What it costs to have {quantity}", quantity) for quantity in study.quantities)
    if study.earlier:
        yield from (_beside(study, study.earlier, quantity) for quantity in study.quantities)
    yield _exponents(study)
    yield _growths(study)
    failures = [(rung.method, rung.setting, rung.status, rung.reason) for rung in study.rungs if not rung.converged]
    yield Table("", "Rungs without result", "", ("method", "setting", "outcome", "reason"), failures)


def verdict(study: SpeedStudy) -> Iterator[str]:
    """What the run was, and what failed that should not have; a sentence each."""
    rungs = sum(len(method.steps) for method in study.methods)
    counted = (
        f"{len(study.rungs)} of {rungs} rungs were climbed, {sum(r.converged for r in study.rungs)} have a result."
    )
    yield f"A quick run: {counted} The finer ones were left out." if study.quick else counted
    troubles = list(study.troubles())
    if troubles:
        yield f"FAILED where it should not have, {len(troubles)} times:"
        yield from (f"* {trouble}" for trouble in troubles)


def _truths(study: SpeedStudy) -> Table:
    """What the errors are taken against, and whether the two truths agree."""
    title = "The truths: each family is judged by the other; an error below the truth's own uncertainty is shown as <"
    columns = [
        f"judge of the {judged}: {truth.family}, rtol {truth.rtol:.0e}" for judged, truth in study.truths.items()
    ]
    rows = []
    for quantity in study.quantities:
        a, b = (truth.values[quantity] for truth in study.truths.values())
        cells = [f"{estimate.value:.12g}, error {estimate.error:.0e}" for estimate in (a, b)]
        rows.append(
            [quantity, UNITS[quantity], *cells, f"{abs(a.value - b.value):.0e}", "yes" if a.agrees(b) else "NO"]
        )
    return Table("", title, "", ("quantity", "unit", *columns, "difference", "within both errors"), rows)


def _costs(study: SpeedStudy, title: str, quantity: str | None) -> Table:
    """One line per method: seconds to each tolerance, and the best that it reached."""
    rows = []
    for method in study.methods:
        rungs = study.of(method.name)
        cells = [_cost(cheapest(rungs, tolerance, quantity), study) for tolerance in TOLERANCES]
        rows.append([method.name, *cells, _best(best(rungs, quantity), quantity)])
    columns = ("method", *(f"to {tolerance:.0e}" for tolerance in TOLERANCES), "best reached")
    return Table("", title, "", columns, rows)


def _cost(rung: Timing | None, study: SpeedStudy) -> str:
    if rung is None:
        return "-"
    return f"{rung.seconds:.2f} s = {rung.seconds / study.yardstick:.0f} yardsticks ({rung.setting})"


def _best(rung: Timing | None, quantity: str | None) -> str:
    named = quantity or (rung.worst if rung else None)
    if rung is None or named is None:
        return "-"
    below = "<" if rung.hidden(named) else ""
    return f"{below}{rung.error(named):.0e} in {rung.seconds:.2f} s ({rung.setting})"


DECADES = tuple(10.0**-digits for digits in range(2, 9))


def _beside(study: SpeedStudy, earlier: Earlier, quantity: str) -> Table:
    """Yardsticks of the fastest method to each tolerance, of the earlier run and of this one."""
    rows = []
    for tolerance in DECADES:
        before, now = (cheapest(rungs, tolerance, quantity) for rungs in (earlier.rungs, study.rungs))
        costs = before.seconds if before else math.nan, now.seconds / study.yardstick if now else math.nan
        cells = [
            f"{cost:.0f} ({rung.method}, {rung.setting})" if rung else "-"
            for cost, rung in zip(costs, (before, now), strict=True)
        ]
        rows.append([f"{tolerance:.0e}", *cells, _number(costs[1] / costs[0], "{:.2f}") or "-"])
    title = (
        f"The front of {quantity} beside that of {earlier.name}: yardsticks of the fastest method, each of its own run"
    )
    return Table("", title, "", ("tolerance", "earlier", "now", "now / earlier"), rows)


def _exponents(study: SpeedStudy) -> Table:
    title = "How the cost grows: exponents b fitted to cost ~ x^b; the error is that of pull_off"
    fitted = {method.name: study.exponents(method.name) for method in study.methods}
    rows = [
        [
            name,
            str(sum(rung.converged for rung in study.of(name))),
            *(_number(b, "{:.2f}") or "-" for b in found.values()),
        ]
        for name, found in fitted.items()
    ]
    return Table("", title, "", ("method", "rungs", *EXPONENTS), rows)


def _growths(study: SpeedStudy) -> Table:
    title = (
        "How the time of the solvers with error control grows: exponents b of time ~ x^b, 0 where only the logarithm "
        f"of x counts; at a Tabor parameter of {TABOR:g} and an rtol of {RTOL:.0e}, unless they are what grows"
    )
    rows = [
        [
            growth.solver,
            growth.grows,
            ", ".join(f"{seconds:.2f} s at {x:g}" for x, seconds in zip(growth.at, growth.seconds, strict=True)),
            _number(growth.exponent, "{:.2f}") or "-",
            f"{growth.expected:g}",
        ]
        for growth in study.growths
    ]
    return Table("", title, "", ("solver", "x", "time", "b", "b expected at most"), rows)


def _growth_cells(study: SpeedStudy) -> Iterator[list[str]]:
    for growth in study.growths:
        for x, seconds in zip(growth.at, growth.seconds, strict=True):
            yield [growth.solver, growth.grows, f"{x:g}", f"{seconds:.4f}", f"{seconds / study.yardstick:.0f}"]
