"""The finite-element load-approach curve to an accuracy asked for: a ladder of meshes, degrees and block sizes."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np
from skfem import ElementQuadP

from fem_adhesion.bodies import sized, user_mesh
from fem_adhesion.elasticity import far_field
from fem_adhesion.elasticity.condensation import condense
from fem_adhesion.elasticity.incompressible import stiffness_for
from fem_adhesion.elasticity.space import Space
from fem_adhesion.finite_strain import scene as finite_strain_scene
from fem_adhesion.mesh.block import graded_breaks, tensor_grid
from fem_adhesion.scene import Scene
from halfspace.accuracy.refinement import MOST_RUNGS, Charted, Charts, Rung, climb
from halfspace.accuracy.trace import rings, widened, widest_radius
from halfspace.elastic import grid
from halfspace.elastic.compliance import to_infinity
from halfspace.elastic.operators import Homogeneous
from halfspace.equilibrium.contact import ContactProblem, spike_width
from halfspace.equilibrium.curve import COMPRESSION, Chart, EquilibriumPath
from halfspace.limits import require_load, require_rtol

FAR_FIELDS = {"point_load": far_field.point_load, "clamped": far_field.clamped, "free": far_field.free}

# Ratio of the block's radii on two successive rungs. The load left out beyond a block that goes on as a half-space
# falls as L^-4: a decade. Held blocks err by O(1/L): half the change from L/3 to L exceeds the error at L.
LARGER = {"point_load": 10**0.25, "clamped": 3.2, "free": 3.2}


@dataclass(frozen=True)
class Resolution:
    """How finely the block is discretised.

    Attributes
    ----------
    degree : int
        Of the quadrilateral elements; the error falls about a decade a degree.
    finest : float
        Length of the cells at the contact edge, in widths of the spike of tension there.
    growth : float
        Ratio of neighbouring cells.
    radius : float
        Size of the block in beta.
    """

    degree: int
    finest: float
    growth: float
    radius: float


def trace(scene: Scene, *, rtol: float = 1e-5, to_load: float = COMPRESSION) -> EquilibriumPath:
    """Trace the load-approach curve of a scene by finite elements and solve for its events.

    Parameters
    ----------
    scene : Scene
        The contact.
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-9 to 1e-1; of approaches, which have no natural zero, in
        parts of eps and the range of those of all events.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.

    Returns
    -------
    EquilibriumPath
        The curve and its events. Of a block, their error estimates add the change by a higher degree and by a larger
        block, that is, they are distances from the half-space, not from the block; of another body they are the change
        by a higher degree, beside that from other cells if it is bonded or held over a cap, of a user's mesh that by a
        finer one. Points of the curve, and the states between them, are
        solved for anew when they are asked for, see `EquilibriumPath.at`.

    Raises
    ------
    InputError
        If an input is out of range, a mesh file is no body, or the contact grows wider than its body.
    halfspace.errors.NotConverged
        If the curve cannot be traced.
    """
    rtol, to_load = require_rtol(rtol), require_load(to_load)
    if scene.strain == "finite":
        return finite_strain_scene.trace(scene, rtol, to_load)
    if isinstance(scene.body, Path):
        return user_mesh.trace(scene, rtol, to_load)
    if scene.sized:
        return climb(rtol, partial(sized.ladder, scene, rtol, to_load), to_load=to_load)
    most_rungs = MOST_RUNGS if scene.radius is None else 1
    return climb(rtol, partial(ladder, scene, rtol, to_load), to_load=to_load, most_rungs=most_rungs)


def ladder(scene: Scene, rtol: float, to_load: float, level: int) -> Rung:
    """Rung of a level: first the degree of the rung below on a larger block, then one degree more."""
    above, below = (resolution_for(scene, rtol, max(n, 0)) for n in (level, level - 1))
    wider = Resolution(below.degree, below.finest, below.growth, above.radius)
    stages = (wider, above) if level else ()
    charted = tuple(Charted(block_charts(scene, stage, to_load)) for stage in stages)
    curve = partial(block_charts, scene, above, to_load)
    # A block of given size is compared with one other size only, and if both are small most of the error is left.
    return Rung(curve, charted, asdict(above), remaining=1.0 if scene.radius is None else 2.0)


def resolution_for(scene: Scene, rtol: float, level: int) -> Resolution:
    """Resolution of a level, whose events are right to about `rtol` at level 0 and a decade better at each above it."""
    degree = int(np.clip(np.ceil(-np.log10(rtol)), 3, 9)) + level
    larger = LARGER[scene.far_field]
    if scene.radius is None:
        radius = size_for(scene.tabor, rtol) * larger**level
    else:
        radius = scene.radius if level else scene.radius / larger
    return Resolution(degree, finest=0.6, growth=2.5, radius=float(radius))


def size_for(tabor: float, rtol: float) -> float:
    """Size in beta of a block whose far field, that of a point load, leaves errors of rtol in the events."""
    return float(2.5 * min(rtol, 0.01) ** -0.25 * widened(tabor) / np.sqrt(tabor))


def block_charts(scene: Scene, resolution: Resolution, to_load: float = COMPRESSION) -> Charts:
    """Charts of the scene's block.

    A block continued by a half-space has no length of its own, so its mesh may follow the contact edge; one that is
    clamped or free has, and needs a mesh that is fine wherever the edge passes.
    """
    if scene.far_field != "point_load":
        return (_fixed_chart(scene, resolution, to_load),)
    lines = rings(scene.tabor, resolution.finest, resolution.growth, resolution.radius * np.sqrt(scene.tabor), to_load)
    return (
        _chart(scene, lines.centred, resolution, until=lines.until),
        _chart(scene, lines.edge, resolution, follows_contact=True),
    )


def _fixed_chart(scene: Scene, resolution: Resolution, to_load: float) -> Chart:
    widest = widest_radius(scene.tabor, to_load)
    fine = resolution.finest * spike_width(scene.tabor) / 2
    return _chart(scene, graded_breaks(fine, min(widest, resolution.radius / 2), resolution.radius), resolution)


def _chart(
    scene: Scene, r_breaks: np.ndarray, resolution: Resolution, *, until: float = np.inf, follows_contact: bool = False
) -> Chart:
    """Condense the block whose cells have these radii, graded in depth from the finest of them."""
    depths = grid.graded(0.0, np.diff(r_breaks).min(), r_breaks[-1], growth=resolution.growth)
    space = Space(tensor_grid(r_breaks, depths), ElementQuadP(resolution.degree))
    stiffness = stiffness_for(scene.poisson)
    body = condense(space, scene.poisson, far_field=FAR_FIELDS[scene.far_field], stiffness=stiffness)
    operator = to_infinity(body.operator, resolution.degree + 1) if scene.far_field == "point_load" else body.operator
    problem = ContactProblem(Homogeneous(operator) if follows_contact else operator, scene.tabor)
    return Chart(problem, body.unknowns, until)
