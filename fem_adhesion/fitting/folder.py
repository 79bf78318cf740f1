"""Fits of many curves at once, each kept as soon as it is there: their table, and their spread beside the intervals.

A row is the record of a fit as plain data, see `terminal.record`, with the file and the number of its curve, or the
reason why there is no fit. Curves of one sample differ by more than their noise: another spot, another asperity. The
spread between curves is the uncertainty of the sample, the interval of a curve that of the curve alone.
"""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import IO, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from rich.console import Group

from fem_adhesion.common import style
from fem_adhesion.common.facts import code_digest, plain
from fem_adhesion.common.files import Plain, Store
from fem_adhesion.common.jobs import solve_all
from fem_adhesion.common.numbers import counted
from fem_adhesion.common.record import column
from fem_adhesion.common.terminal import Column, Fitted, Prose
from fem_adhesion.fitting import makers, terminal
from fem_adhesion.fitting.likelihood import NORMAL
from fem_adhesion.fitting.measured import count, read
from fem_adhesion.fitting.study import UNITS, Value, fit
from fem_adhesion.fitting.words import interval, sized
from fem_adhesion.registry import record_of
from halfspace.errors import InputError, Unsolved, tried

Row = Mapping[str, Any]
FORCES: Mapping[str, str] = {"pull_off": "N", "noise": "N"}  # found without a model
SHOWN = ("work_of_adhesion", "spacing", "pull_off")


@dataclass(frozen=True)
class Source:
    """A curve: its file and its number in it."""

    path: Path
    number: int = 0

    @property
    def named(self) -> dict[str, Any]:
        """What a row says of its curve."""
        return {"file": str(self.path), "number": self.number}


def sources(paths: Sequence[Path], **given: float | None) -> tuple[Source, ...]:
    """Curves of files and folders in the order of their names; stiffness and sensitivity as for `read`."""
    files = list[Path]()
    for path in paths:
        inside = [file for file in sorted(path.iterdir()) if file.is_file()] if path.is_dir() else [path]
        files += [file for file in inside if file.suffix.lower() == ".csv" or makers.is_makers(file)]
    if not files:
        names = ", ".join(map(str, paths)) or "nothing"
        raise InputError(
            f"{names} has no file of a force curve, limit: .csv and files of makers; give a file or a folder"
        )
    return tuple(Source(file, number) for file in dict.fromkeys(files) for number in range(count(file, **given)))


def outcome(source: Source, *, reading: Mapping[str, float | None], **asked: Any) -> Row:
    """Row of a curve, see `fem_adhesion.fitting.study.fit`."""
    found = tried(lambda: fit(read(source.path, number=source.number, **reading), **asked), refusals=True)
    return source.named | ({"reason": found.reason} if isinstance(found, Unsolved) else terminal.record(found))


def run(
    curves: Sequence[Source],
    reading: Mapping[str, float | None],
    asked: Mapping[str, Any],
    store: Store | None = None,
    **how: Any,
) -> tuple[Row, ...]:
    """Fit the curves that the store does not hold, and store each at once.

    `reading` are keywords of `read`, `asked` those of `fit`; `how` are further keywords of
    `fem_adhesion.common.jobs.solve_all`: jobs, dask, progress.
    """

    def inputs(source: Source) -> Plain:
        named = {name: plain(record_of(value)) for name, value in {**reading, **asked}.items()}
        return {"file": _digest(source.path, source.path.stat().st_mtime_ns), "number": source.number, **named}

    return solve_all(
        curves,
        store,
        work=partial(outcome, reading=reading, **asked),
        inputs=inputs,
        name=lambda source: curve_of(source.named),
        write=dict,
        read=lambda source, row: {**row, **source.named},  # the store knows the curve by what is in its file
        died=lambda source, reason: source.named | {"reason": reason},
        **how,
    )


def code() -> str:
    """Digest of the code that fits a curve."""
    return code_digest(__name__)


@cache  # the file of a map is read once
def _digest(path: Path, _changed: int) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def curve_of(row: Row) -> str:
    """File of a row, and the number of the curve in it."""
    return f"{Path(row['file']).name} {row['number'] or ''}".strip()


def values(rows: Sequence[Row], name: str) -> list[Value]:
    """Values of a quantity in the rows that have it; a force that was found without a model has no interval."""
    return [Value(*map(row[name].get, ("value", "low", "high", "unit"))) for row in rows if name in row]


def spreads(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Spread of each quantity between the curves, in SI: quantiles, and one standard deviation.

    `between` is half of what the middle 68 % of the curves span, `within` the median standard error of the curves that
    have both ends, None without any. The travel of the contact means nothing there.
    """
    found = []
    for name, unit in {**UNITS, **FORCES}.items():
        given = values(rows, name)
        if not given or name == "contact_point":
            continue
        halves = [
            (each.high - each.low) / 2 / NORMAL for each in given if each.low is not None and each.high is not None
        ]
        quantiles = np.percentile([each.value for each in given], [10, 50, 90, 16, 84])
        shown = dict(zip(("low", "median", "high"), quantiles.tolist(), strict=False))
        between, within = float(np.ptp(quantiles[3:])) / 2, float(np.median(halves)) if halves else None
        found.append({"name": name, "unit": unit, "curves": len(given), **shown, "between": between, "within": within})
    return found


def told(rows: Sequence[Row]) -> str:
    """How many curves were fitted, how many with a misfit, and whether they differ by more than their intervals."""
    fitted = [row for row in rows if "reason" not in row]
    misfits = sum(row["misfit"]["found"] for row in fitted)
    cautions = "; the table (--csv) and the record (--json) have their cautions" if misfits else ""
    lines = [f"{len(fitted)} of {counted(len(rows), 'curve')} fitted, {misfits} with a misfit{cautions}."]
    for each in spreads(rows):
        if each["curves"] > 2 and each["within"] and each["between"] > 2 * each["within"]:
            times = f"{each['between'] / each['within']:.2g} times what their own intervals allow"
            lines.append(f"The {each['name'].replace('_', ' ')} differs between curves by {times}: quote the spread.")
    return " ".join(lines)


def write_csv(rows: Sequence[Row], file: IO[str]) -> None:
    """Write a line for each curve, in SI; an end of an interval that the curve leaves open is empty."""
    names = {name: unit for name, unit in {**UNITS, **FORCES}.items() if any(name in row for row in rows)}
    lines = []
    for row in rows:
        line = {"file": row["file"], "curve": row["number"], "model": row.get("model", "")}
        line["misfit"] = {True: "yes", False: "no"}[row["misfit"]["found"]] if "misfit" in row else ""
        for name, unit in names.items():
            for end in ("value",) if name in FORCES else ("value", "low", "high"):
                what = name if end == "value" else f"{name}_{end}"
                line[column(what, unit) if unit else what] = row.get(name, {}).get(end)
        lines.append(line | {"warnings": " ".join(row.get("warnings", ())), "reason": row.get("reason", "")})
    writer = csv.DictWriter(file, list(lines[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)


def report(rows: Sequence[Row]) -> Group:
    """Tables of the curves and of their spread for the terminal."""

    def cells(name: str, text: Callable[[Value], str]) -> list[str]:
        return [text(values([row], name)[0]) if name in row else "" for row in rows]

    first = [Column("curve", [curve_of(row) for row in rows], words=True)]
    for name in SHOWN[:2]:
        first.append(Column(name.replace("_", " "), cells(name, lambda value: sized(value.value, value.unit))))
        first.append(Column("95 %", cells(name, interval)))
    first.append(Column("model", [row.get("model", "") for row in rows], words=True))
    ended = [row.get("reason") or ("misfit" if row["misfit"]["found"] else "") for row in rows]
    found = spreads(rows)
    second = [
        Column(
            "quantity", [each["name"].replace("pull_off", "pull-off").replace("_", " ") for each in found], words=True
        ),
        Column("curves", [str(each["curves"]) for each in found]),
    ]
    headers = {
        "median": "median",
        "low": "10 %",
        "high": "90 %",
        "between": "between\ncurves",
        "within": "within\na curve",
    }
    for name, header in headers.items():
        second.append(Column(header, ["" if each[name] is None else sized(each[name], each["unit"]) for each in found]))
    title = ["over the curves, one standard deviation between them and within one"]
    return Group(Fitted([*first, Column("ended", ended, words=True)]), Fitted(second, title), Prose(told(rows)))


def draw(rows: Sequence[Row]) -> Figure:
    """Histograms of the quantities over the curves, and above the bars each curve with its interval."""
    figure, panels = style.panels(len(SHOWN), height=4.4)
    for axes, name in zip(panels, SHOWN, strict=True):
        given = sorted(values(rows, name), key=lambda each: each.value)
        if not given:
            axes.set_axis_off()
            continue
        numbers = np.array([each.value for each in given])
        highest = float(numbers.max() + max(np.ptp(numbers), 0.1 * numbers.max()))  # where an open end is drawn to
        lows = [0.0 if each.low is None and name not in FORCES else each.low or each.value for each in given]
        highs = [highest if each.high is None and name not in FORCES else each.high or each.value for each in given]
        widths = np.abs(np.clip([lows, highs], 0, max(highest, numbers.max() * 1.1)) - numbers)
        tops, *_ = axes.hist(numbers, bins="auto", color=style.SKY, edgecolor="white", label="curves")
        heights = float(np.max(tops)) * np.linspace(1.1, 1.7, len(given))
        bars = {"fmt": ".", "color": style.BLUE, "linewidth": 0.8, "label": "intervals at 95 %"}
        axes.errorbar(numbers, heights, xerr=widths, **bars)
        style.dress(axes, name.replace("_", " "), "curves", legend=None)
        style.engineering_ticks(axes.xaxis, given[0].unit)
        axes.xaxis.set_major_locator(MaxNLocator(3))
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    style.legend_below(figure, panels, 2)
    return figure
