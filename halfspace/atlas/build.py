"""How the atlas is made: Chebyshev series through events that `halfspace.trace` solves for at their nodes."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from halfspace.accuracy.trace import trace
from halfspace.atlas.series import EDGE, LEAST, MOST, Series, series_of
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import approach_scale
from halfspace.roots import root
from halfspace.values import Array, Estimate


@dataclass(frozen=True)
class BuildSettings:
    """Pieces of the numbers of events, and their nodes."""

    rtol: float = 1e-9  # of all events
    nodes: int = 24  # of a piece
    whole: tuple[float, ...] = (LEAST, 0.1, 0.5, 2.0, 10.0, 60.0, MOST)  # ends of pieces of what all curves have
    folded: tuple[float, ...] = (0.35, 1.0, 1.6, 2.1)  # ends between the pieces of jumps, in sqrt(ln(tabor/birth))
    near_birth: tuple[float, float] = (0.6975, 0.8)  # Tabor parameters from which the birth of folds is found
    birth_nodes: int = 12  # of the birth of folds, in ln(tabor)
    next_birth: float = 3.974  # Tabor parameter from which curves have four folds, near which more is checked
    check_points: int = 8  # drawn, at which what is built is compared with `halfspace.trace`


BUILD = BuildSettings()


EVENTS = ("pull_off", "zero_load")
OF_JUMPS = (
    *("take_off.approach", "take_off.load", "take_off.central_gap"),
    *("landing.load", "landing.central_gap", "energy"),
)
IN_CONTACT = {"jump_on": "landing", "jump_off": "take_off"}  # the end of each jump that has a contact radius

UNBORN = Estimate(1.0, 0.0)  # stands for the birth of a number that all curves have

Numbers = Mapping[str, Estimate]
Node = Callable[[float], Numbers]
Key = TypeVar("Key")
T = TypeVar("T")
Entry = dict[str, Any]


def solved(tabor: float) -> dict[str, Estimate]:
    """All numbers of a Tabor parameter by `halfspace.trace`, by their names in the atlas; those there are."""
    path = trace(tabor, rtol=BUILD.rtol)
    states = {name: path.events[name] for name in EVENTS}
    found = {"energy_released": path.energy}
    if jumps := cycle(path):
        for name, jump in (("jump_on", jumps.jump_on), ("jump_off", jumps.jump_off)):
            states |= {f"{name}.take_off": jump.take_off, f"{name}.landing": jump.landing}
            found[f"{name}.energy"] = jump.energy
    found |= {
        f"{name}.{quantity}": state.estimate(quantity) for name, state in states.items() for quantity in OBSERVABLES
    }
    return {name: number for name, number in found.items() if not math.isnan(number.value)}


class Store(Generic[Key, T]):
    """What was solved for at some Tabor parameters, one line each in a file, so that an interrupted build goes on.

    `solve` gives what is stored by name; `read` makes it of the numbers in the file. Progress is shown.
    """

    def __init__(self, file: Path, solve: Callable[[Key], dict[str, T]], read: Callable[[Any], T]) -> None:
        self.file, self.solve, self.known = file, solve, dict[Key, dict[str, T]]()
        for line in file.read_text().splitlines() if file.exists() else ():
            at, found = json.loads(line)
            key: Any = tuple(at) if isinstance(at, list) else at
            self.known[key] = {name: read(numbers) for name, numbers in found.items()}

    def __call__(self, key: Key) -> dict[str, T]:
        """What there is at a Tabor parameter, solved for unless it is known."""
        if key not in self.known:
            self.known[key] = self.solve(key)
            with self.file.open("a") as lines:
                lines.write(json.dumps([key, self.known[key]], default=_plain) + "\n")
            last = np.ravel(np.array(key))[0]
            print(f"\r{self.file.stem}: {len(self.known)}, the last at tabor {last:.4g}   ", end="", flush=True)
        return self.known[key]


def _plain(value: Any) -> Any:
    """Numbers of an estimate or an array."""
    return value.tolist() if isinstance(value, np.ndarray) else [value.value, value.error]


def digest() -> str:
    """Digest, 16 hexadecimal digits, of the code of `halfspace` and of the libraries that computed the numbers."""
    package = Path(__file__).parents[1]
    found = hashlib.sha256("".join(f"{name} {version(name)}\n" for name in ("numpy", "scipy")).encode())
    for file in sorted(package.rglob("*.py")):
        if file.parent != Path(__file__).parent:
            found.update(f"{file.relative_to(package)}\n".encode() + file.read_bytes())
    return found.hexdigest()[:16]


def built(node: Node, digest: str) -> Entry:
    """Content of the file of series, from the numbers at its nodes; Tabor parameters that are no nodes check it."""
    birth = birth_of_folds(node)
    of_all = [f"{event}.{quantity}" for event in EVENTS for quantity in OBSERVABLES]
    of_all.remove("zero_load.load")
    found = {name: whole(node, name) for name in ("energy_released", *of_all)}
    for jump, end in IN_CONTACT.items():
        found |= {f"{jump}.{number}": folded(node, jump, number, birth) for number in OF_JUMPS}
        name = f"{jump}.{end}.contact_radius"
        found[name] = radius(node, name, birth, series_of(found[f"{jump}.{end}.central_gap"]))
    at = sample(BUILD.check_points, 0, birth.value).tolist()
    return {
        "source": {
            "command": "make atlas",
            "what": f"halfspace.trace(tabor, rtol={BUILD.rtol:g}), paraboloid on a half-space, 3-9 law",
            "version": version("fem-adhesion"),
            "digest": digest,
        },
        "tabor": [LEAST, MOST],
        "birth": [birth.value, birth.error],
        "series": found,
        "check_points": [point for tabor in at for point in compared(found, node(tabor), tabor)],
    }


def sample(count: int, seed: int, birth: float) -> Array:
    """Random Tabor parameters: a quarter of them close above the birth of folds, or about that of the next pair.

    The rest are spread evenly in the logarithm.
    """
    random = np.random.default_rng(seed)
    close = count // 8
    near = birth + 10 ** random.uniform(-5, -1, close), BUILD.next_birth + random.uniform(-0.1, 0.1, close)
    spread = np.exp(random.uniform(np.log(LEAST), np.log(MOST), count - 2 * close))
    return np.concatenate([*near, spread])


def birth_of_folds(node: Node) -> Estimate:
    """Tabor parameter at which both folds are born.

    There the difference of their loads vanishes as the root of the distance: its square is smooth and changes sign.
    """
    low, high = np.log(BUILD.near_birth).tolist()

    def born(nodes: int) -> Estimate:
        places = (low + high) / 2 + (high - low) / 2 * chebyshev.chebpts1(nodes)
        numbers = [node(tabor) for tabor in np.exp(places).tolist()]
        apart = [at["jump_on.take_off.load"] - at["jump_off.take_off.load"] for at in numbers]
        squares = chebyshev.Chebyshev(fitted([(one * one).value for one in apart]), domain=[low, high])
        x = root(squares, low - (high - low) / 5, low, "the birth of folds; take more nodes", xtol=1e-15)
        return Estimate(math.exp(x), (apart[0] * apart[0]).error / float(squares.deriv()(x)) * math.exp(x))

    fine, coarse = born(BUILD.birth_nodes), born(BUILD.birth_nodes - 2)
    return Estimate(fine.value, fine.error + abs(fine.value - coarse.value))


def whole(node: Node, name: str) -> Entry:
    """Entry of a number that all curves have."""
    ends = np.log(BUILD.whole).tolist()
    power = 2 if name.endswith("contact_radius") else 1
    return entry(ends, [piece(lambda x: node(math.exp(x))[name], *part, power) for part in pairwise(ends)], power)


def folded(node: Node, jump: str, number: str, birth: Estimate) -> Entry:
    """Entry of a number of a jump.

    Beside their birth both jumps are one function of x = sqrt(ln(tabor/birth)): to jump off is to jump on with -x.
    """
    ends = [0.0, *BUILD.folded, math.sqrt(math.log(MOST / birth.value))]
    sign = 1 if jump == "jump_on" else -1

    def either(x: float) -> Estimate:
        return node(birth.value * math.exp(x**2))[f"{'jump_on' if x > 0 else 'jump_off'}.{number}"]

    both, error = piece(either, -ends[1], ends[1])
    first = fitted(chebyshev.chebval(sign * (1 + chebyshev.chebpts1(BUILD.nodes)) / 2, both)), error
    return entry(ends, [first, *(piece(lambda x: either(sign * x), *part) for part in pairwise(ends[1:]))], 1, birth)


def radius(node: Node, name: str, birth: Estimate, gap: Series) -> Entry:
    """Entry of the square of a contact radius at an end of a jump, from where the central gap is that of the edge."""

    def closed(x: float) -> float:
        return EDGE - float(gap(np.array([birth.value * math.exp(x**2)]))[0][0])

    begin = root(closed, 0.0, BUILD.folded[0], "the birth of a contact; take more nodes", xtol=1e-15)
    ends = [begin, *BUILD.folded, math.sqrt(math.log(MOST / birth.value))]
    pieces = [piece(lambda x: node(birth.value * math.exp(x**2))[name], *part, 2) for part in pairwise(ends)]
    return entry(ends, pieces, 2, birth)


def entry(ends: Sequence[float], pieces: Iterable[tuple[Array, float]], power: int, birth: Estimate = UNBORN) -> Entry:
    """Entry of a number's power from its pieces, each coefficients and an error."""
    coefficients, errors = zip(*pieces, strict=True)
    half = np.diff(ends) / 2
    slopes = [np.max(np.abs(chebyshev.chebval(np.linspace(-1, 1), chebyshev.chebder(c)))) for c in coefficients]
    moves = slopes / half * birth.error / birth.value / 2  # x moves by the relative error of the birth over 2 x
    return {
        "birth": birth.value,
        "power": power,
        "ends": list(ends),
        "errors": [float(f"{error:.3g}") for error in errors],
        "birth_errors": [float(f"{error:.3g}") for error in moves.tolist()],
        "coefficients": [c.tolist() for c in coefficients],
    }


def piece(at: Callable[[float], Estimate], low: float, high: float, power: int = 1) -> tuple[Array, float]:
    """Chebyshev coefficients of a number's power on a piece of x, and their error: the nodes' and the series' tail."""
    places = (low + high) / 2 + (high - low) / 2 * chebyshev.chebpts1(BUILD.nodes)
    numbers = [at(x) for x in places.tolist()]
    numbers = [number * number if power == 2 else number for number in numbers]
    coefficients = fitted([number.value for number in numbers])
    return coefficients, max(number.error for number in numbers) + float(np.abs(coefficients[-2:]).sum())


def fitted(values: ArrayLike) -> Array:
    """Chebyshev coefficients of the polynomial through values at the Chebyshev points, along the first axis."""
    f = np.asarray(values)
    weights = np.where(np.arange(len(f)), 2, 1) / len(f)
    return np.tensordot(weights[:, None] * chebyshev.chebvander(chebyshev.chebpts1(len(f)), len(f) - 1).T, f, axes=1)


def compared(entries: Mapping[str, Entry], numbers: Numbers, tabor: float) -> list[Entry]:
    """What the source says of a Tabor parameter, number by number, and how far series are off it.

    That is in the number's unit, relative to its scale, and in parts of both errors. The scale of an approach is eps
    and the range of those of all events, see `halfspace.equilibrium.events.approach_scale`; that of others their size.
    """
    scale = approach_scale(number.value for name, number in numbers.items() if name.endswith("approach"))
    points = []
    for name in (name for name in entries if name in numbers):
        value, error = (float(array[0]) for array in series_of(entries[name])(np.array([tabor])))
        number = numbers[name]
        off, size = value - number.value, scale if name.endswith("approach") else abs(number.value)
        point = {"tabor": tabor, "number": name, "reference": number.value, "reference_error": number.error}
        of_errors = abs(off) / (error + number.error)
        points.append({**point, "deviation": off, "relative": abs(off) / size, "of_errors": of_errors})
    return points
