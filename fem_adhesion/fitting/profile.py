"""Intervals of fitted parameters: the least chi square at each Tabor parameter, as far as that is likely."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, minimize_scalar
from scipy.special import ndtr
from scipy.stats import chi2 as chi2_law

from fem_adhesion.fitting.likelihood import FITS, LEVEL, SCALES, Best, Problem
from fem_adhesion.fitting.model import by_atlas
from halfspace.errors import tried
from halfspace.values import Array


@dataclass(frozen=True)
class ProfileSettings:
    """How closely the profile of the likelihood is looked at."""

    nearly: float = 1.1  # chi square in the least one, or in that of noise, up to which a fit counts as one
    shallow: float = 0.01  # of a squared standard error: how far a valley of the profile falls that is not looked into
    still: float = 0.1  # of a standard error: to which a least chi square is looked for
    near: float = 0.05  # of the distance between fits within and beyond a profile, to which its end is looked for
    nodes: tuple[float, ...] = (0.25, 0.5, 0.75)  # of the way from the best Tabor parameter to either end, for fits
    fine: int = 401  # places between these on which intervals are read off
    range: float = 7.0  # logarithms beyond which an end is open: a factor of a thousand


HOW = ProfileSettings()


@dataclass(frozen=True, eq=False)
class Profile:
    """Least chi square at each Tabor parameter: the best fit, and fits in order as far as they are likely.

    A parameter's interval holds all its values for which some Tabor parameter has a chi square that is low enough; at
    one Tabor parameter the chi square is a parabola of the others. MINOS of all at once was tried in the place of this:
    of 24 curves it gave up an end of five, where the likelihood has a kink or a limit.

    Attributes
    ----------
    ends : tuple of bool
        Whether the least and the largest Tabor parameter that the theory knows are likely.
    """

    best: Best
    fits: tuple[Best, ...]
    ends: tuple[bool, bool]

    def region(self, name: str, rise: float) -> tuple[Array, Array, Array]:
        """Values of ln tabor up to a rise of chi square, and the ends of a parameter's coordinate at each."""
        rows = []
        for one in self.fits:
            gradient = one.gradient(name)[:-1]
            rows.append((one.chi2 - self.best.chi2, one.coordinate(name), gradient @ one.covariance @ gradient))
        at, table = np.array([one.problem.log_tabor for one in self.fits]), np.array(rows)
        if len(at) > 1:
            fine = np.unique(np.append(np.linspace(at[0], at[-1], HOW.fine), at))
            at, table = fine, PchipInterpolator(at, table)(fine)
        above, middle, variance = table[table[:, 0] <= rise].T
        half = np.sqrt((rise - above) * variance)
        return at[table[:, 0] <= rise], middle - half, middle + half

    def interval(self, name: str) -> tuple[float | None, float | None]:
        """Ends of a parameter's interval in SI; None if the curve leaves one open."""
        rise = self.best.scale * self._factor(name) ** 2
        _, lows, highs = self.region(name, rise)
        ends, middle = (float(lows.min()), float(highs.max())), self.best.coordinate(name)
        if name == "spacing":  # the smaller the Tabor parameter, the larger is the spacing
            within = [one.chi2 - self.best.chi2 <= rise for one in (self.fits[0], self.fits[-1])]
            rigid, soft = (is_open and low for is_open, low in zip(self.ends, within, strict=True))
            return None if soft else math.exp(ends[0]), None if rigid else math.exp(ends[1])
        known = [name not in SCALES or abs(end - middle) < HOW.range for end in ends]
        low, high = (
            self.best.problem.value(name, end) if is_known else None for end, is_known in zip(ends, known, strict=True)
        )
        return low, high

    def _factor(self, name: str) -> float:
        """Standard errors in half an interval: 1.96 of a normal error, 1.65 of a uniform one, as a place has.

        Thousands of samples make a normal error, but the share of a place in a parameter's error may be all of it.
        """
        influence = self.best.gradient(name) @ np.linalg.pinv(self.best.whole)
        first, places, _ = self.best.counts
        uniform = [at.is_uniform for at in self.best.problem.data.places]
        shares = (influence**2 / np.sum(influence**2))[first : first + places] * uniform
        u, weights = np.polynomial.legendre.leggauss(32)
        parts = [math.sqrt(3 * share) * u for share in (*shares, 0.0, 0.0)[:2]]
        sums, weight = np.add.outer(*parts), np.multiply.outer(weights, weights) / 4
        rest = math.sqrt(max(1 - float(sum(shares)), 1e-3))
        return float(brentq(lambda t: np.sum(weight * (2 * ndtr((t - sums) / rest) - 1)) - LEVEL, 1.0, 2.5))

    def contour(self) -> Array:
        """Contour (2, n) of work of adhesion and spacing in SI: at each Tabor parameter the ends of the first."""
        best, level = self.best, self.best.scale * float(chi2_law.ppf(LEVEL, 2))
        _, low, high = self.region("work_of_adhesion", level)
        _, small, large = self.region("spacing", level)
        works = [best.problem.value("work_of_adhesion", x) for x in (*low, *high[::-1])]
        return np.array([works, np.exp(np.append(small, large[::-1]))])


def profiled(problem: Problem, tabors: Sequence[float], limits: tuple[float, float]) -> Profile:
    """Profile that starts from some Tabor parameters, and goes on within limits until the least is between two."""
    fits = dict[float, Best]()
    for at in (round(math.log(tabor), 9) for tabor in tabors):
        here = problem.at(at, np.zeros(len(problem.fitted)))
        fits[at] = here.settled(here.first(), loose=True)
    if problem.theory is by_atlas and min(fits.values(), key=lambda one: one.chi2).scale > HOW.nearly:
        _exchange(problem, fits)
    least, most = (round(math.log(limit), 9) for limit in limits)
    scan = Scan(problem, (least, most), fits)
    scan.minimise()
    is_open = scan.follow(-1), scan.follow(1)
    order = sorted(scan.fits)
    likely = [i for i, at in enumerate(order) if scan.rise(at) < 0]
    around = order[max(likely[0] - 1, 0) : likely[-1] + 2]
    return Profile(scan.best, tuple(scan.fits[at] for at in around), is_open)


def _exchange(problem: Problem, fits: dict[float, Best]) -> None:
    """Try each fit from its neighbours, both ways: that of a wrong model may end in one of some minima.

    Of 200 curves that a model fits none changed; of three measured ones one came from 4 % above the least.
    """
    grid = sorted(fits)
    for way in (grid, grid[::-1]):
        for near, at in pairwise(way):
            one = problem.at(at, fits[near].x).settled(fits[near].x, loose=True)
            fits[at] = min(one, fits[at], key=lambda each: each.chi2)


@dataclass(frozen=True, eq=False)
class Scan:
    """Fits by ln tabor between limits, each made when it is asked for, from the nearest one that is there."""

    problem: Problem
    limits: tuple[float, float]
    fits: dict[float, Best]

    def fit(self, at: float) -> Best:
        """The fit there."""
        at = round(float(np.clip(at, *self.limits)), 9)
        if at not in self.fits:
            near = self.fits[min(self.fits, key=lambda other: abs(other - at))]
            found = tried(lambda: self.problem.at(at, near.x).settled(near.x), refusals=True)
            self.fits[at] = found or self._refused(near, at)
        return self.fits[at]

    def _refused(self, near: Best, at: float) -> Best:
        """Stand-in where a traced part has no such contact, as a sphere less wide than its spacing: most unlikely."""
        chi2 = self.best.chi2 * (1 + FITS.wall)
        return replace(near, problem=replace(near.problem, log_tabor=at), chi2=chi2)

    def rise(self, at: float) -> float:
        """Chi square over the best one, less that at which a pair of parameters is unlikely."""
        return self._excess(self.fit(at).chi2)

    def _excess(self, chi2: float) -> float:
        return chi2 - self.best.chi2 - self.best.scale * float(chi2_law.ppf(LEVEL, 2))

    @property
    def best(self) -> Best:
        """The best fit."""
        return min(self.fits.values(), key=lambda one: one.chi2)

    def minimise(self) -> None:
        """Go on until the best fit is between two others, or at a limit; look for the least in each valley.

        Valleys are told by slopes, and by values where a fit is lower than both neighbours and not the least.
        """
        while (low := self.best.problem.log_tabor) in (min(self.fits), max(self.fits)) and low not in self.limits:
            self.fit(low + (FITS.apart if low == max(self.fits) else -FITS.apart))
        for pair in pairwise(sorted(self.fits)):
            left, right = (self.fits[at] for at in pair)
            if self._is_valley(left, right):
                near = HOW.still * min(left, right, key=lambda one: one.chi2).tabor_error
                brentq(lambda at: self.fit(at).slope, *pair, xtol=near)
        grid = sorted(self.fits)
        for before, at, after in zip(grid, grid[1:], grid[2:], strict=False):
            here = self.fits[at]
            lowest = here.chi2 <= min(self.fits[before].chi2, self.fits[after].chi2, HOW.nearly * self.best.chi2)
            if lowest and abs(here.slope) * here.tabor_error > HOW.still * self.best.scale:
                minimize_scalar(
                    lambda at: self.fit(at).chi2,
                    bounds=(before, after),
                    method="bounded",
                    options={"xatol": HOW.still * here.tabor_error},
                )

    def _is_valley(self, left: Best, right: Best) -> bool:
        """Whether the least chi square falls at one fit, rises at the next, and may be likely between them.

        Where it is convex it is above its tangents. By values alone a valley is not seen if it is narrower than fits
        are apart and lies on a slope: five of 400 curves had the truth in one. Beside a refused fit none is looked for.
        """
        if max(left.chi2, right.chi2) > FITS.wall * self.best.chi2 or not left.slope < 0 < right.slope:
            return False
        apart = right.problem.log_tabor - left.problem.log_tabor
        meet = (right.chi2 - left.chi2 - right.slope * apart) / (left.slope - right.slope)
        least = left.chi2 + left.slope * meet
        return min(left.chi2, right.chi2) - least > HOW.shallow * self.best.scale and self._excess(least) < 0

    def follow(self, side: int) -> bool:
        """Fit down and up to where the profile has risen, on the side of smaller (-1) or larger ones; False if found.

        Whatever lies between, a profile reaches as far as its farthest fit that is likely enough.
        """
        middle, limit, step = self.best.problem.log_tabor, self.limits[side > 0], 2.5 * self.best.tabor_error
        near = far = max((at for at in self.fits if self.rise(at) < 0), key=lambda at: side * at)
        while self.rise(far) < 0 and far != limit:
            beyond = [at for at in self.fits if side * (at - far) > 0]
            near, far = far, min((*beyond, limit, far + side * step), key=lambda at: side * at)
            step *= 2
        is_open = self.rise(far) < 0
        if not is_open:
            far = float(brentq(self.rise, near, far, xtol=HOW.near * abs(far - near)))
        for part in HOW.nodes:
            self.fit(middle + part * (far - middle))
        return is_open
