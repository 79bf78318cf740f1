"""The finite sphere: pull-off and jumps of an elastic hemisphere on a sliding mid-plane, beside the half-space's.

Three inputs: the Tabor parameter, R/eps and Poisson's ratio. A number is the half-space's, from the rest of the atlas,
changed by f: the load by 1 + f, the approach by (1 + tabor) f eps. The body's size enters f by beta/R and the shape of
its cap by eps/R: f = (beta/R) tabor/(1 + tabor) A + (eps/R) B, A and B polynomials on each piece of ln(R/eps). Folds of
a sphere are born elsewhere than the half-space's: a jump is set beside the half-space's as far past its own birth,
tabor/birth being the same, and f is smooth in sqrt(ln(tabor/birth)); that of the pull-off is in ln(tabor).
Made by ``python -m fem_adhesion.finite_sphere.atlas``; to read it takes NumPy alone.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebval2d, chebval3d
from numpy.typing import ArrayLike, NDArray

from halfspace.atlas import events
from halfspace.errors import InputError
from halfspace.limits import SMALLEST_SPHERE
from halfspace.values import Array, States, Valued

TABORS = (0.05, 10.0)
RATIOS = (5.0, 22.5, 150.0, 1e5)  # ends of the pieces of R/eps; below 22.5 the largest tabor has no sphere of 1.5 beta
FITTED = ((5.0, 22.5), (22.5, 260.0), (90.0, 1e5))  # ends of R/eps for each piece's polynomials: beyond it if they may
POISSON = (0.0, 0.49)
DEGREES = {
    "pull_off": ((8, 20, 6), (3, 12, 2)),
    "jump_on": ((8, 12, 8), (3, 8, 2)),
    "jump_off": ((8, 12, 8), (3, 8, 2)),
}
"""Largest of A and B in ln(R/eps), tabor and Poisson's ratio."""

PAST = 1e-3  # a jump's Tabor parameter is past the birth of folds by this part at least; nearer, the error exceeds 1e-4
FILE = Path(__file__).with_name("sphere.json")

NUMBERS = ("load", "approach")
Inputs = tuple[Array, Array, Array]


@dataclass(frozen=True, eq=False, repr=False)
class SphereEvent(Valued):
    """An event of spheres, and beside the half-space's at the same Tabor parameter.

    Attributes
    ----------
    approach, approach_error : array
        In eps.
    load, load_error : array
        In R dgamma, positive in compression.
    load_ratio, load_ratio_error : array
        Load over the half-space's; nan where the half-space does not jump.
    approach_excess : array
        Approach less the half-space's, in eps, with the approach's error; nan where the half-space does not jump.
    """

    approach: Array
    approach_error: Array
    load: Array
    load_error: Array
    load_ratio: Array
    load_ratio_error: Array
    approach_excess: Array


def pull_off(tabor: ArrayLike, radius_ratio: ArrayLike, poisson: ArrayLike = 0.3) -> SphereEvent:
    """Pull-off: where the load is least.

    Parameters
    ----------
    tabor : array_like
        Tabor parameters, 0.05 to 10.
    radius_ratio : array_like
        R/eps, 5 to 1e5, and at least 2.25 tabor: R is 1.5 beta or more.
    poisson : array_like
        Poisson's ratios, 0 to 0.49.

    Returns
    -------
    SphereEvent
        Numbers of the shape of the inputs together.

    Raises
    ------
    InputError
        If an input is outside the atlas.
    """
    inputs = require_inputs(tabor, radius_ratio, poisson)
    return _event("pull_off", inputs, events.pull_off(inputs[0]), (0.0, 0.0))


def jump_on(tabor: ArrayLike, radius_ratio: ArrayLike, poisson: ArrayLike = 0.3) -> SphereEvent:
    """Jump into contact under fixed grips; as `pull_off`, and InputError where the sphere's curve does not fold."""
    return _jump("jump_on", require_inputs(tabor, radius_ratio, poisson))


def jump_off(tabor: ArrayLike, radius_ratio: ArrayLike, poisson: ArrayLike = 0.3) -> SphereEvent:
    """Jump out of contact under fixed grips; as `pull_off`, and InputError where the sphere's curve does not fold."""
    return _jump("jump_off", require_inputs(tabor, radius_ratio, poisson))


def birth_of_folds(radius_ratio: ArrayLike, poisson: ArrayLike = 0.3) -> tuple[Array, Array]:
    """Tabor parameter below which the curve of a sphere does not fold, and its error; InputError outside the atlas."""
    _, ratio, nu = require_inputs(np.full(np.shape(radius_ratio), TABORS[0]), radius_ratio, poisson)
    birth = _birth(ratio, nu)
    return birth, stored()["birth"]["error"] * birth


def _jump(name: str, inputs: Inputs) -> SphereEvent:
    """Event of a jump, from the half-space's as far past its birth of folds."""
    tabor, birth = inputs[0], _birth(*inputs[1:])
    early = tabor < (1 + PAST) * birth
    if early.any():
        at, least = tabor[early].flat[0], ((1 + PAST) * birth)[early].flat[0]
        raise InputError(
            f"tabor = {at:.9g} is outside {least:.6g} <= tabor, from where this sphere jumps; take a larger one, or "
            "fem_adhesion.trace close to it"
        )
    slope, off = like(name, tabor, birth, 1), stored()["birth"]["error"] * events.birth_of_folds().value * tabor / birth
    by_birth = abs(slope.load) * off, abs(slope.approach) * off
    return _event(name, inputs, getattr(events, name)(tabor).take_off, by_birth)


def like(name: str, tabor: Array, birth: Array, derivative: int = 0) -> States:
    """State of the half-space that a sphere's is set beside: a jump as far past the birth of folds."""
    if name == "pull_off":
        return events.pull_off(tabor, derivative=derivative)
    jump: events.Jump = getattr(events, name)(events.birth_of_folds().value * tabor / birth, derivative=derivative)
    return jump.take_off


def _event(name: str, inputs: Inputs, same: States, by_birth: tuple[Any, Any]) -> SphereEvent:
    """Event beside the half-space's states of the same tabor; `by_birth` is the error by that of the birth of folds."""
    tabor, ratio, nu = inputs
    birth = _birth(ratio, nu)
    y, of = place(name, tabor, ratio, birth), like(name, tabor, birth)
    (part, part_error), (shift, shift_error) = (changed(f"{name}.{number}", y, *inputs) for number in NUMBERS)
    load, approach = of.load * (1 + part), of.approach + (1 + tabor) * shift
    load_error = abs(of.load) * part_error + of.load_error + by_birth[0]
    approach_error = (1 + tabor) * shift_error + of.approach_error + by_birth[1]
    beside = load / same.load, load_error / abs(same.load), approach - same.approach
    return SphereEvent(*(np.asarray(value)[()] for value in (approach, approach_error, load, load_error, *beside)))


def require_inputs(tabor: ArrayLike, radius_ratio: ArrayLike, poisson: ArrayLike) -> Inputs:
    """Inputs as arrays of one shape; InputError if one is outside the atlas."""
    mu, ratio, nu = np.broadcast_arrays(*(np.asarray(value, float) for value in (tabor, radius_ratio, poisson)))
    remedy = "fem_adhesion.trace serves beyond"
    for name, values, least, most in (
        ("tabor", mu, *TABORS),
        ("poisson", nu, *POISSON),
        ("radius_ratio", ratio, np.maximum(RATIOS[0], (1 - 1e-12) * SMALLEST_SPHERE * mu), RATIOS[-1]),
    ):
        outside = ~((least <= values) & (values <= most))
        if outside.any():
            limit = np.broadcast_to(least, mu.shape)[outside].flat[0]
            worst = values[outside].flat[0]
            raise InputError(f"{name} = {worst:.9g} is outside the atlas, {limit:.6g} <= {name} <= {most:g}; {remedy}")
    return mu, ratio, nu


def place(name: str, tabor: Array, ratio: Array, birth: Array) -> Array:
    """Place of Tabor parameters, -1 to 1: in the logarithm, of jumps in its root from the birth of folds."""
    most = np.minimum(TABORS[1], ratio / SMALLEST_SPHERE)
    least = TABORS[0] if name == "pull_off" else birth
    share = np.maximum(np.log(tabor / least) / np.log(most / least), 0)
    return np.asarray(2 * (share if name == "pull_off" else np.sqrt(share)) - 1)


def born(ratio: Array, poisson: Array, coefficients: Array) -> Array:
    """Tabor parameter at which folds are born, from the coefficients of its logarithm."""
    x = _place(ratio**-0.25, RATIOS[-1] ** -0.25, RATIOS[0] ** -0.25)
    return np.asarray(np.exp(chebval2d(x, _place(poisson, *POISSON), coefficients)))


def _birth(ratio: Array, poisson: Array) -> Array:
    return born(ratio, poisson, np.array(stored()["birth"]["coefficients"]))


def across(piece: int | NDArray[np.intp], ratio: Array, poisson: Array) -> tuple[Array, Array]:
    """Places in R/eps and in Poisson's ratio, -1 to 1, for the polynomials of pieces."""
    low, high = np.moveaxis(np.log(FITTED)[piece], -1, 0)
    return _place(np.log(ratio), low, high), _place(poisson, *POISSON)


def sizes(tabor: Array, ratio: Array) -> tuple[Array, Array]:
    """What A and B are multiplied by."""
    return np.asarray(tabor**1.5 / (1 + tabor) / np.sqrt(ratio)), np.asarray(1 / ratio)


def changed(name: str, y: Array, tabor: Array, ratio: Array, poisson: Array) -> Array:
    """Change (2, ...) of a number of the half-space and its error, at places in tabor from -1 to 1."""
    piece = np.clip(np.searchsorted(RATIOS, ratio, side="right") - 1, 0, len(FITTED) - 1)
    x, z = across(piece, ratio, poisson)
    found = np.zeros(piece.shape)
    for size, tensors in zip(sizes(tabor, ratio), polynomials(name), strict=True):
        for number, tensor in enumerate(tensors):
            here = piece == number
            found[here] += size[here] * chebval3d(x[here], y[here], z[here], tensor)
    return np.array([found, np.array(stored()["series"][name]["errors"])[piece]])


def _place(x: Array, low: Any, high: Any) -> Array:
    return np.asarray((2 * x - low - high) / (high - low))


def terms(degrees: tuple[int, ...]) -> NDArray[np.intp]:
    """Degrees (3, terms) of the products of Chebyshev polynomials: those whose parts of the largest add up to one."""
    every = np.indices([degree + 1 for degree in degrees]).reshape(3, -1)
    return np.asarray(every[:, (every.T / (np.array(degrees) + 0.5)).sum(axis=1) <= 1])


@cache
def polynomials(name: str) -> list[Array]:
    """Coefficients (pieces, ...) of A and of B of a number."""
    found = []
    for degrees, kind in zip(DEGREES[name.partition(".")[0]], "AB", strict=True):
        tensors = np.zeros((len(FITTED), *(degree + 1 for degree in degrees)))
        tensors[:, *terms(degrees)] = stored()["series"][name][kind]
        found.append(tensors)
    return found


@cache
def stored() -> dict[str, Any]:
    """Content of the file."""
    content: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
    return content
