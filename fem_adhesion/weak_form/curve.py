"""The path of equilibria through the folds, its events, and the whole curve of a scene with errors from two degrees."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from fem_adhesion.scene import Scene, require_scene
from fem_adhesion.weak_form.body import Array, box, discretise
from fem_adhesion.weak_form.contact import Contact
from fem_adhesion.weak_form.newton import Equilibrium, even, newton
from halfspace.equilibrium.events import Event, Tolerance, WithEvents, is_fold, tolerance_told
from halfspace.errors import InputError, NotConverged, tried
from halfspace.laws import LENNARD_JONES
from halfspace.limits import require_between
from halfspace.profiles import Paraboloid
from halfspace.values import States, Valued

LIMITS = {"tabor": (0.02, 5.0), "poisson": (0.0, 0.49), "rtol": (1e-4, 0.1), "to_load": (1e-3, 20.0)}

# The path


@dataclass(frozen=True, eq=False, repr=False)
class Point(Valued):
    """An equilibrium at the place s of a `Path`."""

    s: float
    state: Equilibrium

    @cached_property
    def rates(self) -> Array:
        """Of approach, load and central gap along the path, (3,), per change of approach and central gap."""
        state = self.state
        change = even(state.contact.body, state.rate[:-1])
        rates = np.array([1.0, state.stiffness, change(0.0)])
        return np.asarray(-np.sign(change(radius_at(self.s))) * rates / np.hypot(rates[0], rates[2]))

    @cached_property
    def observables(self) -> Array:
        """Approach and load, central gap H(0) in eps, contact radius in beta (nan without contact)."""
        radius = radius_at(self.s) if self.s > 0 else math.nan
        return np.array([self.state.approach, self.state.load, self.state.central_gap, radius])


def radius_at(s: float) -> float:
    """Radius in beta at which the gap is given at a place of a `Path`."""
    return math.sqrt(max(s, 0.0))


@dataclass(frozen=True, eq=False, repr=False)
class Path(Valued):
    """The equilibria of a contact, each known by one number s that grows all along, while approach and load turn back.

    Apart, s < 0, the gap on the axis is that of the largest tension less s, in eps; in contact sqrt(s) is the contact
    radius in beta, where the gap is that of the largest tension.
    """

    contact: Contact

    def at(self, s: float, y: Array) -> Point:
        """Point at a place, from a state nearby."""
        gap = self.contact.law.edge - min(s, 0.0)

        def there(y: Array) -> float:
            return float(even(self.contact.body, y[:-1])(radius_at(s)))

        return Point(s, newton(self.contact, y, lambda y: (gap - there(y), there)))

    def follow(self, approach: float, to_load: float, longest: float = 0.1) -> list[Point]:
        """Points from an approach of separated surfaces, through every fold, to a compressive load.

        The steps are at most a part, `longest`, of the central gap, or of one and the squared contact radius: with 0.3
        both folds at a Tabor parameter of 0.72 were passed by, with 0.15 they are found. A step that fails is halved.
        """
        edge = self.contact.law.edge
        points, halvings = [self.at(edge - 1 + approach, self.contact.undeformed(approach))], 0
        while (last := points[-1]).state.load < to_load:
            step = longest * (edge - last.s if last.s < 0 else 1 + last.s) / 2**halvings
            found = tried(self.at, last.s + step, last.state.y)
            if found:
                points.append(found)
                halvings = max(halvings - 1, 0)
            elif (halvings := halvings + 1) > 16:
                at = f"alpha = {last.state.approach:.4g} eps"
                raise NotConverged(f"the weak form's path ends at {at}; try another to_load or a smaller tabor")
        return [*points[:-1], *self.located(points[-2:], lambda point: point.state.load - to_load)]

    def located(self, points: Sequence[Point], condition: Any) -> list[Point]:
        """All points at which a condition changes its sign, in order; the state is solved for at every trial."""
        found = []
        for a, b in pairwise(points):
            if condition(a) * condition(b) < 0:
                root = brentq(lambda s, y=a.state.y: condition(self.at(s, y)), a.s, b.s, xtol=1e-7)
                found.append(self.at(root, a.state.y))
        return found

    def events(self, points: Sequence[Point]) -> dict[str, Point]:
        """Pull-off, zero load in contact, and the folds: jump_on and jump_off the outermost, fold_2 ... between."""
        folds, extrema = (self.located(points, lambda point, n=n: point.rates[n]) for n in (0, 1))
        zeros = self.located(points, lambda point: point.state.load)
        if not extrema:
            raise NotConverged("the weak form's path has no minimum of the load; give a larger to_load")
        found = {"pull_off": min(extrema, key=lambda point: point.state.load)}
        if len(folds) > 1:
            found |= {"jump_on": folds[0], "jump_off": folds[-1]}
            found |= {f"fold_{n}": point for n, point in enumerate(folds[1:-1], 2)}
        return found | ({"zero_load": zeros[-1]} if zeros else {})

    def again(self, point: Point) -> Point:
        """Point at the same place on the same cells by elements of another degree."""
        y = np.append(even(point.state.contact.body, point.state.y[:-1])(self.contact.body.radii), point.state.approach)
        return self.at(point.s, y)


# The curve


@dataclass(frozen=True, eq=False, repr=False)
class Curve(WithEvents, States):
    """A load-approach curve from separation to compression, through every fold: points with their errors, and events.

    Attributes
    ----------
    tabor : float
        Tabor parameter.
    rates : (points, 3) array
        Of approach, load and central gap along the path.
    arclength : (points,) array
        Along the path, in eps: of approach and central gap.
    stable : (points,) array of bool
        Stability under fixed grips.
    events : mapping of str to Event
        ``pull_off``, ``jump_on``, ``jump_off``, ``zero_load`` and, where the path winds, ``fold_2`` ...; each solved
        for, with the estimated error of each number.
    unknowns : int
        Displacements of the finest elements.
    seconds : float
        Wall time.
    settings : mapping
        The accuracy that was asked of loads and approaches, and the size of the box.
    """

    tabor: float
    rates: Array
    arclength: Array
    stable: NDArray[np.bool_]
    events: Mapping[str, Event]
    unknowns: int
    seconds: float = field(compare=False)
    settings: Mapping[str, Any]

    def __repr__(self) -> str:
        """What was found, and whether to the accuracy asked for."""
        found = "; ".join(f"{name} at {each.approach:.5g} eps, {each.load:.5g}" for name, each in self.events.items())
        told = tolerance_told(self.rtol, self.missed)
        return f"<Curve of tabor {self.tabor:g}, {len(self.load)} points: {found}; {told}>"


def trace(scene: Scene, rtol: float = 1e-3, *, to_load: float = 5.0) -> Curve:
    """Trace the load-approach curve by Newton's method for all displacements at once.

    The body is meshed by quadrilaterals and clamped far away; scikit-fem assembles the weak form of
    `fem_adhesion.weak_form`, and a sparse factorisation solves it with the approach as a further unknown and the
    contact radius, or the gap on the axis before there is a contact, as a further equation. The path is followed on
    elements of the lowest degree. Its points and events are solved for on higher degrees, until the changes of the
    events from degree to degree, which are the error estimates, are within `rtol`; each point has an error of its own,
    the change at its contact radius. It takes half a minute at a Tabor parameter of 0.5 and two minutes at 2, where
    `fem_adhesion.trace` takes a fraction of a second.

    Parameters
    ----------
    scene : Scene
        A half-space under a paraboloid by the 3-9 law, of Tabor parameter 0.02 to 5 and Poisson's ratio to 0.49.
    rtol : float
        Relative accuracy of loads, and of approaches in the range of the events', 1e-4 to 0.1.
    to_load : float
        Compressive load in R dgamma at which the curve ends, 0.001 to 20.

    Raises
    ------
    InputError
        If the scene is another, or a value is out of range.
    NotConverged
        If the path ends before that load.
    """
    require_served(scene, rtol, to_load)
    began, mesh = time.perf_counter(), mesh_for(scene, rtol, to_load)
    paths = (Path(Contact(discretise(mesh, degree, [(scene.poisson, 1.0)]), scene.tabor)) for degree in (2, 3, 4, 5))
    path = next(paths)
    points = path.follow(-9.0, to_load)  # eps; the attraction is a hundredth of its maximum there
    events, told = path.events(points), dict[str, Event]()
    values = np.array([point.observables for point in points])
    for path in paths:
        coarse, points = events, [path.again(point) for point in points]
        before, values = values, np.array([point.observables for point in points])
        events = path.events(points)
        if events.keys() != coarse.keys():  # a fold of one may not be that of the other
            coarse = {name: event for name, event in coarse.items() if not is_fold(name)}
        told = {name: _event(name, path, coarse.get(name), event) for name, event in events.items()}
        rough = any(event.contact_radius_error > rtol * event.contact_radius for event in told.values())
        if not (rough or Tolerance.on(told, rtol).missed(told)):
            break
    fields: list[Any] = [
        *values.T,
        *np.abs(values - before).T,
        scene.tabor,
        np.array([point.rates for point in points]),
        np.append(0.0, np.cumsum(np.hypot(*np.diff(values[:, [0, 2]], axis=0).T))),
        np.array([point.state.unstable == 0 for point in points]),
        told,
        path.contact.body.stiffness.shape[0],
        time.perf_counter() - began,
        {"rtol": rtol, "far": path.contact.body.rim},
    ]
    return Curve(*fields)


def mesh_for(scene: Scene, rtol: float, to_load: float) -> Any:
    """Box so large that its clamp takes a thousandth of rtol eps from the approach.

    Its cells are fine up to the contact radius by JKR at the largest load: the edge, whose spike of tension is as wide
    as 1/mu^2 beta, passes by all of it. Attraction is as wide as mu^(-1/2) beta at least. Beyond they grow threefold.
    """
    mu, W = scene.tabor, to_load
    far = mu * max(W, 1.0) / (np.pi * 1e-3 * rtol)  # a clamp at L takes W/(pi L) beta^2/R of the approach
    swept = float(0.75 * (W + 3 * np.pi + np.sqrt(6 * np.pi * W + (3 * np.pi) ** 2))) ** (1 / 3)
    fine = np.linspace(0, swept, int(np.ceil(swept / 0.3 * max(mu**2, mu**0.5))) + 1)
    beyond = np.cumsum(fine[1] * 3.0 ** np.arange(1 + np.ceil(np.log(far / fine[1]) / np.log(3))))
    return box(np.append(fine, swept + 3 * beyond), beyond)


def _event(name: str, path: Path, coarse: Point | None, fine: Point) -> Event:
    """Numbers of an event on the finer elements, with errors.

    Each errs by its change from the coarser elements, if these have it. As two numbers may agree by chance
    while the event moves along the path, where that turns they err no less than by what its move makes of them.
    """
    if coarse is None:
        return Event(name, *map(float, fine.observables), *[math.inf] * 4)
    others = (coarse,) if name == "zero_load" else (coarse, path.again(coarse))
    errors = np.max([np.abs(fine.observables - other.observables) for other in others], axis=0) + 1e-8
    return Event(name, *map(float, fine.observables), *map(float, errors))


def require_served(scene: Scene, rtol: float, to_load: float) -> None:
    """Refuse a scene or a value that the weak form is not written for; raise InputError."""
    require_scene(scene)
    known = {"half-space": "half-space", "paraboloid": Paraboloid(), "the 3-9 law": LENNARD_JONES}
    given = {"body": scene.body.name, "profile": scene.shape, "law": scene.law}
    for (limit, served), (name, value) in zip(known.items(), given.items(), strict=True):
        if value != served:
            raise InputError(f"{name} = {value} by the weak form, limit: {limit}; take fem_adhesion.trace, solver fem")
    for name, value in {"tabor": scene.tabor, "poisson": scene.poisson, "rtol": rtol, "to_load": to_load}.items():
        require_between(value, name, *LIMITS[name], "take fem_adhesion.trace, solver fem", " of the weak form")
