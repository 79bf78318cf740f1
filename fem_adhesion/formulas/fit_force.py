"""Fit the load by approach of `halfspace.theories.fits` to the atlas: ``python -m fem_adhesion.formulas.fit_force``."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import least_squares

from fem_adhesion.formulas.fit import rounded, weighed_by
from halfspace import atlas
from halfspace.theories import fits
from halfspace.values import Array

PIECES = ((0.01, 0.4), (0.4, 3.0), (3.0, 300.0))  # of Tabor parameters


@dataclass(frozen=True)
class ForceSettings:
    """Terms of the formula for the force, and the curves that it is fitted to."""

    terms: int = 7  # of the sum over z
    degree: int = 8  # of its coefficients in ln(tabor)
    cusp_degree: int = 10  # of the coefficients of the cubic
    free_degree: int = 4  # the same on the first piece, where no fold is near
    tabors: int = 24  # curves that are fitted to on a piece
    least_slope: float = 0.05  # of the cubic there
    rounds: int = 20  # repetitions with weights of Lawson
    digits: int = 8
    most_load: float = 5.5  # R dgamma, to which a curve is fitted


HOW = ForceSettings()

FREE = ((0.01, 0.13, 0.2), (0.05, 0.06, 0.25), (0.1, -0.1, 0.24), (0.2, -0.344, 0.2), (0.3, -0.5305, 0.157))
"""Tabor parameter, middle and slope of the cubic from which the fit on the first piece begins."""
FOLDS = ((0.35, 0.4, 0.45, 0.5, 0.6, 0.65, 0.69), (-0.63, -0.72, -0.81, -0.9007, -1.07204, -1.15478, -1.21958))
"""Tabor parameters and nearly the real part of the approach of both folds, which are complex there."""


def piece(low: float, high: float) -> dict[str, Any]:
    """Coefficients on one piece of Tabor parameters, of which ``halfspace/theories/force.json`` has a list."""
    curves = _curves(_tabors(low, high, HOW.tabors))
    t = fits.place(curves["tabor"], low, high)
    middle, slope = _free(low, high, t, curves) if low < FOLDS[0][0] else _folds(low, high)
    coefficients = _sums(t, curves, middle, slope, HOW.rounds)[0].reshape(HOW.terms, HOW.degree + 1)
    numbers = {"middle": middle, "slope": slope, "sums": coefficients}
    return {"from": low, "to": high} | {name: rounded(values, HOW.digits) for name, values in numbers.items()}


def _tabors(low: float, high: float, count: int) -> Array:
    return np.asarray(np.exp((chebyshev.chebpts1(count) * np.log(high / low) + np.log(low * high)) / 2))


def _curves(tabors: Array) -> dict[str, Array]:
    """States of all curves that are stable under fixed grips: q, scaled approach, whether in contact, Tabor."""
    rows = []
    for tabor in tabors.tolist():
        curve, event = atlas.curve(tabor), atlas.pull_off(tabor)
        whole = len(curve.branches("approach")) == 1
        for name, (first, last) in curve.branches("approach").items():
            if name.startswith("unstable"):
                continue
            turns = (1 - np.cos(np.linspace(0, np.pi, 60))) / 2
            at = np.clip(first + (last - first) * turns, first, last)
            states = curve.states(300) if whole else curve.at(approach=at, branch=name)
            p = np.sqrt(np.maximum(0, 1 - states.load / event.load))
            p = np.where(states.central_gap > event.central_gap, -p, p)
            kept = states.load < HOW.most_load
            row = [
                np.cbrt((1 + p) / 2),
                states.approach / (1 + tabor),
                np.full(p.shape, name == "contact"),
                0 * p + tabor,
            ]
            rows.append(np.array(row)[:, kept])
    q, approach, contact, tabor_of = np.concatenate(rows, axis=1)
    return {"q": q, "approach": approach, "contact": contact > 0, "tabor": tabor_of}


def _folds(low: float, high: float) -> tuple[Array, Array]:
    """Middle and slope of the cubic from both folds, which are a complex pair below their birth."""
    tabors, birth = _tabors(low, high, 30), atlas.birth_of_folds().value
    numbers = []
    for tabor in tabors.tolist():
        if tabor > birth:
            on, off = (float(jump(tabor).take_off.approach) for jump in (atlas.jump_on, atlas.jump_off))
            numbers.append(((on + off) / 2 / (1 + tabor), -(((on - off) / 4 / (1 + tabor)) ** (2 / 3))))
        else:
            fold = complex_fold(tabor)
            numbers.append((fold.real / (1 + tabor), (abs(fold.imag) / 2 / (1 + tabor)) ** (2 / 3)))
    t = fits.place(tabors, low, high)
    series = [chebyshev.chebfit(t, values, HOW.cusp_degree) for values in zip(*numbers, strict=True)]
    return series[0], series[1]


def complex_fold(tabor: float) -> complex:
    """Approach where d(approach)/d(gap) = 0 by Newton's method on the series of a curve's last piece before contact."""
    curve, k = atlas.curve(tabor), 2
    c, ends = curve.coefficients[0][:, k], curve.ends
    d, w = (ends[k + 1] - ends[k]) / 2, curve.width
    found = []
    for start in np.add.outer(np.array([0.4j, 1.2j]), np.linspace(-1, 1, 9)).ravel():
        t = complex(start)
        for _ in range(60):
            x = ends[k] + (t + 1) * d
            rate = chebyshev.chebval(t, chebyshev.chebder(c)) - w * np.cosh(x) * d
            step = rate / (chebyshev.chebval(t, chebyshev.chebder(c, 2)) - w * np.sinh(x) * d**2)
            t = t - step
            if abs(step) < 1e-14 or abs(t) > 5:
                break
        if abs(t) < 4 and abs(t.real) < 1.5 and t.imag > 1e-9:
            found.append(complex(chebyshev.chebval(t, c) - w * np.sinh(ends[k] + (t + 1) * d)))
    return min(found, key=lambda fold: abs(fold.real - np.interp(tabor, *FOLDS)))


def _free(low: float, high: float, t: Array, curves: dict[str, Array]) -> tuple[Array, Array]:
    """Middle and slope of the cubic where no fold is near: whatever fits best."""
    tabor, middle, slope = np.array(FREE).T
    first = [
        chebyshev.chebfit(fits.place(tabor, low, high), y, HOW.free_degree)
        for y in (middle / (1 + tabor), slope / (1 + tabor) ** (2 / 3))
    ]

    def off(x: Array) -> Array:
        """Deviations, and by how much the slope is below its least: a cubic of three roots would be a false fold."""
        middle, slope = x[: x.size // 2], x[x.size // 2 :]
        below = np.minimum(chebyshev.chebval(np.linspace(-1, 1, 200), slope) - HOW.least_slope, 0)
        return np.concatenate([_sums(t, curves, middle, slope, 1)[1], below])

    found = np.split(least_squares(off, np.concatenate(first), max_nfev=10).x, 2)
    wide = [np.pad(x, (0, HOW.cusp_degree - HOW.free_degree)) for x in found]
    return wide[0], wide[1]


def _sums(t: Array, curves: dict[str, Array], middle: Array, slope: Array, rounds: int) -> tuple[Array, Array]:
    """Coefficients of the sums, and the deviations of the load in pull-off loads."""
    q, s = curves["q"], np.asarray(chebyshev.chebval(t, slope), float)
    y = fits.root_of_cubic(curves["approach"] - chebyshev.chebval(t, middle), s, curves["contact"])
    basis, series = fits.shapes(y, HOW.terms), chebyshev.chebvander(t, HOW.degree)
    A = (basis.T[:, :, None] * series[:, None, :]).reshape(len(q), -1)
    p = 2 * q**3 - 1
    weight, lawson = 12 * q**2 * np.abs(p) + 0.3, np.ones(len(q))
    best: Array = np.zeros(A.shape[1])
    off, least = p, np.inf
    for _ in range(rounds):
        w = weight * np.sqrt(lawson)
        x = np.asarray(np.linalg.lstsq(A * w[:, None], q * w, rcond=None)[0], float)
        now = p**2 - (2 * (A @ x) ** 3 - 1) ** 2
        if np.abs(now).max() < least:
            best, off, least = x, now, np.abs(now).max()
        lawson = weighed_by(np.abs(now), lawson, 0.02)
    return best, off


if __name__ == "__main__":
    fits.FORCE_FILE.write_text(json.dumps([piece(*ends) for ends in PIECES]) + "\n", encoding="utf-8")
