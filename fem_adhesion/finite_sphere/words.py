"""What is said of the study of the finite sphere: each sentence is found by a test on the results, or is not said."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from fem_adhesion.common.numbers import plus_minus
from fem_adhesion.finite_sphere.chart import LEVELS, contour, field_of
from fem_adhesion.finite_sphere.fit import Samples, samples
from fem_adhesion.finite_sphere.points import (
    by_poisson,
    jumping_tabors,
    panel_tabors,
    points_by_poisson,
    reference_poisson,
)
from fem_adhesion.finite_sphere.records import Record, Study
from fem_adhesion.finite_sphere.table import Border, Results, Row

PARTS = ("profile", "body")
"""Causes of which the whole deviation is made; the others change what is held fixed in it."""


def headline(study: Study) -> str:
    """How the study went, in one line."""
    tried = [record for record in study.records if record.status != "left out"]
    ended = f"{len(study.failed)} of {_count(len(tried), 'case')} not solved ({kinds(study.failed)})"
    parts = [
        "quick study, of few points" if study.quick else "",
        ended if study.failed else f"{_count(len(tried), 'case')}, all solved" if tried else "no case",
        f"{_count(len(study.left_out), 'case')} left out, beyond the limits" if study.left_out else "",
    ]
    return "; ".join(filter(None, parts))


def kinds(records: Sequence[Record]) -> str:
    """How many records ended how."""
    return ", ".join(f"{count} {kind}" for kind, count in Counter(r.kind or r.status for r in records).items())


def caption(stem: str, results: Results) -> str:
    """What to see in a figure."""
    return " ".join(CAPTIONS[stem](results))


def _chart(results: Results) -> Iterator[str]:
    poisson = reference_poisson(results.rows)
    fields = [field_of(results.rows, quantity, poisson) for quantity in ("pull_off_load", "jump_on_approach")]
    if any(np.isfinite(contour(field, level)).any() for field in fields for level in LEVELS):
        yield (
            "A line is where the half-space under a paraboloid errs by as much as it says, between the points solved; "
            "at the points above it, it errs by less."
        )
    else:
        yield f"No deviation passes {', '.join(f'{100 * level:g}' for level in LEVELS)} % between the points solved."
    yield from _borders([border for border in results.borders if border.poisson in (None, poisson)])
    if any(set(field.ending.flat) - {"solved", "absent", ""} for field in fields):
        yield "Hatched: nearest to points that were not solved."
    yield (
        "Materials are typical, and placed by their own values, whatever their Poisson's ratio; sizes are radii, of "
        "the tips at the left edge."
    )


def _borders(borders: Sequence[Border]) -> Iterator[str]:
    """Where the jumps begin, on the smallest sphere, the largest, and the half-space."""
    spheres = [(b.radius_ratio, b.tabor) for b in borders if b.tabor and b.radius_ratio]
    flat = [b.tabor for b in borders if b.tabor and b.radius_ratio is None]
    ends = dict(sorted(spheres, key=lambda pair: pair[0]))
    shown = [f"{plus_minus(ends[ratio])} at R/eps = {ratio:g}" for ratio in dict.fromkeys([*ends][:1] + [*ends][-1:])]
    shown += [f"{plus_minus(tabor)} on the half-space" for tabor in flat]
    if shown:
        yield f"Jumps under fixed grips begin at mu = {', '.join(shown)}."


def _causes(results: Results) -> Iterator[str]:
    rows, poisson = results.rows, reference_poisson(results.rows)
    yield "Filled markers: the force is weakened; hollow: strengthened; only what exceeds its error has one."
    for tabor in panel_tabors(rows):
        found = {cause: _of(rows, cause, tabor, poisson) for cause in PARTS}
        yield from _largest(found, tabor)
    yield from _exponents(rows, poisson)
    yield from _changes(rows, poisson)
    yield from _given_back(rows, poisson)


def _of(rows: Sequence[Row], cause: str, tabor: float, poisson: float | None) -> Samples:
    data = samples(rows, cause, "pull_off_load", None if cause == "profile" else poisson).significant
    return data.where(data.tabor == tabor)


def _largest(found: Mapping[str, Samples], tabor: float) -> Iterator[str]:
    """Which part is the larger on the smallest and on the largest sphere on which profile and body are both known."""
    both = np.intersect1d(found["profile"].radius_ratio, found["body"].radius_ratio)
    ends = []
    for ratio in dict.fromkeys(float(value) for value in both[[0, -1]]) if both.size else ():
        sizes = {cause: _size_at(data, ratio) for cause, data in found.items()}
        known = {cause: size for cause, size in sizes.items() if np.isfinite(size)}
        most = max(known, key=lambda cause: known[cause])
        ends.append(f"the {most}'s at R/eps = {ratio:g} ({100 * known[most]:.2g} %)")
    if ends:
        yield f"At mu = {tabor:g} the larger part is {', and '.join(ends)}."


def _size_at(data: Samples, ratio: float) -> float:
    size = np.abs(data.deviation[data.radius_ratio == ratio])
    return float(size[0]) if size.size else float("nan")


def _exponents(rows: Sequence[Row], poisson: float | None) -> Iterator[str]:
    """Powers of beta/R in which profile and body go between the two largest spheres, of the middle panel."""
    for tabor in panel_tabors(rows)[1:2]:
        found = {cause: _of(rows, cause, tabor, poisson) for cause in ("profile", "body")}
        powers = [f"the {cause}'s as (beta/R)^{_power(data):.2g}" for cause, data in found.items() if _two(data)]
        if powers:
            yield f"Between the two largest R/eps at mu = {tabor:g} the parts go: {', '.join(powers)}."


def _two(data: Samples) -> bool:
    return bool(data.stretch.size > 1)


def _power(data: Samples) -> float:
    order = np.argsort(data.stretch)[:2]
    x, y = np.log(data.stretch[order]), np.log(np.abs(data.deviation[order]))
    return float((y[1] - y[0]) / (x[1] - x[0]))


def _changes(rows: Sequence[Row], poisson: float | None) -> Iterator[str]:
    """What grip and strain change beside the whole."""
    whole = samples(rows, "all", "pull_off_load", poisson)
    for cause, name in (("grip", "The grip"), ("strain", "Finite strain")):
        shares = np.abs(_ratios(samples(rows, cause, "pull_off_load", poisson), whole))
        if shares.size:
            yield f"{name} changes the force by {_span(100 * shares)} % of the whole deviation{_at(shares.size)}."
    others = [_ratios(samples(rows, cause, "pull_off_load", poisson), whole) for cause in ("reference", "normal")]
    spread = np.abs(np.concatenate(others))
    if spread.size:
        yield (
            f"What its traction is counted per, a model uncertainty, leaves {_span(100 * spread)} % of it "
            f"open{_at(spread.size)}."
        )


def _given_back(rows: Sequence[Row], poisson: float | None) -> Iterator[str]:
    """Whether the law per true area undoes what the profile does."""
    shares = _ratios(
        samples(rows, "traction", "pull_off_load", poisson), samples(rows, "profile", "pull_off_load", None)
    )
    if not shares.size:
        return
    if np.all(shares < 0):
        yield f"The law per true area gives back {_span(-100 * shares)} % of what the profile takes{_at(shares.size)}."
    elif np.all(shares > 0):
        yield f"The law per true area adds {_span(100 * shares)} % to what the profile does{_at(shares.size)}."
    else:
        yield f"The law per true area works against the profile at {np.sum(shares < 0)} of {shares.size} points."


def _ratios(part: Samples, whole: Samples) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """A deviation over another, where both exceed their errors."""
    part, whole = part.significant, whole.significant
    sizes = dict(zip(zip(whole.tabor, whole.radius_ratio, strict=True), whole.deviation, strict=True))
    points = zip(part.tabor, part.radius_ratio, part.deviation, strict=True)
    return np.array([value / sizes[mu, rho] for mu, rho, value in points if (mu, rho) in sizes], float)


APPROACHES = (
    "Deviations of approaches, which have no natural zero, are parts of the spacing and the range of the approaches at "
    "all events on the half-space."
)


def _poisson(results: Results) -> Iterator[str]:
    yield "Hollow markers: the force is strengthened, or the jump is from nearer."
    yield from _trend(results.rows)
    yield from _signs(results.rows)


def _trend(rows: Sequence[Row]) -> Iterator[str]:
    """Which way the size of the pull-off's deviation goes from the least to the largest Poisson's ratio."""
    ends = []
    for mu, rho in points_by_poisson(rows):
        nu, deviation = by_poisson(rows, "pull_off_load", mu, rho)
        ends.append((float(nu[0]), float(nu[-1]), *np.abs(deviation[[0, -1]])))
    falling = sum(last < first for _, _, first, last in ends)
    if ends:
        least, most = min(end[0] for end in ends), max(end[1] for end in ends)
        yield (
            f"From Poisson's ratio {least:g} to {most:g} the size of the pull-off's deviation falls at {falling} of "
            f"{_count(len(ends), 'point')}."
        )


def _signs(rows: Sequence[Row]) -> Iterator[str]:
    """Where the deviation of the jump-on changes its sign with Poisson's ratio."""
    found = [by_poisson(rows, "jump_on_approach", mu, rho)[1] for mu, rho in points_by_poisson(rows)]
    known = [deviation for deviation in found if deviation.size > 1]
    changing = sum(bool(deviation.min() < 0 < deviation.max()) for deviation in known)
    if known:
        yield f"That of the approach at jump-on changes its sign at {changing} of {_count(len(known), 'point')}."


def _bulk(results: Results) -> Iterator[str]:
    rows, poisson = results.rows, reference_poisson(results.rows)
    yield (
        "The yield of the body as a whole is kappa W/(E* R), which can be taken out by hand. Filled markers: from "
        "farther away than on the half-space; hollow: from nearer. Where a line has no marker, the deviation is within "
        f"its error. {APPROACHES}"
    )
    shares = np.concatenate([_left(rows, f"jump_{way}_approach", poisson) for way in ("on", "off")])
    if not jumping_tabors(rows) or not shares.size:
        return
    most = int(np.sum(shares < 0.5))
    yield (
        f"Without it {_span(100 * shares)} % of the deviation is left{_at(shares.size)}: the yield is most of it at "
        f"{most if most < shares.size else 'all'} of them."
    )


def _left(rows: Sequence[Row], quantity: str, poisson: float | None) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Part of an approach's deviation, at most, that is left without the yield, where the whole exceeds its error."""
    whole, rest = (samples(rows, "all", quantity + suffix, poisson) for suffix in ("", "_less_bulk"))
    whole = whole.significant
    sizes = dict(zip(zip(whole.tabor, whole.radius_ratio, strict=True), np.abs(whole.deviation), strict=True))
    points = zip(rest.tabor, rest.radius_ratio, np.abs(rest.deviation) + rest.error, strict=True)
    return np.array([size / sizes[mu, rho] for mu, rho, size in points if (mu, rho) in sizes], float)


def _span(values: Sequence[float] | np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    """Least and largest of some numbers, to two digits or to the last before the point."""
    ends = (float(np.min(values)), float(np.max(values)))
    return " to ".join(dict.fromkeys(f"{end:.2g}" if abs(end) < 99.5 else f"{end:.0f}" for end in ends))


def _at(count: int) -> str:
    return f" ({_count(count, 'point')})"


def _count(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


CAPTIONS: Mapping[str, Callable[[Results], Iterator[str]]] = {
    "chart": _chart,
    "causes": _causes,
    "poisson": _poisson,
    "bulk": _bulk,
}
