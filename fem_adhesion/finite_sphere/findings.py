"""How the study of the finite sphere went, and the tables of its page: rules, fits, theories, yield, failures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.common.page import Table
from fem_adhesion.common.words import counted
from fem_adhesion.finite_sphere.bulk import coefficients
from fem_adhesion.finite_sphere.chart import LEVELS, Rule, field_of, rule
from fem_adhesion.finite_sphere.fit import DEVIATIONS, TOLERANCE, Finding, Fit, compare, findings
from fem_adhesion.finite_sphere.points import reference_poisson
from fem_adhesion.finite_sphere.records import Record, Study
from fem_adhesion.finite_sphere.table import Border, DeviationRow, Results
from halfspace.errors import InputError

QUANTITIES = {
    "pull_off_load": "pull-off force",
    "zero_load_radius": "contact radius under no load",
    "jump_on_approach": "approach at jump-on",
    "jump_on_approach_less_bulk": "approach at jump-on, bulk yield taken out",
    "jump_off_approach": "approach at jump-off",
    "jump_off_approach_less_bulk": "approach at jump-off, bulk yield taken out",
    "hysteresis": "energy lost in a cycle",
}
"""Quantities on the page; the files have the others besides."""


def headline(study: Study) -> str:
    """How the study went, in one line."""
    tried = [record for record in study.records if record.status != "left out"]
    ended = f"{len(study.failed)} of {counted(len(tried), 'case')} not solved ({kinds(study.failed)})"
    parts = [
        "quick study, of few points" if study.quick else "",
        ended if study.failed else f"{counted(len(tried), 'case')}, all solved" if tried else "no case",
        f"{counted(len(study.left_out), 'case')} left out, beyond the limits" if study.left_out else "",
    ]
    return "; ".join(filter(None, parts))


def kinds(records: Sequence[Record]) -> str:
    """How many records ended how."""
    return ", ".join(f"{count} {kind}" for kind, count in Counter(r.kind or r.status for r in records).items())


def tables(results: Results) -> list[Table]:
    """All tables in the order of the page.

    Parameters
    ----------
    results : Results
        Of the study, with the approaches less the bulk yield.
    """
    rows, records = results.rows, results.study.records
    found = findings(rows, reference_poisson(rows) or 0.0)
    return [
        _rules(rows),
        _borders(results.borders),
        _fits(found),
        _theories(rows),
        _bulk(records),
        _failures(records),
    ]


def _rules(rows: Sequence[DeviationRow]) -> Table:
    poisson = reference_poisson(rows)
    lines = (_rule(rows, quantity, level, poisson) for quantity in QUANTITIES for level in LEVELS)
    columns = ("quantity", "half-space errs less than", "if R/eps >", "rule fits contour within", "mu", "why no rule")
    see = (
        "Lines a + b mu through the contours of the chart, refused where a point contradicts them: within the range of "
        "mu, the deviation is below its bound at all points solved that lie above the line by more than its misfit."
    )
    return Table("rules", "Rules of thumb", see, columns, tuple(lines))


def line(found: Rule) -> str:
    """Right-hand side of a rule."""
    return f"{found.constant:g} {'-' if found.slope < 0 else '+'} {abs(found.slope):g} mu"


def _rule(rows: Sequence[DeviationRow], quantity: str, level: float, poisson: float | None) -> tuple[str, ...]:
    head = (QUANTITIES[quantity], f"{100 * level:g} %")
    try:
        found = rule(field_of(rows, quantity, poisson), level)
    except InputError as error:
        return (*head, "", "", "", str(error))
    return (*head, line(found), f"{100 * found.misfit:.2g} %", f"{found.tabor[0]:g} to {found.tabor[1]:g}", "")


def _fits(found: Sequence[Finding]) -> Table:
    columns = ("quantity", "cause", "mu", "leading terms", "up to beta/R", "points", "largest residual", "why no fit")
    see = (
        f"Errors are {DEVIATIONS:g} standard deviations and the change when the points farther than half-way are left "
        f"out; up to the beta/R stated, every point is within {100 * TOLERANCE:g} % of the terms beside its own error."
    )
    shown = [f for f in found if f.quantity in QUANTITIES and (f.cause == "all" or f.quantity == "pull_off_load")]
    return Table("fits", "Leading terms of the relative deviations", see, columns, tuple(map(_finding, shown)))


def _finding(finding: Finding) -> tuple[str, ...]:
    tabor = "all" if finding.tabor is None else f"{finding.tabor:g}"
    head = (QUANTITIES[finding.quantity], finding.cause, tabor)
    return (*head, *(_fit(finding.fit) if finding.fit else ("", "", "", "")), finding.reason)


def _fit(fit: Fit) -> tuple[str, ...]:
    terms = "; ".join(f"({plus_minus(c)}) {name}" for name, c in fit.coefficients.items())
    return (terms, f"{fit.holds_to:.2g}", str(fit.points), f"{fit.worst:.1e}")


def _theories(rows: Sequence[DeviationRow]) -> Table:
    columns = ("theory and term", "expected", "fitted", "error", "at mu", "why not")
    see = (
        "The profile's part of the pull-off alone, on a half-space. The theories are of the limits mu = 0 and "
        "infinity, the fits of the mu stated."
    )
    try:
        lines = tuple(
            (c.theory, f"{c.expected:.4f}", f"{c.fitted.value:.4f}", f"{c.fitted.error:.1e}", f"{c.tabor:g}", "")
            for c in compare(rows)
        )
    except InputError as error:
        lines = (("", "", "", "", "", str(error)),)
    return Table("theories", "Leading coefficients beside theories", see, columns, lines)


def _bulk(records: Sequence[Record]) -> Table:
    known = sorted({r.case.poisson for r in records if r.case.poisson is not None})
    columns = ("grip", "Poisson's ratio", "kappa_0", "error", "kappa_1", "size of the term in beta/R")
    see = (
        "The body approaches by W/(E* R) (kappa_0 + kappa_1 ln(beta/R)) more than the half-space, in eps by mu beta/R "
        "times as much. kappa_1 = -(1 - 2 nu)^2/(2 pi (1 - nu)) is exact, kappa_0 is measured under Hertz's pressure "
        "on r < beta; the term in beta/R is not taken out, but counted as error."
    )
    return Table("bulk", "The body's linear yield, in 1/(E* R)", see, columns, tuple(_yields(known)))


def _yields(poissons: Sequence[float]) -> Iterator[tuple[str, ...]]:
    for grip in ("sliding", "bonded"):
        for poisson in poissons:
            found = coefficients(grip, poisson)
            constant = (f"{found.constant.value:.4f}", f"{found.constant.error:.1e}")
            yield (grip, f"{poisson:g}", *constant, f"{found.logarithm:.5f}", f"{found.linear:.2g}")


def _failures(records: Sequence[Record]) -> Table:
    lines = tuple((r.case.name, r.status, r.kind, r.reason) for r in records if r.status != "solved")
    see = f"{len(lines)} of {len(records)} cases."
    return Table("failures", "What was not solved, and why", see, ("case", "status", "kind", "reason"), lines)


def _borders(borders: Sequence[Border]) -> Table:
    columns = ("R/eps", "Poisson's ratio", "mu", "error", "why none")
    see = (
        "From this mu on the approach turns back along the curve; the spheres are held on a sliding mid-plane. Errors "
        "are the changes from elements one degree lower, or from a coarser grid."
    )
    return Table("first_jumps", "Where jumps under fixed grips begin", see, columns, tuple(map(_border, borders)))


def _border(border: Border) -> tuple[str, ...]:
    size = "half-space" if border.radius_ratio is None else f"{border.radius_ratio:g}"
    found = (f"{border.tabor.value:.9g}", f"{border.tabor.error:.1e}") if border.tabor else ("", "")
    return (size, "" if border.poisson is None else f"{border.poisson:g}", *found, border.reason)
