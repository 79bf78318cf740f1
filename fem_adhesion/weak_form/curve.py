"""The whole load-approach curve of a scene by full Newton on the weak form, with errors from two degrees."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.scene import Scene, require_scene
from fem_adhesion.weak_form.body import Array, box, discretise, growing
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.path import Path, Point, arclength, condition_of
from fem_adhesion.weak_form.settings import USUAL, Settings
from halfspace.equilibrium.events import Event, Tolerance, tolerance_told
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES
from halfspace.limits import require_between
from halfspace.profiles import Paraboloid
from halfspace.values import Valued

OBSERVABLES = ("approach", "load", "central_gap", "contact_radius")
LIMITS = {"tabor": (0.02, 5.0), "poisson": (0.0, 0.49), "rtol": (1e-4, 0.1), "to_load": (0.0, 20.0)}


@dataclass(frozen=True, eq=False, repr=False)
class Curve(Valued):
    """A load-approach curve from separation to compression, through every fold.

    Attributes
    ----------
    tabor, rtol : float
        Tabor parameter, and the relative accuracy that was asked of loads and approaches.
    observables, errors : (points, 4) array
        Approach (eps), load (R dgamma, positive in compression), central gap H(0) (eps) and contact radius (beta, nan
        without contact) of each point, and the estimated errors of these.
    rates : (points, 3) array
        Of approach, load and central gap along the path.
    arclength : (points,) array
        Along the path, in eps: of approach and root mean square of the gap.
    stable : (points,) array of bool
        Stability under fixed grips.
    events : mapping of str to Event
        ``pull_off``, ``jump_on``, ``jump_off``, ``zero_load`` and, where the path winds, ``fold_2`` ...; each solved
        for, with the estimated error of each number.
    tolerance : Tolerance
        What `rtol` means for loads and approaches.
    unknowns : int
        Displacements of the finest elements.
    seconds : float
        Wall time.
    settings : mapping
        Degrees of the elements, cells, size of the box.
    """

    tabor: float
    rtol: float
    observables: Array
    errors: Array
    rates: Array
    arclength: Array
    stable: NDArray[np.bool_]
    events: Mapping[str, Event]
    tolerance: Tolerance
    unknowns: int
    seconds: float = field(compare=False)
    settings: Mapping[str, Any]

    def __getattr__(self, name: str) -> Array:
        """Observables by name, ``approach``, ``load``, ``central_gap``, ``contact_radius``, and ``load_error`` ..."""
        observable, _, error = name.partition("_error")
        if observable not in OBSERVABLES or (error and name):
            raise AttributeError(name)
        table = self.errors if name.endswith("_error") else self.observables
        return np.asarray(table[:, OBSERVABLES.index(observable)])

    def __repr__(self) -> str:
        """What was found, and whether to the accuracy asked for."""
        found = "; ".join(f"{name} at {each.approach:.5g} eps, {each.load:.5g}" for name, each in self.events.items())
        told = tolerance_told(self.rtol, self.missed)
        return f"<Curve of tabor {self.tabor:g}, {len(self.load)} points: {found}; {told}>"

    def event(self, name: str) -> Event | None:
        """Event by name, None if the curve does not have it."""
        return self.events.get(name)

    @property
    def stable_under_dead_load(self) -> NDArray[np.bool_]:
        """Stability under a dead load: stable under fixed grips, and the load rises with the approach."""
        return np.asarray(self.stable & (self.rates[:, 0] * self.rates[:, 1] > 0))

    @property
    def missed(self) -> dict[str, tuple[str, ...]]:
        """By event, the numbers whose estimated errors exceed `tolerance`."""
        return self.tolerance.missed(self.events)

    @property
    def met(self) -> bool:
        """Whether all events have their loads and approaches to the accuracy asked for."""
        return not self.missed


def trace(scene: Scene, rtol: float = 1e-3, *, to_load: float = 5.0, how: Settings = USUAL) -> Curve:
    """Trace the load-approach curve by Newton's method for all displacements at once.

    The body is meshed by quadrilaterals and clamped far away; scikit-fem assembles the weak form of
    `fem_adhesion.weak_form`, and a sparse factorisation solves it with the approach as a further unknown and the
    arclength as a further equation. The path is followed on elements of the lowest degree. Its events and points are
    solved for on higher ones, each until its change from degree to degree, which is its error estimate, is within
    `rtol`. It takes 10 s at a Tabor parameter of 0.5, 20 s at 1 and a minute at 2, where `fem_adhesion.trace` takes a
    fraction of a second.

    Parameters
    ----------
    scene : Scene
        A half-space under a paraboloid by the 3-9 law, of Tabor parameter 0.02 to 5 and Poisson's ratio to 0.49.
    rtol : float
        Relative accuracy of loads, and of approaches in the range of the events', 1e-4 to 0.1.
    to_load : float
        Compressive load in R dgamma at which the curve ends, 0 to 20.
    how : Settings
        Degrees of the elements, cells, and where the curve begins.

    Raises
    ------
    InputError
        If the scene is another, or a value is out of range.
    NotConverged
        If the path ends before that load.
    """
    require_served(scene, rtol, to_load)
    began, paths = time.perf_counter(), _paths(scene, rtol, to_load, how)
    path = next(paths)
    points = path.follow(how.separated, to_load)
    found, told = path.events(points), dict[str, Event]()
    open_events = list(found)
    errors, open_points = np.full((len(points), len(OBSERVABLES)), np.inf), np.arange(len(points))
    for path in paths:
        for name in open_events:
            finer = path.event_near(path.taken_over(found[name]), condition_of(name))
            told[name], found[name] = _event(name, found[name], finer, how.found), finer
        tolerance = Tolerance.on(told, rtol)
        rough = [name for name, event in told.items() if event.contact_radius_error > rtol * event.contact_radius]
        open_events = [name for name, event in told.items() if name in rough or tolerance.missed_by(event)]
        for n in open_points:
            finer = path.taken_over(points[n])
            errors[n], points[n] = np.abs(finer.observables - points[n].observables), finer
        sizes = np.array([tolerance.approach, max(abs(point.state.load) for point in points)])
        open_points = np.flatnonzero((errors[:, :2] > rtol * sizes).any(axis=1))
        if not (open_points.size or open_events):
            break
    return Curve(
        scene.tabor,
        rtol,
        np.array([point.observables for point in points]),
        errors,
        np.array([point.rates for point in points]),
        np.cumsum([0.0, *(arclength(*both) for both in pairwise(points))]),
        np.array([point.stable for point in points]),
        told,
        tolerance,
        path.contact.body.reaction.size,
        time.perf_counter() - began,
        {"rtol": rtol, "far": path.contact.body.rim},
    )


def _paths(scene: Scene, rtol: float, to_load: float, how: Settings) -> Iterator[Path]:
    """Paths on elements of ever higher degree, on one mesh.

    The box is so large that its clamp takes little of the approach. Its cells are fine up to the contact radius by JKR
    at the largest load: the edge, whose spike of tension is as wide as 1/mu^2 beta, passes by all of it. Attraction is
    as wide as mu^(-1/2) beta at least.
    """
    mu, W = scene.tabor, to_load
    far = mu * max(W, 1.0) / (np.pi * how.left_out * rtol)  # a clamp at L takes W/(pi L) beta^2/R of the approach
    swept = float(0.75 * (W + 3 * np.pi + np.sqrt(6 * np.pi * W + (3 * np.pi) ** 2))) ** (1 / 3)
    length = how.cells / max(mu**2, mu**0.5)
    fine = np.linspace(0, swept, int(np.ceil(swept / length)) + 1)
    beyond = growing(fine[1], far, how.growth)
    mesh = box(np.append(fine, swept + how.growth * beyond), beyond)
    for degree in how.degrees:
        yield Path(Contact(discretise(mesh, degree, [(scene.poisson, 1.0)]), mu, endless=False), swept)


def _event(name: str, coarse: Point, fine: Point, found: float) -> Event:
    """Numbers of an event with errors, from those on coarser elements.

    Each errs by its change. As two numbers may agree by chance while the event moves, approach and load where
    the path turns err no less than by what the event's shift along the path makes of them, which the central gap tells.
    """
    changes = np.abs(fine.observables - coarse.observables)
    if name != "zero_load":
        shift = changes[2] / abs(fine.rates[2])
        changes[:2] = np.maximum(changes[:2], np.abs(fine.rates[:2]) * shift)
    return Event(name, *map(float, fine.observables), *map(float, changes + found))


def require_served(scene: Scene, rtol: float, to_load: float) -> None:
    """Refuse a scene or a value that the weak form is not written for; raise InputError."""
    require_scene(scene)
    counts = {
        "body": (scene.body.name, scene.body.name == "half-space", "half-space"),
        "profile": (scene.shape, scene.shape == Paraboloid(), "paraboloid"),
        "law": (scene.law, scene.law == LENNARD_JONES, "the 3-9 law"),
        "material": (scene.material, not scene.material.finite, "small strain"),
    }
    for name, (value, served, limit) in counts.items():
        if not served:
            raise InputError(f"{name} = {value} by the weak form, limit: {limit}; take fem_adhesion.trace, solver fem")
    values = {"tabor": scene.tabor, "poisson": scene.poisson, "rtol": rtol, "to_load": to_load}
    for name, value in values.items():
        require_between(value, name, *LIMITS[name], "take fem_adhesion.trace, solver fem", " of the weak form")
