"""Whether error estimates hold the truth and are not much larger, by families of scenes; `make honesty` runs it.

A family is data: its scenes, how they are solved, which numbers are told, and their truth, which is known to what two
truths differ by. A number is held if its true error is no more than its estimate and that, and close if its estimate is
no more than a hundred times its true error, or that, or what rounding leaves. A table tells the shares, and the worst
of what lies outside. `side_by_side` makes a second table, `combinations` compares laws, profiles and bodies.
"""

import argparse
import math
import secrets
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import partial
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import combinations
import drawn_layers
import numpy as np
import side_by_side
import truths
from scenes import pair

import fem_adhesion
import halfspace
from fem_adhesion import HalfSpace, HeldSphere, Hemisphere, Meshed, NeoHookean, Scene
from fem_adhesion.assess.study import assess
from fem_adhesion.common.contact import Contact
from fem_adhesion.common.jobs import progress_bar, stream
from halfspace import Coated, Layer, Layers, Stratum
from halfspace.equilibrium.charts import placed
from halfspace.equilibrium.conditions import Condition, Located
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import is_event
from halfspace.equilibrium.search import energy_released
from halfspace.equilibrium.states import COORDINATES
from halfspace.errors import InputError, NotConverged
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Power
from halfspace.values import Estimate

MESHES = Path(__file__).parents[2] / "meshes"
QUANTITIES = ("approach", "load", "central_gap", "contact_radius")
HELD = 0.99
CLOSE = {"full": 0.9, "quick": 0.8}  # few scenes have few independent numbers
CLOSENESS = 100
ROUNDED = 1e-11

Numbers = Mapping[str, Estimate]
Values = Mapping[str, float]


class Net(NamedTuple):
    """Scenes of a family, or what draws those of a seed, and the tolerances at which each is solved."""

    scenes: Sequence[Any] | Callable[[int], Sequence[Any]]
    rtols: Sequence[float]

    def of(self, seed):
        """Scenes."""
        return self.scenes(seed) if callable(self.scenes) else self.scenes


@dataclass(frozen=True)
class Family:
    """Scenes of one kind.

    Attributes
    ----------
    full, quick : Net
        All that is looked at, and half a minute's part of it.
    solve : callable
        A scene at a tolerance: whatever carries its numbers.
    numbers : callable
        Those numbers with their estimates.
    truth : callable
        A scene and what was solved of it: the same numbers twice, the second time better known.
    anew : bool
        Whether the numbers are of places that no two tolerances share, so that each has truths of its own.
    """

    full: Net
    quick: Net
    solve: Callable[[Any, float], Any]
    numbers: Callable[[Any], Numbers]
    truth: Callable[[Any, Any], Sequence[Values]]
    anew: bool = False


@dataclass(frozen=True)
class Judged:
    """One number: what it is of, its estimate, its true error, and how well that is known."""

    what: str
    estimate: float
    error: float
    known: float
    size: float

    @property
    def held(self):
        """Whether the estimate holds the truth."""
        return self.error <= self.estimate + self.known

    @property
    def alike(self):
        """What it is of, but for the tolerance, and what it is: equal where one grid serves two tolerances."""
        return self.what.split(" at rtol ")[0], self.estimate, self.error

    @property
    def close(self):
        """Whether the estimate tells the size of the error."""
        return self.estimate <= CLOSENESS * max(self.error, self.known, ROUNDED * (1 + self.size))


# What is told of a curve ----------------------------------------------------------------------------------------------


def of_path(path):
    """Events and energy."""
    told = {f"{name} {q}": _estimate(event, q) for name, event in path.events.items() for q in QUANTITIES}
    return _real(told | {"energy": path.energy})


def of_state(state):
    """The same of located events."""
    found = {name: state[name].point.observables for name in state if is_event(name)}
    told = {f"{name} {q}": float(v) for name, all_ in found.items() for q, v in zip(QUANTITIES, all_, strict=True)}
    return told | {"energy": energy_released(state)}


def _estimate(event, quantity):
    return Estimate(getattr(event, quantity), getattr(event, f"{quantity}_error"))


def _real(numbers):
    """Numbers that exist, but for the load that is zero by definition."""
    return {what: n for what, n in numbers.items() if math.isfinite(n.value) and what != "zero_load load"}


STIFFNESSES = (1e-6, 1e-2, 1.0, math.inf)


def of_springs(path):
    """Jumps with apparatus of several stiffnesses, where there are any."""
    return {f"k = {k:g}, {what}": n for k in STIFFNESSES for what, n in _of_cycle(cycle(path, k)).items()}


def _of_cycle(found):
    if found is None:
        return {}
    ends = {f"{j} {e}": getattr(getattr(found, j), e) for j in ("jump_on", "jump_off") for e in ("take_off", "landing")}
    told = {f"{where} {q}": _estimate(end, q) for where, end in ends.items() for q in QUANTITIES}
    return _real(told | {"energy lost": found.energy_lost, "jump_on energy": found.jump_on.energy})


EVERY = 2  # points of a curve


def of_curve(path):
    """Every second point."""
    columns = [(q, getattr(path, q), getattr(path, f"{q}_error")) for q in QUANTITIES]
    told = {f"point {k} {q}": Estimate(float(v[k]), float(e[k])) for q, v, e in columns for k in _places(path)}
    return _real(told)


def _places(path):
    return range(0, path.count, EVERY)


PLACES = (0.02, 0.3, 0.8)  # on a branch, in its range
SHORT = 0.05  # eps or R dgamma: a branch that another tolerance may not have


def of_states(path):
    """What `path.at` says at some places of every branch."""
    told = {}
    for coordinate, branch, values in _asked(path):
        states = path.at(**{coordinate: values}, branch=branch)
        columns = [(q, getattr(states, q), getattr(states, f"{q}_error")) for q in QUANTITIES if q != coordinate]
        for q, v, e in columns:
            told |= {_place(coordinate, n, branch, q): Estimate(float(v[n]), float(e[n])) for n in range(len(PLACES))}
    return _real(told)


def _asked(path):
    for coordinate in COORDINATES:
        for branch, (low, high) in path.branches(coordinate).items():
            if high - low > SHORT:
                yield coordinate, branch, [low + part * (high - low) for part in PLACES]


def _place(coordinate, n, branch, quantity):
    return f"{quantity} at {PLACES[n]:g} of the {coordinate} on {branch}"


def of_assessment(assessment):
    """What the computed models say in SI."""
    models = (m for m in assessment.models if m.is_computed)
    return {f"{m.model}, {what}": Estimate(q.value, q.error) for m in models for what, q in m.values.items()}


# Truths ---------------------------------------------------------------------------------------------------------------


def traced(stages, tabor_of, scene, _):
    return [of_state(state) for state in truths.traced(stages(tabor_of(scene)))]


def relocated(stages, scene, path):
    return [of_state(state) for state in truths.relocated(path.stages[-1], stages(scene))]


def beside(stages, scene, path):
    """The same points of a curve on each stage, in the plane across the path."""
    points = [(part.problem, point) for part in path.finest_curve.segments for point in part.points]
    return [_curve_on(stage, [(k, *points[k]) for k in _places(path)]) for stage in stages(scene)]


def _curve_on(stage, points):
    found = {k: placed(stage, problem, point)[1].observables for k, problem, point in points}
    return {f"point {k} {q}": float(v) for k, all_ in found.items() for q, v in zip(QUANTITIES, all_, strict=True)}


def at_places(stages, scene, path):
    """The states at the same values on each stage."""
    curve, found = path.finest_curve, {}
    for coordinate, branch, values in _asked(path):
        k, _ = COORDINATES[coordinate]
        for n, value in enumerate(values):
            problem, point, _ = curve._solved(k, value, curve.parts(coordinate)[branch])
            found[coordinate, n, branch] = Located(Condition(k, value=value), problem, point, float(point.rates[k]))
    return [_at_places(stage, found) for stage in stages(scene)]


def _at_places(stage, located):
    found = {place: state.point.observables for place, state in truths.on(stage, located).items()}
    return {
        _place(*place, q): float(v)
        for place, all_ in found.items()
        for q, v in zip(QUANTITIES, all_, strict=True)
        if q != place[0]
    }


def sprung(stages, scene, path):
    """Jumps on each stage, from where they are on the curve."""
    on = (replace(path, finest=stage, twin=None) for stage in stages(scene))
    return [{what: n.value for what, n in of_springs(one).items()} for one in on]


def _of_any_scene(scene, path):
    """Of a half-space and what stands for one, as a block, the curve is traced anew; others' events are found again."""
    endless = scene.checked_by == "half-space" and not (scene.body.layered or scene.surface.end < math.inf)
    return traced(truths.half_space_of, _itself, scene, path) if endless else relocated(truths.of, scene, path)


def assessed(contact, assessment):
    """Events and jumps of each model's scene on the stages of that scene, in SI by formulas of our own."""
    answers = ({}, {})
    for model in assessment.models:
        if model.is_computed:
            for answer, stage in zip(answers, _stages_of(model, contact), strict=True):
                answer |= {f"{model.model}, {q}": v for q, v in _in_si(contact, model.curve, stage).items()}
    return answers


def _stages_of(model, contact):
    tabor, rho = contact.units.tabor, contact.units.radius_ratio
    if model.model == "half-space":
        return truths.half_space(tabor)
    if model.model == "true profile":
        return truths.under_sphere(tabor, rho)
    return truths.elements(_sphere(tabor, rho, poisson=contact.poisson))


def _in_si(contact, path, stage):
    E, R, dgamma, eps = contact.units.modulus, contact.radius, contact.work_of_adhesion, contact.spacing
    beta = (R**2 * dgamma / E) ** (1 / 3)
    k = contact.stiffness / (R * dgamma / eps)
    state = truths.on(stage, path.stages[-1])
    at = {name: dict(zip(QUANTITIES, state[name].point.observables, strict=True)) for name in ("pull_off", "zero_load")}
    told = {
        "pull_off_force": -at["pull_off"]["load"] * R * dgamma,
        "pull_off_radius": at["pull_off"]["contact_radius"] * beta,
        "zero_load_radius": at["zero_load"]["contact_radius"] * beta,
    }
    round_trip = cycle(replace(path, finest=stage, twin=None), k)
    for name in ("jump_on", "jump_off"):
        off = getattr(round_trip, name).take_off
        told[f"{name}_separation"] = (1 - off.approach) * eps
        told[f"{name}_base"] = (off.approach + off.load / k) * eps
    return told | {"energy_lost": round_trip.energy_lost.value * R * dgamma * eps}


# The families ---------------------------------------------------------------------------------------------------------


def _sphere(tabor, radius_ratio, body=Hemisphere, **of_body):
    return Scene(tabor, body(radius_ratio=radius_ratio, **of_body))


def _elements_under_sphere(tabor, radius_ratio, poisson):
    return Scene(tabor, HalfSpace(poisson=poisson), halfspace.profiles.Sphere(radius_ratio))


def _mesh(name, tabor, radius_ratio, **more):
    """A mesh file, and the body of ours that it is of."""
    return Scene(tabor, Meshed(MESHES / f"{name}.msh", radius_ratio=radius_ratio, **more))


def _ours(scene):
    body = {"hemisphere": Hemisphere, "sphere": HeldSphere}[scene.body.file.stem]
    return truths.elements(Scene(scene.tabor, body(radius_ratio=scene.radius_ratio)))


def _decades(*exponents):
    return tuple(10.0**-n for n in exponents)


def _silica(**changes):
    usual = {"radius": 100e-9, "modulus": 72e9, "poisson": 0.17, "work_of_adhesion": 0.063, "spacing": 0.14e-9}
    return Contact(**(usual | {"stiffness": 0.2} | changes))


USUAL = (0.02, 0.1, 0.3, 0.5, 0.65, 0.75, 1, 1.5, 2, 3, 5, 8, 20, 50)
BETWEEN = (0.05, 0.2, 0.4, 0.6, 0.69, 0.696, 0.6975, 0.7, 0.72, 0.8, 0.9, 1.2, 2.5, 3.5, 3.9, 4, 4.1, 4.5, 6, 10, 15)
SIZES = ((0.05, 10), (0.3, 10), (0.3, 300), (1, 6), (1, 30), (1, 1000), (2, 100), (5, 30))
POISSONS = (0, 0.3, 0.45, 0.499)


def _sized(*sizes, made=_sphere, truth=truths.elements, few=1, **more):
    """Family of bodies of some sizes, each with another Poisson's ratio; `few` is the place of that which is quick."""
    scenes = [made(*size, poisson=POISSONS[n % 4], **more) for n, size in enumerate(sizes)]
    nets = Net(scenes, _decades(4, 5, 6)), Net(scenes[few : few + 1], _decades(4))
    return Family(*nets, _by(fem_adhesion.trace), of_path, partial(relocated, truth))


def _finite_strain():
    """Spheres at finite strain, by each way of counting the traction, down to one as small as its contact."""
    scenes = [
        _sphere(tabor, ratio, material=material, **more)
        for tabor, ratio, material, more in (
            (0.3, 30, NeoHookean(0.0), {}),
            (1, 100, NeoHookean(), {}),
            (0.1, 2, NeoHookean(traction="vertical"), {}),
            (1, 6, NeoHookean(traction="reference"), {}),
            (0.5, 30, NeoHookean(0.45, "normal"), {}),
            (1, 1000, NeoHookean(), {"grip": "bonded"}),
            (2, 100, NeoHookean(0.2), {}),
            (1.5, 300, NeoHookean(0.499), {"grip": "bonded"}),
            (1, 6, NeoHookean(), {}),
        )
    ]
    scenes += [replace(_sphere(1, ratio, material=NeoHookean()), law=Dugdale(0.2)) for ratio in (30, 100)]
    nets = Net(scenes, _decades(3, 4, 5)), Net(scenes[:1], _decades(3))
    return Family(*nets, _by(fem_adhesion.trace), of_path, partial(relocated, truths.finite_strain))


def _by(solve):
    return partial(_solved, solve)


def _solved(solve, scene, rtol):
    return solve(scene, rtol=rtol)


def _under_sphere(size, rtol):
    return halfspace.trace(size[0], profile=halfspace.profiles.Sphere(size[1]), rtol=rtol)


def _stages_under_sphere(size):
    return truths.under_sphere(*size)


def _tip(half_angle, rows, end, radius_ratio):
    """Blunted cone by a table of so many rows, up to so many radii of its apex."""
    r = np.linspace(0, end, rows)
    table = np.stack([r, Hyperboloid(1 / math.tan(math.radians(half_angle))).height(r)], axis=1)
    with TemporaryDirectory() as folder:
        np.savetxt(Path(folder, "tip.csv"), table, delimiter=",", header="r,z", comments="")
        return halfspace.profiles.Tabulated(Path(folder, "tip.csv"), radius_ratio)


def _under_tip(scene, rtol):
    tabor, *tip = scene
    return halfspace.trace(tabor, profile=_tip(*tip), rtol=rtol)


def _stages_under_tip(scene):
    tabor, *tip = scene
    return truths.under_surface(tabor, _tip(*tip).surface(tabor))


def _on_layers(scene, rtol):
    return halfspace.trace(scene.tabor, law=scene.law, profile=scene.shape, body=scene.body.layered, rtol=rtol)


def _half_space_under(scene):
    return truths.under_sphere(scene.tabor, scene.radius_ratio)


def _block(tabor):
    return Scene(tabor)


def _itself(scene):
    return scene


def _by_law_and_profile(scene, rtol):
    return halfspace.trace(scene.tabor, law=scene.law, profile=scene.shape, rtol=rtol)


def _tabor(scene):
    return scene.tabor


def _half_space_of(scene):
    return truths.half_space(scene.tabor)


def _assess(contact, _):
    return assess(contact)


TIPS = (
    (1.0, 60, 100, 3, 100.0),
    (0.3, 60, 100, 3, 30.0),
    (0.3, 20, 300, 5, 30.0),
    (2.0, 70, 200, 4, 100.0),
    (1.0, 45, 60, 3, 30.0),
    (5.0, 30, 150, 4, 300.0),
)
SLIDING = _sphere(1, 30, poisson=0.3), _sphere(0.3, 30), _sphere(2, 100, poisson=0.45)
BLOCKS = tuple(map(_block, (*USUAL[:12:2], 0.1, 0.69, 0.7, 0.8, 3, 4, 7, 10, 20)))
PLIES = Stratum(0.3, 0.3), Stratum(1.0, 0.45, 0.2), Stratum(0.5, 0.3, 3.0)
LAYERED = (
    Scene(1.0, Layer(2.0, 0.3)),
    Scene(5.0, Coated(1.0, 10.0, 0.4, 0.3)),
    Scene(0.1, Layer(0.1, 0.4999)),
    Scene(0.75, Layer(20.0, 0.3, "sliding")),
    Scene(2.0, Coated(0.2, 0.05, 0.3, 0.2)),
    Scene(2.0, Layers(PLIES)),
    Scene(20.0, Layer(3.0, 0.45)),
)
COATED = (
    Scene(1.0, fem_adhesion.Coated(2.0, 10.0)),
    Scene(1.0, fem_adhesion.Coated(0.5, 100.0)),
    Scene(2.0, fem_adhesion.Coated(0.5, 0.01, 0.0, poisson=0.499)),
    Scene(1.0, Layers(PLIES)),
    Scene(0.5, Layers(PLIES, "sliding")),
)
LAWS_AND_PROFILES = (
    Scene(1.0, law=Morse(3)),
    Scene(0.5, law=Dlvo(0.3, 1.0), profile=Power(4)),
    Scene(2.0, law=PowerLaw(4, 10)),
    Scene(1.0, law=PowerLaw(2.5, 9.5)),
    Scene(0.3, law=Morse(20)),
    Scene(5.0, law=Morse(0.3)),
    Scene(0.05, law=Exponential(3)),
    Scene(3.0, law=Dlvo(-0.5, 0.3)),
    Scene(1.0, law=Dugdale(0.2)),
    Scene(1.0, law=Dugdale(0.1)),
    Scene(1.0, profile=Power(1.5)),
    Scene(0.1, profile=Power(10)),
    Scene(3.0, profile=Power(3)),
    Scene(0.3, profile=Hyperboloid(0.1)),
    Scene(1.0, law=Morse(3), profile=Hyperboloid(1)),
    Scene(1.0, law=PowerLaw(3.5, 9.5), profile=Hyperboloid(0.3)),
)
FAMILIES = {
    "half-space": Family(
        Net((*USUAL, *BETWEEN, 30, 70, 100), _decades(*range(1, 10))),
        Net((0.05, 0.75, 2, 20), _decades(2, 5, 8)),
        _by(halfspace.trace),
        of_path,
        partial(traced, truths.half_space, _itself),
    ),
    "triangles": Family(
        Net((*USUAL[:12], *BETWEEN), _decades(*range(1, 7))),
        Net((0.75, 3), _decades(3, 5)),
        _by(partial(halfspace.trace, kernel="triangles")),
        of_path,
        partial(traced, truths.half_space, _itself),
    ),
    "block": Family(
        Net(BLOCKS, _decades(*range(1, 8))),
        Net((Scene(0.1), Scene(1, HalfSpace(poisson=0.499)), Scene(3)), _decades(2, 4)),
        _by(fem_adhesion.trace),
        of_path,
        partial(traced, truths.half_space, _tabor),
    ),
    "sphere's profile": Family(
        Net((*SIZES, (10, 100), (2, 10)), _decades(1, 2, 3, 4, 5, 6, 7, 8, 9)),
        Net(((0.3, 30), (2, 100)), _decades(2, 6)),
        _under_sphere,
        of_path,
        partial(relocated, _stages_under_sphere),
    ),
    "laws and profiles": Family(
        Net(LAWS_AND_PROFILES, _decades(2, 3, 4, 5, 6, 7, 8)),
        Net(LAWS_AND_PROFILES[:2], _decades(3, 6)),
        _by_law_and_profile,
        of_path,
        partial(traced, truths.half_space_of, _itself),
    ),
    "tips from tables": Family(
        Net(TIPS, _decades(2, 3, 4, 5, 6, 7, 8, 9)),
        Net(TIPS[:1], _decades(3, 6)),
        _under_tip,
        of_path,
        partial(relocated, _stages_under_tip),
    ),
    "layers": Family(
        Net(LAYERED, _decades(2, 3, 4, 5, 6, 7)),
        Net(LAYERED[:2], _decades(3, 6)),
        _on_layers,
        of_path,
        partial(relocated, truths.layered),
    ),
    "layers, drawn": Family(
        Net(partial(drawn_layers.drawn, count=12), _decades(2, 4, 6)),
        Net(partial(drawn_layers.drawn, count=1), _decades(4)),
        _on_layers,
        of_path,
        partial(relocated, truths.layered),
    ),
    "layers by elements": Family(
        Net(COATED, _decades(2, 3, 4, 5)),
        Net(COATED[:1], _decades(3)),
        _by(fem_adhesion.trace),
        of_path,
        partial(relocated, truths.layered),
    ),
    "elements, drawn": Family(
        Net(partial(drawn_layers.elements, count=12), _decades(2, 4, 6)),
        Net(partial(drawn_layers.elements, count=1), _decades(3)),
        _by(fem_adhesion.trace),
        of_path,
        _of_any_scene,
    ),
    "hemisphere, sliding": _sized(
        (0.2, 10), (0.2, 100), (1, 10), (1, 30), (1, 100), (2, 30), truth=truths.harmonics, few=3
    ),
    "hemisphere, bonded": _sized(*SIZES, grip="bonded", few=3),
    "held sphere": _sized(*SIZES[:4], body=HeldSphere, few=3),
    "pair of spheres": _sized(*SIZES[2:6], made=partial(pair, share=0.4, larger=2.0)),
    "pair of spheres, bonded": _sized(
        *SIZES[:4], made=partial(pair, share=0.4, counter_poisson=0.45, larger=3.0), grip="bonded", few=3
    ),
    "block under a sphere": _sized(*SIZES[2:6], made=_elements_under_sphere, truth=_half_space_under),
    "finite strain": _finite_strain(),
    "mesh from a file": Family(
        Net([_mesh("hemisphere", 1.0, 30.0), _mesh("hemisphere", 2.0, 100.0), _mesh("sphere", 1.0, 100.0)], [1e-3]),
        Net([_mesh("hemisphere", 1.0, 30.0)], [1e-3]),
        _by(fem_adhesion.trace),
        of_path,
        partial(relocated, _ours),
    ),
    "curve, half-space": Family(
        Net((0.05, 0.3, 0.75, 1, 2, 5), _decades(2, 4, 6, 8)),
        Net((0.3, 2), _decades(3)),
        _by(halfspace.trace),
        of_curve,
        partial(beside, truths.half_space),
        anew=True,
    ),
    "curve, finite strain": replace(
        _finite_strain(),
        full=Net([_sphere(0.3, 30, material=NeoHookean()), _sphere(1, 100, material=NeoHookean(0.45))], _decades(3, 4)),
        quick=Net([], []),
        numbers=of_curve,
        truth=partial(beside, truths.along_at_finite_strain),
        anew=True,
    ),
    "curve, block": Family(
        Net(tuple(map(_block, (0.05, 0.3, 1, 2, 5))), _decades(2, 3, 4, 5)),
        Net(tuple(map(_block, (0.05, 2))), _decades(3)),
        _by(fem_adhesion.trace),
        of_curve,
        partial(beside, _half_space_of),
        anew=True,
    ),
    "springs, half-space": Family(
        Net((0.05, 0.3, 0.75, 1, 2, 5, 20), _decades(2, 4, 6, 8)),
        Net((0.3, 2), _decades(3, 6)),
        _by(halfspace.trace),
        of_springs,
        partial(sprung, truths.half_space),
    ),
    "springs, block": Family(
        Net(tuple(map(_block, (0.05, 0.3, 1, 2, 5))), _decades(2, 3, 4, 5)),
        Net((_block(1),), _decades(3)),
        _by(fem_adhesion.trace),
        of_springs,
        partial(sprung, _half_space_of),
    ),
    "springs, sphere's profile": Family(
        Net(((0.3, 30), (1, 6), (2, 100)), _decades(2, 4, 6, 8)),
        Net(((2, 100),), _decades(4)),
        _under_sphere,
        of_springs,
        partial(sprung, _stages_under_sphere),
    ),
    "springs, hemisphere": Family(
        Net(SLIDING, _decades(3, 5)),
        Net(SLIDING[:1], _decades(4)),
        _by(fem_adhesion.trace),
        of_springs,
        partial(sprung, truths.harmonics),
    ),
    "states, half-space": Family(
        Net((0.05, 0.3, 0.75, 1, 2, 5), _decades(2, 4, 6, 8)),
        Net((0.3, 2), _decades(3)),
        _by(halfspace.trace),
        of_states,
        partial(at_places, truths.half_space),
        anew=True,
    ),
    "states, hemisphere": Family(
        Net(SLIDING, _decades(3, 5)),
        Net(SLIDING[:1], _decades(3)),
        _by(fem_adhesion.trace),
        of_states,
        partial(at_places, truths.harmonics),
        anew=True,
    ),
    "curve, hemisphere": Family(
        Net(SLIDING, _decades(3, 5)),
        Net(SLIDING[1:2], _decades(3, 4)),
        _by(fem_adhesion.trace),
        of_curve,
        partial(beside, truths.harmonics),
        anew=True,
    ),
    "assess": Family(
        Net((_silica(), _silica(radius=20e-9, modulus=3e9, poisson=0.4), _silica(radius=1e-6, stiffness=20.0)), [0.0]),
        Net((_silica(radius=5e-9),), [0.0]),
        _assess,
        of_assessment,
        assessed,
    ),
}


# Judging --------------------------------------------------------------------------------------------------------------


def judged(item):
    """All numbers of one scene of a family, at all tolerances, the seconds that took, and what was refused.

    Scenes that are drawn may be such as no grid carries; of others none may be refused.
    """
    began = time.process_time()
    name, scene, rtols = item
    family, answers, refused = FAMILIES[name], {}, []
    for rtol in rtols:
        try:
            answers[rtol] = family.solve(scene, rtol)
        except (InputError, NotConverged) as why:
            if not callable(family.full.scenes):
                raise
            refused.append(f"{_briefly(scene)} at rtol {rtol:g}: {why}")
    shared = None if family.anew or not answers else family.truth(scene, answers[min(answers)])
    numbers = []
    for rtol, answer in answers.items():
        rough, best = shared or family.truth(scene, answer)
        numbers += _judged(family.numbers(answer), rough, best, scene, rtol)
    return numbers, time.process_time() - began, refused


def _judged(numbers, rough, best, scene, rtol):
    """Each number beside its truth; one that the truth lacks, or has beyond them, is held by no estimate."""
    for what in numbers.keys() | {w for w, v in best.items() if math.isfinite(v) and w != "zero_load load"}:
        told, truth = numbers.get(what, Estimate(math.nan, 0.0)), best.get(what, math.nan)
        error, known = abs(told.value - truth), abs(truth - rough.get(what, math.nan))
        lost = not math.isfinite(error)
        yield Judged(
            f"{what} of {_briefly(scene)} at rtol {rtol:g}", told.error, math.inf if lost else error, known, abs(truth)
        )


def _briefly(scene):
    """Show of a scene or contact what is not as usual."""
    if not is_dataclass(scene):
        return scene
    usual = {f.name: f.default for f in fields(scene)}
    return ", ".join(f"{n} = {getattr(scene, n)}" for n in usual if getattr(scene, n) != usual[n])


@dataclass(frozen=True)
class Row:
    """What the table says of a family."""

    name: str
    numbers: Sequence[Judged]
    seconds: float
    refused: Sequence[str] = ()

    @property
    def outside(self):
        """Numbers that their estimates do not hold, the worst first."""
        return sorted((n for n in self.numbers if not n.held), key=lambda n: n.estimate / max(n.error, 1e-300))

    @property
    def shares(self):
        """Parts of the numbers that are held, and close; none of no numbers."""
        return tuple(sum(getattr(n, k) for n in self.numbers) / max(len(self.numbers), 1) for k in ("held", "close"))

    def honest(self, net):
        """Whether both shares are what they should be; of a few numbers one may lie outside.

        What two tolerances give alike, since one grid serves both, is one number.
        """
        numbers, outside = ({n.alike for n in some} for some in (self.numbers, self.outside))
        few = len(outside) <= max(1, int((1 - HELD) * len(numbers)))
        return few and self.shares[1] >= CLOSE[net]


def rows_of(net, names=tuple(FAMILIES), jobs=None, seed=0):
    """Rows of the families as each is done, in the order in which they end."""
    nets = {name: getattr(FAMILIES[name], net) for name in names}
    scenes = {name: nets[name].of(seed) for name in names}
    items = [(name, scene, nets[name].rtols) for name in names for scene in scenes[name]]
    done = {name: [] for name in names}
    with progress_bar() as told:
        for k, (item, result) in enumerate(stream(judged, items, jobs=jobs), start=1):
            told(item[0], k, len(items))
            done[item[0]].append(result)
            if len(done[item[0]]) == len(scenes[item[0]]):
                numbers, seconds, refused = zip(*done[item[0]], strict=True)
                yield Row(item[0], list(chain(*numbers)), sum(seconds), list(chain(*refused)))


HEAD = f"{'family':22}{'numbers':>8}{'within':>9}{'within 100 times':>18}{'CPU s':>8}"
MOST_SHOWN = 5


def printed(row):
    """One row, and the worst of its numbers that lie outside."""
    held, close = row.shares
    print(f"{row.name:22}{len(row.numbers):8}{held:9.1%}{close:18.1%}{row.seconds:8.0f}", flush=True)
    for n in row.outside[:MOST_SHOWN]:
        print(f"    {n.error:.1e}, estimated as {n.estimate:.1e}: {n.what}", flush=True)
    for why in row.refused:
        print(f"    refused: {why}", flush=True)
    return row


def main(arguments=None):
    """Run both tables; 1 if a family is not honest or two solvers contradict each other."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="half a minute's part")
    parser.add_argument("--seed", type=int, help="of the scenes that are drawn; a new one unless given")
    parser.add_argument("--families", nargs="+", metavar="FAMILY", default=list(FAMILIES), choices=list(FAMILIES))
    asked = parser.parse_args(arguments)
    net = "quick" if asked.quick else "full"
    seed = secrets.randbelow(10**6) if asked.seed is None else asked.seed
    print(f"{HEAD}    seed {seed}", flush=True)
    dishonest = [row.name for row in rows_of(net, asked.families, seed=seed) if not printed(row).honest(net)]
    agreed = side_by_side.searched(net, seed)
    if net == "full":
        agreed &= combinations.compared(seed)
    print(
        f"not honest: {', '.join(dishonest) or 'none'}; both solvers {'agree' if agreed else 'contradict each other'}"
    )
    return 0 if agreed and not dishonest else 1


if __name__ == "__main__":
    from honesty import main as run  # under its own name, which other processes know it by

    sys.exit(run())
