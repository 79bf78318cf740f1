"""Make the finite sphere's part of the atlas, or check it: ``python -m fem_adhesion.finite_sphere.atlas``, 25 minutes.

Polynomials of `halfspace.atlas.sphere` through events that `fem_adhesion.trace` solves for: on the edges of the domain,
and at points spread evenly in the arc cosine of each place (an additive recurrence of the root of g^4 = g + 1). There
are more terms than points: a coefficient is expected to fall with its degrees, and the fit is the likeliest one, that
is ridge regression. What it is off is told by how far each point that is not on an edge is from the fit of all others.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from itertools import product
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebpts1, chebvander

from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.common.facts import code_digest
from fem_adhesion.convergence import trace
from fem_adhesion.finite_sphere.cases import CRITICAL, MODELS, TO_LOAD, case_of
from fem_adhesion.scene import Scene
from halfspace.atlas import build, sphere
from halfspace.limits import SMALLEST_SPHERE
from halfspace.values import Array, Estimate


@dataclass(frozen=True)
class AtlasSettings:
    """Pieces of the atlas of spheres, and how closely it is fitted."""

    rtol: float = 1e-5  # of all events
    births: tuple[int, int] = (10, 8)  # nodes of the birth of folds in (R/eps)^(-1/4) and Poisson's ratio
    noise: float = 1e-6  # of what is fitted, as it is expected, beside a third of the error that `trace` states
    check_points: int = 8  # drawn, at which what is built is compared with `trace`


HOW = AtlasSettings()

POINTS = {"past": (190, 190, 150), "below": (60, 50, 40)}  # on each piece of R/eps, past the birth of folds and below
EDGES = ((5.0, 7.0, 10.0, 15.0, 22.5, 50.0, 150.0, 1e3, 1e5), (0.0, 0.245, 0.49))
"""R/eps and Poisson's ratios of points on edges."""

JUMPS = ((0.2, 0.4, 0.2), (0.2, 0.4, 0.1))
FALL = {"pull_off": ((0.3, 0.5, 0.3), (0.2, 0.4, 0.1)), "jump_on": JUMPS, "jump_off": JUMPS}
"""Fall that is expected of a coefficient of A and B by each degree in ln(R/eps), tabor and Poisson's ratio."""

GOLDEN = 1.2207440846057596  # root of g^4 = g + 1

Point = tuple[float, ...]
Node = Callable[[Point], Mapping[str, Estimate]]


def solved(point: Point) -> dict[str, Estimate]:
    """Events at a Tabor parameter, R/eps and Poisson's ratio, or the birth of folds at the last two."""
    if len(point) == 2:
        return dict(MODELS["first_jump"].solve(case_of("first_jump", None, *point, HOW.rtol)))
    tabor, ratio, poisson = point
    path = trace(Scene(tabor, Hemisphere(radius_ratio=ratio, poisson=poisson)), rtol=HOW.rtol, to_load=TO_LOAD)
    every = product((name for name in sphere.DEGREES if name in path.events), sphere.NUMBERS)
    return {f"{name}.{number}": path.events[name].estimate(number) for name, number in every}


def births(node: Node) -> tuple[Array, float]:
    """Coefficients of the logarithm of the birth of folds, and the relative error: the nodes' and the series' tail."""
    x, z = (chebpts1(count) for count in HOW.births)
    low, high = sphere.RATIOS[-1] ** -0.25, sphere.RATIOS[0] ** -0.25
    ratios = ((low + high) / 2 + (high - low) / 2 * x) ** -4
    found = [[node((ratio, nu))[CRITICAL] for nu in poissons(z).tolist()] for ratio in ratios.tolist()]
    rows = build.fitted(np.log([[birth.value for birth in row] for row in found]))
    coefficients = build.fitted(rows.T).T
    tail = np.abs(coefficients[-1]).sum() + np.abs(coefficients[:, -1]).sum()
    return coefficients, float(tail + max(birth.error / birth.value for row in found for birth in row))


def poissons(places: Array) -> Array:
    """Poisson's ratios at places from -1 to 1."""
    return (1 + places) / 2 * (sphere.POISSON[1] - sphere.POISSON[0]) + sphere.POISSON[0]


def spread(kind: str, piece: int, coefficients: Array) -> Iterator[Point]:
    """Points on a piece of R/eps, past the birth of folds or below it."""
    numbers = np.arange(1, POINTS[kind][piece] + 1)[:, None]
    x, y, z = -np.cos(np.pi * ((0.5 + numbers * GOLDEN ** -np.arange(1.0, 4)) % 1)).T
    low, high = np.log(sphere.RATIOS[piece : piece + 2])
    ratio, nu = np.exp((low + high) / 2 + (high - low) / 2 * x), poissons(z)
    birth, share = sphere.born(ratio, nu, coefficients), (1 + y) / 2
    most = np.minimum(sphere.TABORS[1], ratio / SMALLEST_SPHERE * (1 - 1e-12))
    if kind == "past":
        tabor = birth * np.exp(share**2 * np.log(most / birth))
    else:
        tabor = sphere.TABORS[0] * np.exp(share * np.log(birth / sphere.TABORS[0]))
    yield from zip(tabor.tolist(), ratio.tolist(), nu.tolist(), strict=True)


def edges(coefficients: Array) -> Iterator[Point]:
    """Points on the edges of the domain and between its pieces."""
    for ratio, nu in product(*EDGES):
        birth = float(sphere.born(np.array(ratio), np.array(nu), coefficients))
        most = min(sphere.TABORS[1], ratio / SMALLEST_SPHERE * (1 - 1e-12))
        least, past = sphere.TABORS[0], birth * (1 + sphere.PAST)
        for tabor in (least, (least * birth) ** 0.5, past, (birth * most) ** 0.5, 0.8 * most, 0.9 * most, most):
            yield tabor, ratio, nu


def built(node: Node, digest: str) -> dict[str, Any]:
    """Content of the file, from the events at its points; others check it, see `compared`."""
    coefficients, birth_error = births(node)
    on_edges = {point: node(point) for point in edges(coefficients)}
    inside = {
        point: node(point) for kind in POINTS for piece in range(3) for point in spread(kind, piece, coefficients)
    }
    series: dict[str, Any] = {}
    for name, number, piece in product(sphere.DEGREES, sphere.NUMBERS, range(3)):
        known = [
            (np.array(point), found[f"{name}.{number}"], point in inside)
            for point, found in (inside | on_edges).items()
            if f"{name}.{number}" in found
        ]
        entry = series.setdefault(f"{name}.{number}", {"errors": [], "A": [], "B": []})
        for key, value in fitted(name, number, piece, known, coefficients).items():
            entry[key].append(value)
    return {
        "source": {
            "command": "make atlas",
            "what": f"fem_adhesion.trace(Scene(tabor, Hemisphere(radius_ratio, poisson)), rtol={HOW.rtol:g}), 3-9 law",
            "version": version("fem-adhesion"),
            "digest": digest,
        },
        "birth": {"error": float(f"{birth_error:.3g}"), "coefficients": np.round(coefficients, 10).tolist()},
        "series": series,
    }


def fitted(
    name: str, number: str, piece: int, known: Sequence[tuple[Array, Estimate, bool]], births: Array
) -> dict[str, Any]:
    """Coefficients of A and B of a number on one piece, and the error: the points' own and what is left out."""
    low, high = sphere.FITTED[piece]
    here = [row for row in known if low <= row[0][1] <= high]
    tabor, ratio, nu = np.array([point for point, _, _ in here]).T
    birth = sphere.born(ratio, nu, births)
    of, (x, z) = sphere.like(name, tabor, birth), sphere.across(piece, ratio, nu)
    places = x, sphere.place(name, tabor, ratio, birth), z
    values, errors = np.array([(solution.value, solution.error) for _, solution, _ in here]).T
    scale = of.load if number == "load" else 1 + tabor
    b, own = (values - getattr(of, number)) / scale, errors / np.abs(scale)
    blocks, expected = [], []
    for size, degrees, fall in zip(sphere.sizes(tabor, ratio), sphere.DEGREES[name], FALL[name], strict=True):
        terms = sphere.terms(degrees)
        products = [chebvander(place, most)[:, i] for place, most, i in zip(places, degrees, terms, strict=True)]
        expected.append(np.prod(np.array(fall)[:, None] ** terms, axis=0))
        blocks.append(size[:, None] * np.prod(products, axis=0) * expected[-1])
    noise = np.sqrt(HOW.noise**2 + (own / 3) ** 2)
    U, s, V = np.linalg.svd(np.hstack(blocks) / noise[:, None])
    parts, s = U.T @ (b / noise), np.pad(s, (0, len(b)))[: len(b)]
    apart = noise * np.abs(U @ (parts / (1 + s**2))) / (U**2 @ (1 / (1 + s**2)))
    count = min(U.shape[0], V.shape[0])
    found = np.concatenate(expected) * (V[:count].T @ (s / (1 + s**2) * parts)[:count])
    judged = np.array([inside for _, _, inside in here])
    judged &= (sphere.RATIOS[piece] <= ratio) & (ratio <= sphere.RATIOS[piece + 1])
    A, B = np.split(np.round(found, 8), [blocks[0].shape[1]])
    return {"errors": float(f"{own.max() + apart[judged].max():.2g}"), "A": A.tolist(), "B": B.tolist()}


def sample(count: int, seed: int) -> list[Point]:
    """Random inputs within the atlas, a quarter of them close past the birth of folds."""
    random, (least, most) = np.random.default_rng(seed), sphere.TABORS
    ratio = np.exp(random.uniform(np.log(sphere.RATIOS[0]), np.log(sphere.RATIOS[-1]), count))
    nu = random.uniform(*sphere.POISSON, count)
    spread = random.uniform(np.log(least), np.log(np.minimum(most, ratio / SMALLEST_SPHERE)))
    close = sphere.birth_of_folds(ratio, nu)[0] * (1 + 10 ** random.uniform(math.log10(sphere.PAST), -1, count))
    tabor = np.where(np.arange(count) < count // 4, close, np.exp(spread))
    return list(zip(tabor.tolist(), ratio.tolist(), nu.tolist(), strict=True))


def compared(point: Point, numbers: Mapping[str, Estimate]) -> Iterator[dict[str, Any]]:
    """What the source says of inputs, and how far the atlas is off: by the half-space's load or 1 + tabor, in errors.

    Where the half-space has no such load it is by the sphere's own.
    """
    jumps = point[0] >= (1 + sphere.PAST) * sphere.birth_of_folds(*point[1:])[0]
    for name in sphere.DEGREES if jumps else ("pull_off",):
        event = getattr(sphere, name)(*point)
        of_half_space = abs(event.load / event.load_ratio)
        for number, scale in (("load", of_half_space), ("approach", 1 + point[0])):
            reference = numbers[f"{name}.{number}"]
            off = float(getattr(event, number)) - reference.value
            by = float(scale if math.isfinite(scale) else abs(event.load))
            yield {
                "point": point,
                "number": f"{name}.{number}",
                "reference": reference.value,
                "relative": abs(off) / by,
                "of_errors": abs(off) / (float(getattr(event, f"{number}_error")) + reference.error),
            }


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the file, or check it at random inputs; 1 if a number is off by more than both errors."""
    parser = argparse.ArgumentParser(prog="python -m fem_adhesion.finite_sphere.atlas", description=__doc__)
    parser.add_argument("--nodes", type=Path, default=Path("build/atlas"), help="directory of the points solved so far")
    parser.add_argument("--check", type=int, metavar="N", help="compare the file with the source at N inputs")
    parser.add_argument("--seed", type=int, default=1, help="of the inputs of --check")
    given = parser.parse_args(arguments)
    digest = code_digest("fem_adhesion.convergence")
    directory = given.nodes / digest
    directory.mkdir(parents=True, exist_ok=True)
    node = build.Store(directory / "sphere.jsonl", solved, lambda pair: Estimate(*pair))
    if given.check:
        return _report(_deviations(node, given.check, given.seed))
    content = built(node, digest)
    _write(content)
    _write(content | {"check_points": list(_deviations(node, HOW.check_points, 0))})  # from the file that there is now
    print(f"\n{sphere.FILE}: {sphere.FILE.stat().st_size / 1000:.0f} kB")
    return 0


def _write(content: Mapping[str, Any]) -> None:
    text = json.dumps(content, separators=(",", ":")).replace('],"', '],\n"')
    sphere.FILE.write_text(text + "\n", encoding="utf-8")


def _deviations(node: Node, count: int, seed: int) -> Iterator[dict[str, Any]]:
    for point in sample(count, seed):
        yield from compared(point, node(point))


def _report(points: Iterator[dict[str, Any]]) -> int:
    """Print by number the largest deviation from the source, and where."""
    by_number: dict[str, list[dict[str, Any]]] = {}
    for point in points:
        by_number.setdefault(point["number"], []).append(point)
    print(f"\n{'number':20}{'inputs':>8}{'relative':>10}{'of errors':>11}   tabor, R/eps, poisson of the largest")
    for number, own in by_number.items():
        off, share = (max(own, key=itemgetter(key)) for key in ("relative", "of_errors"))
        where = ", ".join(f"{value:.4g}" for value in off["point"])
        print(f"{number:20}{len(own):8}{off['relative']:10.1e}{share['of_errors']:11.2f}   {where}")
    return int(max(point["of_errors"] for own in by_number.values() for point in own) > 1)


if __name__ == "__main__":
    raise SystemExit(main())
