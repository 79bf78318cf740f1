"""What a scene means, by formulas of its own: lengths of bodies, tensions of laws, heights of profiles.

The formulas are those that laws and profiles are named after, written once more and shared with no solver. They give
the weak form its lengths and heights, and closed numbers that a law and a profile must have: a parameter that enters
elsewhere with another value is told by the number that it should make.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from fem_adhesion.crosscheck.comparison import CLOSED_FORM, Row, of_values
from fem_adhesion.crosscheck.settings import USUAL
from fem_adhesion.scene import Scene
from fem_adhesion.weak_form.contact import Heights, paraboloid
from halfspace.laws import Dlvo, Dugdale, Exponential, Law, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Paraboloid, Power, RoundedPunch, Sphere
from halfspace.values import Array, Estimate

Tension = Callable[[Array], Array]

# Lengths


def lengths(scene: Scene) -> tuple[float, tuple[float, ...]]:
    """R of the scene and those of its bodies in beta, infinite where they have none.

    With eps = 1 the sphere has R = rho; mu^3 = R w^2 and beta^3 = R^2 w with w = dgamma/(E* eps).
    """
    bodies = [body.size for body in scene.bodies]
    curvature = sum(1 / rho for rho in bodies)
    own = scene.profile if curvature == 0 else None
    rho = getattr(own, "radius_ratio", math.inf) if curvature == 0 else 1 / curvature
    if math.isinf(rho):
        return math.inf, tuple(bodies)
    w = (scene.tabor**3 / rho) ** 0.5
    beta = (rho**2 * w) ** (1 / 3)
    return rho / beta, tuple(size / beta for size in bodies)


# Laws

TENSIONS: Mapping[type, Callable[[Any, Array], Array]] = {
    PowerLaw: lambda law, h: h ** -float(law.attraction) - h ** -float(law.repulsion),
    Morse: lambda law, h: np.exp(law.k * (1 - h)) - np.exp(2 * law.k * (1 - h)),
    Exponential: lambda law, h: np.exp(law.k * (1 - h)) * (1 - h ** -float(law.core)),
    Dlvo: lambda law, h: h**-3.0 - law.charge * np.exp(law.screening * (1 - h)) - (1 - law.charge) * h**-9.0,
    Dugdale: lambda law, h: _until(law.width, h) - _until(law.width, 1.0) * np.exp((1 - h) / law.width**2),
}
"""Tension at gaps h in eps, but for a factor."""


def _until(width: float, h: Any) -> Any:
    """One up to the gap 2 eps, where it falls to none."""
    return (1 - np.tanh((h - 2) / (2 * width))) / 2


LOGARITHMS = np.arange(-25.0, 40.0, USUAL.step)  # of gaps H; a tension that falls as h^-2.1 leaves 1e-19 beyond


@dataclass(frozen=True)
class Numbers:
    """What a tension makes: its integral from equilibrium on, and of the law of that work 1 what follows.

    Gaps H of the edge and of `range`, beyond which half of the work is left, in eps; strength in dgamma/eps, stiffness
    in dgamma/eps^2.
    """

    work: Estimate
    edge: float
    strength: float
    stiffness: float
    range: float


def numbers(tension: Tension) -> Numbers:
    """Numbers of a law from its tension at gaps h, which need not be of work 1."""
    H, step = np.exp(LOGARITHMS), USUAL.step
    s = tension(1 + H)
    parts = step * H * s
    work = float(parts.sum())
    doubt = abs(2 * float(parts[::2].sum()) - work)
    left = np.cumsum(parts[::-1])[::-1] - parts / 2
    half = math.exp(np.interp(-0.5 * work, -left, LOGARITHMS))
    top = int(np.argmax(s))
    a, b, c = np.polyfit(np.arange(-1, 2), s[top - 1 : top + 2], 2)
    edge, strength = math.exp(LOGARITHMS[top] - step * b / (2 * a)), float(c - b**2 / (4 * a))
    d = np.array([-1e-5, 1e-5])
    stiffness = float(np.diff(tension(1 + d))[0] / np.diff(d)[0])
    return Numbers(Estimate(work, doubt), edge, strength / work, stiffness / work, half)


@lru_cache(maxsize=8)
def numbers_of(law: Law) -> Numbers:
    """Numbers of a law by its definition here, of one's own laws by the pressure that they tell."""
    known = TENSIONS.get(type(law))
    return numbers(lambda h: known(law, h)) if known else numbers(lambda h: -law.pressure(h - 1, 1.0))


# Profiles

HEIGHTS: Mapping[type, Callable[[Any, Array], Array]] = {
    Paraboloid: lambda _, r: paraboloid(r),
    Power: lambda profile, r: r**profile.k / profile.k,
    Hyperboloid: lambda profile, r: r**2 / (1 + np.sqrt(1 + (r / profile.b) ** 2)),
    RoundedPunch: lambda profile, r: (r**2 / (np.sqrt(profile.flat**2 + r**2) + profile.flat)) ** 2 / 2,
}


def _sphere(r: Array, R: float) -> Array:
    """Height in beta^2/R over radii in beta of a sphere of radius R (beta): R (R - sqrt(R^2 - r^2))."""
    return np.asarray(r**2 / (1 + np.sqrt((1 - r / R) * (1 + r / R))))


def heights(scene: Scene) -> Heights:
    """Undeformed gap in beta^2/R over radii in beta; those of two spheres add. What is not known here tells its own."""
    shape, (R, _) = scene.shape, lengths(scene)
    if isinstance(shape, Sphere):
        over = shape.counter_radius
        radii = [R * (1 + 1 / over), R * (1 + over)] if math.isfinite(over) else [R]
        return lambda r: sum((R / each * _sphere(r, each) for each in radii), 0 * r)
    known = HEIGHTS.get(type(shape))
    return (lambda r: known(shape, r)) if known else scene.surface.height


# What they must make


def rows(scene: Scene) -> list[Row]:
    """Numbers of law, profile and lengths, by definition and as the solvers take them."""
    found = []
    for name, unit, known, value in _pairs(scene):
        both = Estimate(known, USUAL.exact * abs(known)), Estimate(value, USUAL.exact * abs(known))
        found.append(of_values(name, unit, *both, USUAL.defined * abs(known), CLOSED_FORM))
    return found


def _pairs(scene: Scene) -> Iterator[tuple[str, str, float, float]]:
    """Name and unit of each number, the number by definition, and that of the solvers."""
    law: Any = scene.law
    known, made = numbers_of(law), replace(law) if type(law) in TENSIONS else law
    yield "law: depth", "dgamma", 1.0, -float(made.energy(np.array(0.0), 1.0))
    yield "law: stiffness", "dgamma/eps^2", known.stiffness, made.stiffness
    yield "law: strength", "dgamma/eps", known.strength, made.strength
    yield "law: edge", "eps", known.edge, made.edge_gap
    yield "law: range", "eps", known.range, made.range(0.5)
    if not scene.body.file:
        z, surface = heights(scene), scene.shape.surface(scene.tabor)
        r = surface.end / 2 if math.isfinite(surface.end) else 1.0
        d = USUAL.small * r
        places = r + d * np.array([-1.0, 0.0, 1.0])
        (low, mid, high), slopes = z(places), surface.slope(places)
        yield "profile: height", "beta^2/R", float(mid), float(surface.height(np.array(r)))
        yield "profile: slope", "beta/R", float(high - low) / (2 * d), float(slopes[1])
        curvatures = float(high - 2 * mid + low) / d**2, float(slopes[2] - slopes[0]) / (2 * d)
        yield "profile: curvature", "1/R", *curvatures
    R, bodies = lengths(scene)
    if math.isfinite(R):
        yield "length: R", "beta", R, scene.sphere_radius
    for n, (length, value) in enumerate(zip(bodies, scene.radii, strict=False), 1):
        if math.isfinite(length):
            yield f"length: R{n}", "beta", length, value
    if scene.share is not None:
        yield "length: share of the second body", "1/E*", scene.share, scene.shares[1]
