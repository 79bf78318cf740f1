"""The comparison as a table and the cause in words, and the sheets of the problems."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from rich.console import Group, RenderableType
from rich.text import Text

from fem_adhesion.benchmark.causes import REMEDIES
from fem_adhesion.benchmark.problems import KINDS, Problem
from fem_adhesion.benchmark.study import Diagnosis, Fit, Row
from fem_adhesion.benchmark.submission import CURVES, NUMBERS
from fem_adhesion.common.numbers import listed, with_error
from fem_adhesion.common.record import UNITS
from fem_adhesion.common.terminal import Column, Fitted, Prose
from fem_adhesion.registry import record_of, words_of

SHOWN = ("approach", "load", "contact_radius", "energy")
DIGITS = 9  # significant, at most, of our values
DEFINITIONS = """\
Units: R is the equivalent radius, E* the contact modulus, dgamma the work of adhesion, eps the spacing at which the
surfaces are in equilibrium, beta = (R^2 dgamma/E*)^(1/3); the Tabor parameter is (R dgamma^2/(E*^2 eps^3))^(1/3).

Approach: positive when pressed together, zero where the undeformed surfaces are eps apart. Load: positive in
compression. Central gap: h/eps - 1 on the axis. Contact radius: where h/eps = 3^(1/6), the largest tension of the 3-9
law. pull_off: the least load. jump_on, jump_off: the folds in approach that fixed grips meet coming from separation
and from contact; the landings are the states after these jumps. zero_load: contact under no load. energy: released
from far separation to zero approach in contact. energy_lost: in a cycle under fixed grips.
"""


def report(found: Diagnosis) -> RenderableType:
    """Everything for the terminal."""
    return Group(
        *(
            _table(one.problem.name, [row for row in found.rows if row.problem == one.problem.name])
            for one in found.submitted
        ),
        Prose(
            "In brackets: error of our last digit. Deviation: of approaches and gaps in parts of eps and the range of "
            "all events, of others in parts of our value. A number agrees if it does within its last digit, the error "
            "stated and our bar."
        ),
        Text(),
        *map(Prose, verdict(found)),
    )


def _table(problem: str, rows: Sequence[Row]) -> Fitted:
    columns = [
        Column("quantity", [row.number.quantity.replace("_", " ") for row in rows], words=True),
        Column("theirs", [f"{row.number.value:.{DIGITS}g}" for row in rows]),
        Column("ours", [with_error(row.ours, digits=DIGITS) if row.ours else "-" for row in rows]),
        Column("deviation", [f"{row.deviation:.1e}" if row.ours else "-" for row in rows]),
        Column("digits", [f"{row.digits:.1f}" if row.ours else "-" for row in rows]),
        Column("verdict", [row.verdict for row in rows], words=True),
    ]
    styles = ["" if row.verdict == "agrees" else "yellow" for row in rows]
    return Fitted(columns, [f"{problem}: their numbers beside ours", "in R dgamma, eps, beta"], styles=styles)


def verdict(found: Diagnosis) -> Iterator[str]:
    """Cause, what fits alike, and the remedies."""
    fits = {fit.cause: fit for fit in found.fits}
    digits = [row.digits for row in found.rows if row.ours]
    if found.cause == "sound":
        yield f"cause: sound, to {min(digits):.1f} to {max(digits):.1f} digits"
    else:
        yield f"cause: {' or '.join(found.causes)}" + (", which fit alike" if len(found.causes) > 1 else "")
    for cause in found.causes:
        if cause in fits and cause != "sound":
            yield f"{cause}: {_told(fits[cause])}. {REMEDIES[cause]}"
        else:
            yield REMEDIES[cause]
    if others := [fit.cause for fit in found.fits if fit.cause not in found.causes][:2]:
        yield f"next after {'it' if len(found.causes) == 1 else 'them'}: {listed(others)}"


def _told(fit: Fit) -> str:
    sizes = " and ".join(f"{size:.3g}" for size in fit.parameters)
    return f"{fit.what}{f' = {sizes}' if sizes else ''}; leaves deviations of {fit.noise:.1g}"


def write(problems: Sequence[Problem], directory: Path) -> None:
    """Write a sheet and a template of numbers for each problem, and a template of a curve."""
    for problem in problems:
        values, scene, units = problem.values, problem.scene, problem.units
        sizes = [f"{UNITS[kind]} = {size:.10g} {si}" for kind in SHOWN for size, si in [units.si(kind)]]
        lines = [
            f"# {problem.name}",
            f"A frictionless contact of a rigid body and this one: Tabor parameter {scene.tabor:g}, profile "
            f"{words_of(scene.shape)}, law {words_of(scene.law)}, body {json.dumps(record_of(scene.body))}.",
            DEFINITIONS,
            f"Numbers in SI are read for R = {units.radius:.10g} m, E* = {units.modulus:.10g} Pa, "
            f"dgamma = {units.work_of_adhesion:g} J/m^2: {', '.join(sizes)}.",
            "| quantity | value | error | unit |\n|---|---|---|---|",
        ]
        table = [f"| {n} | {v.value:.12g} | {v.error:.1g} | {UNITS[KINDS[n]]} |" for n, v in values.items()]
        (directory / f"{problem.name}.md").write_text("\n\n".join(lines) + "\n" + "\n".join(table) + "\n", "utf-8")
        template = [f"{problem.name},{name},,{UNITS[KINDS[name]]}," for name in values]
        (directory / f"{problem.name}.csv").write_text(
            "\n".join([",".join((*NUMBERS, "unit", "error")), *template, ""])
        )
    (directory / "curve.csv").write_text(f"{','.join(CURVES)}\n{problems[0].name},,\n")
