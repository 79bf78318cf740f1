"""The cross-check as plain data, for machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fem_adhesion.common.facts import finite, versions
from fem_adhesion.crosscheck.comparison import Row
from fem_adhesion.crosscheck.study import Case, Failure
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import Event, is_fold
from halfspace.values import Estimate

VERDICTS = ("failed", "disagree", "inconclusive", "agree")  # worst first
EVENT_KEYS = ("approach", "load", "central_gap", "contact_radius", "approach_error", "load_error")
EVENT_NAMES = ("pull_off", "jump_on", "jump_off")


def verdict_of(case: Case | Failure) -> str:
    """Verdict of a case, ``failed`` if it was not solved."""
    return "failed" if isinstance(case, Failure) else case.verdict


def told(failure: Failure) -> str:
    """Why a case has no solution, and which rows show what is wrong."""
    return "; ".join([failure.reason, *(f"{quantity} disagrees" for quantity in failure.shown_by)])


def overall_verdict(cases: Sequence[Case | Failure]) -> str:
    """The worst verdict of all."""
    return min(map(verdict_of, cases), key=VERDICTS.index)


def crosscheck_record(cases: Sequence[Case | Failure]) -> dict[str, Any]:
    """All cases with verdict and versions, ready for JSON: no NaN, an event that does not exist is absent."""
    return {"verdict": overall_verdict(cases), "versions": versions(), "cases": [_case(case) for case in cases]}


def _case(case: Case | Failure) -> dict[str, Any]:
    scene = {"tabor": case.scene.tabor, "poisson": case.scene.poisson, "verdict": verdict_of(case)}
    if isinstance(case, Failure):
        return {**scene, "reason": told(case), "comparison": [_row(row) for row in case.rows]}
    solutions = {KEYS[name]: _solution(path) for name, path in case.solutions.items()}
    return {**scene, **solutions, "comparison": [_row(row) for row in case.rows]}


KEYS = {"half-space": "halfspace", "harmonics": "harmonics", "finite elements": "finite_element"}


def _solution(path: EquilibriumPath) -> dict[str, Any]:
    return {
        "events": {name: _event(event) for name, event in path.events.items() if name in EVENT_NAMES or is_fold(name)},
        "jumps": path.jumps,
        "rtol": path.rtol,
        "missed": {name: list(numbers) for name, numbers in path.missed.items()},
        "unknowns": path.unknowns,
        "seconds": path.seconds,
        "settings": path.settings,
    }


def _event(event: Event) -> dict[str, float | None]:
    return {key: finite(getattr(event, key)) for key in EVENT_KEYS}


def _row(row: Row) -> dict[str, Any]:
    return {
        "quantity": row.quantity,
        "unit": row.unit,
        "between": list(row.between),
        "first": _value(row.first),
        "second": _value(row.second),
        "difference": finite(row.difference),
        "first_error": _error(row.first),
        "second_error": _error(row.second),
        "error": finite(row.error),
        "budget": row.budget,
        "verdict": row.verdict,
    }


def _value(estimate: Estimate | None) -> float | None:
    return finite(estimate.value) if estimate else None


def _error(estimate: Estimate | None) -> float | None:
    return finite(estimate.error) if estimate else None
