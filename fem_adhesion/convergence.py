"""The finite-element load-approach curve to an accuracy asked for: ladders of meshes, degrees and sizes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from fem_adhesion.bodies.body import MOST_RINGS, Discretisation
from fem_adhesion.discretise import ELEMENTS, Discretised, discretise, size_for, sized_body
from fem_adhesion.elasticity.elimination import DISSECTED
from fem_adhesion.mesh.file import chords, read_scaled
from fem_adhesion.scene import Scene, require_scene
from halfspace.accuracy import stages as ladders
from halfspace.accuracy.finite_bodies import Made
from halfspace.accuracy.grids import GRIDS, Resolution, half_space_charts
from halfspace.accuracy.refinement import MOST_RUNGS, climb
from halfspace.accuracy.stages import Charted, Charts, Rung, charted
from halfspace.accuracy.standing import Standing, left_between, sized, standing
from halfspace.elastic.compliance import to_infinity
from halfspace.equilibrium.charts import COMPRESSION, Chart
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import ErrorRule
from halfspace.errors import GridTooCoarse
from halfspace.limits import require_load, require_rtol
from halfspace.values import Array


def trace(scene: Scene, *, rtol: float = 1e-5, to_load: float = COMPRESSION) -> EquilibriumPath:
    """Trace the load-approach curve of a scene by finite elements and solve for its events.

    Parameters
    ----------
    scene : Scene
        The contact.
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-9 to 0.1; of approaches, which have no natural zero, in
        parts of eps and the range of those of all events.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.

    Returns
    -------
    EquilibriumPath
        The curve and its events. Of a half-space, their error estimates add the change by a higher degree and by a
        larger block, or from two smaller ones to one that is given: they are distances from the half-space, not from
        the block. Of another body they are the change by a higher degree, beside that from other cells if it is bonded
        or held over a cap, or the tension ends by a step, of a user's mesh that by a finer one. Points of the curve,
        and the states between them, are solved for anew when they are asked for, see `EquilibriumPath.at`.

    Raises
    ------
    InputError
        If an input is out of range, or a mesh file is no body.
    halfspace.errors.NotConverged
        If the curve cannot be traced; as ContactTooWide if the contact grows wider than its body.
    """
    require_scene(scene)
    try:
        return _traced(scene, require_rtol(rtol), require_load(to_load))
    finally:
        DISSECTED.clear()  # up to 0.3 GB


def _traced(scene: Scene, rtol: float, to_load: float) -> EquilibriumPath:
    """Trace by the ladder that suits the body."""
    if scene.material.finite:
        from fem_adhesion.finite_strain import scene as finite_strain_scene  # it takes time to load, and few need it

        return finite_strain_scene.trace(scene, rtol, to_load)
    if scene.body.file:
        return _trace_on_given_mesh(scene, scene.body.file, rtol, to_load)
    rung = sized_ladder(scene, rtol, to_load) if scene.sized else partial(ladder, scene, rtol, to_load)
    most_rungs = MOST_RUNGS if scene.sized or scene.body.cut_off is None else 1
    return climb(rtol, rung, to_load=to_load, most_rungs=most_rungs)


# A half-space without a length, as a block


def ladder(scene: Scene, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level: first the degree of the rung below on a larger block, then one degree more.

    A block of given size is compared with a second smaller one, between these.
    """
    (above, size), (below, _) = (resolution_for(scene, rtol, max(n, 0)) for n in (level, level - 1))
    block, given = partial(discretised_block, scene, to_load), scene.body.cut_off
    settings = {name: getattr(above, name) for name in ("degree", "finest", "growth")} | {"radius": size}
    curve, *stages = block(above, size)
    if not scene.body.endless:  # traced on the whole, which carries contacts that a smaller one does not
        how, whole = Discretisation(ELEMENTS.curve_degree + level), given or size
        curve, _ = block(how, whole)
        settings |= {"curve_degree": how.degree, "curve_radius": whole}
    if level:
        # Where both sizes are small a number may be alike on them by accident, which a third, between them, tells.
        sizes = (size / math.sqrt(_larger(scene)), size) if given else (size,)
        stages = [*(block(below, each)[1] for each in sizes), *stages]
    # What a clamp and what the attraction beyond it change may cancel: with 1 approaches were up to 1.5 times outside.
    rule = ErrorRule(1.0 if scene.body.endless else 2.0)
    return Rung(curve, tuple(stages), settings, rule=rule)


def resolution_for(scene: Scene, rtol: float, level: int) -> tuple[Discretisation, float]:
    """Discretisation of a level, and the size of the block in beta.

    Events are right to about `rtol` at level 0 and a decade better at each above it. A block of given size is that of
    level 1.
    """
    degree = int(np.clip(np.ceil(-np.log10(rtol)), 3, 9)) + level
    larger, size = _larger(scene), scene.body.cut_off
    if size is None:
        return Discretisation(degree), size_for(scene.scales, rtol) * larger**level
    return Discretisation(degree), size * larger ** (level - 1)


def _larger(scene: Scene) -> float:
    return ELEMENTS.larger_endless if scene.body.endless else ELEMENTS.larger_held


def discretised_block(scene: Scene, to_load: float, how: Discretisation, size: float) -> ladders.Discretised:
    """Charts for the curve, and the stage for events, of the scene's block of a size in beta.

    A block continued by a half-space has no length of its own, so that one mesh may follow the contact edge; one that
    is clamped or free has, and is discretised as any body with a length.
    """
    if scene.body.endless:
        return charted(block_charts(scene, how, size, to_load))
    body = replace(sized_body(scene, how, to_load), outer=np.array([size]), planned=size / 2)
    return sized(body, how.degree + 2)


def block_charts(scene: Scene, how: Discretisation, radius: float, to_load: float) -> Charts:
    """Charts of the scene's block of a size in beta, continued by a half-space: the half-space's by other operators."""
    extent = np.sqrt(2 * scene.tabor * float(scene.surface.height(np.array(radius))))

    def with_infinite_cell(_: int, reach: float, lines: Array) -> Made:
        made = discretise(scene, lines, how)
        return to_infinity(made.operator, how.degree + 1, reach), made.unknowns

    resolution = Resolution(how.degree + 2, how.finest, how.growth, extent)
    charts = half_space_charts(scene.scales, resolution, to_load=to_load, make=with_infinite_cell)
    return tuple(replace(chart, leave=np.inf) for chart in charts)  # an event stays on the chart on which it was found


# Bodies with a length


def sized_ladder(scene: Scene, rtol: float, to_load: float) -> Callable[[int], Rung]:
    """Rungs by level: the events on elements of a degree that suits the tolerance, one more on each level.

    What a degree more does not tell other cells do, a twin; see `fem_adhesion.bodies.body.Known`. A tension that ends
    by a step does so at one place of a cell, for both degrees: numbers erred by up to fifty times their estimate.
    """
    stage = cache(partial(_standing, scene, to_load))  # that of a rung is the coarser one two rungs above
    body, step = scene.body, ELEMENTS.by_step if scene.scales.step_gap else 1.0
    # Where a degree gains little the lowest takes half of the time; elsewhere estimates were twice as wide by it.
    lowest = degree_for(rtol, least=3 if scene.scales.step_gap else 4)
    rule = ErrorRule(
        step * ELEMENTS.remaining,
        parts=(GRIDS.before, 1.0),
        along=True,
        steps=scene.scales.steps,
        beyond=scene.tension_beyond,
    )

    def rung(level: int) -> Rung:
        degree = lowest + level
        degrees = degree, degree - 1, degree - 2, ELEMENTS.curve_degree + level
        how, below, coarser, curve = map(with_rings, degrees)
        twin = replace(below, finest=GRIDS.twin[0] * below.finest, growth=GRIDS.twin[1] * below.growth)
        return Rung(
            sized_body(scene, curve, to_load).curve,
            (stage(how),),
            asdict(how) | {"curve_degree": curve.degree},
            stage(twin) if level and (body.other_cells or scene.scales.step_gap) else None,
            stage(coarser) if level else None,
            rule,
        )

    return rung


def _standing(scene: Scene, to_load: float, how: Discretisation) -> Standing:
    return standing(sized_body(scene, how, to_load), left_between(how.degree + 2))


def degree_for(rtol: float, least: int = 4) -> int:
    """Degree of the elements on the lowest rung."""
    more = np.ceil(np.log(ELEMENTS.fourth / rtol) / np.log(ELEMENTS.per_degree) - 1e-9)
    return int(np.clip(4 + more, least, 8))


def with_rings(degree: int) -> Discretisation:
    """Discretisation whose rings leave less than its degree does."""
    return Discretisation(degree, rings=min(degree - 2, MOST_RINGS))


# A mesh that is given


def _trace_on_given_mesh(scene: Scene, file: Path, rtol: float, to_load: float) -> EquilibriumPath:
    """Trace on a mesh and once cut finer; raise GridTooCoarse in the file's unit if it does not carry the spike."""
    mesh, unit = read_scaled(file)
    _require_smooth(mesh, unit, scene, rtol)
    try:
        return climb(rtol, partial(mesh_ladder, scene, unit), to_load=to_load, most_rungs=1)
    except GridTooCoarse as error:
        raise _in_the_files_unit(error, scene, unit) from error


def _require_smooth(mesh: Any, unit: float, scene: Scene, rtol: float) -> None:
    """Refuse straight lines of a contact that leave its smooth line by more than the tolerance of the gap there."""
    (r, z), off = chords(mesh)
    limit = rtol * (1 / scene.body.size - z)
    if np.all(off <= limit):
        return
    worst = int(np.argmax(off / limit))
    where = [float(values[worst]) for values in (r, off, limit)]
    place, found, most = (unit * value for value in where)
    raise GridTooCoarse(
        f"mesh {scene.body.file}: straight cells leave the smooth line of the contact by {found:.2g} at "
        f"r = {place:.3g}, in the file's unit, limit {most:.2g} for radius_ratio {scene.body.size:g}, rtol {rtol:g}; "
        "mesh it in second order (Gmsh: Mesh.ElementOrder = 2), or finer there",
        *(scene.sphere_radius * value for value in where),
    )


def mesh_ladder(scene: Scene, unit: float, level: int) -> Rung:
    """Rung of a level: the mesh, each cell cut into four as often as the level says, with quadratic elements."""
    made = on_given_mesh(scene, level)
    charts = (Chart(made.problem, made.unknowns),)
    settings = {"mesh": str(scene.body.file), "pole_radius": unit, "degree": QUADRATIC.degree, "refined": level}
    return Rung(partial(tuple, charts), (Charted(charts),) if level else (), settings, rule=ErrorRule(1.0))


QUADRATIC = Discretisation(2)


def on_given_mesh(scene: Scene, times_refined: int = 0) -> Discretised:
    """The mesh, each cell cut into four so many times."""
    return discretise(scene, np.empty(0), replace(QUADRATIC, refined=times_refined))


def _in_the_files_unit(error: GridTooCoarse, scene: Scene, unit: float) -> GridTooCoarse:
    R = scene.sphere_radius
    radius, length, limit = (value / R * unit for value in (error.radius, error.length, error.limit))
    return GridTooCoarse(
        f"mesh {scene.body.file}: lines of the contact are {length:.3g} long at r = {radius:.3g}, in the file's unit, "
        f"limit {limit:.3g} for tabor {scene.tabor:g} and radius_ratio {scene.radius_ratio:g}; mesh it finer there "
        f"(in the recipes of meshes/: fine = {_rounded_down(limit):.2g}, or a smaller growth beyond the fine part), or "
        "take a smaller tabor or radius_ratio",
        *(error.radius, error.length, error.limit),
    )


def _rounded_down(length: float) -> float:
    """Two digits and a little less, as Gmsh exceeds the size it is given by some per cents."""
    scale = 10.0 ** (math.floor(math.log10(length)) - 1)
    return math.floor(0.97 * length / scale) * scale
