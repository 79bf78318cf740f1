"""Limits of the inputs, checked where they enter; each refusal names the value, the limit and the remedy."""

from __future__ import annotations

import math
import re
import reprlib
from collections.abc import Callable
from numbers import Integral, Real

import numpy as np

from halfspace.errors import InputError
from halfspace.values import Array

SMALLEST_SPHERE = 1.5**2
"""Least R/eps over the Tabor parameter, (R/beta)^2."""
MOST_POINTS = 10_000
"""Of a curve."""
LAYER_THICKNESS = (0.01, 1000.0)
"""Of a layer, in beta."""


def require_number(value: object, name: str) -> float:
    """Return a real number of any type as a float, or raise InputError for what is none."""
    if isinstance(value, bool) or not isinstance(value, Real):
        shown, kind = " ".join(reprlib.repr(value).split()), type(value).__name__
        raise InputError(f"{name} = {shown} of type {kind}, limit: a real number; give a float")
    try:
        return float(value)
    except OverflowError as error:
        raise InputError(f"{name} has {len(str(value))} digits, limit: 1.8e308; give a float") from error


def require_numbers(values: object, name: str) -> Array:
    """Return a real number, or an array of them, as an array, or raise InputError for what is none."""
    if isinstance(values, np.ndarray) and values.dtype.kind in "iuf":
        return values.astype(float)
    numbers = np.asarray(values, dtype=object)
    return np.array([require_number(one, name) for one in numbers.ravel()], dtype=float).reshape(numbers.shape)


def require_between(value: object, name: str, least: float, most: float, remedy: str, of: str = "") -> float:
    """Return a real number of any type as a float, or raise InputError unless it is finite and in a range.

    The least and the most are in it; what it is a number `of` is told behind it.
    """
    number = require_number(value, name)
    limit = f"{_short(least)} <= {name} {f'<= {_short(most)}' if math.isfinite(most) else '< inf'}"
    return _require(number, name, least <= number <= most, limit, remedy, of)


def _short(limit: float) -> str:
    """Number without the zeros and the plus of its exponent."""
    return re.sub(r"e\+?(-?)0*", r"e\1", f"{limit:g}")


def require_positive(value: object, name: str, remedy: str, unit: str = "") -> float:
    """Return a real number of any type as a float, or raise InputError unless it is positive and finite."""
    number = require_number(value, name)
    return _require(number, name, number > 0, f"0 < {name} < inf", remedy, unit and f" {unit}")


def require_one_of(value: object, name: str, names: tuple[str, ...]) -> None:
    """Raise InputError unless a word is one of some names."""
    if value not in names:
        raise InputError(f"{name} = {value!r} is not one of {', '.join(names)}; take {names[0]}")


def require_part(value: object, name: str, trait: str, example: str) -> None:
    """Raise InputError unless a part of a scene is an object with the attribute by which it is known."""
    if isinstance(value, type) or not hasattr(value, trait):
        shown = " ".join(reprlib.repr(value).split())
        raise InputError(f"{name} = {shown} of type {type(value).__name__} is no {name}; take {example}, say")


def require_all(part: object, *findings: tuple[str, bool, str, str]) -> None:
    """Raise InputError for the first finding about a part that does not hold.

    A finding is a value in words, whether it will do, its limit and the remedy.
    """
    for value, holds, limit, remedy in findings:
        if not holds:
            raise InputError(f"{part}: {value}, limit: {limit}; {remedy}")


def off_derivative(derivative: Array, of: Callable[[Array], Array], x: Array, size: Array, scale: Array) -> float:
    """Largest distance of a derivative at places x from differences of its function, in parts of a scale.

    Differences are over 1e-4 of a size of the places. The distance at two neighbouring places counts: at one alone a
    law or a profile may have a corner or a step.
    """
    d = 1e-4 * size
    one, two = (of(x + k * d) - of(x - k * d) for k in (1, 2))
    off = np.abs(derivative - (8 * one - two) / (12 * d)) / scale
    return float(np.max(np.minimum(off[1:], off[:-1])))


def require_tabor(tabor: float) -> float:
    """Return the Tabor parameter, or raise InputError unless 1e-12 <= tabor <= 300: beyond, a closed form will do."""
    tabor = require_number(tabor, "tabor")
    _require(tabor, "tabor", 0 < tabor < math.inf, "0 < tabor", "give the Tabor parameter of the contact")
    _require(
        tabor,
        "tabor",
        tabor >= 1e-12,
        "1e-12 <= tabor",
        "the body is rigid: use halfspace.theories.closed_forms.bradley_load",
    )
    return _require(
        tabor, "tabor", tabor <= 300, "tabor <= 300", "JKR's theory holds: use halfspace.theories.closed_forms.jkr_load"
    )


def require_poisson(poisson: float) -> float:
    """Return Poisson's ratio, or raise InputError unless 0 <= poisson <= 0.499999.

    A digit is lost to rounding for each further 9 of 0.4999...; the limit leaves nine.
    """
    poisson = require_number(poisson, "poisson")
    remedy = "take 0.4999 for rubber" if poisson > 0 else "take 0.3 if it is not known"
    _require(poisson, "poisson", 0 <= poisson < 0.5, "0 <= poisson < 0.5", remedy)
    return _require(poisson, "poisson", poisson <= 0.499999, "poisson <= 0.499999", remedy)


def require_rtol(rtol: float) -> float:
    """Return the relative tolerance, or raise InputError unless 1e-9 <= rtol <= 0.1."""
    return require_between(rtol, "rtol", 1e-9, 1e-1, "take 1e-5 if in doubt")


def require_load(to_load: float) -> float:
    """Return the compressive load at which a curve ends, or raise InputError unless 0 < to_load <= 1000."""
    to_load = require_number(to_load, "to_load")
    remedy = "the curve must pass zero load, and Hertz's theory serves above: take 5"
    return _require(to_load, "to_load", 0 < to_load <= 1000, "0 < to_load <= 1000", remedy)


def require_points(points: int) -> int:
    """Return the number of points of a curve, or raise InputError unless 2, its ends, <= points <= 10000.

    Each is solved for on all stages, in milliseconds; a curve through 10000 points errs by less than they do.
    """
    whole = isinstance(points, Integral) and not isinstance(points, bool)
    if not whole or not 2 <= points <= MOST_POINTS:
        raise InputError(f"points = {points} is outside 2 <= points <= {MOST_POINTS}; take a whole number, say 500")
    return int(points)


def require_radius(radius: float, tabor: float = math.inf, least: float = 5.0) -> float:
    """Return the size of a block, or raise InputError unless the contact and its attraction fit in, and it in floats.

    A contact is 2 to 3 beta wide and a nearly rigid sphere attracts over some beta/sqrt(tabor). The error is estimated
    from smaller blocks, which must do, too: of one that is held from a third, so that it is `least` beta at least.
    """
    radius = require_number(radius, "radius")
    least = max(least, 5 * tabor**-0.5)
    remedy = "a contact is 2 to 3 beta wide, take 50 or more, or a half-space"
    return _require(radius, "radius", least < radius <= 1e9, f"{least:.3g} < radius <= 1e9", remedy)


def require_radius_ratio(radius_ratio: float, tabor: float = 0.0) -> float:
    """Return R/eps, or raise InputError unless it is 2 to 1e12 and R/beta = sqrt(radius_ratio/tabor) at least 1.5.

    A contact is 1 to 2 beta wide where it is lost: a smaller sphere is deformed as a whole, and past its equator.
    """
    radius_ratio = require_between(
        radius_ratio, "radius_ratio", 2, 1e12, "it is the radius over the spacing: change one of the two"
    )
    least = SMALLEST_SPHERE * tabor
    remedy = "the sphere is as small as its contact, R < 1.5 beta: take a stiffer or larger one"
    limit = f"{SMALLEST_SPHERE:g} tabor = {least:.3g} or more"
    return _require(radius_ratio, "radius_ratio", radius_ratio >= least, limit, remedy)


def require_counter_radius(counter_radius: float) -> float:
    """Return a second sphere's radius in radii of the first, or raise InputError unless it is 1 or more."""
    counter_radius = require_number(counter_radius, "counter_radius")
    if not counter_radius >= 1:
        raise InputError(
            f"counter_radius = {counter_radius:g} is outside 1 <= counter_radius; let the smaller be first"
        )
    return counter_radius


def require_cap_angle(cap_angle: float) -> float:
    """Return the half-angle of a cap in degrees, or raise InputError unless it is 1 to 89.99, or 90.

    Between the last two the free ring beside the equator is lost to rounding.
    """
    cap_angle = require_number(cap_angle, "cap_angle")
    holds = 1 <= cap_angle <= 89.99 or cap_angle == 90
    return _require(cap_angle, "cap_angle", holds, "1 <= cap_angle <= 89.99 and is not 90", "give degrees, say 30")


def require_modulus(modulus: float) -> float:
    """Return a Young's modulus, or raise InputError unless it is positive and finite."""
    return require_positive(modulus, "modulus", "a rigid body is no counter-body: leave it out")


def require_thickness(thickness: float) -> float:
    """Return the thickness of a layer in beta, or raise InputError unless it is 0.01 to 1000.

    A thinner one is a mattress, a thicker one a half-space, of which contacts of some beta do not see the end.
    """
    remedy = "it is in beta = (R^2 dgamma/E*)^(1/3); a thicker one is a half-space"
    return require_between(thickness, "thickness", *LAYER_THICKNESS, remedy)


def require_stiffness(modulus: float) -> float:
    """Return a Young's modulus in units of the first stratum's, or raise InputError unless it is 0.01 to 1000.

    Under a film that is stiffer still rounding hides the contact's edge; what is 1000 times as stiff is rigid.
    """
    remedy = "what is stiffer is rigid: a bonded base; over what is softer the first stratum is a plate"
    return require_between(modulus, "modulus", 0.01, 1000, remedy, ", in units of the first stratum's,")


def require_film(ratio: float) -> float:
    """Return a coating's Young's modulus over that of what is below, or raise InputError unless it is 0.001 to 100."""
    remedy = "a softer coating is a layer on a rigid base; a stiffer one is a plate"
    return require_between(ratio, "modulus_ratio", 0.001, 100, remedy)


def require_share(share: float | None) -> float:
    """Return a counter-body's part of the compliance, or raise InputError unless 0 < share < 1."""
    share = require_number(share, "share")
    return _require(share, "share", 0 < share < 1, "0 < share < 1", "a rigid one is no counter-body: leave it out")


def _require(value: float, name: str, holds: bool, limit: str, remedy: str, of: str = "") -> float:
    if not holds or not math.isfinite(value):
        raise InputError(f"{name} = {value:.9g}{of} is outside {limit}; {remedy}")
    return value
