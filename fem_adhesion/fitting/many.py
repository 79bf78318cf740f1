"""The command's part on many curves: their fits with resume, a table, a figure and what they say together."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from fem_adhesion.common import style
from fem_adhesion.common.facts import plain
from fem_adhesion.common.files import open_store
from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.numbers import PREFIXES, engineering, exponent_of
from fem_adhesion.common.options import AGREE, DISAGREE, all_written, console_beside
from fem_adhesion.common.record import record, write_beside
from fem_adhesion.common.terminal import Column, Fitted, Prose
from fem_adhesion.fitting.folder import FORCES, Outcome, Spread, code, run, sources, spreads, told, write_csv
from fem_adhesion.fitting.words import interval, sized

BINS = 12  # of a histogram, of which the curves of a map fill most
SHOWN = ("work_of_adhesion", "spacing", "pull_off")


def fit_all(
    options: argparse.Namespace,
    paths: Sequence[Path],
    reading: Mapping[str, float | None],
    asked: Mapping[str, Any],
) -> int:
    """Fit the curves of files and folders and write csv, json and plot, as far as the options name them.

    Returns
    -------
    int
        1 if any curve was not fitted, else 0.
    """
    form = style.require_suffix(options.plot) if options.plot else ""
    curves = sources(paths, **reading)
    store = open_store(options.resume, code(), resume=True, force=None) if options.resume else None
    given = {"curves": [str(path) for path in paths], **reading, **asked}
    with (
        all_written(csv=options.csv, json=options.json, plot=options.plot) as files,
        progress_bar() as step,
    ):
        found = run(curves, reading, asked, store, jobs=options.jobs, dask=options.dask, progress=step)
        if "csv" in files:
            write_csv(found, files["csv"])
        if "metadata" in files:
            write_beside(files["metadata"], options.csv.name, record(None, {}, **given))
        if "json" in files:
            parts = {"curves": [plain(one) for one in found], "spread": [plain(each) for each in spreads(found)]}
            json.dump({**record(None, {}, **given), **parts}, files["json"], indent=1, allow_nan=False)
        if "plot" in files:
            style.write(lambda: draw(found), files["plot"], form)
    console = console_beside(options.csv, options.json)
    console.print(_curves(found), _spreads(spreads(found)), Prose(told(found)))
    return DISAGREE if any(one.reason for one in found) else AGREE


def _curves(found: Sequence[Outcome]) -> Fitted:
    """Table of the curves."""
    columns = [Column("curve", [f"{Path(one.file).name} {one.number or ''}".strip() for one in found], words=True)]
    for name in SHOWN[:2]:
        columns.append(Column(name.replace("_", " "), [_sized(one, name) for one in found]))
        columns.append(Column("95 %", [_interval(one, name) for one in found]))
    columns.append(Column("model", [one.model for one in found], words=True))
    columns.append(Column("", [one.reason or ("misfit" if one.misfit else "") for one in found], words=True))
    return Fitted(columns)


def _sized(one: Outcome, name: str) -> str:
    value = one.values.get(name)
    return engineering(value.value, value.unit) if value else ""


def _interval(one: Outcome, name: str) -> str:
    value = one.values.get(name)
    return interval(value) if value else ""


def _spreads(found: Sequence[Spread]) -> Fitted:
    """Table of what the curves say together."""
    columns = [
        Column("quantity", [each.name.replace("_", " ") for each in found], words=True),
        Column("curves", [str(each.curves) for each in found]),
        *(
            Column(header, [sized(getattr(each, name), each.unit) for each in found])
            for header, name in (
                ("median", "median"),
                ("10 %", "low"),
                ("90 %", "high"),
                ("between\ncurves", "between"),
            )
        ),
        Column("within\na curve", [sized(each.within, each.unit) if each.within > 0 else "" for each in found]),
    ]
    return Fitted(columns, ["over the curves, one standard deviation between them and within one"])


def draw(found: Sequence[Outcome]) -> Figure:
    """Histograms of the quantities over the curves, and above the bars each curve with its interval."""
    figure, panels = style.panels(len(SHOWN), height=4.4)
    for axes, name in zip(panels, SHOWN, strict=True):
        unit, values = _of(found, name)
        if not values:
            axes.set_axis_off()
            continue
        numbers = np.array([value for value, _, _ in values])
        exponent = exponent_of(float(np.median(np.abs(numbers))))
        scaled = numbers * 10.0**-exponent
        bars = {"bins": min(BINS, numbers.size), "color": style.SKY, "edgecolor": "white", "label": "curves"}
        order, top = np.argsort(numbers), float(np.max(axes.hist(scaled, **bars)[0]))
        ends = [end * 10.0**-exponent for each in values for end in each if end is not None]
        width = float(np.ptp(scaled)) or abs(float(scaled[0]))
        left, right = (
            float(np.clip(end, scaled.min() - width, scaled.max() + width)) for end in (min(ends), max(ends))
        )
        margin = 0.03 * ((right - left) or width)
        axes.set_yticks(np.unique(np.linspace(0, top, 5).round()))
        for rank, i in enumerate(order):
            low, high = (end if end is None else end * 10.0**-exponent for end in values[i][1:])
            shown = (left if low is None else low, right if high is None else high)
            y = top * (1.1 + 0.6 * (rank + 0.5) / numbers.size)
            axes.plot(shown, (y, y), color=style.BLUE, linewidth=0.8, label=None if rank else "intervals at 95 %")
            axes.plot(scaled[i], y, ".", color=style.BLUE, markersize=3)
        named = f"{name.replace('_', ' ')}, {PREFIXES[exponent]}{unit}"
        style.dress(axes, named, "curves", legend=None, xlim=(left - margin, right + margin))
    style.legend_below(figure, panels, 2)
    return figure


def _of(found: Sequence[Outcome], name: str) -> tuple[str, list[tuple[float, float | None, float | None]]]:
    """Unit, values and ends of a quantity; a force that was found without a model has no interval."""
    fitted = [one.values[name] for one in found if name in one.values]
    if fitted:
        return fitted[0].unit, [(each.value, each.low, each.high) for each in fitted]
    forces = [one.forces[name] for one in found if name in one.forces]
    return FORCES.get(name, ""), [(each, each, each) for each in forces]
