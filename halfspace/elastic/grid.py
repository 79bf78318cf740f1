"""Radial grids: where the rings of pressure begin and end. Radii in beta, or in units of a length scaled later."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from halfspace.errors import InputError
from halfspace.values import Array


def uniform(extent: float, spacing: float) -> Array:
    """Breakpoints from 0 to `extent`, equally spaced by `spacing` at most."""
    _require_positive(extent=extent, spacing=spacing)
    return np.linspace(0, extent, int(np.ceil(extent / spacing - 1e-9)) + 1)


def graded(
    radius: float,
    finest: float,
    extent: float,
    *,
    growth: float = 2.0,
    last: float = np.inf,
    until: float | None = None,
) -> Array:
    """Breakpoints from 0 to `extent`, finest at `radius` and growing geometrically away from it on both sides.

    The intervals that touch the radius, 0 <= radius < extent, 1 for a grid that is scaled with the contact, are
    `finest` long, or less; the growth, above 1, is the ratio of the lengths of neighbours. The interval that touches
    `extent` is `last` long, or less, if they are to be fine there too. Beyond the radius they are equally long `until`
    another one, if it is given. InputError if one is out of range.
    """
    _require_positive(finest=finest, extent=extent)
    until = radius if until is None else until
    if not 0 <= radius <= until < extent:
        told = f"radius {radius:g}" if until == radius else f"what is fine, from {radius:g} to {until:g},"
        raise InputError(f"{told} lies outside 0 <= radius < extent = {extent:g}; move it inside the grid")
    if growth <= 1:
        raise InputError(f"growth {growth:g} is not above 1; take about 2")
    inner = radius - geometric(radius, finest, growth)[::-1] if radius else np.zeros(1)
    even = np.linspace(radius, until, int(np.ceil((until - radius) / finest - 1e-9)) + 1)
    lines = np.concatenate([inner, even[1:], (until + geometric(extent - until, finest, growth, last))[1:]])
    lines[[0, -1]] = 0.0, extent  # not what rounding leaves of them
    return lines


def towards_axis(lines: Array, first: float, growth: float) -> Array:
    """Cut the cell on the axis so that the first is `first` long, or less, and they grow geometrically from there."""
    end = float(lines[1])
    return lines if first >= end else np.append(geometric(end, first, growth), lines[2:])


def geometric(length: float, finest: float, growth: float, last: float = np.inf) -> Array:
    """Breakpoints from 0 to `length`: geometric with at most the given growth, the first at `finest` or less.

    The last interval is `last` long, or less: they grow from both ends to where they are equally long.
    """
    if (growth - 1) * length + finest <= growth * last:
        return _growing(length, finest, growth)
    met = float(np.clip((length + (last - finest) / (growth - 1)) / 2, 0.0, length))
    from_last = length - _growing(length - met, last, growth)[::-1]
    from_last[-1] = length
    return np.concatenate([_growing(met, finest, growth)[:-1], from_last]) if met else from_last


def _growing(length: float, finest: float, growth: float) -> Array:
    count = int(np.ceil(np.log1p((growth - 1) * length / finest) / np.log(growth) - 1e-9))
    steps = growth ** np.arange(max(count, 1))
    return np.concatenate([[0.0], np.cumsum(steps) * (length / steps.sum())])


def equal_ratios(first: float, last: float, *, most: float) -> Array:
    """Breakpoints from `first` to `last` in equal ratios, each of `most` or less; `last` alone if it is no larger."""
    count = int(np.ceil(np.log(last / first) / np.log(most) - 1e-9))
    return np.geomspace(first, last, count + 1) if count > 0 else np.array([last])


@cache
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Points in (-1, 1) and weights of Gauss's rule; computed once, since every panel of every grid asks for them."""
    rule = legendre.leggauss(points)
    for values in rule:
        values.flags.writeable = False
    return rule


def gauss_points(lines: Array, count: int) -> tuple[Array, Array]:
    """Points of Gauss's rule, so many from each of the lines (..., m + 1) to the next, and weights, (..., m, count)."""
    x, w = gauss_legendre(count)
    half = np.diff(lines)[..., None] / 2
    return lines[..., :-1, None] + half * (1 + x), half * w


def _require_positive(**lengths: float) -> None:
    for name, value in lengths.items():
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"{name} {value:g} is not a positive length; give it in beta")


def polynomial(places: Array, x: Array | float) -> Array:
    """Weights (..., k) of values at places (k,) in that of the polynomial through all at others x (...)."""
    own = np.eye(places.size, dtype=bool)
    ahead = np.where(own, 1.0, (np.asarray(x)[..., None] - places)[..., None, :])
    return np.asarray(np.prod(ahead / (places[:, None] - places + own), axis=-1))


@dataclass(frozen=True)
class SurfaceCoordinate:
    """Coordinate x along the surface of a sphere, stereographic: r = x/(1 + k x^2), k = 1/4R^2, R in beta.

    On a flat one, of infinite R, it is the radius itself. The area is that which the density of a ring's is:
    "projected" on the plane of the contact, or the sphere's "surface".
    """

    R: float = np.inf
    area: str = "projected"

    def of(self, radius: float) -> float:
        """Coordinate 2 R tan(theta/2) at the radius R sin(theta)."""
        return float(self.along(np.array(radius)))

    def along(self, radii: Array) -> Array:
        """Coordinates at radii."""
        s = np.minimum(radii / self.R, 1.0)
        return np.asarray(2 * radii / (1 + np.sqrt((1 - s) * (1 + s))))

    def rate(self, radius: float) -> float:
        """Derivative dx/dr at a radius; nan on the equator, where it is infinite."""
        slope = float(self.radius(np.array(self.of(radius)))[1])
        return 1 / slope if slope else np.nan

    def radius(self, x: Array) -> tuple[Array, Array]:
        """Radius r at x and dr/dx."""
        t = (x / (2 * self.R)) ** 2
        return np.asarray(x / (1 + t)), np.asarray((1 - t) / (1 + t) ** 2)

    def ring(self, x: Array) -> tuple[Array, Array]:
        """Density r dr/dx of a ring's area, or r ds/dx with ds/dx = 1/(1 + t), and its derivative by x."""
        t = (x / (2 * self.R)) ** 2
        if self.area == "surface":
            return np.asarray(x / (1 + t) ** 2), np.asarray((1 - 3 * t) / (1 + t) ** 3)
        return np.asarray(x * (1 - t) / (1 + t) ** 3), np.asarray((1 - 8 * t + 3 * t**2) / (1 + t) ** 4)


FLAT = SurfaceCoordinate()
