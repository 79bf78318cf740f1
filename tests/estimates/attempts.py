"""The hard cases: contacts, bodies and meshes that are hard for the solvers, and what must be refused.

A curve is held against one that shares no grid with it, or is two decades tighter; a single state of the half-space
against the curve on a finer grid.
"""

import math
from functools import partial

import numpy as np
import truths
from families import by_elements, by_integral, of_path, of_random, relocated, sphere
from hard import Case, Locking, Measured, Refusal
from references import charted_rung, deflection_error, taylor_hood
from scipy.optimize import minimize_scalar
from skfem import ElementQuadP, ElementTriP1, ElementTriP2, ElementTriP3, MeshTri

import fem_adhesion
import halfspace
from fem_adhesion import Block, HalfSpace, Scene
from fem_adhesion.common.fold_birth import FIRST, SECOND, approached, at_gap, count_folds, tabor_of
from fem_adhesion.elasticity.cells import Cells, projected_stiffness
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.space import Space
from fem_adhesion.mesh.block import block_grid, graded_size, quarter_disc, tensor_grid, with_named_boundaries
from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.accuracy.refinement import climb
from halfspace.elastic import grid
from halfspace.equilibrium import newton
from halfspace.equilibrium.charts import Chart, metric_for, trace_charts, transfer
from halfspace.equilibrium.conditions import ROUND_OFF, Condition, locate
from halfspace.equilibrium.contact import APPROACH, CENTRAL_GAP, LOAD, ContactProblem
from halfspace.equilibrium.path import Steps
from halfspace.equilibrium.search import find_events
from halfspace.errors import GridTooCoarse, InputError, NotConverged
from halfspace.profiles import Sphere
from halfspace.scales import Scales
from halfspace.values import Estimate

GRID = 1e-6  # tolerance of the grids on which single states are solved for, and so their error
TIGHTER, HALF_SPACE = "two decades tighter", "half-space"


def steps_of(path):
    """Newton steps taken along a curve."""
    return sum(point.iterations for segment in path.segments for point in segment.points)


def curves(path, truth, reference):
    """Loads and approaches of a curve's events, of which a tolerance is asked, against those of another."""
    ours, theirs = (
        {what: n for what, n in of_path(one).items() if what.endswith((" load", " approach"))} for one in (path, truth)
    )
    return Measured(ours, theirs, reference, steps_of(path))


def against_tighter(scene, *, rtol=1e-4, solve=by_elements):
    """Trace a scene, and again two decades tighter."""
    return curves(solve(scene, rtol), solve(scene, max(rtol / 100, 1e-9)), TIGHTER)


def against_half_space(scene, *, rtol=1e-4, alone=None):
    """Trace a scene by finite elements, and the same contact, or another, on the half-space."""
    other = by_integral(alone or Scene(scene.tabor, profile=scene.profile), max(rtol / 100, 1e-9))
    return curves(by_elements(scene, rtol), other, HALF_SPACE)


def traced(tabor, *, rtol=1e-6):
    """Trace a curve on the half-space, and again two decades tighter, or else on other grids."""
    if rtol > 1e-8:
        return against_tighter(Scene(tabor), rtol=rtol, solve=by_integral)
    path = halfspace.trace(tabor, rtol=rtol)
    truth = relocated(truths.half_space_of, Scene(tabor), path)
    return Measured(of_path(path), truth, "other grids", steps_of(path))


def compressed(trace, scene, load, rtol):
    """Trace to a large load; the state there and the events against a tighter curve."""
    path, truth = (trace(scene, rtol=tolerance, to_load=1.1 * load) for tolerance in (rtol, rtol / 100))
    asked = [("load", "contact", load)]
    return Measured(of_random(path, asked), of_random(truth, asked), TIGHTER, steps_of(path))


def located_birth(birth):
    """Find the Tabor parameter at which a pair of folds is born, on three grids."""
    coarse, fine, truth = (tabor_of(birth, rtol=rtol) for rtol in (1e-5, 1e-7, 1e-9))
    return Measured({"tabor": Estimate(fine, abs(fine - coarse))}, {"tabor": Estimate(truth, 0.0)}, TIGHTER)


def near_birth(birth, offset, folds):
    """Trace a curve whose folds are about to merge or to be born; it is wrong if their number is."""
    path, truth = (halfspace.trace(tabor_of(birth) + offset, rtol=rtol) for rtol in (1e-4, GRID))
    found = curves(path, truth, TIGHTER)
    found.numbers["folds"], found.truth["folds"] = Estimate(count_folds(path), 0.5), Estimate(folds, 0.0)
    return found


def long_steps(tabor, factor):
    """Trace a curve with first and longest step `factor` times too long: it must meet the same events."""
    charts, usual = half_space_charts(Scales(tabor), resolution_for(Scales(tabor), GRID)), Steps()
    segments = trace_charts(charts, steps=Steps(first=factor * usual.first, longest=factor * usual.longest))
    found, expected = (
        {name: float(event.point.observables[LOAD]) for name, event in find_events(some).items()}
        for some in (segments, trace_charts(charts))
    )
    taken = sum(point.iterations for segment in segments for point in segment.points)
    numbers = {f"{name} load": Estimate(load, 10 * ROUND_OFF) for name, load in found.items()}
    return Measured(numbers, {f"{n} load": Estimate(v, 0.0) for n, v in expected.items()}, "usual steps", taken)


# Newton's method from where it is hard: single states of the half-space on the grid that stands still


def centred(tabor, rtol=GRID):
    return half_space_charts(Scales(tabor), resolution_for(Scales(tabor), rtol))[0].problem


def states_at(tabor, rtol, approach):
    """States of a curve at an approach."""
    curve = trace_charts(half_space_charts(Scales(tabor), resolution_for(Scales(tabor), rtol)))
    condition, metric = Condition(APPROACH, value=approach), metric_for(curve[0].problem)
    return [state for part in curve for state in locate(part.problem, part.points, metric, condition)]


def nearest(problem, solution, loads):
    """Hold a state against the nearest of some loads, if its grid can carry it at all."""
    problem.require_resolution(solution.x)
    load = float(solution.observables[LOAD])
    truth = min(loads, key=lambda other: abs(other - load))
    number = {"load": Estimate(load, GRID * (1 + abs(load)))}
    return Measured(number, {"load": Estimate(float(truth), 0.0)}, "curve on a finer grid", solution.iterations)


def from_state(tabor, approach, start=None, gap=None):
    """Start Newton's method at an approach from surfaces with one gap, or from the last state at another approach."""
    problem = centred(tabor).interface
    if start is None:
        x = problem.undeformed(approach)
        x[:-2] = gap
    else:
        found = states_at(tabor, GRID, start)[-1]
        x = transfer(found.problem, found.point.x, problem)
    solution = newton.solve(problem, x, newton.approach(approach))
    return nearest(problem, solution, [s.point.observables[LOAD] for s in states_at(tabor, GRID / 100, approach)])


def tangent_spring(stiffer, start, tabor=2.0, gaps=(0.25, 0.45)):
    """Solve under a spring whose load line hugs the curve where it is straightest, from a central gap nearby.

    Between the `gaps` dW/d(alpha*) has a minimum, and a negative one; at a stiffness of 1, in that, three solutions are
    one, which Newton's method meets at a crawl.
    """
    problem = centred(tabor).interface
    x = approached(problem, gaps[1])

    def slope(gap):
        rates = at_gap(problem, x, gap).rates
        return float(rates[LOAD] / rates[APPROACH])

    touch = minimize_scalar(slope, bounds=gaps, method="bounded", options={"xatol": 1e-6})
    at, stiffness = at_gap(problem, x, touch.x).observables, -stiffer * touch.fun
    control = newton.spring(stiffness, at[APPROACH] + at[LOAD] / stiffness)
    solution = newton.solve(problem, at_gap(problem, x, start).x, control)
    finer, gap = centred(tabor, GRID / 100), float(solution.observables[CENTRAL_GAP])
    return nearest(problem, solution, [at_gap(finer, approached(finer, gap), gap).observables[LOAD]])


# Badly shaped meshes: a curve on elements of two degrees and blocks of two sizes


def on_meshes(mesh, elements, tabor=1.0, rtol=1e-2):
    def charts(length, element):
        body = condense(Space(mesh(length), element), 0.3)
        return (Chart(ContactProblem(body.operator, tabor), body.unknowns),)

    def rung(level):
        if level == 0:
            return charted_rung(charts(20.0, elements[0]))
        return charted_rung(charts(40.0, elements[0]), charts(40.0, elements[1]))

    return curves(climb(rtol, rung, most_rungs=1), halfspace.trace(tabor, rtol=rtol / 100), HALF_SPACE)


def stretched(aspect):
    """Cells that are `aspect` times as wide as deep all along the surface."""

    def mesh(length):
        depths = grid.graded(0.0, 0.15 / aspect, length, until=0.15 / aspect)
        return tensor_grid(grid.graded(0.0, 0.15, length, until=2.5), depths)

    return on_meshes(mesh, (ElementQuadP(3), ElementQuadP(4)))


def obtuse(angle):
    """Triangles of which one, where the contact edge passes, has an angle near pi."""

    def mesh(length):
        return flattened(quarter_disc(length, graded_size(0.15, 2.5, 0.3)), 1.0, angle)

    return on_meshes(mesh, (ElementTriP2(), ElementTriP3()))


def flattened(mesh, radius, angle):
    """Press the triangle that rests on the surface at a radius flat, until its angle below is as given."""
    surface = mesh.facets[:, mesh.boundaries["contact"]]
    base = surface[:, np.argmin(np.abs(mesh.p[0, surface].mean(axis=0) - radius))]
    cell = mesh.t[:, np.isin(mesh.t, base).sum(axis=0) == 2]
    points, (a, b) = mesh.p.copy(), mesh.p[0, base]
    points[:, np.setdiff1d(cell, base)] = np.array([[(a + b) / 2], [-abs(b - a) / 2 / np.tan(angle / 2)]])
    return with_named_boundaries(MeshTri(points, mesh.t))


def too_coarse(factor, tabor=2.0):
    """Trace a curve on a mesh coarser by a factor than the spike of tension at the contact edge allows."""
    element = ElementQuadP(3)
    fine = factor * 0.1 * tabor**-2 * (element.facet_dofs + 2)
    lines = [grid.graded(0.0, fine, 20.0, until=until) for until in (2.5, fine)]
    body = condense(Space(tensor_grid(*lines), element), 0.3)
    trace_charts((Chart(ContactProblem(body.operator, tabor), body.unknowns),))


# Locking


def locking(poissons=(0.3, 0.45, 0.49, 0.499, 0.4999)):
    """How displacement elements lock on fixed meshes, without and with a remedy."""
    triangles, cells = quarter_disc(50.0, graded_size(0.125, 2.0, 0.2)), block_grid(0.3, 3.0, 50.0)
    for poisson in poissons:
        space = Space(triangles, ElementTriP2())
        mixed = taylor_hood(space, poisson, ElementTriP1())
        plain = condense(space, poisson).operator
        yield Locking(poisson, "P2", "Taylor-Hood P2-P1", deflection_error(plain), deflection_error(mixed))
        for degree in (3, 4, 6):
            space = Space(cells, ElementQuadP(degree))
            K = projected_stiffness(Cells.of(space), poisson)
            remedied = condense(space, poisson, stiffness=lambda K=K: [(range(len(K)), K)]).operator
            errors = (deflection_error(one) for one in (condense(space, poisson).operator, remedied))
            yield Locking(poisson, f"Q{degree}", "projected dilatation", *errors)


# The cases


def block(tabor, rtol=1e-3, **of_block):
    """Scene that may be refused where it is made."""
    return against_half_space(Scene(tabor, Block(**of_block)), rtol=rtol)


def rubber(poisson):
    return against_half_space(Scene(1.0, HalfSpace(poisson=poisson)), rtol=1e-5)


def hemisphere(tabor=1.0, radius_ratio=100.0, poisson=0.3):
    return against_tighter(sphere(tabor, radius_ratio, poisson=poisson))


def to_load(load):
    return halfspace.trace(1.0, to_load=load)


SOLVED = {
    "tabor 0.005": partial(traced, 0.005),
    "tabor 0.02, compressed to 20 R dgamma": partial(compressed, halfspace.trace, 0.02, 20.0, GRID),
    "tabor 0.02 to load 20, finite elements": partial(compressed, fem_adhesion.trace, Scene(0.02), 20.0, 1e-4),
    "tabor 50": partial(traced, 50.0),
    "tabor 100": partial(traced, 100.0),
    "tabor 50, finite elements": lambda: against_half_space(Scene(50.0), rtol=1e-3),
    "critical tabor": partial(located_birth, FIRST),
    "critical tabor - 1e-4: no fold": partial(near_birth, FIRST, -1e-4, 0),
    "critical tabor + 1e-4: two folds": partial(near_birth, FIRST, 1e-4, 2),
    "birth of a second pair of folds": partial(located_birth, SECOND),
    "second birth - 1e-4: two folds": partial(near_birth, SECOND, -1e-4, 2),
    "second birth + 1e-4: four folds": partial(near_birth, SECOND, 1e-4, 4),
    "start from contact, far left of jump_off": partial(from_state, 2.0, -9.0, -3.0),
    "steps 100 times too long, tabor 2": partial(long_steps, 2.0, 100.0),
    "steps 100 times too long, tabor 20": partial(long_steps, 20.0, 100.0),
    "spring 1 % softer than that": partial(tangent_spring, 0.99, 0.6),
    "spring 1 % stiffer than that": partial(tangent_spring, 1.01, 0.2),
    **{f"poisson {poisson:g}": partial(rubber, poisson) for poisson in (0.49, 0.499, 0.4999, 0.499999)},
    "cells of aspect ratio 100": partial(stretched, 100.0),
    "angle of 170 degrees at the contact edge": partial(obtuse, math.radians(170)),
    "block of 5.5 beta": partial(block, 1.0, radius=5.5),
    "clamped block of 20 beta": partial(block, 1.0, radius=20.0, far_field="clamped"),
    "free block of 20 beta": partial(block, 1.0, radius=20.0, far_field="free"),
    "block of 1e9 beta": partial(block, 1.0, radius=1e9),
    "sphere of R/eps 1e12": lambda: against_half_space(sphere(1.0, 1e12), alone=Scene(1.0)),
    "half-space under a sphere of R/eps 3": lambda: against_half_space(Scene(1.0, profile=Sphere(3.0))),
    "sphere as small as its contact, R = 1.5 beta": partial(hemisphere, radius_ratio=2.25),
    "rubber sphere, poisson 0.4999": partial(hemisphere, poisson=0.4999),
    "sphere at tabor 6": partial(hemisphere, 6.0),
    "rigid sphere, tabor 1e-9": partial(hemisphere, 1e-9),
    "tabor 1e-12": partial(traced, 1e-12),
    "tabor 300": partial(traced, 300.0),
    "tabor 1e-12, finite elements": lambda: against_half_space(Scene(1e-12)),
    "rtol 1e-9": partial(traced, 1.0, rtol=1e-9),
    "rtol 1e-1": partial(traced, 1.0, rtol=1e-1),
}
LOST = Refusal(NotConverged, "last relative step", "40 Newton steps", "try a nearer start")
RIGID = "1e-12 <= tabor", "halfspace.theories.closed_forms.bradley_load"
SOFT = "tabor <= 300", "halfspace.theories.closed_forms.jkr_load"
RTOL, LOAD_LIMIT = ("1e-9 <= rtol <= 0.1", "take 1e-5"), ("0 < to_load <= 1000", "take 5")
FINER, LARGER = "refine the grid there", "take 50 or more"
SIZE = "2 <= radius_ratio <= 1e12", "it is the radius over the spacing: change one of the two"
REFUSED = {  # what is attempted, and the class, value, limit and remedy of the refusal
    "start with gaps of 0.8 eps": (partial(from_state, 2.0, -3.0, gap=-0.2), *LOST),
    "start with gaps of 0.01 eps": (partial(from_state, 2.0, -3.0, gap=-0.99), *LOST),
    "start from separation, right of jump_on": (partial(from_state, 2.0, 0.0, -9.0), *LOST),
    "start from contact, just left of jump_off": (partial(from_state, 2.0, -3.6, -3.0), *LOST),
    "contact on cells that are fine on the axis": (
        partial(from_state, 2.0, -3.0, -3.0),
        GridTooCoarse, "spacing 0.202 beta", "exceeds 0.175 beta for tabor 2", FINER,
    ),
    "mesh too coarse by ten": (
        partial(too_coarse, 10.0),
        GridTooCoarse, "spacing 0.208 beta", "exceeds 0.084 beta for tabor 2", FINER,
    ),
    "clamped block of 7 beta, tabor 1": (
        partial(block, 1.0, radius=7.0, far_field="clamped"), InputError, "radius = 7", "8 <", LARGER,
    ),
    "block of 5.5 beta, tabor 0.02": (partial(block, 0.02, radius=5.5), InputError, "radius = 5.5", "35.4 <", LARGER),
    "block of 1e300 beta": (partial(block, 1.0, radius=1e300), InputError, "radius = 1e+300", "<= 1e9", LARGER),
    "poisson 0.49999999": (partial(rubber, 0.49999999), InputError, "0.49999999", "<= 0.499999", "take 0.4999"),
    "sphere of R/eps 1e13": (partial(hemisphere, radius_ratio=1e13), InputError, "= 1e+13", *SIZE),
    "sphere of R/eps 1": (partial(hemisphere, radius_ratio=1.0), InputError, "= 1 is", *SIZE),
    "sphere of R/eps nan": (partial(hemisphere, radius_ratio=math.nan), InputError, "= nan", *SIZE),
    "sphere smaller than its contact": (
        partial(hemisphere, 50.0),
        InputError, "radius_ratio = 100", "2.25 tabor = 112 or more", "take a stiffer or larger one",
    ),
    "tabor 1e-300": (partial(traced, 1e-300), InputError, "tabor = 1e-300", *RIGID),
    "tabor 1e12": (partial(traced, 1e12), InputError, "tabor = 1e+12", *SOFT),
    "tabor 1e300": (partial(traced, 1e300), InputError, "tabor = 1e+300", *SOFT),
    "rtol 1e-10": (partial(traced, 1.0, rtol=1e-10), InputError, "rtol = 1e-10", *RTOL),
    "rtol 1": (partial(traced, 1.0, rtol=1.0), InputError, "rtol = 1 is", *RTOL),
    "load nan": (partial(to_load, math.nan), InputError, "to_load = nan", *LOAD_LIMIT),
    "load 1e9": (partial(to_load, 1e9), InputError, "to_load = 1e+09", *LOAD_LIMIT),
}  # fmt: skip
CASES = (
    *(Case(name, attempt) for name, attempt in SOLVED.items()),
    *(Case(name, attempt, (Refusal(*refusal),)) for name, (attempt, *refusal) in REFUSED.items()),
    Case("spring tangent to third order", partial(tangent_spring, 1.0, 0.6), (LOST,), solvable=True),
)
