"""Cases that are hard for the solvers, each of which must end in a number within its estimate or in a clear refusal."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal

from fem_adhesion.scene import Scene
from fem_adhesion.studies.fold_birth import FIRST, SECOND
from fem_adhesion.studies.hard_bodies import obtuse, solved, stretched, too_coarse
from fem_adhesion.studies.hard_contacts import (
    compressed,
    from_other_branch,
    gaps_below_equilibrium,
    located_birth,
    long_steps,
    near_birth,
    tangent_spring,
    traced,
)
from fem_adhesion.studies.hard_spheres import against_half_space, against_integral, against_tighter
from fem_adhesion.studies.measured import Measured
from halfspace.errors import InputError, NotConverged

Outcome = Literal["converged", "refused", "wrong"]
Attempt = Callable[[], Measured]

REMEDY = ";"  # a message names the cause before it and the remedy behind it


@dataclass(frozen=True)
class Case:
    """A name and what is attempted under it."""

    name: str
    attempt: Attempt


@dataclass(frozen=True)
class Row:
    """How a case ended.

    Attributes
    ----------
    name : str
        Of the case.
    outcome : str
        ``converged`` within the estimate, ``refused`` with a message that names cause and remedy, or ``wrong``: in
        error beyond the estimate, or refused without saying why.
    message : str
        What was compared with what, or the refusal.
    error, estimate : float
        Of the quantity worst off; NaN if refused.
    newton_steps : int
        Taken; 0 if refused.
    seconds : float
        Wall time, that of the reference included.
    """

    name: str
    outcome: Outcome
    message: str
    error: float
    estimate: float
    newton_steps: int
    seconds: float


def run(cases: Sequence[Case]) -> Iterator[Row]:
    """Attempt the cases one after the other."""
    for case in cases:
        began = time.perf_counter()
        ending = _attempt(case)
        seconds = time.perf_counter() - began
        if isinstance(ending, Measured):
            yield _measured_row(case, ending, seconds)
        else:
            outcome: Outcome = "refused" if REMEDY in ending else "wrong"
            yield Row(case.name, outcome, ending, math.nan, math.nan, 0, seconds)


def _attempt(case: Case) -> Measured | str:
    """What was measured, or the message with which it was refused."""
    try:
        return case.attempt()
    except (InputError, NotConverged) as error:
        return str(error)


def _measured_row(case: Case, found: Measured, seconds: float) -> Row:
    message = f"{found.quantity}, against: {found.reference}"
    outcome: Outcome = "converged" if found.within else "wrong"
    return Row(case.name, outcome, message, found.error, found.estimate, found.newton_steps, seconds)


def cases() -> tuple[Case, ...]:
    """All hard cases."""
    groups = (_extremes(), _folds(), _starts(), _bodies(), _spheres(), _limits())
    return tuple(Case(name, attempt) for group in groups for name, attempt in group.items())


def _extremes() -> dict[str, Attempt]:
    return {
        "tabor 0.005": partial(traced, 0.005),
        "tabor 0.02, compressed to 20 R dgamma": partial(compressed, 0.02, 20.0),
        "tabor 0.02 to load 20, finite elements": partial(solved, Scene(0.02), to_load=20.0),
        "tabor 50": partial(traced, 50.0),
        "tabor 100": partial(traced, 100.0),
        "tabor 50, finite elements": partial(solved, Scene(50.0), rtol=1e-3),
    }


def _folds() -> dict[str, Attempt]:
    return {
        "critical tabor": partial(located_birth, FIRST),
        "critical tabor - 1e-4: no fold": partial(near_birth, FIRST, -1e-4, 0),
        "critical tabor + 1e-4: two folds": partial(near_birth, FIRST, 1e-4, 2),
        "birth of a second pair of folds": partial(located_birth, SECOND),
        "second birth - 1e-4: two folds": partial(near_birth, SECOND, -1e-4, 2),
        "second birth + 1e-4: four folds": partial(near_birth, SECOND, 1e-4, 4),
    }


def _starts() -> dict[str, Attempt]:
    spring = partial(tangent_spring, 2.0, (0.25, 0.45))
    return {
        "start with gaps of 0.8 eps": partial(gaps_below_equilibrium, 2.0, -3.0, -0.2),
        "start with gaps of 0.01 eps": partial(gaps_below_equilibrium, 2.0, -3.0, -0.99),
        "start from contact, far left of jump_off": partial(from_other_branch, 2.0, -3.0, -9.0),
        "start from contact, just left of jump_off": partial(from_other_branch, 2.0, -3.0, -3.6),
        "start from separation, right of jump_on": partial(from_other_branch, 2.0, -9.0, 0.0),
        "steps 100 times too long, tabor 2": partial(long_steps, 2.0, 100.0),
        "steps 100 times too long, tabor 20": partial(long_steps, 20.0, 100.0),
        "spring tangent to third order": partial(spring, stiffer=1.0, start=0.6),
        "spring 1 % softer than that": partial(spring, stiffer=0.99, start=0.6),
        "spring 1 % stiffer than that": partial(spring, stiffer=1.01, start=0.2),
    }


def _bodies() -> dict[str, Attempt]:
    rubber = {
        f"poisson {poisson:g}": partial(solved, Scene(1.0, poisson=poisson), rtol=1e-5)
        for poisson in (0.49, 0.499, 0.4999, 0.499999)
    }
    return rubber | {
        "cells of aspect ratio 100": partial(stretched, 100.0),
        "angle of 170 degrees at the contact edge": partial(obtuse, math.radians(170)),
        "mesh too coarse by ten": partial(too_coarse, 10.0),
        "block of 5.5 beta": partial(solved, Scene(1.0, radius=5.5), rtol=1e-3),
        "block of 5.5 beta, tabor 0.02": lambda: solved(Scene(0.02, radius=5.5), rtol=1e-3),
        "clamped block of 20 beta": partial(solved, Scene(1.0, radius=20.0, far_field="clamped"), rtol=1e-3),
        "clamped block of 10 beta, tabor 5": lambda: solved(Scene(5.0, radius=10.0, far_field="clamped"), rtol=1e-3),
        "free block of 20 beta": partial(solved, Scene(1.0, radius=20.0, far_field="free"), rtol=1e-3),
        "block of 1e9 beta": partial(solved, Scene(1.0, radius=1e9), rtol=1e-3),
    }


def _spheres() -> dict[str, Attempt]:
    return {
        "sphere of R/eps 1e12": partial(against_half_space, 1e12),
        "half-space under a sphere of R/eps 3": partial(against_integral, 3.0),
        "sphere as small as its contact, R = 1.5 beta": partial(against_tighter, radius_ratio=2.25),
        "rubber sphere, poisson 0.4999": partial(against_tighter, poisson=0.4999),
        "sphere at tabor 6": partial(against_tighter, tabor=6.0),
        "rigid sphere, tabor 1e-9": partial(against_tighter, tabor=1e-9),
    }


def _limits() -> dict[str, Attempt]:
    return {
        "sphere of R/eps 1e13": partial(against_tighter, radius_ratio=1e13),
        "sphere of R/eps 1": partial(against_tighter, radius_ratio=1.0),
        "sphere smaller than its contact": partial(against_tighter, tabor=50.0),
        "sphere of R/eps nan": partial(against_tighter, radius_ratio=math.nan),
        "tabor 1e-12": partial(traced, 1e-12),
        "tabor 1e-300": partial(traced, 1e-300),
        "tabor 300": partial(traced, 300.0),
        "tabor 1e12": partial(traced, 1e12),
        "tabor 1e300": partial(traced, 1e300),
        "tabor 1e-12, finite elements": partial(solved, Scene(1e-12)),
        "rtol 1e-9": partial(traced, 1.0, rtol=1e-9),
        "rtol 1e-10": partial(traced, 1.0, rtol=1e-10),
        "rtol 1e-1": partial(traced, 1.0, rtol=1e-1),
        "rtol 1": partial(traced, 1.0, rtol=1.0),
        "poisson 0.49999999": lambda: solved(Scene(1.0, poisson=0.49999999)),
        "load nan": partial(traced, 1.0, to_load=math.nan),
        "load 1e9": partial(traced, 1.0, to_load=1e9),
        "block of 1e300 beta": lambda: solved(Scene(1.0, radius=1e300)),
    }
