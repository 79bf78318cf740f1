"""Tables of the Greenwood study: cells with names, as CSV files and as HTML."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from fem_adhesion.studies.greenwood1997 import Greenwood1997
from fem_adhesion.studies.greenwood_criteria import CriteriaStudy
from fem_adhesion.studies.greenwood_devices import DeviceStudy
from fem_adhesion.studies.greenwood_relaxation import Attempt
from fem_adhesion.studies.greenwood_tables import Printed
from halfspace.curve import Estimate

SYMBOLS = {
    "mu": "&mu;",
    "alpha": "&alpha;",
    "dgamma": "&Delta;&gamma;",
    "beta": "&beta;",
    "eps": "&epsilon;",
    "pi": "&pi;",
}
WORDS = re.compile(rf"\b({'|'.join(SYMBOLS)})\b")


@dataclass(frozen=True)
class Table:
    """A table and the file that holds it.

    Attributes
    ----------
    stem, title, see : str
        File name without suffix, heading, one sentence on what to see.
    columns : tuple of str
        Names with units.
    rows : tuple of tuple of str
        Cells.
    """

    stem: str
    title: str
    see: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def tables(study: Greenwood1997) -> list[Table]:
    """All tables in the order of the page."""
    return [
        *_printed_tables(study),
        _jumps(study),
        _cycles(study.devices),
        _relaxations(study.relaxations),
        _pull_offs(study),
        _true_jumps(study.criteria),
        _constants(study.criteria),
    ]


def _printed_tables(study: Greenwood1997) -> Iterator[Table]:
    printed = study.tables
    a, b = (with_error(e) for e in printed.asymptote)
    yield _printed(
        "table_1",
        "Table 1: f(alpha*)/alpha*^(3/2) of the DMT force method",
        f"Every value agrees to its last printed digit; the asymptote f = a alpha*^(3/2) - b alpha*^2, fitted between "
        f"2e-5 and 1e-4, has a = {a} and b = {b} (standard errors of the fit; the paper: 1.84 and 7.7).",
        "alpha*",
        printed.table_1,
    )
    yield _printed(
        "table_2",
        "Table 2: jumping on and off under fixed grips",
        f"The largest relative deviation is {max(abs(p.deviation) for p in printed.table_2):.1e}; what is off is "
        "explained by states found beside the folds and by misprints, see the notes.",
        "mu",
        printed.table_2,
    )
    yield _printed(
        "fig_4_checks",
        "Pressures printed with Fig. 4, mu = 5",
        "The printed pressures have the sign of the corrected law, compression positive; their error is that of the "
        "rounded gap.",
        "gap H",
        printed.profile_checks,
    )


def _printed(stem: str, title: str, see: str, column: str, entries: Sequence[Printed]) -> Table:
    columns = ("row", column, "unit", "printed", "computed", "error", "relative deviation", "note")
    return Table(stem, title, see, columns, tuple(_entry(p) for p in entries))


def _entry(p: Printed) -> tuple[str, ...]:
    return (p.row, f"{p.column:g}", p.unit, p.printed, *_cells(p.computed), f"{p.deviation:+.1e}", p.note)


def _jumps(study: Greenwood1997) -> Table:
    columns = ("jump", "alpha*, eps", "error", "W before, R dgamma", "error", "W after, R dgamma", "error")
    rows = tuple(
        (f"{j.take_off} to {j.landing}", *_cells(j.approach), *_cells(j.load), *_cells(j.landing_load))
        for j in study.states.jumps
    )
    return Table(
        "jumps", "Jumps of Fig. 2a, mu = 2, fixed grips", "Where each jump takes off and lands.", columns, rows
    )


def _cycles(devices: DeviceStudy) -> Table:
    """Both jumps and the loss of every apparatus."""
    ends = ("jump on", "lands", "jump off", "lands")
    columns = ("stiffness, R dgamma/eps", *(f"{end}: alpha*, eps | W, R dgamma" for end in ends))
    rows = tuple(
        (
            "fixed grips" if math.isinf(c.stiffness) else f"{c.stiffness:g}",
            *(f"{e.approach:.6f} | {e.load:.6f}" for j in (c.jump_on, c.jump_off) for e in (j.take_off, j.landing)),
            *_cells(c.energy_lost),
        )
        for c in devices.cycles
    )
    see = "The softer the apparatus, the more energy a cycle loses; the loss is the work of the base round the loop."
    title = f"Cycles of an apparatus, mu = {devices.tabor:g}"
    return Table("devices", title, see, (*columns, "energy lost, R dgamma eps", "error"), rows)


def _relaxations(attempts: Sequence[Attempt]) -> Table:
    """Sweeps and times of the iterations of 1997."""
    columns = ("mu", "iteration", "sweeps", "seconds", "Newton, seconds", "outcome")
    rows = tuple(
        (
            f"{a.tabor:g}",
            a.method,
            "not converged" if a.sweeps is None else str(a.sweeps),
            f"{a.seconds:.3f}",
            f"{a.newton_seconds:.3f}",
            a.outcome,
        )
        for a in attempts
    )
    see = (
        "Simple relaxation reaches H(0) = 0 in sweeps that grow with mu and as 1/c, until c must shrink; Greenwood's "
        "needs some ten thousand at any mu, since its changes conserve the sum of the pressures."
    )
    return Table("relaxation", "The iterations of 1997 on 200 uniform nodes", see, columns, rows)


def _pull_offs(study: Greenwood1997) -> Table:
    columns = ("mu", "half-space, R dgamma", "error", "finite elements, R dgamma", "error")
    rows = tuple((f"{p.tabor:.6g}", *_cells(p.half_space), *_cells(p.finite_element)) for p in study.pull_offs)
    see = "From Bradley's -2 pi = -6.2832 to JKR's -3 pi/2 = -4.7124."
    return Table("pull_off", "Load at pull-off, Fig. 7", see, columns, rows)


def _true_jumps(criteria: CriteriaStudy) -> Table:
    """True jumps beside what the criteria predict for them."""
    usable = [c for c in criteria.criteria if c.predict is not None]
    predicted = [c.predict(criteria.tabor) for c in usable if c.predict]
    names = (f"{'alpha*' if c.of_approach else 'H0'} by {c.name}, eps" for c in usable)
    columns = ("mu", "alpha*, eps", "error", "H0, eps", "error", "b sigma'/sigma", *names)
    rows = tuple(
        (
            f"{jump.tabor:.6g}",
            *_cells(jump.approach),
            *_cells(jump.central_gap),
            f"{jump.fundamental:.5f}",
            *(f"{values[i]:.5f}" for values in predicted),
        )
        for i, jump in enumerate(criteria.jumps)
    )
    see = (
        "The fundamental criterion (4.3) reads b sigma'/sigma = -1 at the jump, where the solution has -1.6 to -1.7: "
        "states that it calls unstable are stable."
    )
    return Table("criteria", "True jumps on and the criteria's predictions", see, columns, rows)


def _constants(criteria: CriteriaStudy) -> Table:
    columns = ("criterion", "formula", "constant", "printed", "refitted", "standard error", "scatter of ln(left side)")
    rows = tuple(
        (c.name, c.formula, name, "" if printed is None else f"{printed:.6g}", *_cells(fitted), f"{c.scatter:.1e}")
        for c in criteria.criteria
        for name, printed, fitted in c.constants
    )
    tabor = criteria.tabor
    title = f"Constants of the criteria, refitted for mu = {tabor[0]:g} to {tabor[-1]:g}"
    see = (
        "Least squares of logarithms; the closed criteria are too large, 1.8 (App. C) to 2.7 times (Pethica & Sutton)."
    )
    return Table("criteria_constants", title, see, columns, rows)


def _cells(estimate: Estimate | None) -> tuple[str, str]:
    """Value and error; empty if there is none."""
    return ("", "") if estimate is None else (_digits(estimate), f"{estimate.error:.1e}")


def with_error(estimate: Estimate) -> str:
    """Value with its error behind it."""
    return f"{_digits(estimate)} +- {estimate.error:.1g}"


def _digits(estimate: Estimate) -> str:
    """Value to one digit beyond the first uncertain one, ten decimals at most."""
    digits = 1 - math.floor(math.log10(estimate.error)) if estimate.error else 10
    return f"{estimate.value:.{min(max(digits, 1), 10)}f}"


def write_csv(table: Table, directory: Path) -> None:
    """Write a table as a CSV file."""
    with (directory / f"{table.stem}.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(table.columns)
        writer.writerows(table.rows)


def html(table: Table) -> Iterator[str]:
    """Lines of the table on the page."""
    yield f'<section id="{table.stem}"><h2>{typeset(table.title)}</h2>'
    yield f'<p>{typeset(table.see)} <a href="{table.stem}.csv">CSV</a></p>'
    yield '<div class="wide"><table><thead><tr>'
    yield "".join(f'<th scope="col">{typeset(name)}</th>' for name in table.columns)
    yield "</tr></thead><tbody>"
    for row in table.rows:
        yield f"<tr>{''.join(_cell(cell) for cell in row)}</tr>"
    yield "</tbody></table></div></section>"


def _cell(text: str) -> str:
    number = bool(re.fullmatch(r"[-+0-9.e]+", text))
    return f'<td class="number">{text}</td>' if number else f"<td>{typeset(text)}</td>"


def typeset(text: str) -> str:
    """Escape for HTML, Greek letters and the sign of an error as such."""
    return WORDS.sub(lambda match: SYMBOLS[match[0]], escape(text)).replace("+-", "&plusmn;")
