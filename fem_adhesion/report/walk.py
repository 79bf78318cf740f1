"""A walk along one load-approach curve: at each of its states the surface and the body, by finite elements and beside.

Made for looking: profiles and lines inside the body on fixed grids, small enough to go into a page, where it moves.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

import numpy as np

from fem_adhesion.bodies.body import Discretisation
from fem_adhesion.common.facts import plain
from fem_adhesion.common.jobs import Progress, unheard
from fem_adhesion.common.lines import UNSTABLE, smooth
from fem_adhesion.curve.solve import Curves
from fem_adhesion.curve.stress import values_at
from fem_adhesion.fields import State, half_space_beside, states_along
from halfspace.equilibrium.events import usual
from halfspace.errors import tried
from halfspace.values import Array, Valued

SEEN = Discretisation(degree=4)  # of the fields: right to the width of a line
LINES = (0.0, 0.25, 0.5, 1.0, 1.5, 2.0)  # depths in beta at which lines are drawn inside the body


@dataclass(frozen=True, eq=False, repr=False)
class Station(Valued):
    """One state of the walk, by the name of the event that it is, or "", and whether it is stable under fixed grips.

    Its numbers are in the path's unit, eps, R dgamma, eps and beta (nan without contact). Pressure and gap (2, n) are P
    and H at the radii of the walk: by finite elements, and by the half-space at the same contact radius or central gap;
    nan where the half-space has no such state. Lines (depths, m) are the upward displacement in eps of those inside the
    body, at the walk's places.
    """

    name: str
    arclength: float
    approach: float
    load: float
    central_gap: float
    contact_radius: float
    stable: bool
    pressure: Array
    gap: Array
    lines: Array


@dataclass(frozen=True, eq=False, repr=False)
class Walk(Valued):
    """States along the curve of a scene by finite elements, in order.

    Radii (n,) of the profiles and places (m,) of the points on the lines inside the body are in beta. The curves are by
    finite elements and by the half-space.
    """

    curves: Curves
    radii: Array
    places: Array
    stations: tuple[Station, ...]


def walk(curves: Curves, *, states: int | None = None, progress: Progress = unheard) -> Walk:
    """Stop at some states along the curve of a block by finite elements, the first of some, and at its events.

    The states are nearly equidistant in arclength, all points of the curve unless their number is given. `progress` is
    called with what is under way, how much is done and of how much.
    """
    scene, path = curves.question.scene, curves.path
    outer = 1.6 * float(np.nanmax(path.contact_radius))
    radii, places = np.linspace(0, outer, 151), np.linspace(0, outer, 81)
    total = (path.count if states is None else states) + len(usual(path.events))
    stations = []
    for number, state in enumerate(states_along(scene, path, points=states, how=SEEN)):
        progress("states along the curve", number, total)
        stations.append(_station(state, radii, places))
    return Walk(curves, radii, places, tuple(stations))


def _station(state: State, radii: Array, places: Array) -> Station:
    approach, load, central_gap, contact_radius = (float(value) for value in state.observables)
    operator = state.problem.operator.at(1.0)
    beside, other = tried(half_space_beside, state), [np.full_like(radii, np.nan)] * 2
    if beside:
        other = [operator.values_at(radii, values) for values in (beside.pressure, beside.gap)]
    own = [operator.values_at(radii, values) for values in (state.pressure, state.gap)]
    pressure, gap = (np.array(both) for both in zip(own, other, strict=True))
    point = state.name, state.point.arclength, approach, load, central_gap, contact_radius, state.stable
    return Station(*point, pressure, gap, _lines(state, places))


def _lines(state: State, places: Array) -> Array:
    """Upward displacement in eps on the lines inside the body."""
    radii, depths = (x.ravel() for x in np.meshgrid(places, LINES))
    rise = state.scene.tabor * values_at(state, state.components[1:], radii, depths)
    return np.asarray(rise.reshape(len(LINES), places.size))


# What the page has of it

BETWEEN = 2.2  # heights in eps per beta of depth at which the lines inside the body are drawn in the moving figure


def walk_words(walk: Walk) -> list[str]:
    """What is said of the moving figure: how many of its states are unstable, and what is missing."""
    total, unstable = len(walk.stations), sum(not station.stable for station in walk.stations)
    missing = sum(bool(np.isnan(station.pressure[1]).all()) for station in walk.stations)
    words = [
        f"Of {total} states {unstable} are unstable under fixed grips: hollow points."
        if unstable
        else f"All {total} states are stable under fixed grips.",
        f"Thin lines lie inside the body, {LINES[1]:g} to {LINES[-1]:g}\u00a0β deep; they are drawn {BETWEEN:g}\u00a0ε "
        "apart for each β, so that what the surface does can be seen.",
    ]
    return words + [f"At {missing} of them the half-space has no such state."] * bool(missing)


def walk_data(walk: Walk) -> str:
    """The walk, and the curve by both solvers, as JSON that is safe inside a script element."""
    drawn = {
        "radii": walk.radii,
        "places": walk.places,
        "curves": [
            {"approach": line.approach, "load": line.load, "unstable": (line.kind == UNSTABLE).tolist()}
            for line in map(smooth, walk.curves.paths.values())
        ],
        "stations": [asdict(station) | {"name": station.name.replace("_", " ")} for station in walk.stations],
    }
    rounded = json.loads(json.dumps(plain(drawn)), parse_float=lambda text: float(f"{float(text):.5g}"))
    data = {"tabor": walk.curves.question.scene.tabor, "depths": LINES, "between": BETWEEN, **rounded}
    return json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
