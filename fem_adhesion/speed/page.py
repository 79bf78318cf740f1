"""The speed study on paper: a table of all rungs, error against wall time, and a page that says what accuracy costs.

A figure for each quantity has half-space and finite elements side by side, on log-log axes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from fem_adhesion.common import style
from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.page import Columns, Item, Table, markdown, said, write_csv
from fem_adhesion.common.record import lines_of
from fem_adhesion.common.style import Picture, captions, draw
from fem_adhesion.speed.methods import QUANTITIES, Method
from fem_adhesion.speed.study import (
    EXPONENTS,
    RTOL,
    TABOR,
    Earlier,
    Growth,
    SpeedStudy,
    Timing,
    best,
    cheapest,
    pareto_front,
)
from halfspace.errors import InputError

COLOURS = (style.ORANGE, style.SKY, style.GREEN, style.BLUE, style.RED, style.PINK)
STYLES = tuple(zip(COLOURS, "XPs^vD", strict=True))  # of the bases of a family; black dots are adaptive
LINES = {"": "-", "clamped": "--", "monolithic": ":"}
ROUND: dict[str, Any] = {"solid_capstyle": "round", "solid_joinstyle": "round"}
FRONT: dict[str, Any] = {"color": "0.85", "linewidth": 9, **ROUND, "zorder": 0, "drawstyle": "steps-post"}
BESIDE: dict[str, Any] = FRONT | {"color": "0.3", "linewidth": 1.5, "linestyle": (0, (6, 2, 1, 2)), "zorder": 1}
FLOOR: dict[str, Any] = {"color": "0.4", "linewidth": 1, "dashes": (1, 3)}
HIDDEN: dict[str, Any] = {"color": "0.4", "linestyle": "none", "marker": r"$\downarrow$", "markersize": 11}


def pictures(study: SpeedStudy) -> list[Picture[SpeedStudy]]:
    """A figure for each quantity that the study has."""
    return [
        Picture(
            q, said("speed", q, "title"), partial(error_against_time, quantity=q), lambda _: [said("speed", "figure")]
        )
        for q in study.quantities
    ]


def error_against_time(study: SpeedStudy, quantity: str) -> Figure:
    """Figure of one quantity: a panel for each family, with the Pareto front of both families behind.

    A method without this quantity has no line and no place in the legend; markers of what departs from the family's
    usual are hollow; an arrow downwards hangs on every error that is no more than the uncertainty of the truth.
    """
    figure = Figure(figsize=(11.5, 7.2), layout="constrained")
    figure.suptitle(said("speed", "figure", "title", quantity=said("speed", quantity, "title"), **run_words(study)))
    panels = figure.subplots(1, 2, sharex=True, sharey=True)

    def draw_rungs(
        axes: Any, rungs: Sequence[Timing], label: str, unit: float = 1.0, low: float = 1.0, **look: Any
    ) -> None:
        known = [rung for rung in rungs if np.isfinite(rung.error(quantity))]
        if known:
            seconds = [unit * rung.seconds for rung in known]
            axes.loglog(seconds, [low * rung.error(quantity) for rung in known], label=label, **look)

    for axes, family in zip(panels, study.truths, strict=True):
        draw_rungs(axes, pareto_front(study.rungs, quantity), "Pareto front, all methods", **FRONT)
        if study.earlier:
            front = pareto_front(study.earlier[1], quantity)
            draw_rungs(axes, front, "that of the earlier run, in yardsticks", study.yardstick, **BESIDE)
        axes.axhline(study.truths[family].floors[quantity], label="uncertainty of the truth", **FLOOR)
        methods = [method for method in study.methods if method.family == family]
        bases = dict.fromkeys(method.basis for method in methods if method.basis not in ("adaptive", "hp"))
        styles = dict(zip(bases, STYLES, strict=False))
        for method in methods:
            colour, marker = styles.get(method.basis, ("#000000", "o"))
            look: dict[str, Any] = {"color": colour, "marker": marker, "linestyle": LINES[method.variant]}
            face = "white" if method.variant else colour
            draw_rungs(axes, study.of(method.name), method.name, **look, markersize=7, markerfacecolor=face)
        hidden = [rung for method in methods for rung in study.of(method.name) if rung.hidden(quantity)]
        draw_rungs(axes, hidden, "within that uncertainty", low=0.75, **HIDDEN)
        axes.set_title(f"{family}, judged by the {study.truths[family].family}")
        axes.tick_params(labelleft=True)
        axes.xaxis.set_minor_formatter(NullFormatter())  # of less than two decades they print over each other
        label = said("speed", quantity, "error") if axes is panels[0] else ""
        style.dress(axes, "wall time from set-up to events, s", label, legend="below", columns=2)
    return figure


def write(study: SpeedStudy, directory: Path) -> None:
    """Write ``speed.csv``, ``growth.csv``, ``speed.md``, plots of each quantity, SVG and PNG, and their captions.

    Give it one made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none.
    """
    times = [
        (growth.solver, growth.grows, f"{x:g}", f"{seconds:.4f}", f"{seconds / study.yardstick:.0f}")
        for growth in study.growths
        for x, seconds in zip(growth.at, growth.seconds, strict=True)
    ]
    growth = Table("growth", "", "", ("solver", "grows", "at", "seconds", "yardsticks"), times)
    write_csv([_rungs(study), growth, captions(pictures(study), study)], directory)
    (directory / "speed.md").write_text("\n".join(markdown(list(parts(study)))) + "\n")
    draw(pictures(study), study, directory)


def run_words(study: SpeedStudy) -> dict[str, Any]:
    """Which run it was, for titles."""
    return {"tabor": study.tabor, "quick": ", quick run" if study.quick else ""}


NAMED: Columns[Timing] = {("method", "setting"): lambda rung: (rung.method, rung.setting)}
ENDED: Columns[Timing] = {("outcome", "reason"): lambda rung: (rung.status, rung.reason)}


def _rungs(study: SpeedStudy) -> Table:
    """Every rung; what is not known is left empty."""
    errors = tuple(f"{quantity}_{what}" for quantity in QUANTITIES for what in ("error", "truth_uncertainty"))
    columns: Columns[Timing] = {
        "tabor": lambda _: f"{study.tabor!r}",
        **NAMED,
        "unknowns": lambda rung: "" if rung.unknowns is None else str(rung.unknowns),
        "seconds": lambda rung: _number(rung.seconds, "{:.4f}"),
        "yardsticks": lambda rung: _number(rung.seconds / study.yardstick, "{:.0f}"),
        "peak_mebibytes": lambda rung: _number(rung.memory, "{:.1f}"),
        errors: lambda rung: [
            _number(value, "{:.3e}") for q in QUANTITIES for value in (rung.error(q), rung.floors.get(q, math.nan))
        ],
        **ENDED,
    }
    return Table.of("speed", "", "", study.rungs, columns)


def _number(value: float, form: str) -> str:
    return form.format(value) if math.isfinite(value) else ""


def parts(study: SpeedStudy) -> Iterator[str | Table]:
    """Lines and tables of the page."""
    yield "# Error against wall time at Tabor parameter {tabor:g}{quick}".format(**run_words(study))
    yield ""
    yield from verdict(study)
    yield ""
    yield from (f"* {key}: {value}" for key, value in (machine() | versions()).items())
    yield f"* yardstick, one dgesv of n = 200: {study.yardstick * 1e3:.2f} ms"
    yield _truths(study)
    yield from (_costs(study, quantity) for quantity in (None, *study.quantities))
    if study.earlier:
        yield from (_beside(study, study.earlier, quantity) for quantity in study.quantities)
    yield _exponents(study)
    yield _growths(study)
    yield _table("failures", (rung for rung in study.rungs if not rung.converged), {**NAMED, **ENDED})


def _table(name: str, items: Iterable[Item], columns: Columns[Item], **numbers: Any) -> Table:
    """Table of the page, which has no file of its own."""
    return Table.of("", said("speed", name, "title", **numbers), "", items, columns)


def verdict(study: SpeedStudy) -> Iterator[str]:
    """What the run was, and what failed that should not have; a sentence each."""
    rungs = sum(len(method.steps) for method in study.methods)
    solved = sum(rung.converged for rung in study.rungs)
    counted = f"{len(study.rungs)} of {rungs} rungs were climbed, {solved} have a result."
    yield f"A quick run: {counted} The finer ones were left out." if study.quick else counted
    troubles = list(study.troubles())
    if troubles:
        yield f"FAILED where it should not have, {len(troubles)} times:"
        yield from (f"* {trouble}" for trouble in troubles)


def _truths(study: SpeedStudy) -> Table:
    """What the errors are taken against, and whether the two truths agree."""
    judges = tuple(f"judge of the {judged}: {t.family}, rtol {t.rtol:.0e}" for judged, t in study.truths.items())
    both = {quantity: [truth.values[quantity] for truth in study.truths.values()] for quantity in study.quantities}
    columns: Columns[str] = {
        "quantity": str,
        "unit": lambda name: said("speed", name, "unit"),
        judges: lambda name: [f"{one.value:.12g}, error {one.error:.0e}" for one in both[name]],
        "difference": lambda name: f"{abs(both[name][0].value - both[name][1].value):.0e}",
        "within both errors": lambda name: "yes" if both[name][0].agrees(both[name][1]) else "NO",
    }
    return _table("truths", study.quantities, columns)


def _costs(study: SpeedStudy, quantity: str | None) -> Table:
    """One line per method: seconds to each tolerance, and the best that it reached."""

    def cost(method: Method, tolerance: float) -> str:
        rung = cheapest(study.of(method.name), tolerance, quantity)
        if rung is None:
            return "-"
        return f"{rung.seconds:.2f} s = {rung.seconds / study.yardstick:.0f} yardsticks ({rung.setting})"

    def reached(method: Method) -> str:
        rung = best(study.of(method.name), quantity)
        if rung is None:
            return "-"
        below = "<" * rung.hidden(quantity or rung.worst)
        return f"{below}{rung.error(quantity):.0e} in {rung.seconds:.2f} s ({rung.setting})"

    columns: Columns[Method] = {
        "method": lambda method: method.name,
        "to 1e-03": lambda method: cost(method, 1e-3),
        "to 1e-06": lambda method: cost(method, 1e-6),
        "best reached": reached,
    }
    return _table("costs", study.methods, columns, what=quantity or said("speed", "costs", "all"))


def _beside(study: SpeedStudy, earlier: Earlier, quantity: str) -> Table:
    """Yardsticks of the fastest method to each tolerance, of the earlier run and of this one."""
    name, known = earlier
    ours, rows = [replace(rung, seconds=rung.seconds / study.yardstick) for rung in study.rungs], []
    for tolerance in (10.0**-digits for digits in range(2, 9)):
        before, now = (cheapest(rungs, tolerance, quantity) for rungs in (known, ours))
        cells = [f"{rung.seconds:.0f} ({rung.method}, {rung.setting})" if rung else "-" for rung in (before, now)]
        ratio = f"{now.seconds / before.seconds:.2f}" if before and now else "-"
        rows.append([f"{tolerance:.0e}", *cells, ratio])
    title = said("speed", "beside", "title", quantity=quantity, name=name)
    return Table("", title, "", ("tolerance", "earlier", "now", "now / earlier"), rows)


def _exponents(study: SpeedStudy) -> Table:
    columns: Columns[Method] = {
        "method": lambda method: method.name,
        "rungs": lambda method: str(sum(rung.converged for rung in study.of(method.name))),
        EXPONENTS: lambda method: [_number(b, "{:.2f}") or "-" for b in study.exponents(method.name).values()],
    }
    return _table("exponents", study.methods, columns)


def _growths(study: SpeedStudy) -> Table:
    columns: Columns[Growth] = {
        ("solver", "x"): lambda growth: (growth.solver, growth.grows),
        "time": lambda growth: ", ".join(f"{s:.2f} s at {x:g}" for x, s in zip(growth.at, growth.seconds, strict=True)),
        "b": lambda growth: _number(growth.exponent, "{:.2f}") or "-",
        "b expected at most": lambda growth: f"{growth.expected:g}",
    }
    return _table("growths", study.growths, columns, tabor=TABOR, rtol=RTOL)


# An earlier run, read back from its table


def read_earlier(path: Path, tabor: float) -> Earlier:
    """Read ``speed.csv`` of an earlier run at the same Tabor parameter, or raise InputError."""
    columns, *lines = lines_of(path, "give speed.csv")
    rows = [dict(zip(columns, line, strict=True)) for line in lines]
    try:
        at = {float(row["tabor"]) for row in rows}
        rungs = [_rung(row) for row in rows if row["outcome"] == "converged"]
    except (KeyError, ValueError) as error:
        why = f"{type(error).__name__} {error}"
        raise InputError(said("speed", "earlier", "unread", path=path, why=why)) from None
    if not rungs or at != {tabor}:
        known = ", ".join(f"{t:g}" for t in sorted(at))
        raise InputError(said("speed", "earlier", "other", path=path, rungs=len(rungs), known=known, tabor=tabor))
    return str(path), rungs


def _rung(row: Mapping[str, str]) -> Timing:
    """Rung of a row of the table, where what is not known is empty."""
    told = [q for q in QUANTITIES if row[f"{q}_error"]]
    errors, floors = ({q: float(row[f"{q}_{what}"]) for q in told} for what in ("error", "truth_uncertainty"))
    yardsticks = float(row["yardsticks"])
    if not 0 < yardsticks < math.inf or not all(math.isfinite(error) for error in errors.values()):
        raise ValueError(f"{row['method']} at {row['setting']} has no time or no error")
    return Timing(row["method"], row["setting"], "converged", yardsticks, errors=errors, floors=floors)
