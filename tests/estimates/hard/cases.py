"""Cases that are hard for the solvers, each with the ending that it must come to."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

from fem_adhesion import Block, HalfSpace
from fem_adhesion.common.fold_birth import FIRST, SECOND
from fem_adhesion.scene import Scene
from halfspace.errors import GridTooCoarse, InputError, NotConverged
from hard.bodies import obtuse, solved, stretched, too_coarse
from hard.contacts import (
    compressed,
    from_other_branch,
    gaps_below_equilibrium,
    located_birth,
    long_steps,
    near_birth,
    tangent_spring,
    traced,
)
from hard.measured import Measured
from hard.run import WITHIN, Attempt, Case, Refusal
from hard.spheres import against_half_space, against_integral, against_tighter

NO_CONVERGENCE = Refusal(NotConverged, "last relative step", "40 Newton steps", "try a nearer start")


def cases() -> tuple[Case, ...]:
    """All hard cases: those to be solved, and those to be refused."""
    solvable = (_extremes(), _folds(), _starts(), _bodies(), _spheres(), _ends())
    within = tuple(Case(name, attempt) for group in solvable for name, attempt in group.items())
    return (*within, *_lost_starts(), *_coarse_grids(), *_beyond_bodies(), *_beyond_spheres(), *_beyond_numbers())


def _extremes() -> Mapping[str, Attempt]:
    return {
        "tabor 0.005": partial(traced, 0.005),
        "tabor 0.02, compressed to 20 R dgamma": partial(compressed, 0.02, 20.0),
        "tabor 0.02 to load 20, finite elements": partial(solved, Scene(0.02), to_load=20.0),
        "tabor 50": partial(traced, 50.0),
        "tabor 100": partial(traced, 100.0),
        "tabor 50, finite elements": partial(solved, Scene(50.0), rtol=1e-3),
    }


def _folds() -> Mapping[str, Attempt]:
    return {
        "critical tabor": partial(located_birth, FIRST),
        "critical tabor - 1e-4: no fold": partial(near_birth, FIRST, -1e-4, 0),
        "critical tabor + 1e-4: two folds": partial(near_birth, FIRST, 1e-4, 2),
        "birth of a second pair of folds": partial(located_birth, SECOND),
        "second birth - 1e-4: two folds": partial(near_birth, SECOND, -1e-4, 2),
        "second birth + 1e-4: four folds": partial(near_birth, SECOND, 1e-4, 4),
    }


def _starts() -> Mapping[str, Attempt]:
    spring = partial(tangent_spring, 2.0, (0.25, 0.45))
    return {
        "start from contact, far left of jump_off": partial(from_other_branch, 2.0, -3.0, -9.0),
        "steps 100 times too long, tabor 2": partial(long_steps, 2.0, 100.0),
        "steps 100 times too long, tabor 20": partial(long_steps, 20.0, 100.0),
        "spring 1 % softer than that": partial(spring, stiffer=0.99, start=0.6),
        "spring 1 % stiffer than that": partial(spring, stiffer=1.01, start=0.2),
    }


def _bodies() -> Mapping[str, Attempt]:
    rubber = {
        f"poisson {poisson:g}": partial(solved, Scene(1.0, HalfSpace(poisson=poisson)), rtol=1e-5)
        for poisson in (0.49, 0.499, 0.4999, 0.499999)
    }
    return {
        **rubber,
        "cells of aspect ratio 100": partial(stretched, 100.0),
        "angle of 170 degrees at the contact edge": partial(obtuse, math.radians(170)),
        "block of 5.5 beta": partial(solved, Scene(1.0, Block(radius=5.5)), rtol=1e-3),
        "clamped block of 20 beta": partial(solved, Scene(1.0, Block(radius=20.0, far_field="clamped")), rtol=1e-3),
        "free block of 20 beta": partial(solved, Scene(1.0, Block(radius=20.0, far_field="free")), rtol=1e-3),
        "block of 1e9 beta": partial(solved, Scene(1.0, Block(radius=1e9)), rtol=1e-3),
    }


def _spheres() -> Mapping[str, Attempt]:
    return {
        "sphere of R/eps 1e12": partial(against_half_space, 1e12),
        "half-space under a sphere of R/eps 3": partial(against_integral, 3.0),
        "sphere as small as its contact, R = 1.5 beta": partial(against_tighter, radius_ratio=2.25),
        "rubber sphere, poisson 0.4999": partial(against_tighter, poisson=0.4999),
        "sphere at tabor 6": partial(against_tighter, tabor=6.0),
        "rigid sphere, tabor 1e-9": partial(against_tighter, tabor=1e-9),
    }


def _ends() -> Mapping[str, Attempt]:
    return {
        "tabor 1e-12": partial(traced, 1e-12),
        "tabor 300": partial(traced, 300.0),
        "tabor 1e-12, finite elements": partial(solved, Scene(1e-12)),
        "rtol 1e-9": partial(traced, 1.0, rtol=1e-9),
        "rtol 1e-1": partial(traced, 1.0, rtol=1e-1),
    }


# To be refused


def _lost_starts() -> tuple[Case, ...]:
    """Newton's method started where it cannot arrive, or crawls: at a triple root, rounding says whether it does."""
    lost = Refusal(NotConverged, "last relative step", "40 Newton steps", "try a nearer start")
    tangent = partial(tangent_spring, 2.0, (0.25, 0.45), stiffer=1.0, start=0.6)
    return (
        Case("start with gaps of 0.8 eps", partial(gaps_below_equilibrium, 2.0, -3.0, -0.2), (lost,)),
        Case("start with gaps of 0.01 eps", partial(gaps_below_equilibrium, 2.0, -3.0, -0.99), (lost,)),
        Case("start from separation, right of jump_on", partial(from_other_branch, 2.0, -9.0, 0.0), (lost,)),
        Case("start from contact, just left of jump_off", partial(from_other_branch, 2.0, -3.0, -3.6), (lost,)),
        Case("spring tangent to third order", tangent, (WITHIN, lost)),
    )


def _coarse_grids() -> tuple[Case, ...]:
    edge = Refusal(GridTooCoarse, "spacing 0.202 beta", "exceeds 0.175 beta for tabor 2", "refine the grid there")
    mesh = Refusal(GridTooCoarse, "spacing 0.208 beta", "exceeds 0.084 beta for tabor 2", "refine the grid there")
    return (
        Case("contact on cells that are fine on the axis", partial(from_other_branch, 2.0, -3.0, -3.0), (edge,)),
        Case("mesh too coarse by ten", partial(too_coarse, 10.0), (mesh,)),
    )


def _beyond_bodies() -> tuple[Case, ...]:
    clamped = Refusal(InputError, "tabor = 5", "tabor <= 3 for a fixed mesh", 'far_field = "point_load"')
    wider = "take 50 or more"
    return (
        Case(
            "clamped block of 10 beta, tabor 5",
            partial(_block, 5.0, radius=10.0, far_field="clamped"),
            (clamped,),
        ),
        _refused("block of 5.5 beta, tabor 0.02", partial(_block, 0.02, radius=5.5), "radius = 5.5", "35.4 <", wider),
        _refused("block of 1e300 beta", partial(_block, 1.0, radius=1e300), "radius = 1e+300", "<= 1e9", wider),
        _refused(
            "poisson 0.49999999",
            partial(_half_space, 0.49999999),
            "0.49999999",
            "<= 0.499999",
            "take 0.4999",
        ),
    )


def _block(tabor: float, **block: Any) -> Measured:
    """Solve a scene that is refused where it is made, so that it cannot be made beforehand."""
    return solved(Scene(tabor, Block(**block)), rtol=1e-3)


def _half_space(poisson: float) -> Measured:
    return solved(Scene(1.0, HalfSpace(poisson=poisson)), rtol=1e-3)


def _beyond_spheres() -> tuple[Case, ...]:
    limit, remedy = "2 <= radius_ratio <= 1e12", "it is the radius over the spacing: change one of the two"
    small = Refusal(InputError, "radius_ratio = 100", "2.25 tabor = 112 or more", "take a stiffer or larger one")
    return (
        _refused("sphere of R/eps 1e13", partial(against_tighter, radius_ratio=1e13), "= 1e+13", limit, remedy),
        _refused("sphere of R/eps 1", partial(against_tighter, radius_ratio=1.0), "= 1 is", limit, remedy),
        _refused("sphere of R/eps nan", partial(against_tighter, radius_ratio=math.nan), "= nan", limit, remedy),
        Case("sphere smaller than its contact", partial(against_tighter, tabor=50.0), (small,)),
    )


def _beyond_numbers() -> tuple[Case, ...]:
    rigid, soft = (
        ("1e-12 <= tabor", "halfspace.theories.closed_forms.bradley_load"),
        ("tabor <= 300", "halfspace.theories.closed_forms.jkr_load"),
    )
    rtol, load = ("1e-9 <= rtol <= 0.1", "take 1e-5"), ("0 < to_load <= 1000", "take 5")
    return (
        _refused("tabor 1e-300", partial(traced, 1e-300), "tabor = 1e-300", *rigid),
        _refused("tabor 1e12", partial(traced, 1e12), "tabor = 1e+12", *soft),
        _refused("tabor 1e300", partial(traced, 1e300), "tabor = 1e+300", *soft),
        _refused("rtol 1e-10", partial(traced, 1.0, rtol=1e-10), "rtol = 1e-10", *rtol),
        _refused("rtol 1", partial(traced, 1.0, rtol=1.0), "rtol = 1 is", *rtol),
        _refused("load nan", partial(traced, 1.0, to_load=math.nan), "to_load = nan", *load),
        _refused("load 1e9", partial(traced, 1.0, to_load=1e9), "to_load = 1e+09", *load),
    )


def _refused(name: str, attempt: Attempt, value: str, limit: str, remedy: str) -> Case:
    """Case that must be refused as bad input."""
    return Case(name, attempt, (Refusal(InputError, value, limit, remedy),))
