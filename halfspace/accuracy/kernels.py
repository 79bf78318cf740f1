"""How the pressure on the half-space is represented: by panels, or as in 1997 by overlapping triangles or by bands.

All have the same cells, fine at the contact edge and the last of them infinite. A panel has one polynomial in each. For
triangles and bands each cell is cut into equal intervals, and the errors of two sizes of these are extrapolated to none
in the operator, see `halfspace.elastic.extrapolated`. So 200 to 600 nodes leave 1e-5 of loads and approaches up to a
Tabor parameter of 5, where plain triangles need 3000 to 6000.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from halfspace.accuracy.finite_bodies import Made
from halfspace.accuracy.grids import (
    GRIDS,
    MakeOperator,
    Resolution,
    endless,
    half_space_charts,
    resolutions_for,
    under_sphere,
)
from halfspace.accuracy.refinement import MOST_RUNGS
from halfspace.accuracy.stages import Discretised, charted
from halfspace.accuracy.standing import sized
from halfspace.elastic import compliance
from halfspace.elastic.extrapolated import divided, extrapolated
from halfspace.errors import InputError
from halfspace.limits import require_between, require_one_of
from halfspace.scales import Scales
from halfspace.values import Array


@dataclass(frozen=True)
class KernelSettings:
    """How many intervals of the pressures of 1997 a cell has, m or 2 m in an estimate."""

    part: float = 0.08  # times m^-4: what the estimates leave of a load, found by trial
    crossing: float = 2.0  # of a change, what may be left where errors of two orders cancel; 1 leaves 1 % outside
    fewest: int = 3  # intervals a cell, of as many parts each, with which the grid carries the spike
    beyond: int = 8  # nodes of the infinite cell; with 12 no digit of 1e-5 is another


INTERVALS = KernelSettings()


@dataclass(frozen=True)
class Kernel:
    """A representation of the pressure.

    `make` makes the operator of the half-space. `resolutions` gives, for a relative accuracy, that of a level, that of
    the level below and, if the change from it tells anything, a coarser one. Of the last change `left` may be left as
    error. `least` is the smallest accuracy that is served, and `most_rungs` the number of levels above the lowest.
    """

    name: str
    make: MakeOperator
    resolutions: Callable[[Scales, float, int], tuple[Resolution, ...]]
    left: float
    least: float
    most_rungs: int

    def discretise(self, scales: Scales, to_load: float, resolution: Resolution, _which: int) -> Discretised:
        """Half-space at a resolution: an operator for all radii, unless the surface ends."""
        if math.isfinite(scales.profile.end):
            return sized(under_sphere(scales, resolution, to_load), resolution.nodes)
        return charted(half_space_charts(scales, resolution, to_load=to_load, make=self.make))


def _straight(kind: str, parts: int, intervals: int, reach: float, cells: Array) -> Made:
    """Operator on cells divided into intervals, by one of `compliance`."""
    inner = extrapolated(getattr(compliance, kind), divided(cells, intervals), parts)
    operator = compliance.to_infinity(inner, INTERVALS.beyond, reach)
    return operator, operator.radii.size


def _finer(scales: Scales, rtol: float, level: int) -> tuple[Resolution, ...]:
    """Resolutions with twice as many intervals from level to level."""
    least = max(INTERVALS.fewest, math.ceil((INTERVALS.part / rtol) ** 0.25))
    levels = (level, max(level - 1, 0))
    return tuple(Resolution(least * 2**k, 0.6, 3.0, GRIDS.extent * scales.widened) for k in levels)


KERNELS: Mapping[str, Kernel] = {
    "panels": Kernel("panels", endless, resolutions_for, 1.0, 1e-9, MOST_RUNGS),
    "triangles": Kernel("triangles", partial(_straight, "triangles", 2), _finer, INTERVALS.crossing, 1e-6, 2),
    "bands": Kernel("bands", partial(_straight, "bands", 3), _finer, INTERVALS.crossing, 1e-6, 2),
}


def require_kernel(name: str, scales: Scales, rtol: float) -> Kernel:
    """Return the kernel of a name, or raise InputError unless it serves a contact of these scales to a tolerance."""
    require_one_of(name, "kernel", tuple(KERNELS))
    kernel, refused = KERNELS[name], f"kernel = {name} does not serve"
    if name == "panels":
        return kernel
    if scales.body is not None:
        raise InputError(f"{refused} body = {scales.body}, limit: the half-space; take kernel = panels")
    if math.isfinite(scales.profile.end):
        raise InputError(
            f"{refused} a profile that ends at {scales.profile.end:.3g} beta, limit: endless ones; take kernel = panels"
        )
    require_between(rtol, "rtol", kernel.least, 1e-1, "take kernel = panels", f" by kernel = {name}")
    return kernel
