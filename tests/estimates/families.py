"""Families of scenes, as data: how each is solved, which of its numbers are judged, and what their truth is.

The truth of events and points is on grids of `truths`, which share neither a grading nor an interpolation with those of
the curve; that of states, of jumps under a spring and of random scenes is a curve at a tighter tolerance.
"""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import drawing
import numpy as np
import truths
from drawing import number, one_of
from judging import Family, Net
from scenes import pair

import fem_adhesion
import fem_adhesion.bodies.layers as bodies
import halfspace
from fem_adhesion import HalfSpace, HeldSphere, Hemisphere, Meshed, NeoHookean, Scene
from fem_adhesion.assess.study import assess
from fem_adhesion.common.contact import Contact
from fem_adhesion.crosscheck import scenes as crosscheck
from halfspace import Coated, Layer, Layers, Stratum
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Power, RoundedPunch, Sphere
from halfspace.values import Estimate

MESHES = Path(__file__).parents[2] / "meshes"

# Numbers of an answer


def of_path(path):
    """Events and energy."""
    found = {f"{name} {q}": _estimate(event, q) for name, event in path.events.items() for q in OBSERVABLES}
    return _real(found | {"energy": path.energy})


def _estimate(event, quantity):
    return Estimate(float(getattr(event, quantity)), float(getattr(event, f"{quantity}_error")))


def _real(numbers):
    """Numbers that exist, or are told to be open, but for the load that is zero by definition."""
    told = {what: n for what, n in numbers.items() if math.isfinite(n.value) or n.error == math.inf}
    return {what: n for what, n in told.items() if what != "zero_load load"}


def of_springs(path, stiffnesses=(1e-6, 1e-2, 1.0, math.inf)):
    """Jumps with apparatus of several stiffnesses, where there are any."""
    found = {}
    for k in stiffnesses:
        if both := cycle(path, k):
            for jump in ("jump_on", "jump_off"):
                for end in ("take_off", "landing"):
                    where, at = f"k = {k:g}, {jump} {end}", getattr(getattr(both, jump), end)
                    found |= {f"{where} {q}": _estimate(at, q) for q in OBSERVABLES}
            found |= {f"k = {k:g}, energy lost": both.energy_lost, f"k = {k:g}, energy": both.jump_on.energy}
    return _real(found)


def of_curve(path):
    """Every second point."""
    columns = [(q, getattr(path, q), getattr(path, f"{q}_error")) for q in OBSERVABLES]
    every_second = range(0, path.count, 2)
    return _real({f"point {k} {q}": Estimate(float(v[k]), float(e[k])) for q, v, e in columns for k in every_second})


def places(path, parts=(0.02, 0.3, 0.8), coordinates=("approach", "load", "central_gap")):
    """Coordinate, branch and value of states on all branches but those that another tolerance may not have."""
    return [
        (coordinate, branch, low + part * (high - low))
        for coordinate in coordinates
        for branch, (low, high) in path.branches(coordinate).items()
        for part in parts
        if high - low > 0.05
    ]


def of_states(path, asked=None):
    """What `path.at` says at some places; those that the curve does not have are left out."""
    found = {}
    for coordinate, branch, value in places(path) if asked is None else asked:
        try:
            state = path.at(**{coordinate: value}, branch=branch)
        except InputError:
            continue
        where = _where(coordinate, branch, value)
        found |= {f"{q} {where}": _estimate(state, q) for q in OBSERVABLES if q != coordinate}
    return _real(found)


def _where(coordinate, branch, value):
    return f"at {coordinate} {value:.6g} on {branch}"


def of_random(path, asked=None):
    """Events, energy, and a state on every branch."""
    return of_path(path) | of_states(path, few_places(path) if asked is None else asked)


few_places = partial(places, parts=(0.4,), coordinates=("approach", "load"))


def of_assessment(assessment):
    """What the computed models say in SI."""
    models = [m for m in assessment.models if m.source != "theory"]
    return {f"{m.model}, {what}": Estimate(q.value, q.error) for m in models for what, q in m.values.items()}


def of_comparison(case, bad=("inconclusive", "disagree")):
    """The rows of a comparison, and why it failed, each as 1 if that is bad, else 0."""
    rows = {f"{row.quantity}, {row.verdict}": Estimate(float(row.verdict in bad), 0.0) for row in case.rows}
    return rows | ({case.reason: Estimate(1.0, 0.0)} if case.reason else {})


# Their truths


def _true(found):
    return [(w, v) for w, v in found.items() if math.isfinite(v) and w != "zero_load load"]


def by_two(pairs):
    """Truth by the second of two grids, known to its change from the first; of a contact that one lacks nothing is."""
    rough, best = (dict(_true(found)) for found in pairs)
    lacking = {w: Estimate(math.nan, math.inf) for w in best.keys() ^ rough.keys() if "contact_radius" in w}
    return {w: Estimate(v, abs(v - rough.get(w, math.nan))) for w, v in best.items()} | lacking


def traced(stages, scene, *_):
    """Events of the curve that is traced anew on the first stage."""
    return by_two(map(truths.of_state, truths.traced(stages(scene))))


def relocated(stages, scene, path, _=None):
    """Events, from where they are on the curve."""
    return by_two(map(truths.of_state, truths.relocated(path.stages[-1], stages(scene))))


def along(stages, scene, path, _):
    """The same points of a curve, in the plane across the path."""
    return by_two(truths.points_on(stage, path, range(0, path.count, 2)) for stage in stages(scene))


def tighter(numbers, asked, solve, scene, path, rtol):
    """Numbers of the same curve at a tighter tolerance, at the places that are asked of this one.

    Where it cannot be told whether there are folds, or the load turns more often on a curve of a tighter tolerance,
    what only one of both has does not count.
    """
    other = solve(scene, max(rtol / 100, 1e-9))
    found, own = numbers(other, asked(path)) if asked else numbers(other), numbers(path)
    if found.keys() == own.keys() and not any(" at load " in what for what in found):
        return found  # whether the load turns more often, which takes the points on the finest grid, changes nothing
    alike = path.branches("load").keys() == other.branches("load").keys()
    if not alike:
        found = {what: n for what, n in found.items() if " at load " not in what}
    if not alike or any(p.unconfirmed or p.jumps is None for p in (path, other)):
        found = {w: found.get(w, Estimate(own[w].value, math.inf)) for w in own}
    return found


def any_scene(scene, path, rtol):
    """Of a half-space and what stands for one, as a block, the curve is traced anew; others' events are found again."""
    return traced(truths.of, scene) if truths.endless(scene) else relocated(truths.of, scene, path, rtol)


def found_again(drawn, path, _=None):
    """Events and states of a drawn scene, from where they are on the curve, on grids that share nothing with those."""
    places = {_where(*place): place for place in few_places(path)}
    states = {where: truths.state_of(path, *place) for where, place in places.items()}
    pairs = truths.relocated(path.stages[-1] | states, truths.of(drawn.scene))
    return by_two(truths.of_state(found) | _of_places(found, places) for found in pairs)


def _of_places(found, places):
    told = {where: truths.numbers(found[where]) for where in places}
    return {f"{q} {where}": told[where][q] for where, (given, *_) in places.items() for q in OBSERVABLES if q != given}


def in_si(contact, assessment, _):
    """Events and jumps of each model's curve at a tighter tolerance, in SI by formulas of our own."""
    E, R, dgamma, eps = contact.units.modulus, contact.radius, contact.work_of_adhesion, contact.spacing
    beta, k, found = (R**2 * dgamma / E) ** (1 / 3), contact.stiffness / (R * dgamma / eps), {}
    tabor, rho = contact.units.tabor, contact.units.radius_ratio
    solved = {
        "half-space": lambda: halfspace.trace(tabor, rtol=1e-9),
        "true profile": lambda: halfspace.trace(tabor, profile=Sphere(rho), rtol=1e-9),
        "finite sphere": lambda: fem_adhesion.trace(sphere(tabor, rho, poisson=contact.poisson), rtol=1e-6),
    }
    for model in (m.model for m in assessment.models if m.source != "theory"):
        path = solved[model]()
        both, pull_off = cycle(path, k), path.event("pull_off")
        told = {
            "pull_off_force": (-pull_off.load * R * dgamma, pull_off.load_error * R * dgamma),
            "pull_off_radius": (pull_off.contact_radius * beta, pull_off.contact_radius_error * beta),
            "zero_load_radius": (path.event("zero_load").contact_radius * beta, 0.0),
            "energy_lost": (both.energy_lost.value * R * dgamma * eps, both.energy_lost.error * R * dgamma * eps),
        }
        for name in ("jump_on", "jump_off"):
            off = getattr(both, name).take_off
            told[f"{name}_separation"] = (1 - off.approach) * eps, off.approach_error * eps
            told[f"{name}_base"] = (off.approach + off.load / k) * eps, (off.approach_error + off.load_error / k) * eps
        found |= {f"{model}, {what}": Estimate(*number) for what, number in told.items()}
    return found


# Scenes


def sphere(tabor, radius_ratio, body=Hemisphere, **of_body):
    return Scene(tabor, body(radius_ratio=radius_ratio, **of_body))


def elements_under_sphere(tabor, radius_ratio, poisson):
    return Scene(tabor, HalfSpace(poisson=poisson), Sphere(radius_ratio))


def mesh(name, tabor, radius_ratio):
    return Scene(tabor, Meshed(MESHES / f"{name}.msh", radius_ratio=radius_ratio))


def body_of_mesh(scene):
    """The body of ours that a mesh file is of."""
    body = {"hemisphere": Hemisphere, "sphere": HeldSphere}[scene.body.file.stem]
    return truths.elements(sphere(scene.tabor, scene.radius_ratio, body))


def tip(half_angle, rows, end, radius_ratio):
    """Blunted cone by a table of so many rows, up to so many radii of its apex."""
    r = np.linspace(0, end, rows)
    table = np.stack([r, Hyperboloid(1 / math.tan(math.radians(half_angle))).height(r)], axis=1)
    with TemporaryDirectory() as folder:
        np.savetxt(Path(folder, "tip.csv"), table, delimiter=",", header="r,z", comments="")
        return halfspace.profiles.Tabulated(Path(folder, "tip.csv"), radius_ratio)


def silica(**changes):
    usual = {"radius": 100e-9, "modulus": 72e9, "poisson": 0.17, "work_of_adhesion": 0.063, "spacing": 0.14e-9}
    return Contact(**(usual | {"stiffness": 0.2} | changes))


def by_integral(scene, rtol):
    """Curve of what `halfspace.trace` is given of a scene."""
    return halfspace.trace(**scene.for_half_space, rtol=rtol)


def by_elements(scene, rtol):
    return fem_adhesion.trace(scene, rtol=rtol)


def by_triangles(scene, rtol):
    return halfspace.trace(scene.tabor, kernel="triangles", rtol=rtol)


def under_tip(scene, rtol):
    tabor, *of_tip = scene
    return halfspace.trace(tabor, profile=tip(*of_tip), rtol=rtol)


def compared(scene, rtol):
    (case,) = crosscheck.run([scene], rtol=rtol)
    return case


class BySolvers(NamedTuple):
    """A scene, and the tolerances of the half-space and of the finite elements."""

    scene: Scene
    rtol: float
    fe_rtol: float

    def __str__(self):
        return f"{self.scene} at rtol {self.rtol} and {self.fe_rtol}"


def for_both_solvers(random):
    """Half-space of any Tabor parameter and tolerances, its Poisson's ratio anywhere and near either end."""
    near = 0.5 * number(random, 2e-6, 1)
    poisson = one_of(random, lambda: 0.0, lambda: round(random.uniform(0, 0.49), 3), lambda: near, lambda: 0.5 - near)
    scene = Scene(number(random, 0.02, 30), HalfSpace(poisson=min(poisson, 0.499999)))
    return BySolvers(scene, number(random, 1e-9, 0.1), number(random, 1e-6, 0.1))


class Line(NamedTuple):
    """A call of `halfspace.trace`, as a line of Python in which the tolerance is left open, and the one asked for."""

    text: str
    rtol: float

    def __str__(self):
        return self.text.format(rtol=self.rtol)

    def solved(self, part):
        """What it gives at a tighter tolerance, in parts of its own; the names are those of the package's parts."""
        names = {"halfspace": halfspace, "inf": math.inf}
        for room in (halfspace, halfspace.laws, halfspace.profiles):
            names |= {name: getattr(room, name) for name in room.__all__}
        return eval(self.text.format(rtol=max(part * self.rtol, 1e-9) if part < 1 else self.rtol), names)


class Drawn(NamedTuple):
    """A scene for the elements and the tolerance asked for."""

    scene: Scene
    rtol: float

    def __str__(self):
        return f"fem_adhesion.trace({self.scene!r}, rtol={self.rtol})"


def half_space_line(random):
    asked = drawing.on_half_space(random)
    tabor, rtol = asked.pop("tabor"), asked.pop("rtol")
    parts = ", ".join(f"{name}={value!r}" for name, value in asked.items() if value not in (None, 5.0))
    return Line(f"halfspace.trace({tabor}, {parts}, rtol={{rtol}})", rtol)


def elements_drawn(random):
    scene = drawing.of_elements(random)
    return Drawn(scene, number(random, 1e-4 if scene.material.finite else 1e-6, 1e-1))


USUAL = (0.02, 0.1, 0.3, 0.5, 0.65, 0.75, 1, 1.5, 2, 3, 5, 8, 20, 50)
BETWEEN = (0.05, 0.2, 0.4, 0.6, 0.69, 0.696, 0.6975, 0.7, 0.72, 0.8, 0.9, 1.2, 2.5, 3.5, 3.9, 4, 4.1, 4.5, 6, 10, 15)
SIZES = ((0.05, 10), (0.3, 10), (0.3, 300), (1, 6), (1, 30), (1, 1000), (2, 100), (5, 30))
POISSONS = (0, 0.3, 0.45, 0.499)
ON_PROFILE = tuple(Scene(tabor, profile=Sphere(ratio)) for tabor, ratio in (*SIZES, (10, 100), (2, 10)))
SLIDING = sphere(1, 30, poisson=0.3), sphere(0.3, 30), sphere(2, 100, poisson=0.45)
TIPS = (
    (1.0, 60, 100, 3, 100.0),
    (0.3, 60, 100, 3, 30.0),
    (0.3, 20, 300, 5, 30.0),
    (2.0, 70, 200, 4, 100.0),
    (1.0, 45, 60, 3, 30.0),
    (5.0, 30, 150, 4, 300.0),
)
PLIES = Stratum(0.3, 0.3), Stratum(1.0, 0.45, 0.2), Stratum(0.5, 0.3, 3.0)
LAYERED = tuple(
    Scene(tabor, fem_adhesion.Layers(body.strata, body.base))
    for tabor, body in (
        (1.0, Layer(2.0, 0.3)),
        (5.0, Coated(1.0, 10.0, 0.4, 0.3)),
        (0.1, Layer(0.1, 0.4999)),
        (0.75, Layer(20.0, 0.3, "sliding")),
        (2.0, Coated(0.2, 0.05, 0.3, 0.2)),
        (2.0, Layers(PLIES)),
        (20.0, Layer(3.0, 0.45)),
    )
)
COATED = (
    Scene(1.0, fem_adhesion.Coated(2.0, 10.0)),
    Scene(1.0, fem_adhesion.Coated(0.5, 100.0)),
    Scene(2.0, fem_adhesion.Coated(0.5, 0.01, 0.0, poisson=0.499)),
    Scene(1.0, fem_adhesion.Layers(PLIES)),
    Scene(0.5, fem_adhesion.Layers(PLIES, "sliding")),
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
AT_FINITE_STRAIN = tuple(
    sphere(tabor, ratio, material=material, **more)
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
) + tuple(
    replace(sphere(tabor, ratio, material=NeoHookean()), law=Dugdale(width))
    for tabor, ratio, width in ((1, 30, 0.2), (1, 100, 0.2), (0.7, 40, 0.25))
)
STEPPED = (replace(sphere(3.2, 1290.0, poisson=0.45), law=Dugdale(0.232)),)
BEADS = (
    silica(),
    silica(radius=20e-9, modulus=3e9, poisson=0.4),
    silica(radius=1e-6, stiffness=20.0),
    silica(radius=5e-9),
)
MESHED = mesh("hemisphere", 1.0, 30.0), mesh("hemisphere", 2.0, 100.0), mesh("sphere", 1.0, 100.0)
RUBBER, ON_OIL = HalfSpace(poisson=0.4999), bodies.Layer(0.5, "sliding")
TOGETHER = (  # laws, profiles and bodies that are hard together, for `compare`
    Scene(1.0, law=PowerLaw(2.1, 2.5)),
    Scene(0.5, law=PowerLaw(20, 60)),
    Scene(5.0, law=Morse(0.3)),
    Scene(0.2, law=Morse(20)),
    Scene(1e-6, law=Morse(3)),
    Scene(0.05, law=Exponential(3)),
    Scene(3.0, law=Dlvo(-0.5, 0.3)),
    Scene(2.0, RUBBER, law=Dlvo(0.3, 1.0)),
    Scene(2.0, RUBBER, law=Morse(3)),
    Scene(1.0, profile=Power(1.5)),
    Scene(0.1, profile=Power(10)),
    Scene(3.0, profile=Power(3)),
    Scene(1.0, profile=Hyperboloid(1)),
    Scene(0.3, RUBBER, profile=Power(6)),
    Scene(1.0, law=PowerLaw(4, 10), profile=Power(10)),
    Scene(1.0, law=Dlvo(0.3, 1.0), profile=Power(4)),
    Scene(1.0, law=PowerLaw(3.5, 9.5), profile=Hyperboloid(0.3)),
    Scene(1.0, law=Exponential(0.5, 4), profile=Power(3)),
    Scene(1.0, law=Morse(3), profile=Power(1.5)),
    Scene(1.0, law=Morse(3), profile=Sphere(30)),
    Scene(2.0, law=PowerLaw(2.5, 9.5), profile=Sphere(10)),
    Scene(0.5, law=Exponential(3), profile=Sphere(3)),
    Scene(1.0, bodies.Layer(0.05)),
    Scene(1.0, bodies.Layer(2.0), law=Morse(3)),
    Scene(1.0, bodies.Layer(100.0), law=Dlvo(0.3, 1.0)),
    Scene(3.0, bodies.Layer(1.0, poisson=0.45), law=PowerLaw(4, 10)),
    Scene(1.0, ON_OIL, profile=Power(1.5)),
    Scene(1.0, bodies.Layer(1.0, poisson=0.4999), profile=Power(4)),
    Scene(0.3, bodies.Layer(5.0, poisson=0.0), law=Exponential(3), profile=Power(3)),
    Scene(0.5, ON_OIL, law=PowerLaw(2.5, 9.5), profile=Power(4)),
    # Of forty drawn at random, those that did not agree before
    Scene(3.5, bodies.Layers([Stratum(2.3, 0.2), Stratum(0.9, 0.37, 0.5), Stratum(0.36, 0.47, 0.24)], "sliding"),
          RoundedPunch(0.6)),
    Scene(7.0, HalfSpace(poisson=0.45), profile=RoundedPunch(0.4)),
    Scene(9.6, HalfSpace(poisson=0.499), law=Morse(1.8)),
    Scene(7.0, bodies.Layer(0.9, "sliding", poisson=0.0), law=Morse(0.9), profile=Hyperboloid(0.7)),
    Scene(4.6, HalfSpace(poisson=0.0), law=Exponential(3.5, 12), profile=Hyperboloid(2.5)),
    Scene(1.0, bodies.Coated(thickness=1.0, modulus_ratio=5.0), profile=Hyperboloid(5.0)),
    Scene(1.7, bodies.Coated(3.6, 36.0, 0.45, poisson=0.0), profile=RoundedPunch(1.0), law=PowerLaw(4.1, 10.4)),
    Scene(0.97, bodies.Coated(72.6, 55.6, poisson=0.0), law=Dugdale(0.36)),
    Scene(0.377, bodies.Coated(1.45, 0.088, 0.0, poisson=0.4999), Sphere(755), law=Dlvo(0.16, 4.12)),
    Scene(0.562, bodies.Layer(3.76, "sliding", poisson=0.47), Hyperboloid(1.79), law=Dlvo(-0.03, 4.73)),
    Scene(1.53, bodies.Layer(0.0653, poisson=0.14), Power(5.31), law=Dugdale(0.338)),
    Scene(0.441, bodies.Coated(19.3, 0.461, 0.4999, poisson=0.4999), Hyperboloid(0.526), law=Dugdale(0.169)),
    Scene(0.898, bodies.Layer(0.199, poisson=0.42), RoundedPunch(0.246), law=Dlvo(0.05, 1.03)),
    Scene(0.531, bodies.Coated(0.0861, 0.0122, 0.4999, poisson=0.0), Power(2.37), law=Exponential(1.44, 8)),
    Scene(8.2, bodies.Layers([Stratum(1.86, 0.14), Stratum(3.5, 0.43, 0.443)], "sliding"), Hyperboloid(1.92),
          law=Morse(1.85)),
)  # fmt: skip


def at(scenes, *decades):
    """Scenes, or Tabor parameters of half-spaces, at tolerances of so many digits."""
    if callable(scenes):
        return Net(scenes, [10.0**-n for n in decades])
    return Net([one if isinstance(one, Scene | tuple) else Scene(one) for one in scenes], [10.0**-n for n in decades])


def drawn(draw, count):
    return partial(drawing.several, draw, count=count)


def events(full, quick, solve, truth):
    return Family(full, quick, solve, of_path, truth)


def sized(*sizes, made=sphere, truth=truths.elements, few=1, **more):
    """Family of bodies of some sizes, each with another Poisson's ratio; `few` is the place of a quick one, or None."""
    scenes = [made(*size, poisson=POISSONS[n % 4], **more) for n, size in enumerate(sizes)]
    quick = at(scenes[few : few + 1] if few else (), 4)
    return events(at(scenes, 4, 5, 6), quick, by_elements, partial(relocated, truth))


def states(full, quick, solve):
    return Family(full, quick, solve, of_states, partial(tighter, of_states, places, solve), anew=True)


def springs(full, quick, solve):
    return Family(full, quick, solve, of_springs, partial(tighter, of_springs, None, solve), anew=True)


def curve(full, quick, solve, stages):
    return Family(full, quick, solve, of_curve, partial(along, stages), anew=True)


def by_compare(full, **bad):
    def none(_, case, __):
        return dict.fromkeys(of_comparison(case), Estimate(0.0, 0.0))

    return Family(full, Net([], []), compared, partial(of_comparison, **bad), none, share=1.0)


half_space = truths.half_space_of


def profile(scene):
    return truths.under_sphere(scene.tabor, scene.radius_ratio)


def stages_under_tip(scene):
    tabor, *of_tip = scene
    return truths.under_surface(tabor, tip(*of_tip).surface(tabor))


new_half_space, on_layers = partial(traced, half_space), partial(relocated, truths.layered)
FE, HS = by_elements, by_integral
FAMILIES = {
    "half-space": events(
        at((*USUAL, *BETWEEN, 30, 70, 100), *range(1, 10)), at((0.05, 0.75, 5), 2, 5, 8), HS, new_half_space
    ),
    "triangles": events(at((*USUAL[:12], *BETWEEN), *range(1, 7)), at((0.75, 3), 3, 5), by_triangles, new_half_space),
    "block": events(
        at((*USUAL[:12:2], 0.1, 0.69, 0.7, 0.8, 3, 4, 7, 10, 20), *range(1, 8)),
        at((0.1, Scene(1, HalfSpace(poisson=0.499)), 3), 2, 4),
        FE,
        new_half_space,
    ),
    "sphere's profile": events(
        at(ON_PROFILE, *range(1, 10)),
        at((Scene(0.3, profile=Sphere(30)), ON_PROFILE[6]), 2, 6),
        HS,
        partial(relocated, profile),
    ),
    "laws and profiles": events(
        at(LAWS_AND_PROFILES, *range(2, 9)), at(LAWS_AND_PROFILES[:2], 3, 6), HS, new_half_space
    ),
    "tips from tables": events(
        at(TIPS, *range(2, 10)), at(TIPS[:1], 3, 6), under_tip, partial(relocated, stages_under_tip)
    ),
    "layers": events(at(LAYERED, *range(2, 8)), at(LAYERED[0:5:4], 3, 5), HS, on_layers),
    "layers, drawn": events(
        at(drawn(drawing.on_layers, 12), 2, 4, 6), at(drawn(drawing.on_layers, 1), 4), HS, on_layers
    ),
    "layers by elements": events(at(COATED, *range(2, 6)), at(COATED[3:4], 3, 5), FE, on_layers),
    "elements, drawn": events(
        at(drawn(drawing.of_elements, 12), 2, 4, 6), at(drawn(drawing.of_elements, 1), 3), FE, any_scene
    ),
    "hemisphere, sliding": sized(
        (0.2, 10), (0.2, 100), (1, 10), (1, 30), (1, 100), (2, 30), truth=truths.harmonics, few=3
    ),
    "hemisphere, bonded": sized(*SIZES, grip="bonded", few=3),
    "held sphere": sized(*SIZES[:4], body=HeldSphere, few=None),
    "pair of spheres": sized(*SIZES[2:6], made=partial(pair, share=0.4, larger=2.0), few=None),
    "pair of spheres, bonded": sized(
        *SIZES[:4], made=partial(pair, share=0.4, counter_poisson=0.45, larger=3.0), grip="bonded", few=None
    ),
    "block under a sphere": sized(*SIZES[2:6], made=elements_under_sphere, truth=profile, few=None),
    "steps within a cell": events(at(STEPPED, 4, 5), at((), 4), FE, partial(relocated, truths.elements)),
    "finite strain": events(
        at(AT_FINITE_STRAIN, 3, 4, 5), at(AT_FINITE_STRAIN[:1], 3), FE, partial(relocated, truths.finite_strain)
    ),
    "mesh from a file": events(at(MESHED, 3), at((), 3), FE, partial(relocated, body_of_mesh)),
    "curve, half-space": curve(at((0.05, 0.3, 0.75, 1, 2, 5), 2, 4, 6, 8), at((0.3, 2), 3), HS, half_space),
    "curve, finite strain": curve(
        at((*AT_FINITE_STRAIN[:2], AT_FINITE_STRAIN[-1]), 3, 4), at((), 3), FE, truths.along_at_finite_strain
    ),
    "curve, block": curve(at((0.05, 0.3, 1, 2, 5), 2, 3, 4, 5), at((0.05, 2), 3), FE, half_space),
    "curve, hemisphere": curve(at(SLIDING, 3, 5), at(SLIDING[1:2], 3), FE, truths.harmonics),
    "springs, half-space": springs(at((0.05, 0.3, 0.75, 1, 2, 5, 20), 2, 4, 6), at((0.3, 2), 6), HS),
    "springs, block": springs(at((0.05, 0.3, 1, 2, 5), 2, 3, 4), at((1,), 3), FE),
    "springs, sphere's profile": springs(at(ON_PROFILE[2:7:2], 2, 4, 6), at(ON_PROFILE[6:7], 4), HS),
    "springs, hemisphere": springs(at(SLIDING, 3, 4), at((), 4), FE),
    "states, half-space": states(at((0.05, 0.3, 0.75, 1, 2, 5), 2, 4, 6), at((0.3, 2), 3), HS),
    "states, hemisphere": states(at(SLIDING, 3, 4), at((), 3), FE),
    "assess": Family(Net(BEADS, [0.0]), Net(BEADS[-1:], [0.0]), lambda bead, _: assess(bead), of_assessment, in_si),
    "both solvers": events(
        at(drawn(for_both_solvers, 60), 0),
        at(drawn(for_both_solvers, 2), 0),
        lambda both, _: HS(both.scene, both.rtol),
        lambda both, _, __: of_path(FE(both.scene, both.fe_rtol)),
    ),
    "half-space, random": Family(
        at(drawn(half_space_line, 60), 0),
        at(drawn(half_space_line, 2), 0),
        Line.solved,
        of_random,
        partial(tighter, of_random, few_places, Line.solved),
        patience=60,
    ),
    "elements, random": Family(
        at(drawn(elements_drawn, 30), 0), at((), 0), lambda one, _: FE(*one), of_random, found_again, patience=60
    ),
    "compare": by_compare(at(TOGETHER, 4)),
    "compare, drawn on layers": by_compare(at(drawn(drawing.on_layers, 12), 4), bad=("disagree",)),
}
