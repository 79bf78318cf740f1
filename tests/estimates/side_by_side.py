"""The same contact by both solvers, in scenes drawn at random: no two numbers may differ by more than both estimates.

A seed given again draws the same scenes.
"""

import math
import time
from collections import Counter
from typing import NamedTuple

import numpy as np

import fem_adhesion
import halfspace
from fem_adhesion import HalfSpace, Scene
from fem_adhesion.common.jobs import progress_bar, stream
from halfspace.errors import NotConverged

QUANTITIES = ("approach", "load", "central_gap", "contact_radius")
SCENES = {"full": 60, "quick": 4}
TABORS, RTOLS, FE_RTOLS = (0.02, 30.0), (1e-9, 1e-1), (1e-6, 1e-1)
LEAST_COMPRESSIBLE = 1e-6  # of 1/2 - poisson
SHARE = 0.99  # of the numbers that must lie within, as of the estimates of either solver


class Drawn(NamedTuple):
    """A scene, and the tolerances of the half-space and of the finite elements."""

    tabor: float
    poisson: float
    rtol: float
    fe_rtol: float

    def __str__(self):
        return f"tabor {self.tabor!r}, poisson {self.poisson!r}, rtol {self.rtol!r} and {self.fe_rtol!r}"


def drawn(seed, count):
    """Scenes: Tabor parameters and tolerances of any size, Poisson's ratios anywhere and near either end."""
    random = np.random.default_rng(seed)
    return [_drawn(random) for _ in range(count)]


def _drawn(random):
    tabor, rtol, fe_rtol = (math.exp(random.uniform(*np.log(ends))) for ends in (TABORS, RTOLS, FE_RTOLS))
    near = 0.5 * math.exp(random.uniform(math.log(2 * LEAST_COMPRESSIBLE), 0.0))
    poisson = (0.0, random.uniform(0.0, 0.49), near, 0.5 - near)[random.integers(4)]
    return Drawn(tabor, poisson, rtol, fe_rtol)


def compared(scene):
    """Each number with the difference of both solvers in parts of the sum of their estimates; or why there is none."""
    try:
        one = halfspace.trace(scene.tabor, rtol=scene.rtol)
        other = fem_adhesion.trace(Scene(scene.tabor, HalfSpace(poisson=scene.poisson)), rtol=scene.fe_rtol)
    except NotConverged as error:
        return {f"not solved: {error}": math.inf}
    if one.events.keys() != other.events.keys():
        return {f"events {', '.join(one.events)} and {', '.join(other.events)}": math.inf}
    parts = {f"{name} {q}": _part(one.events[name], other.events[name], q) for name in one.events for q in QUANTITIES}
    energy = abs(one.energy.value - other.energy.value) / (one.energy.error + other.energy.error)
    return {what: part for what, part in parts.items() if not math.isnan(part)} | {"released energy": energy}


def _part(a, b, quantity):
    error = f"{quantity}_error"
    return abs(getattr(a, quantity) - getattr(b, quantity)) / (getattr(a, error) + getattr(b, error))


def searched(net, seed):
    """Draw scenes, print the table and every number outside; whether the shares inside are what they should be."""
    began, numbers = time.perf_counter(), []
    print(f"\nboth solvers side by side, {SCENES[net]} scenes of seed {seed}", flush=True)
    with progress_bar() as told:
        for k, (scene, parts) in enumerate(stream(compared, drawn(seed, SCENES[net])), start=1):
            told("side by side", k, SCENES[net])
            numbers += [(what.split()[-1], part) for what, part in parts.items()]
            for what, part in parts.items():
                if part > 1:
                    print(f"    {what}: {part:.2g} times the sum of both estimates: {scene}", flush=True)
    return _told(numbers, time.perf_counter() - began)


def _told(numbers, seconds):
    """Print a row for each quantity, with the worst ratio of difference and estimates."""
    outside = Counter(quantity for quantity, part in numbers if part > 1)
    print(f"{'quantity':22}{'numbers':>8}{'outside':>9}{'worst ratio':>18}")
    for quantity in (*QUANTITIES, "energy"):
        parts = [part for q, part in numbers if q == quantity]
        print(f"{quantity:22}{len(parts):8}{outside[quantity]:9}{max(parts, default=math.nan):18.2g}")
    print(f"{len(numbers)} numbers in {seconds:.0f} s", flush=True)
    return outside.total() <= max(1, int((1 - SHARE) * len(numbers)))
