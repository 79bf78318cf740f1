"""The lengths of a contact, asked of its law and its profile: one place for all grids, meshes and curves.

Each is known for the 3-9 law on a paraboloid, from derivations and trials, and goes over to others by what it depends
on: the spike of tension at a contact edge by the law's stiffness and strength, all that is undeformed by the heights of
the profile, contact radii by JKR's theory of the profile. Radii in beta, heights and gaps in eps where not said.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from halfspace.elastic.layers import LayeredBody, softest, stiff_as
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import GAPS, TINY
from halfspace.profiles import PARABOLOID, Surface
from halfspace.profiles.indentation import hertz_radius, jkr_fold, jkr_least_load, jkr_radius
from halfspace.roots import rising_root, root
from halfspace.values import Array

BRADLEY = 2 * math.pi  # largest tension of a rigid sphere, R dgamma
STEP = 0.1  # step of the trapezoidal rule in ln r for the tension of undeformed surfaces
LOGARITHMS = np.arange(-16.0, 16.0, STEP)


@dataclass(frozen=True)
class ScaleSettings:
    """Numbers by which lengths of a contact are chosen.

    Of those on steps: with ``sudden`` 0.7 and ``slower`` 1 the sharper of Dugdale's laws did not meet 1e-6, and at 1e-8
    it erred by twice the estimates. Of those on valleys: with cells that grew threefold curves rippled, and 15 nodes in
    each cell left 1e-4 in the load of a fold on a coating.
    """

    rise: float = 0.245  # eps over which the tension of the 3-9 law rises: 0.7 beta mu^-1/2 of a rigid paraboloid
    sudden: float = 0.65  # part of its maximum that a tension may fall by within one edge gap while cells grow as usual
    slower: float = 1.5  # power of the excess over that part by which cells grow more slowly
    stepped: float = 0.55  # part of its maximum by which the tension of a law with a step falls within one edge gap
    shallow: float = 0.05  # depth of a valley of the load in ln H, in its largest, to which cells grow as usual
    broken: float = 0.5  # power of deeper valleys by which cells grow more slowly
    left: float = (
        1e-9  # part of the load beyond the cells of a layer, none of which is infinite; they go farther for it
    )
    most_left: float = 1e-6  # part of the load beyond those cells at which a scene is refused
    farthest: float = 1e5  # extents that those cells go farther; longer elements, as thin, make the stiffness singular
    farther: float = 8.0  # least extents up to which the infinite cell is cut where the tail is no polynomial
    untold: float = 1e-7  # part of the load beyond the finite cells that the last of these cells may leave
    crowd: float = 64.0  # times as near to infinity as its ends the nodes of the last cell are
    flattest: float = 6.0  # most widths of its edge that a rigid contact is wide, in those on a paraboloid
    least_load: float = 0.1  # R dgamma, least size of the tensions: curves that end at loads of 5 take too many steps
    far_out: float = 1e6  # beta, where the exponent of a profile is read off
    separated: float = 10.0  # eps, least gap at which surfaces count as separated


HOW = ScaleSettings()


@dataclass(frozen=True)
class Scales:
    """Lengths of one contact.

    Parameters
    ----------
    tabor : float
        Tabor parameter.
    law : Law
        Of the tension against the gap.
    profile : Surface
        Of the undeformed surfaces.
    body : LayeredBody, optional
        Strata on a base; what else is elastic yields as a half-space of E* to waves as short as the attraction is wide.
    """

    tabor: float
    law: Law = LENNARD_JONES
    profile: Surface = PARABOLOID
    body: LayeredBody | None = None

    @cached_property
    def of_contact(self) -> Scales:
        """Those of the contact alone, whatever body is below it."""
        return self if self.body is None else replace(self, body=None)

    @property
    def pieced(self) -> bool:
        """Whether derivatives of the law or the profile leap."""
        return self.law.pieced or self.profile.pieced

    @cached_property
    def softest(self) -> float:
        """How many times as much as a half-space of E* the body yields to waves of any length, at most."""
        return 1.0 if self.body is None else softest(self.body)

    @cached_property
    def spike_width(self) -> float:
        """Width over which the tension at a contact edge varies: mu^-2, or about mu^-1/2 when nearly rigid.

        A stiffness f' of the law balances an elastic deflection over 1/(mu^2 f'), a strength s the work of adhesion
        over 1/(mu s)^2; less where something softer below lets strata bend.
        """
        return self._width(self._sharpness)

    @cached_property
    def least_width(self) -> float:
        """That wherever surfaces attract: the steepest fall of the tension takes the place of the stiffness."""
        return self._width(min(self._sharpness, _steepest(LENNARD_JONES) / _steepest(self.law)))

    def _width(self, sharpness: float) -> float:
        """Width of a spike from that in a soft contact's by the 3-9 law."""
        width = self.tabor**-2 * sharpness
        return float(min(width if self.body is None else stiff_as(self.body, width), self._rigid_width))

    @cached_property
    def _sharpness(self) -> float:
        """Width of a soft contact's spike in those of the 3-9 law."""
        ours, known = self.law, LENNARD_JONES
        return min(known.stiffness / ours.stiffness, (known.strength / ours.strength) ** 2)

    def edge_cell(self, finest: float) -> float:
        """Length in beta of the cells at the contact edge, or on the axis, from that in widths of the spike there."""
        return finest * self.spike_width / 2

    def growth(self, most: float) -> float:
        """Ratio of neighbouring cells away from the edge, `most` by most laws."""
        return 1 + (most - 1) * min(self.gradual, self._unbroken)

    @cached_property
    def gradual(self) -> float:
        """Part of the growth of cells that the law allows: less where the tension ends by a step.

        A gap beyond the edge by H has opened over some distance d, so that a tension which falls within a part of H
        does within that part of d.
        """
        return float(min(1.0, HOW.sudden / self._steepness[1].max()) ** HOW.slower)

    @cached_property
    def _unbroken(self) -> float:
        """Part of that growth which is left where the surfaces attract once more, beyond a barrier or a weaker pull.

        The area over which a paraboloid is H apart or less grows as H, so that H times the tension is the load in each
        part of ln H, in which cells that grow are as long. What counts is its valley, below the lower of its two tops.
        """
        load = -GAPS * self.law.pressure(GAPS, 1.0)
        top = np.minimum(np.maximum.accumulate(load), np.maximum.accumulate(load[::-1])[::-1])
        return float(min(1.0, HOW.shallow * load.max() / max((top - load).max(), TINY)) ** HOW.broken)

    @cached_property
    def _steepness(self) -> tuple[Array, Array]:
        """Gaps beyond the edge, and how fast the tension falls there, in parts of the largest in such a distance."""
        beyond = GAPS[self.law.edge_gap < GAPS]
        return beyond, (beyond - self.law.edge_gap) * np.abs(self.law.slope(beyond, 1.0)) / self.law.strength

    @cached_property
    def step_gap(self) -> float:
        """Gap at which a tension that ends by a step does so; 0 for one that falls gradually."""
        gaps, steepness = self._steepness
        return float(gaps[np.argmax(steepness)]) if self.gradual < 1 else 0.0

    @property
    def steps(self) -> bool:
        """Whether the tension ends by a step, if only by one so wide that cells grow as by any other law."""
        return bool(self._steepness[1].max() > HOW.stepped)

    @property
    def _rigid_width(self) -> float:
        """Length over which the undeformed gap opens by as much as the tension rises over."""
        r = self._touching_radius
        return 2 * float(self.profile.height(np.array(r)) / self.profile.slope(np.array(r)))

    @cached_property
    def flat(self) -> float:
        """How many times as many widths of its edge as on a paraboloid a rigid contact is wide: k/2 on u^k."""
        return min(max(1.0, self._touching_radius / self._rigid_width), HOW.flattest)

    @cached_property
    def _touching_radius(self) -> float:
        """Radius of a rigid contact: where the undeformed gap has opened by as much as the tension rises over."""
        return self.radius_at(HOW.rise * math.sqrt(LENNARD_JONES.stiffness / self.law.stiffness))

    def widest_radius(self, to_load: float) -> float:
        """Contact radius that a curve up to a load hardly exceeds: a soft and a rigid contact's together."""
        soft = jkr_radius(self.profile, to_load, self.softest)
        if self.tabor < 1:
            soft = max(soft, hertz_radius(self.profile, to_load + self.rigid_tension, self.softest))
        return float(np.hypot(soft, self._touching_radius))

    @cached_property
    def rigid_tension(self) -> float:
        """Tension of the undeformed surfaces in touch, in R dgamma: 2 pi on a paraboloid."""
        return -self.rigid_load(0.0)

    def rigid_load(self, approach: float) -> float:
        """Load on undeformed surfaces at an approach in eps, Bradley's on a paraboloid by the 3-9 law, in R dgamma."""
        return self._undeformed(self.law.pressure, -approach)

    def rigid_jump_on(self, stiffness: float) -> float:
        """Approach in eps at which undeformed surfaces jump on from afar; the apparatus is so stiff in R dgamma/eps."""

        def softer(H: float) -> float:
            return self._undeformed(self.law.slope, H) - stiffness

        if softer(self.law.edge_gap) <= 0:
            return -self.law.edge_gap
        return -root(softer, self.law.edge_gap, 1e9, "the jump of a soft apparatus; take a stiffer one", rtol=1e-12)

    def _undeformed(self, density: Callable[[Array, float], Array], gap: float) -> float:
        """Integral of the law's pressure or slope over undeformed surfaces at a central gap, in R dgamma."""
        r = self.radius_at(max(gap, HOW.rise)) * np.exp(LOGARITHMS)
        r = r[r < self.profile.end]
        return 2 * np.pi * STEP * float(r**2 @ density(gap + self.tabor * self.profile.height(r), self.tabor))

    @cached_property
    def largest_load(self) -> float:
        """Size of the tensions in R dgamma: Bradley's 2 pi, but what others a profile has."""
        found = self.rigid_tension if self.tabor < 1 else -4 / 3 * jkr_least_load(self.profile)
        return max(found, HOW.least_load) if abs(math.log2(found / BRADLEY)) > 1 else BRADLEY

    def tension_beyond(self, r: float) -> float:
        """Tension beyond a radius in beta, in R dgamma; 0 where the surface or the law ends.

        On a profile that rises as r^g a tension that decays as h^-n leaves 2 pi r^2 sigma/(g n - 2) beyond r.
        """
        power = self.law.decay * self._growth - 2
        if math.isinf(power) or math.isfinite(self.profile.end):
            return 0.0
        tension = abs(float(self.law.pressure(self.tabor * self.profile.height(np.array(r)), self.tabor)))
        return 2 * math.pi * r**2 * tension / power

    def whole_radius(self, height: float) -> float:
        """Radius at which cells end beyond which nothing acts: that of a height, or farther for the load beyond."""
        r, power = self.radius_at(height), self.law.decay * self._growth - 2
        beyond = self.tension_beyond(r) / self.rigid_tension
        if not beyond:
            return r
        farther = min(max(1.0, beyond / HOW.left) ** (1 / power), HOW.farthest)
        if beyond > HOW.most_left * farther**power:
            least = math.log(beyond / HOW.most_left) / math.log(HOW.farthest)
            raise InputError(
                f"{self.law} on {self.profile}: the load beyond r falls as r^-{power:.2g} alone, limit on layers: "
                f"r^-{least:.2g}; take a law or a profile that rises faster"
            )
        return float(r * farther)

    @property
    def widened(self) -> float:
        """Width of the attraction at jump_on, in those of a rigid paraboloid's.

        It pulls up a bulge b = (2/E*) int sigma dr, as mu^(3/2) h^(1/2 - n) on a paraboloid, as high as the gap h.
        """
        return float(max(1.0, self.tabor * self.softest ** (2 / 3)) ** (0.75 / (self.law.decay + 0.5)))

    @cached_property
    def tail_reach(self) -> float:
        """Extents of the finite cells up to which the infinite one is cut: 1 if the tail is a polynomial in 1/r.

        The load beyond r falls as r^(2 - n) under a pressure that falls as r^-n, slowly if n is little more than 2.
        """
        if math.isinf(self.law.decay) or math.isfinite(self.profile.end):
            return 1.0
        powers = np.array([self.law.decay, 1.0]) * self._growth
        if np.allclose(powers, np.round(powers), rtol=0, atol=1e-4):
            return 1.0
        return float(max(HOW.farther, HOW.untold ** (-1 / (powers[0] - 2)) / HOW.crowd))

    @property
    def _growth(self) -> float:
        """Exponent of the profile's height far out."""
        r = np.array(HOW.far_out)
        return float(r * self.profile.slope(r) / self.profile.height(r))

    @cached_property
    def far_energy(self) -> bool:
        """Whether so much of the law's energy is far out that only differences from an undeformed state can be told."""
        return math.isinf(self.profile.end) and (self.law.decay - 1) * self._growth < 4 - 1e-3

    @cached_property
    def separated_approach(self) -> float:
        """Approach in eps at which a half-space is separated alone; left of jump_off, -1.61 mu in the JKR limit."""
        apart = max(HOW.separated, 3 * self.law.range(0.1))
        return -apart - self.tabor * max(2.0, -1.2 * jkr_fold(self.profile))

    def radius_at(self, height: float) -> float:
        """Radius at which the undeformed gap has opened by a height in eps, 0 by none, or where the surface ends."""
        if height <= 0:
            return 0.0
        z = height / self.tabor
        what = f"the radius at which the profile rises to {z:.3g} beta^2/R; let it grow outwards"
        return rising_root(lambda r: float(self.profile.height(np.array(r))) - z, what, end=self.profile.end)


def _steepest(law: Law) -> float:
    """Steepest fall of a law's tension beyond its edge, in dgamma/eps^2."""
    return float(law.slope(GAPS[law.edge_gap < GAPS], 1.0).max())
