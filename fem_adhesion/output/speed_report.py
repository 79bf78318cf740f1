"""The speed study on paper: a table of all rungs, the plots, and a page that says what accuracy costs."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from fem_adhesion.output.record import versions
from fem_adhesion.output.speed_plots import draw
from fem_adhesion.studies.machine import machine
from fem_adhesion.studies.methods import QUANTITIES
from fem_adhesion.studies.speed_result import Rung, SpeedStudy, best, cheapest

TOLERANCES = (1e-3, 1e-6)
UNITS = {"pull_off": "R dgamma", "jump_on": "eps", "hysteresis": "R dgamma eps"}
COLUMNS = ("method", "setting", "unknowns", "seconds", "yardsticks", "peak_mebibytes")
ERROR_COLUMNS = tuple(f"{quantity}_error" for quantity in QUANTITIES)


def write(study: SpeedStudy, directory: Path) -> None:
    """Write ``speed.csv``, ``speed.md`` and a plot for each quantity, SVG and PNG, into a directory that exists.

    Give it one made by `fem_adhesion.output.files.directory_written_aside`, so that all files appear or none.
    """
    with (directory / "speed.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([*COLUMNS, *ERROR_COLUMNS, "outcome"])
        table.writerows(_cells(rung, study.yardstick) for rung in study.rungs)
    (directory / "speed.md").write_text("\n".join(page(study)) + "\n")
    draw(study, directory)


def _cells(rung: Rung, yardstick: float) -> list[str]:
    """Row of the table; what is not known is left empty."""
    errors = [_number(rung.error(quantity), "{:.3e}") for quantity in QUANTITIES]
    return [
        rung.method,
        rung.setting,
        "" if rung.unknowns is None else str(rung.unknowns),
        _number(rung.seconds, "{:.4f}"),
        _number(rung.seconds / yardstick, "{:.0f}"),
        _number(rung.memory, "{:.1f}"),
        *errors,
        rung.outcome,
    ]


def _number(value: float, form: str) -> str:
    return form.format(value) if math.isfinite(value) else ""


def page(study: SpeedStudy) -> Iterator[str]:
    """Lines of the page, in Markdown."""
    yield f"# Error against wall time at Tabor parameter {study.tabor:g}{', quick' if study.quick else ''}"
    yield ""
    yield from (f"* {key}: {value}" for key, value in (machine() | versions()).items())
    yield f"* yardstick, one dgesv of n = 200: {study.yardstick * 1e3:.2f} ms"
    yield ""
    yield "The truth is the half-space solver at rtol 1e-9; errors are not counted below its own uncertainty."
    yield ""
    for quantity, estimate in study.truth.items():
        yield f"* {quantity}: {estimate.value:.10g} {UNITS[quantity]}, within {estimate.error:.0e}"
    yield from _costs(study, "What it costs to have every quantity that a method gives", None)
    for quantity in study.truth:
        yield from _costs(study, f"What it costs to have {quantity}", quantity)
    yield from _exponents(study)
    yield from _failures(study)


def _costs(study: SpeedStudy, title: str, quantity: str | None) -> Iterator[str]:
    """One line per method: seconds to each tolerance, and the best that it reached."""
    yield from _heading(title, ["method", *(f"to {tolerance:.0e}" for tolerance in TOLERANCES), "best reached"])
    for method in study.methods:
        rungs = study.of(method.name)
        cells = [_cost(cheapest(rungs, tolerance, quantity), study) for tolerance in TOLERANCES]
        yield _line([method.name, *cells, _best(best(rungs, quantity), quantity)])


def _cost(rung: Rung | None, study: SpeedStudy) -> str:
    if rung is None:
        return "-"
    return f"{rung.seconds:.2f} s = {rung.seconds / study.yardstick:.0f} yardsticks ({rung.setting})"


def _best(rung: Rung | None, quantity: str | None) -> str:
    if rung is None:
        return "-"
    error = rung.error(quantity) if quantity else rung.worst_error
    return f"{error:.0e} in {rung.seconds:.2f} s ({rung.setting})"


def _exponents(study: SpeedStudy) -> Iterator[str]:
    title = "How the cost grows: exponents b fitted to cost ~ x^b; the error is that of pull_off"
    costs = [f"{cost}, x = {x}" for x in ("unknowns", "1/error") for cost in ("time", "peak memory")]
    yield from _heading(title, ["method", *costs])
    for method in study.methods:
        b = study.exponents(method.name)
        fitted = (b.time, b.memory, b.time_by_accuracy, b.memory_by_accuracy)
        yield _line([method.name, *(_number(value, "{:.2f}") or "-" for value in fitted)])


def _failures(study: SpeedStudy) -> Iterator[str]:
    yield from _heading("Rungs without result", ["method", "setting", "reason"])
    yield from (_line([rung.method, rung.setting, rung.outcome]) for rung in study.rungs if not rung.converged)


def _heading(title: str, columns: Sequence[str]) -> Iterator[str]:
    yield from ("", f"## {title}", "", _line(columns), _line(["---"] * len(columns)))


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
