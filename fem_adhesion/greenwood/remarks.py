"""What is to be seen in each table of the Greenwood study: counted and measured on its entries."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.greenwood.criteria import CriteriaStudy
from fem_adhesion.greenwood.devices import DeviceStudy
from fem_adhesion.greenwood.relaxation import Attempt
from fem_adhesion.greenwood.study import Greenwood1997, PullOff
from fem_adhesion.greenwood.tables import Printed
from fem_adhesion.greenwood.text import joined, rises, told
from fem_adhesion.greenwood.trend_captions import closed_ratios
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF
from halfspace.values import Estimate


def agreement(entries: Sequence[Printed]) -> str:
    """How many entries agree to their last digit, and which is off most."""
    if not entries:
        return "Nothing was computed."
    exact = sum(entry.to_last_digit for entry in entries)
    known = [entry for entry in entries if math.isfinite(entry.deviation)]
    worst = max(known, key=lambda entry: abs(entry.deviation), default=None)
    return joined(
        f"{exact} of {len(entries)} values agree to their last printed digit.",
        f"The largest relative deviation is {abs(worst.deviation):.1e}, in {worst.row} at {worst.column:g}."
        if worst
        else "",
        "" if len(known) == len(entries) else f"{len(entries) - len(known)} are not numbers.",
    )


def table_1(entries: Sequence[Printed], asymptote: tuple[Estimate, Estimate]) -> str:
    """Agreement, and the constants of the asymptote."""
    a, b = asymptote
    fit = (
        f"The asymptote f = a alpha*^(3/2) - b alpha*^2, fitted between 2e-5 and 1e-4, has a = {plus_minus(a)} and b = "
        f"{plus_minus(b)} (standard errors of the fit; the paper: 1.84 and 7.7)."
    )
    return joined(agreement(entries), told(fit, a.value, b.value))


def profile_checks(entries: Sequence[Printed]) -> str:
    """Whether the printed pressures have the sign and size of the corrected law."""
    if not entries:
        return "Nothing was computed."
    same = sum(float(entry.printed) * entry.computed.value > 0 for entry in entries)
    within = sum(entry.to_last_digit for entry in entries)
    return (
        f"{same} of {len(entries)} printed pressures have the sign of the corrected law, compression positive, and "
        f"{within} its value within the error, which is that of the rounded gap."
    )


def devices(study: DeviceStudy) -> str:
    """Whether a softer apparatus loses more."""
    lost = np.array([cycle.energy_lost.value for cycle in study.cycles])
    grows = "the more energy a cycle loses" if rises(lost) else "the energy that a cycle loses does not always grow"
    return joined(told(f"The softer the apparatus, {grows}.", lost), "The loss is the work of the base round the loop.")


def relaxations(attempts: Sequence[Attempt]) -> str:
    """How many of each iteration ended, and in how many sweeps."""
    names = dict.fromkeys(attempt.method for attempt in attempts)
    return joined(*(_iteration(name, [a for a in attempts if a.method == name]) for name in names))


def _iteration(name: str, attempts: Sequence[Attempt]) -> str:
    sweeps = [attempt.sweeps for attempt in attempts if attempt.sweeps is not None]
    ended = f"{name}: {len(sweeps)} of {len(attempts)} converged"
    return f"{ended}, in {min(sweeps)} to {max(sweeps)} sweeps." if sweeps else f"{ended}."


def pull_offs(found: Sequence[PullOff]) -> str:
    """The ends beside their limits."""
    if not found:
        return "Nothing was computed."
    first, last = found[0], found[-1]
    text = (
        f"From {first.half_space.value:.4f} at mu = {first.tabor:.3g} to {last.half_space.value:.4f} at mu = "
        f"{last.tabor:.3g}; Bradley's is -2 pi = {BRADLEY_PULL_OFF:.4f}, JKR's -3 pi/2 = {JKR_PULL_OFF:.4f}."
    )
    return told(text, first.half_space.value, last.half_space.value) or joined()


def true_jumps(study: CriteriaStudy) -> str:
    """What the fundamental criterion reads at the true jumps."""
    read = np.array([jump.fundamental for jump in study.jumps])
    if not read.size:
        return "Nothing was computed."
    verdict = "states that it calls unstable are stable" if read.max() < -1 else "it does not always come too soon"
    text = (
        f"The fundamental criterion (4.3) expects b sigma'/sigma = -1 at the jump, where the solution has "
        f"{read.max():.2f} to {read.min():.2f}: {verdict}."
    )
    return told(text, read) or joined()


def constants(study: CriteriaStudy) -> str:
    """How far the closed criteria's printed constants are from the refitted ones."""
    printed = [
        (criterion.name, value / fitted.value)
        for criterion in study.criteria
        for name, value, fitted in criterion.constants
        if name == "k" and value is not None
    ]
    ratios = np.array([ratio for _, ratio in printed])
    if not ratios.size:
        return "Least squares of logarithms."
    low, high = min(printed, key=lambda item: item[1]), max(printed, key=lambda item: item[1])
    size = "too large" if low[1] > 1 else "too small" if high[1] < 1 else "too small and too large"
    text = f"The closed criteria's are {size}: {low[1]:.2f} times the refitted ({low[0]}) to {high[1]:.2f} ({high[0]})."
    return joined("Least squares of logarithms.", told(text, ratios, closed_ratios(study)))


def rises_of(study: Greenwood1997) -> str:
    """Why each series ends."""
    return joined(*(f"{spacing:g} beta: ended as {rise.ended}." for spacing, rise in study.rises.items()))
