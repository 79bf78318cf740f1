"""Fit the constants of `halfspace.theories.fits` to the atlas: ``python -m fem_adhesion.formulas.fit``, some seconds.

Each fit is linear least squares, repeated: quotients are multiplied out with their last denominator as weight, and
points weigh more the larger their deviation was (Lawson), which makes the largest one as small as it can be.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyval

from halfspace import atlas
from halfspace.atlas import sphere
from halfspace.limits import SMALLEST_SPHERE
from halfspace.theories import fits
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF, ZERO_LOAD_RADIUS
from halfspace.values import Array

ROUNDS = 400  # repetitions of a fit
DIGITS = 6  # significant digits of a coefficient
TABORS = np.geomspace(0.01, 300, 1500)
FOLDED = atlas.birth_of_folds().value + np.geomspace(1e-6, 299.3, 1500)
LOSING = atlas.birth_of_folds().value + np.geomspace(1e-5, 299.3, 1500)  # nearer, the atlas has few digits of the loss

GRID = (24, 36, 9)  # points in tabor, R/eps and Poisson's ratio


def constants() -> dict[str, Any]:
    """Content of ``halfspace/theories/fits.json``: constants of the limits as they are, coefficients fitted to them."""
    found: dict[str, Any] = {name: fits.CONSTANTS[name] for name in ("birth", "softening", "attraction")}
    s, load = np.sqrt(TABORS), atlas.pull_off(TABORS).load
    f = (load - JKR_PULL_OFF) / (BRADLEY_PULL_OFF - JKR_PULL_OFF)
    c = fits.SOFTENING / (JKR_PULL_OFF - BRADLEY_PULL_OFF)
    A = np.column_stack([*((1 - f) * s**i for i in (1, 2, 3)), *(-f * s**i for i in (4, 5, 6, 7))])

    def below(x: Array) -> Array:
        return np.asarray(polyval(s, [1, *x[:3]]) + c * s**3 + s**4 * polyval(s, x[3:]))

    x = quotient(A, f * c * s**3 - (1 - f), below, load)
    found |= {"pull_off": [1.0, *x[:3]], "pull_off_below": [*x[3:]]}
    radius = atlas.zero_load(TABORS).contact_radius
    g, k = radius * s / fits.RIGID_RADIUS, ZERO_LOAD_RADIUS / fits.RIGID_RADIUS
    A = np.column_stack([*(s**i for i in (1, 2, 3, 4)), *(-g * s**i for i in (1, 2, 3)), k * s**5 - g * s**4])
    x = quotient(A, g - 1, lambda x: polyval(s, [1, *x[4:]]), g)
    found |= {"zero_load": [1.0, *x[:4]], "zero_load_below": [1.0, *x[4:]]}
    on, off = atlas.jump_on(FOLDED).take_off.approach, atlas.jump_off(FOLDED).take_off.approach
    soft_on, soft_off = 1 - fits.ATTRACTION * FOLDED ** (3 / 7), -3 / 4 * np.pi ** (2 / 3) * FOLDED
    lost, soft_lost = atlas.energy_lost(LOSING).energy, fits.JKR_LOST * LOSING * fits.past_birth(LOSING, 4 / 7) ** 4
    for name, tabors, power, exact, soft, offset, terms in (
        ("jump_on", FOLDED, 18 / 7, on, soft_on, 1.0, 4),
        ("jump_off", FOLDED, 3 / 2, off, soft_off, 0.0, 7),
        ("energy_lost", LOSING, 4 / 7, lost, soft_lost, 0.0, 6),
    ):
        v = fits.past_birth(tabors, power)
        A = ((soft - offset) * (1 - v))[:, None] * np.vander(v, terms, increasing=True)
        found[name] = list(quotient(A, exact - soft, lambda _: np.ones(1), np.abs(exact) + offset))
    found["sphere"] = list(of_spheres())
    return {name: rounded(value, DIGITS) if isinstance(value, list) else value for name, value in found.items()}


def of_spheres() -> Array:
    """Coefficients of the logarithm of the sphere's factor, fitted to points that are closer at the ends."""
    share, ratio, nu = (
        grid.ravel() for grid in np.meshgrid(*(np.sin(np.linspace(0, np.pi / 2, n)) ** 2 for n in GRID))
    )
    ratio = sphere.RATIOS[0] * (sphere.RATIOS[-1] / sphere.RATIOS[0]) ** ratio**2
    most = np.minimum(sphere.TABORS[1], ratio / SMALLEST_SPHERE)
    inputs = sphere.TABORS[0] * (most / sphere.TABORS[0]) ** share, ratio, sphere.POISSON[1] * nu
    one = np.ones(len(nu))
    return quotient(fits.sphere_terms(*inputs), np.log(sphere.pull_off(*inputs).load_ratio), lambda _: one, one)


def quotient(A: Array, b: Array, below: Callable[[Array], Array], scale: Array) -> Array:
    """Coefficients x for which max |(A x - b)/(below(x) scale)| is least."""
    lawson, under = np.ones(len(b)), np.ones(len(b))
    best, least = np.zeros(A.shape[1]), np.inf
    for _ in range(ROUNDS):
        w = np.sqrt(lawson) / np.abs(under * scale)
        sizes = np.linalg.norm(A * w[:, None], axis=0)
        x = np.linalg.lstsq(A * w[:, None] / sizes, b * w, rcond=None)[0] / sizes
        under = below(x) * np.ones(len(b))
        off = np.abs((A @ x - b) / (under * scale))
        if off.max() < least and (under > 0).all():
            best, least = x, off.max()
        lawson = weighed_by(off, lawson, 1e-9)
    return best


def weighed_by(off: Array, weights: Array, floor: float) -> Array:
    """Weights (n,) of points, more where the deviations (n,) are larger (Lawson); the floor keeps every point."""
    weights = weights * (np.sqrt(off / off.max()) + floor)
    return np.asarray(weights / weights.mean())


def rounded(values: Sequence[float] | Array, digits: int) -> Any:
    """Lists of coefficients with so many significant digits."""
    return np.vectorize(lambda c: float(f"{c:.{digits}g}"))(values).tolist()


if __name__ == "__main__":
    lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(value)}" for name, value in constants().items())
    fits.FILE.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")
