"""The comparison as a table and the cause in words, and the sheets of the problems."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from string import Template

from rich.console import Group, RenderableType
from rich.text import Text

from fem_adhesion.benchmark.causes import REMEDIES
from fem_adhesion.benchmark.problems import KINDS, Problem
from fem_adhesion.benchmark.study import Diagnosis, Row
from fem_adhesion.benchmark.submission import CURVES, NUMBERS
from fem_adhesion.common.numbers import digits, with_error
from fem_adhesion.common.page import Table, data_rows, data_text, write_csv
from fem_adhesion.common.record import UNITS
from fem_adhesion.common.terminal import Column, Fitted, Prose
from fem_adhesion.registry import name_of
from halfspace.values import Estimate

SHOWN = ("approach", "load", "contact_radius", "energy")
DIGITS = 9  # significant, at most, of our values


def report(found: Diagnosis) -> RenderableType:
    """Everything for the terminal."""
    tables = [_table(name, [row for row in found.rows if row.problem == name]) for name in found.problems]
    brackets = Prose(
        "In brackets: error of our last digit. Deviation: of approaches and gaps in parts of eps and the range of "
        "all events, of others in parts of our value. A number agrees if it does within its last digit, the error "
        "stated and our bar."
    )
    return Group(*tables, brackets, Text(), *map(Prose, verdict(found)))


def _table(problem: str, rows: Sequence[Row]) -> Fitted:
    known = [not math.isnan(row.ours) for row in rows]
    ours = [with_error(Estimate(row.ours, row.bar), digits=DIGITS) for row in rows]
    columns = [
        Column("quantity", [row.quantity.replace("_", " ") for row in rows], words=True),
        Column("theirs", [f"{row.theirs:.{DIGITS}g}" for row in rows]),
        Column("ours", [text if has else "-" for text, has in zip(ours, known, strict=True)]),
        Column("deviation", [f"{row.deviation:.1e}" if has else "-" for row, has in zip(rows, known, strict=True)]),
        Column("digits", [f"{row.digits:.1f}" if has else "-" for row, has in zip(rows, known, strict=True)]),
        Column("verdict", [row.verdict for row in rows], words=True),
    ]
    styles = ["" if row.verdict == "agrees" else "yellow" for row in rows]
    return Fitted(columns, [f"{problem}: their numbers beside ours", "in R dgamma, eps, beta"], styles=styles)


def verdict(found: Diagnosis) -> Iterator[str]:
    """Cause, what fits alike, the remedies, and the causes of the problems alone where these differ."""
    causes, fits = found.causes, {fit.cause: fit for fit in found.fits}
    right = [row.digits for row in found.rows if not math.isnan(row.ours)]
    span = f", to {min(right):.1f} to {max(right):.1f} digits" if found.cause == "sound" else ""
    yield f"cause: {' or '.join(causes)}{span}{', which fit alike' if len(causes) > 1 else ''}"
    for cause in causes:
        fitted = ""
        if (fit := fits.get(cause)) and cause != "sound":
            sizes = " and ".join(f"{size:.3g}" for size in fit.parameters)
            fitted = f"{cause}: {f'{fit.what} {sizes}'.strip()}; leaves deviations of {fit.noise:.1g}. "
        yield fitted + REMEDIES[cause]
    if len({tuple(own) for own in found.problems.values()} | {tuple(causes)}) > 1:
        alone = [f"{name} {' or '.join(own)}" for name, own in found.problems.items()]
        yield f"Each problem alone: {', '.join(alone)}."


def write(problems: Sequence[Problem], directory: Path) -> None:
    """Write a sheet for each problem, a template of numbers for all, one of a curve, and the record of the run."""
    words = {row["name"]: row["words"] for row in data_rows("benchmark", "statements.csv")}
    sheet = Template(data_text("benchmark", "sheet.md.template"))
    for problem in problems:
        (body, law), units = (problem.scene.body, problem.scene.law), problem.units
        table = [f"| {n} | {digits(v)} | {v.error:.1g} | {UNITS[KINDS[n]]} |" for n, v in problem.values.items()]
        text = sheet.substitute(
            name=problem.name,
            bodies=words[name_of(body)].format(**vars(body)),
            poisson=f"{problem.scene.poisson:g}",
            tabor=f"{problem.scene.tabor:g}",
            tension=words[name_of(law)].format(**vars(law), c=getattr(law, "amplitude", 1.0)),
            radius=f"{units.radius:.10g}",
            modulus=f"{units.modulus:.10g}",
            work=f"{units.work_of_adhesion:g}",
            sizes=", ".join(f"{UNITS[kind]} = {size:.10g} {si}" for kind in SHOWN for size, si in [units.si(kind)]),
            edge=f"{1 + law.edge_gap:.10g}",
            table="\n".join(table),
        )
        (directory / f"{problem.name}.md").write_text(text, "utf-8")
    lines = [(problem.name, name, "", UNITS[KINDS[name]], "") for problem in problems for name in problem.values]
    numbers = Table("numbers", "numbers", "to be filled in", (*NUMBERS, "unit", "error"), lines)
    curve = Table("curve", "points of a curve", "to be filled in", CURVES, [(problems[0].name, "", "")])
    write_csv((numbers, curve), directory)
