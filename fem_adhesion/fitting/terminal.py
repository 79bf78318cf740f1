"""A fit for the terminal and as a record."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from fem_adhesion.common.facts import plain
from fem_adhesion.common.terminal import Column, Fitted, Prose
from fem_adhesion.fitting import words
from fem_adhesion.fitting.study import Fit, Value


def report(fit: Fit) -> RenderableType:
    """Everything for the terminal."""
    return Group(
        Prose(words.counted_samples(fit)),
        *map(Prose, fit.prepared.told),
        _values(fit),
        _branches(fit),
        _models(fit),
        Text(),
        Prose(words.comparison(fit)),
        *map(Prose, words.series(fit)),
        *(Prose(f"caution: {line}") for line in words.warnings(fit)),
        *map(Prose, words.remedies(fit)),
    )


def _values(fit: Fit) -> Fitted:
    values = fit.values
    columns = [
        Column("quantity", [name.replace("_", " ") for name in values], words=True),
        Column("value", [words.sized(value.value, value.unit) for value in values.values()]),
        Column("95 %", [words.interval(value) for value in values.values()]),
        Column("note", ["" if value.identified else "not identified" for value in values.values()], words=True),
    ]
    return Fitted(columns, [f"fit of the atlas: tabor = {fit.best.apparatus.units.tabor:.3g}"])


def _branches(fit: Fit) -> Fitted:
    columns = [
        Column("segment", [part.segment for part in fit.branches], words=True),
        Column("branch", [part.branch for part in fit.branches], words=True),
        Column("samples", [str(part.samples) for part in fit.branches]),
        Column("mean square\nnoise^2", [f"{part.mean_square:.3g}" for part in fit.branches]),
        Column("chance of the runs", [f"{part.chance:.2g}" for part in fit.branches]),
    ]
    return Fitted(columns, ["residuals by branch"])


def _models(fit: Fit) -> Fitted:
    values = [[one.values.get(name) for one in fit.candidates] for name in ("work_of_adhesion", "spacing")]
    columns = [
        Column("model", [one.name for one in fit.candidates], words=True),
        Column("criterion", [f"{one.criterion - fit.candidates[0].criterion:+.3g}" for one in fit.candidates]),
        *(
            Column(f"{name}, 95 %", [words.interval(value) if value else "" for value in row])
            for name, row in zip(("dgamma", "eps"), values, strict=True)
        ),
    ]
    return Fitted(columns, ["models, by Akaike's criterion over the least"])


def record(fit: Fit) -> dict[str, Any]:
    """A fit as plain data."""
    return {
        **told(fit.values),
        "model": fit.model,
        "models": [
            {"name": one.name, "chi2": one.chi2, "criterion": one.criterion, **told(one.values)}
            for one in fit.candidates
        ],
        "misfit": {
            "found": fit.misfit,
            "chi2": fit.best.chi2,
            "degrees": fit.best.degrees,
            "branches": plain([vars(part) for part in fit.branches]),
        },
        "contour": plain(dict(zip(("work_of_adhesion", "spacing"), fit.contour, strict=True))),
        "warnings": list(words.warnings(fit)),
        "told": [words.comparison(fit), *words.series(fit), *words.remedies(fit)],
        "noise": {"value": fit.prepared.noise, "unit": "N", "correlation": fit.prepared.correlation},
        "pull_off": {"value": fit.prepared.pull_off, "unit": "N"},
    }


def told(values: Mapping[str, Value]) -> dict[str, Any]:
    """Values as plain data."""
    return {name: {**vars(value), "identified": value.identified} for name, value in values.items()}
