"""The whole elastic sphere in Legendre polynomials: a solver that shares no operator with the finite elements.

Axisymmetric Navier solutions regular at the centre, A. I. Lur'e, Three-dimensional Problems of the Theory of Elasticity
(1964), for a sphere of radius 1 and each degree n, with x = cos(theta), P = P_n(x) and D = dP_n/dtheta:

    u_r = [A (n + 1)(n - 2 + 4 nu) + B n] P,    sigma_r / 2 G = [A (n + 1)(n^2 - n - 2 - 2 nu) + B n (n - 1)] P,
    u_t = [A (n + 5 - 4 nu) + B] D,             tau_rt / 2 G = [A (n^2 + 2 n - 1 + 2 nu) + B (n - 1)] D.

Vertical tractions that mirror each other in the equator's plane need even n alone; that plane then moves without
friction and with u_z = 0, as the mid-plane of a hemisphere in the sliding grip does.

A pressure is a polynomial in each cell of the surface, as on a half-space; its coefficients are integrals by Gauss's
rule. The harmonics must resolve the spike of tension at the edge of a contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import count, islice, pairwise

import numpy as np

from fem_adhesion.scene import Scene
from halfspace.accuracy.finite_bodies import Made, SizedBody
from halfspace.accuracy.grids import GRIDS
from halfspace.accuracy.refinement import climb
from halfspace.accuracy.stages import Rung
from halfspace.accuracy.standing import left_between, standing
from halfspace.elastic import compliance, grid
from halfspace.elastic.compliance import collocated
from halfspace.elastic.grid import FLAT
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import ErrorRule
from halfspace.errors import InputError
from halfspace.limits import require_load, require_rtol
from halfspace.values import Array

# The sphere


def legendre(harmonics: int, x: Array) -> tuple[Array, Array]:
    """P_n and dP_n/dtheta at x = cos(theta) of the first even n, each (harmonics, x.size)."""
    P, odd = np.array(list(islice(_even(x), harmonics))).swapaxes(0, 1)
    sine = np.sqrt((1 - x) * (1 + x))
    return P, 2.0 * np.arange(harmonics)[:, None] * (x * P - odd) / np.where(sine > 0, sine, 1.0)


def _even(x: Array) -> Iterator[tuple[Array, Array]]:
    """P_n and P_(n - 1) at x of the even n one after the other."""
    even, odd = np.ones(x.size), x
    yield even, odd
    for n in count(2, 2):
        even = ((2 * n - 1) * x * odd - (n - 1) * even) / n
        yield even, odd
        odd = ((2 * n + 1) * x * even - n * odd) / (n + 1)


def _traction(p: Array) -> tuple[Array, Array]:
    """Coefficients of t_r = -p x^2 by P_n and of t_theta = p x sin(theta) by D_n, from int_0^1 p P_n dx of the even n.

    They are (2 n + 1) int t_r P_n dx and (2 n + 1)/(n (n + 1)) int t_theta D_n dx, and x^2 P_n and x sin(theta) D_n are
    sums of three P_n; so there is one n less.
    """
    n = 2.0 * np.arange(len(p) - 1)[:, None]
    above, here, below = p[1:], p[:-1], np.concatenate([0 * p[:1], p[:-2]])
    up, down = (n + 1) / (2 * n + 3), n / (2 * n - 1)
    normal = up * ((n + 2) * above + (n + 1) * here) + down * (n * here + (n - 1) * below)
    shear = ((n + 2) * above + (n + 1) * here) / (2 * n + 3) - (n * here + (n - 1) * below) / (2 * n - 1)
    return -normal, shear


def _displacements(poisson: float, normal: Array, shear: Array) -> tuple[Array, Array]:
    """Coefficients of u_r by P_n and of u_theta by D_n, from those of the traction; 2 G = 1 - nu."""
    nu, n = poisson, 2.0 * np.arange(1, len(normal))[:, None]
    a, b = (n + 1) * (n**2 - n - 2 - 2 * nu), n * (n - 1)
    c, d = n**2 + 2 * n - 1 + 2 * nu, n - 1
    A = (d * normal[1:] - b * shear[1:]) / (a * d - b * c)
    B = (a * shear[1:] - c * normal[1:]) / (a * d - b * c)
    uniform = normal[:1] * (1 - 2 * nu) / (1 + nu)  # n = 0: hydrostatic
    radial = np.concatenate([uniform, A * (n + 1) * (n - 2 + 4 * nu) + B * n])
    polar = np.concatenate([0 * uniform, A * (n + 5 - 4 * nu) + B])
    return radial / (1 - nu), polar / (1 - nu)


# Its surface in cells, in each of which a pressure is a polynomial by Gauss's nodes


def coefficients(lines: Array, nodes: int, R: float, harmonics: int) -> Array:
    """Integrals by dx = d cos(theta) of the nodes' polynomials by the even P_n on a sphere of radius R.

    The lines (m + 1,), from 0, are the cells' ends in beta. One more than asked for, (harmonics + 1, q). Each cell has
    Gauss's points enough for the last.
    """
    ends = np.arcsin(np.minimum(lines / R, 1.0))
    rules = [_gauss(a, b, nodes, harmonics) for a, b in pairwise(ends)]
    theta = np.concatenate([points for points, _ in rules])
    parts = [
        (np.sin(points) * weights)[:, None] * grid.polynomial(places, R * np.sin(points))
        for (points, weights), places in zip(rules, grid.gauss_points(lines, nodes)[0], strict=True)
    ]
    cuts = np.cumsum([len(points) for points, _ in rules])[:-1]
    rows, found = _even(np.cos(theta)), []
    for first in range(0, harmonics + 1, 256):
        block = np.array([P for P, _ in islice(rows, min(256, harmonics + 1 - first))])
        of_cells = np.split(block, cuts, axis=1)
        found.append(np.hstack([values @ part for values, part in zip(of_cells, parts, strict=True)]))
    return np.concatenate(found)


def _gauss(a: float, b: float, nodes: int, harmonics: int) -> tuple[Array, Array]:
    """Gauss's points and weights from a to b, for polynomials of so many nodes times the harmonics."""
    pieces = 1 + int(harmonics * (b - a) / 30.0)  # the phase of the last harmonic over a rule is 60 rad at most
    count = nodes + 8 + math.ceil(harmonics * (b - a) / pieces)
    points, weights = grid.gauss_points(np.linspace(a, b, pieces + 1), count)
    return points.ravel(), weights.ravel()


def sphere_compliance(
    R: float, poisson: float, lines: Array, nodes: int, harmonics: int, radii: Array | None = None
) -> Array:
    """Compliance of a sphere, E* = 1: deflections at some radii by pressures on the projected area at the nodes.

    The sphere has a radius R in beta and so many even n; the cells between the lines, with so many nodes each, are of
    its surface, or of another sphere's under which it lies. Radii (k,) are those of the nodes unless given.
    """
    sine = (grid.gauss_points(lines, nodes)[0].ravel() if radii is None else radii) / R
    x = np.sqrt((1 - sine) * (1 + sine))
    radial, polar = _displacements(poisson, *_traction(coefficients(lines, nodes, R, harmonics)))
    P, D = legendre(len(radial), x)
    return np.asarray(R * ((D * sine).T @ polar - (P * x).T @ radial))  # -u_z = -u_r cos(theta) + u_theta sin(theta)


# The solver

MOST = 5000  # most harmonics on the first rung above the lowest


@dataclass(frozen=True)
class Fineness:
    """How finely the sphere is discretised.

    So many nodes in each cell; harmonics in R over the width of the spike of tension at the contact edge; the length of
    the cells there in widths of the spike, and the ratio of neighbours.
    """

    nodes: int
    harmonics: float
    finest: float = 0.4
    growth: float = 2.0


def trace(scene: Scene, *, rtol: float = 1e-6, to_load: float = COMPRESSION) -> EquilibriumPath:
    """Trace the load-approach curve of a sphere in the sliding grip and solve for its events by spherical harmonics.

    Parameters
    ----------
    scene : Scene
        One that is ``checked_by`` harmonics, with a counter-body or without.
    rtol, to_load : float
        As in `halfspace.trace`.

    Raises
    ------
    InputError
        If an input is out of range, the harmonics do not know a body, or it takes too many of them.
    halfspace.errors.NotConverged
        If the curve cannot be traced.
    """
    rtol, to_load = require_rtol(rtol), require_load(to_load)
    require_few(scene, rtol)

    def rung(level: int) -> Rung:
        above, below = (resolution_for(rtol, max(n, 0)) for n in (level, level - 1))
        twin = Fineness(below.nodes, below.harmonics, above.finest * GRIDS.twin[0], above.growth * GRIDS.twin[1])
        curve = sized_body(scene, Fineness(above.nodes, 10.0), to_load)
        body, other = (sized_body(scene, how, to_load) for how in (above, twin))
        settings = {"nodes": above.nodes, "harmonics": counts(scene, above)}
        own, others = standing(body, left_between(above.nodes)), standing(other, left_between(below.nodes))
        rule = ErrorRule(steps=scene.scales.steps)
        return Rung(curve.curve, (own,), settings, others if level else None, rule=rule)

    return climb(rtol, rung, to_load=to_load, most_rungs=2)


def resolution_for(rtol: float, level: int) -> Fineness:
    """Fineness of a level, whose events are right to about `rtol` at level 0 and a decade better at each above it."""
    digits = -math.log10(rtol)
    nodes = min(math.ceil(3 + digits - 1e-9) + 2 * level, 16)
    return Fineness(nodes, 2.5 * digits + 6.0 * level)


def counts(scene: Scene, how: Fineness) -> list[int]:
    """Harmonics of each sphere."""
    return [math.ceil(how.harmonics * R / scene.scales.spike_width) for R in scene.radii if math.isfinite(R)]


def require_few(scene: Scene, rtol: float) -> None:
    """Refuse a scene that is not ``checked_by`` harmonics, or takes too many; raise InputError."""
    if scene.checked_by != "harmonics":
        raise InputError(
            f"scene = {', '.join(scene.words)} is not known to harmonics, limit: linear hemispheres that slide, no "
            "pointed tip, all tractions per projected area; take fem_adhesion.trace"
        )
    most = max(counts(scene, resolution_for(rtol, 1)))
    if most > MOST:
        raise InputError(
            f"radius_ratio = {scene.radius_ratio:g} at tabor {scene.tabor:g} takes {most} harmonics of the sphere, "
            f"limit {MOST}; take a smaller one, a smaller tabor or a larger rtol"
        )


RIM = 1.7 / (1 + 1.7**2 / 4)  # part of the smaller sphere's radius beyond which both bodies of a pair are rigid
CROWDED = 0.3 ** np.arange(5)  # cells crowd to the equator, where a sphere's profile has a vertical tangent


def sized_body(scene: Scene, how: Fineness, to_load: float = COMPRESSION) -> SizedBody:
    """Body of a scene, to be discretised on any cells of its surface."""
    outer = scene.radii[0] * np.append(1 - (1 - (RIM if scene.counter else 0.98)) * CROWDED, 1.0)
    make = partial(_made, scene, how.nodes, counts(scene, how))
    return SizedBody(scene.scales, make, how.finest, how.growth, outer, FLAT, to_load=to_load)


def _made(scene: Scene, nodes: int, harmonics: list[int], lines: Array) -> Made:
    """Sphere, or two bodies whose compliances add."""
    (R, *others), counter = scene.radii, scene.counter
    radii, lengths = grid.gauss_points(lines, nodes)
    found = sphere_compliance(R, scene.poisson, lines, nodes, harmonics[0])
    if counter:
        if math.isinf(others[0]):
            other = compliance.panels(lines, nodes).compliance
        else:
            other = sphere_compliance(others[0], counter.material.poisson, lines, nodes, harmonics[1])
        yields = radii.ravel() < RIM * R
        part, rest = scene.shares
        found = (part * found + rest * other) * np.outer(yields, yields)
    return collocated(radii, lengths, found, lines), radii.size
