"""The printed numbers of Greenwood's paper beside converged ones, each with its error and its relative deviation."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import resources

import numpy as np
from scipy.optimize import curve_fit

from fem_adhesion.studies.greenwood_curves import states
from halfspace import criteria, dmt
from halfspace.contact import LOAD
from halfspace.curve import EquilibriumPath, Estimate
from halfspace.events import Condition, Event
from halfspace.lennard_jones import LENNARD_JONES

TABORS = (1.0, 2.0, 3.0, 5.0, 6.0)  # of Table 2
ROUNDING = 1e-15  # of 1 + f, and of closed forms relative to their value
PROFILE_CHECKS = (("2.554", "-0.2968"), ("-0.0036", "0.2943"))  # gap H and pressure P, Fig. 4, mu = 5

LAST_DIGIT = "to the last printed digit"
BESIDE = "a state beside the fold: ours with the printed load has {beside}"
NOTES = {
    ("jump_on", "minus_alpha_star"): "no separated state exists at the printed approach: the fold comes before it",
    ("jump_on", "H0_plus_1_over_mu_3_7"): "follows from the printed H0",
    ("jump_off", "minus_alpha_star"): "short of the fold: states in contact exist beyond the printed approach",
    ("jump_off", "minus_alpha_star_over_mu"): "follows from the printed alpha*",
}
MISPRINTS = {
    (
        "jump_on",
        "minus_alpha_star",
        5.0,
    ): "known misprint, converged 4.26358: no separated state exists at the printed one",
    (
        "jump_off",
        "minus_alpha_star",
        5.0,
    ): "digits exchanged, as 8.187/5 is the 1.637 of the next row, and short of the fold",
    ("jump_off", "minus_alpha_star_over_mu", 5.0): "follows from alpha* = 8.187, not from the printed 8.178",
    ("jump_off", "minus_W_over_R_dgamma", 5.0): f"known misprint, converged 2.67591: {BESIDE}",
}
ROUNDED_NOTE = "the printed argument is rounded"


@dataclass(frozen=True)
class Printed:
    """A printed number and the computed one.

    Attributes
    ----------
    row : str
        Row of the table.
    column : float
        Column: alpha* of Table 1, the Tabor parameter of Table 2, the gap of Fig. 4.
    unit : str
        Of both values.
    printed : str
        As printed.
    computed : Estimate
        Converged value with its error.
    note : str
        What explains the difference.
    """

    row: str
    column: float
    unit: str
    printed: str
    computed: Estimate
    note: str

    @property
    def deviation(self) -> float:
        """Computed over printed value, less one."""
        return self.computed.value / float(self.printed) - 1


def table_1() -> list[Printed]:
    """Table 1: f(alpha*)/alpha*^(3/2) of the force method."""
    return [
        _excess(float(row["alpha_star"]), row["f_over_alpha_star_1_5"]) for row in _rows("greenwood1997_table1.csv")
    ]


def _excess(alpha: float, printed: str) -> Printed:
    computed = Estimate(float(dmt.force_excess(alpha)) / alpha**1.5, ROUNDING / alpha**1.5)
    return Printed("f_over_alpha_star_1_5", alpha, "1", printed, computed, _explained(printed, computed, ""))


def excess_asymptote() -> tuple[Estimate, Estimate]:
    """Constants of f = a alpha*^(3/2) - b alpha*^2, fitted between 2e-5 and 1e-4: 1.84 and 7.7 in the paper."""
    alpha = np.geomspace(2e-5, 1e-4, 30)
    ratio = dmt.force_excess(alpha) / alpha**1.5
    values, covariance = curve_fit(lambda root, a, b: a - b * root, np.sqrt(alpha), ratio, p0=(1.84, 7.7))
    a, b = (Estimate(float(v), float(e)) for v, e in zip(values, np.sqrt(np.diag(covariance)), strict=True))
    return a, b


def table_2(paths: Mapping[float, EquilibriumPath]) -> list[Printed]:
    """Table 2, jumping on and off, from converged paths at those of its Tabor parameters that are given."""
    return [entry for row in _rows("greenwood1997_table2.csv") for entry in _entries(row, paths)]


def _entries(row: Mapping[str, str], paths: Mapping[float, EquilibriumPath]) -> Iterator[Printed]:
    name, quantity = row["event"], row["quantity"]
    for tabor in TABORS:
        printed, path = row[f"mu={tabor:g}"], paths.get(tabor)
        event = path.event(name) if path else None
        if path and printed and event:
            computed, unit = _quantity(quantity, event, tabor)
            note = _explained(printed, computed, _note(name, quantity, path))
            yield Printed(f"{name} {quantity}", tabor, unit, printed, computed, note)


def _quantity(quantity: str, event: Event, tabor: float) -> tuple[Estimate, str]:
    """A quantity of Table 2 at an event, and its unit."""
    if quantity == "minus_W_over_R_dgamma_AP":
        load = -float(criteria.undeformed_load(criteria.closed_gap(tabor, criteria.ATTARD_PARKER)))
        return Estimate(load, ROUNDING * load), "R dgamma"
    scale = tabor ** (3 / 7)
    return {
        "minus_alpha_star": (Estimate(-event.approach, event.approach_error), "eps"),
        "minus_alpha_star_over_mu": (Estimate(-event.approach / tabor, event.approach_error / tabor), "beta^2/R"),
        "minus_W_over_R_dgamma": (Estimate(-event.load, event.load_error), "R dgamma"),
        "H0": (Estimate(event.central_gap, event.central_gap_error), "eps"),
        "H0_plus_1_over_mu_3_7": (Estimate((event.central_gap + 1) / scale, event.central_gap_error / scale), "1"),
        "a_star": (Estimate(event.contact_radius, event.contact_radius_error), "beta"),
    }[quantity]


def _note(name: str, quantity: str, path: EquilibriumPath) -> str:
    """What explains a deviation: a misprint, a state that is not at the fold, or another printed number."""
    note = MISPRINTS.get((name, quantity, path.tabor)) or NOTES.get((name, quantity), BESIDE)
    return note.format(beside=_beside(name, path))


def _beside(name: str, path: EquilibriumPath) -> str:
    """State near a fold whose load is the printed one: the paper's column, if its approach is left aside."""
    rows = _rows("greenwood1997_table2.csv")
    row = next(r for r in rows if (r["event"], r["quantity"]) == (name, "minus_W_over_R_dgamma"))
    load = -float(row[f"mu={path.tabor:g}"])
    approach, _, gap, radius = states(path, Condition(LOAD, value=load))[0].point.observables
    edge = "" if np.isnan(radius) else f"a* = {radius:.4f}, "
    return f"H0 = {gap:.5f}, {edge}alpha* = {approach:.5f}"


def profile_checks() -> list[Printed]:
    """Printed pressures of Fig. 4 at mu = 5, which settle the sign of [G97] (2.9)."""
    return [_profile_check(*check) for check in PROFILE_CHECKS]


def _profile_check(gap: str, printed: str) -> Printed:
    """Pressure at a printed gap, whose own last digit is the error."""
    H = np.array(float(gap))
    half_digit = _last_digit(gap) / 2
    error = abs(float(LENNARD_JONES.slope(H, 5.0))) * half_digit
    computed = Estimate(float(LENNARD_JONES.pressure(H, 5.0)), error)
    return Printed("P at gap H", float(gap), "dgamma/(mu eps)", printed, computed, ROUNDED_NOTE)


def _explained(printed: str, computed: Estimate, note: str) -> str:
    """`note`, unless the printed value is the computed one rounded."""
    rounded = abs(computed.value - float(printed)) <= _last_digit(printed) * (0.5 + 1e-9) + computed.error
    return LAST_DIGIT if rounded else note


def _last_digit(printed: str) -> float:
    return float(10.0 ** -len(printed.partition(".")[2]))


def _rows(name: str) -> list[dict[str, str]]:
    """Rows of a packaged table, comments left out."""
    text = (resources.files("fem_adhesion.studies") / "data" / name).read_text()
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
