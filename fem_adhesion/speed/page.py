"""The speed study on paper: a table of all rungs, error against wall time, and a page that says what accuracy costs.

A figure for each quantity has half-space and finite elements side by side, on log-log axes.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from fem_adhesion.common import style
from fem_adhesion.common.facts import machine, versions
from fem_adhesion.common.page import Columns, Table, markdown, write_csv
from fem_adhesion.common.style import Picture, captions, draw
from fem_adhesion.speed.methods import QUANTITIES, Family, Method
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
UNITS = {"pull_off": "R dgamma", "jump_on": "eps", "hysteresis": "R dgamma eps"}
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
    caption = "Error against wall time: half-space left, finite elements right."
    return [
        Picture(quantity, TITLES[quantity], partial(error_against_time, quantity=quantity), lambda _: [caption])
        for quantity in study.quantities
    ]


def error_against_time(study: SpeedStudy, quantity: str) -> Figure:
    """Figure of one quantity: a panel for each family, with the Pareto front of both families behind.

    A method without this quantity has no line and no place in the legend; markers of what departs from the family's
    usual are hollow; an arrow downwards hangs on every error that is no more than the uncertainty of the truth.
    """
    figure = Figure(figsize=(11.5, 7.2), layout="constrained")
    quick = ", quick run" if study.quick else ""
    figure.suptitle(f"{TITLES[quantity]}: error against wall time at Tabor parameter {study.tabor:g}{quick}")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)

    def draw_rungs(
        axes: Any, rungs: Sequence[Timing], label: str, unit: float = 1.0, low: float = 1.0, **look: Any
    ) -> None:
        known = [rung for rung in rungs if np.isfinite(rung.error(quantity))]
        if known:
            seconds = [unit * rung.seconds for rung in known]
            axes.loglog(seconds, [low * rung.error(quantity) for rung in known], label=label, **look)

    for axes, family in zip(panels, FAMILIES, strict=True):
        draw_rungs(axes, pareto_front(study.rungs, quantity), "Pareto front, all methods", **FRONT)
        if study.earlier:
            front = pareto_front(study.earlier.rungs, quantity)
            draw_rungs(axes, front, "that of the earlier run, in yardsticks", study.yardstick, **BESIDE)
        axes.axhline(study.uncertainty(family, quantity), label="uncertainty of the truth", **FLOOR)
        methods = [method for method in study.methods if method.family == family]
        bases = dict.fromkeys(method.basis for method in methods if method.basis not in ("adaptive", "hp"))
        styles = dict(zip(bases, STYLES, strict=False))
        for method in methods:
            colour, marker = styles.get(method.basis, ("#000000", "o"))
            look: dict[str, Any] = {
                "color": colour,
                "marker": marker,
                "markersize": 7,
                "linestyle": LINES[method.variant],
            }
            look["markerfacecolor"] = "white" if method.variant else colour
            draw_rungs(axes, study.of(method.name), method.name, **look)
        hidden = [rung for method in methods for rung in study.of(method.name) if rung.hidden(quantity)]
        draw_rungs(axes, hidden, "within that uncertainty", low=0.75, **HIDDEN)
        axes.set_title(f"{family}, judged by the {study.truths[family].family}")
        axes.tick_params(labelleft=True)
        axes.xaxis.set_minor_formatter(NullFormatter())  # of less than two decades they print over each other
        label = ERRORS[quantity] if axes is panels[0] else ""
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


def _rungs(study: SpeedStudy) -> Table:
    """Every rung; what is not known is left empty."""
    errors = tuple(f"{quantity}_{what}" for quantity in QUANTITIES for what in ("error", "truth_uncertainty"))
    columns: Columns[Timing] = {
        "tabor": lambda _: f"{study.tabor!r}",
        "method": lambda rung: rung.method,
        "setting": lambda rung: rung.setting,
        "unknowns": lambda rung: "" if rung.unknowns is None else str(rung.unknowns),
        "seconds": lambda rung: _number(rung.seconds, "{:.4f}"),
        "yardsticks": lambda rung: _number(rung.seconds / study.yardstick, "{:.0f}"),
        "peak_mebibytes": lambda rung: _number(rung.memory, "{:.1f}"),
        errors: lambda rung: [
            _number(value, "{:.3e}") for q in QUANTITIES for value in (rung.error(q), rung.floors.get(q, math.nan))
        ],
        "outcome": lambda rung: rung.status,
        "reason": lambda rung: rung.reason,
    }
    return Table.of("speed", "", "", study.rungs, columns)


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
    failures: Columns[Timing] = {
        "method": lambda rung: rung.method,
        "setting": lambda rung: rung.setting,
        "outcome": lambda rung: rung.status,
        "reason": lambda rung: rung.reason,
    }
    yield Table.of("", "Rungs without result", "", (rung for rung in study.rungs if not rung.converged), failures)


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
    title = "The truths: each family is judged by the other; an error below the truth's own uncertainty is shown as <"
    judges = tuple(f"judge of the {judged}: {t.family}, rtol {t.rtol:.0e}" for judged, t in study.truths.items())
    both = {quantity: [truth.values[quantity] for truth in study.truths.values()] for quantity in study.quantities}
    columns: Columns[str] = {
        "quantity": str,
        "unit": lambda name: UNITS[name],
        judges: lambda name: [f"{one.value:.12g}, error {one.error:.0e}" for one in both[name]],
        "difference": lambda name: f"{abs(both[name][0].value - both[name][1].value):.0e}",
        "within both errors": lambda name: "yes" if both[name][0].agrees(both[name][1]) else "NO",
    }
    return Table.of("", title, "", study.quantities, columns)


def _costs(study: SpeedStudy, title: str, quantity: str | None) -> Table:
    """One line per method: seconds to each tolerance, and the best that it reached."""

    def cost(method: Method, tolerance: float) -> str:
        rung = cheapest(study.of(method.name), tolerance, quantity)
        if rung is None:
            return "-"
        return f"{rung.seconds:.2f} s = {rung.seconds / study.yardstick:.0f} yardsticks ({rung.setting})"

    def reached(method: Method) -> str:
        rung = best(study.of(method.name), quantity)
        named = quantity or (rung.worst if rung else None)
        if rung is None or named is None:
            return "-"
        return f"{'<' * rung.hidden(named)}{rung.error(named):.0e} in {rung.seconds:.2f} s ({rung.setting})"

    columns: Columns[Method] = {
        "method": lambda method: method.name,
        "to 1e-03": lambda method: cost(method, 1e-3),
        "to 1e-06": lambda method: cost(method, 1e-6),
        "best reached": reached,
    }
    return Table.of("", title, "", study.methods, columns)


def _beside(study: SpeedStudy, earlier: Earlier, quantity: str) -> Table:
    """Yardsticks of the fastest method to each tolerance, of the earlier run and of this one."""
    rows = []
    for tolerance in (10.0**-digits for digits in range(2, 9)):
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
    columns: Columns[Method] = {
        "method": lambda method: method.name,
        "rungs": lambda method: str(sum(rung.converged for rung in study.of(method.name))),
        EXPONENTS: lambda method: [_number(b, "{:.2f}") or "-" for b in study.exponents(method.name).values()],
    }
    title = "How the cost grows: exponents b fitted to cost ~ x^b; the error is that of pull_off"
    return Table.of("", title, "", study.methods, columns)


def _growths(study: SpeedStudy) -> Table:
    title = (
        "How the time of the solvers with error control grows: exponents b of time ~ x^b, 0 where only the logarithm "
        f"of x counts; at a Tabor parameter of {TABOR:g} and an rtol of {RTOL:.0e}, unless they are what grows"
    )
    columns: Columns[Growth] = {
        "solver": lambda growth: growth.solver,
        "x": lambda growth: growth.grows,
        "time": lambda growth: ", ".join(f"{s:.2f} s at {x:g}" for x, s in zip(growth.at, growth.seconds, strict=True)),
        "b": lambda growth: _number(growth.exponent, "{:.2f}") or "-",
        "b expected at most": lambda growth: f"{growth.expected:g}",
    }
    return Table.of("", title, "", study.growths, columns)


# An earlier run, read back from its table


def read_earlier(path: Path, tabor: float) -> Earlier:
    """Read ``speed.csv`` of an earlier run at the same Tabor parameter, or raise InputError."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        at = {float(row["tabor"]) for row in rows}
        rungs = tuple(_rung(row) for row in rows if row["outcome"] == "converged")
    except OSError as error:
        raise InputError(
            f"beside = {path} cannot be read: {error.strerror}; give speed.csv of an earlier run"
        ) from None
    except KeyError as error:
        raise InputError(f"beside = {path} has no column {error}; give speed.csv of this version's study") from None
    except (TypeError, ValueError, csv.Error) as error:
        raise InputError(f"beside = {path} is no table of a speed study ({error}); give its speed.csv") from None
    if not rungs:
        raise InputError(f"beside = {path} has no rung with a result; give speed.csv of an earlier run")
    if at != {tabor}:
        raise InputError(f"beside = {path} is of tabor {', '.join(f'{t:g}' for t in sorted(at))}, not {tabor:g}")
    return Earlier(str(path), rungs)


def _rung(row: Mapping[str, str]) -> Timing:
    """Rung of a row of the table, where what is not known is empty."""
    told = [q for q in QUANTITIES if row[f"{q}_error"]]
    errors, floors = ({q: float(row[f"{q}_{what}"]) for q in told} for what in ("error", "truth_uncertainty"))
    yardsticks = float(row["yardsticks"])
    if not 0 < yardsticks < math.inf or not all(math.isfinite(error) for error in errors.values()):
        raise ValueError(f"{row['method']} at {row['setting']} has no time or no error")
    return Timing(row["method"], row["setting"], "converged", yardsticks, errors=errors, floors=floors)
