"""Likelihood of an apparatus by a measured curve, and where it is greatest at a Tabor parameter."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import norm

from fem_adhesion.common.numbers import Measured
from fem_adhesion.fitting.data import Data, Run
from fem_adhesion.fitting.model import Apparatus, Branches, Theory, by_jkr, recorded
from halfspace.values import Array

LEVEL = 0.95  # of all intervals
NORMAL = float(norm.isf((1 - LEVEL) / 2))  # standard errors in half an interval


@dataclass(frozen=True)
class LikelihoodSettings:
    """Where the likelihood is looked for, and by which steps."""

    blind: float = 1e6  # largest ratio of two standard errors
    farthest: float = 12.0  # coordinates beyond which nothing is asked for: a factor of 1e5
    apart: float = math.log(10) / 2  # of the Tabor parameters from which fits start
    rounds: int = 5  # of dividing runs and fitting; two are usual
    far_off: float = 3.0  # times the measured pull-off force, or a part of it, that no fit has
    wall: float = 1e4  # residual of a factor of e beyond: more than those of all samples of a wrong model
    step: float = 1e-3  # of derivatives by coordinates, which see past the kinks and errors of a curve
    shift: float = 0.01  # the same by ln tabor


FITS = LikelihoodSettings()

MEAN_PULL_OFF = 1.75 * math.pi  # R dgamma, between JKR's and Bradley's

SCALES = ("radius", "modulus", "work_of_adhesion", "spacing", "stiffness", "sensitivity")
"""Positive parameters: the fitter moves their logarithms."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Likelihood of an apparatus at a Tabor parameter, as residuals whose squares sum up to -2 ln of it.

    At a given Tabor parameter one curve of the theory serves, and what is fitted scales and shifts it; the spacing
    follows. `start` holds all parameters, `fitted` the names of those that are moved, `prior` what was known of some,
    `pull_off` is the force of the data's in N, as recorded.
    """

    theory: Theory
    data: Data
    start: Apparatus
    fitted: tuple[str, ...]
    prior: Mapping[str, Measured]
    pull_off: float
    recorded_stiffness: float | None = None
    log_tabor: float = 0.0
    curve: Array = field(default_factory=lambda: np.empty((2, 0)))

    def at(self, log_tabor: float, x: Array) -> Problem:
        """The problem at another Tabor parameter, its curve that of the sizes at coordinates."""
        moved = replace(self, log_tabor=log_tabor)
        return replace(moved, curve=self.theory(moved.apparatus(x).units))

    def apparatus(self, x: Array) -> Apparatus:
        """Apparatus at the fitter's coordinates: logarithms, and lengths in those of the start."""
        moved = replace(
            self.start, **{name: self.value(name, float(at)) for name, at in zip(self.fitted, x, strict=True)}
        )
        return replace(moved, spacing=moved.units.displacement / math.exp(self.log_tabor))

    def value(self, name: str, x: float) -> float:
        """Value at a coordinate."""
        value: float = getattr(self.start, name)
        if name in SCALES:
            return value * math.exp(min(max(x, -FITS.farthest), FITS.farthest))
        moved = value + x * self._units[name]
        return moved if name == "contact_point" else max(moved, 0.0)

    def coordinate(self, name: str, value: float) -> float:
        """Coordinate of a value."""
        start: float = getattr(self.start, name)
        return math.log(value / start) if name in SCALES else (value - start) / self._units[name]

    @property
    def held(self) -> tuple[str, ...]:
        """What is known with an error and was not fitted."""
        return tuple(name for name in self.prior if name not in self.fitted)

    def departure(self, name: str, value: float) -> float:
        """Standard errors from what was known to a value; log-normal where the quantity is positive.

        A normal error would leave a radius of 10 +- 3 nm free to run to zero for 3.3 standard errors, and it did.
        """
        known, error = self.prior[name]
        return math.log(value / known) * known / error if name in SCALES else (value - known) / error

    @cached_property
    def _units(self) -> Mapping[str, float]:
        """Units of the coordinates that are no logarithms."""
        return {"contact_point": self.start.units.displacement, "compliance": 1 / self.start.stiffness}

    def first(self) -> Array:
        """Coordinates of the contact point that the jumps or, without any, the force says; all others as given."""
        x, contact = np.zeros(len(self.fitted)), self.start.contact_point
        found = self.branches(self.apparatus(x))
        base, force = found.contact[:, np.argmin(found.contact[1]) :]
        shifts = [at.travel - found.place(at.segment) for at in self.data.places]
        shift = float(np.mean(shifts or contact - np.interp(0.0, force, base)))
        x[1] = self.coordinate("contact_point", contact + shift)
        return x

    def branches(self, apparatus: Apparatus) -> Branches:
        """Branches as they are recorded."""
        return recorded(self.curve, apparatus, self.recorded_stiffness)

    def residuals(self, x: Array) -> Array:
        """Whitened residuals of the samples, then those of the jumps' places and of what was known before."""
        apparatus = self.apparatus(x)
        found = self.branches(apparatus)
        samples = self.data.compared(self.data.modelled(found))
        places = [(found.place(at.segment) - at.travel) / at.error for at in self.data.places]
        known = [self.departure(name, getattr(apparatus, name)) for name in self.prior]
        return np.concatenate([samples, places, known, [self._wall(apparatus)]])

    def _wall(self, apparatus: Apparatus) -> float:
        """Residual that keeps the pull-off near the data's: a contact point far off makes a minimum without one."""
        force = MEAN_PULL_OFF * apparatus.units.load / apparatus.sensitivity
        return FITS.wall * max(abs(math.log(force / self.pull_off)) - math.log(FITS.far_off), 0.0)

    def jacobian(self, x: Array) -> Array:
        """Derivatives of the residuals by the coordinates."""
        here = self.residuals(x)
        steps = FITS.step * np.diag(self._sizes)
        return np.column_stack([(self.residuals(x + step) - here) / step.max() for step in steps])

    @property
    def _sizes(self) -> Array:
        """Coordinates of a change that counts: of the contact point a spacing and a displacement."""
        return np.array([1 + math.exp(-self.log_tabor) if name == "contact_point" else 1.0 for name in self.fitted])

    def settled(self, x: Array, *, loose: bool = False) -> Best:
        """Least squares where runs without a jump in the data are divided as the model has it; see `Data.divided`.

        If `loose`, the coordinates are a first guess, and the samples alone decide on the first division.
        """
        runs = self.data.runs
        for i in range(FITS.rounds):
            divided = self.data.divided(self.branches(self.apparatus(x)), loose=loose and not i)
            problem = replace(self, data=divided)
            found = least_squares(
                problem.residuals,
                x,
                problem.jacobian,
                method="lm",
                x_scale=self._sizes / 10,
                xtol=1e-5,
                ftol=1e-7,
                max_nfev=100,
            )
            x = found.x
            if runs == divided.runs:
                break
            runs = divided.runs
        return Best(problem, x, 2 * float(found.cost), np.asarray(found.jac))


@dataclass(frozen=True, eq=False)
class Best:
    """Where the likelihood is greatest at a Tabor parameter: coordinates x, -2 ln of it, and the Jacobian there.

    `problem` has the runs as the fit divides them.
    """

    problem: Problem
    x: Array
    chi2: float
    jacobian: Array

    @cached_property
    def apparatus(self) -> Apparatus:
        """What was found."""
        return self.problem.apparatus(self.x)

    @property
    def tabor(self) -> float:
        """Tabor parameter."""
        return math.exp(self.problem.log_tabor)

    @property
    def degrees(self) -> int:
        """Degrees of freedom, the coefficients of the baseline taken off; the wall is no datum."""
        return int(len(self.jacobian) - 1 - self.problem.data.baseline.shape[1] - self.parameters)

    @property
    def parameters(self) -> int:
        """How many were fitted, the Tabor parameter among them, which JKR's theory does not have."""
        return self.x.size + (self.problem.theory is not by_jkr)

    @property
    def scale(self) -> float:
        """Chi square per degree of freedom, or 1 if that is less: intervals grow by its root, as a misfit demands."""
        return max(1.0, self.chi2 / self.degrees)

    @cached_property
    def rest(self) -> Array:
        """Whitened residuals, of the samples first."""
        return self.problem.residuals(self.x)

    @property
    def counts(self) -> tuple[int, int, int]:
        """How many residuals are those of samples, of places of jumps, and others."""
        places, others = len(self.problem.data.places), len(self.problem.prior) + 1
        return len(self.jacobian) - places - others, places, others

    def residuals(self) -> Iterator[tuple[Run, Array]]:
        """Whitened residuals of the samples, run after run."""
        runs = self.problem.data.runs
        ends = np.cumsum([self.problem.data.travel[run.samples].size for run in runs])
        return zip(runs, np.split(self.rest, ends), strict=False)  # the last part is not of samples

    @cached_property
    def covariance(self) -> Array:
        """Of the coordinates at this Tabor parameter, where the noise is the baseline's."""
        return inverse(self.jacobian)

    @cached_property
    def whole(self) -> Array:
        """Jacobian by the coordinates and, last, ln tabor."""
        shifted = self.problem.at(self.problem.log_tabor + FITS.shift, self.x).residuals(self.x)
        return np.column_stack([self.jacobian, (shifted - self.rest) / FITS.shift])

    @cached_property
    def slope(self) -> float:
        """Derivative of the least chi square by ln tabor: what the other coordinates take up does not count."""
        by_tabor = self.whole[:, -1]
        along = by_tabor - self.jacobian @ np.linalg.lstsq(self.jacobian, by_tabor)[0]
        return 2 * float(self.rest @ along)

    @property
    def tabor_error(self) -> float:
        """Standard error of ln tabor by the curvature, within what is of use for a step."""
        return float(np.clip(math.sqrt(self.scale * inverse(self.whole)[-1, -1]), 1e-4, FITS.apart / 2))

    def coordinate(self, name: str) -> float:
        """Coordinate of a parameter; of the spacing its logarithm."""
        return math.log(self.apparatus.spacing) if name == "spacing" else float(self.x[self.problem.fitted.index(name)])

    def gradient(self, name: str) -> Array:
        """Derivatives of a parameter's coordinate by all coordinates and ln tabor."""
        if name != "spacing":
            return np.append(np.array([each == name for each in self.problem.fitted], float), 0.0)
        moved = [self.problem.apparatus(self.x + step).spacing for step in FITS.step * np.eye(self.x.size)]
        return np.append(np.log(np.array(moved) / self.apparatus.spacing) / FITS.step, -1.0)

    def half_width(self, name: str, sharper: Array | float = 1.0, exact: str = "") -> float:
        """Half of a parameter's interval by the curvature, with residuals so many times as sharp, or one more exact."""
        kept = np.array([each != exact for each in (*self.problem.fitted, "")])
        jacobian = (self.whole.T * sharper).T[:, kept]
        gradient = self.gradient(name)[kept]
        return NORMAL * math.sqrt(self.scale * float(gradient @ inverse(jacobian) @ gradient))


def inverse(jacobian: Array) -> Array:
    """Covariance of coordinates from the Jacobian of the residuals.

    What the data do not show at all has a standard error of `BLIND` times that of what they show best.
    """
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    return np.asarray((directions.T / np.maximum(sizes, sizes[0] / FITS.blind) ** 2) @ directions)
