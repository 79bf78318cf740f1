"""What a picture of the body shows: the part of it near the contact, its heights magnified, under the wall.

Lengths are in beta. A height of beta^2/R, the unit of gaps times mu and of displacement, is drawn as `View.heights`:
the undeformed surface, the vertical displacement and the gap are magnified alike, so that the deformed sphere is as
flat as its wall where they touch, and the rigid sphere as round as the dent it leaves. Radii are true.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fem_adhesion.fields.state import State
from fem_adhesion.paraview.lattice import cut_for
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.values import Array, Index, Valued

TOLERANCE = 1e-2
"""Largest error of the stress as drawn, of its maximum."""

WIDER = 1.7
"""Radius of what is shown, in that of the widest contact."""

STEEPEST = 0.5
"""Height of the undeformed sphere at the rim of what is shown, of that radius, as drawn."""

TO_SCALE = 2.0
"""Magnification of true heights below which they are not magnified at all."""

WHOLE = 0.8
"""Part of a body's radius from which on the whole of it is shown, if to scale."""

DEEP = 0.6
"""Depth of what is shown under the rim of the surface, of the radius shown."""

STRONGEST = 1.0
"""Stress in E* beta/R at the ends of the colours at most: under a stiff spike the rest would be pale."""

_QUARTERS = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])
_HALVES = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
LINEAR = {9: _QUARTERS, 6: _HALVES}
"""Linear cells into which those of a section are cut, by their nodes."""


@dataclass(frozen=True)
class View:
    """What is shown, of all states of a curve alike.

    Attributes
    ----------
    reach, depth, top : float
        Radius, depth under the pole and height of the wall over it, in beta.
    heights : float
        In beta, what a height of beta^2/R is drawn as.
    limit : float
        Stress at the ends of the colours in E* beta/R.
    """

    reach: float
    depth: float
    top: float
    heights: float
    limit: float


@dataclass(frozen=True, eq=False, repr=False)
class Section(Valued):
    """Meridian section of the body.

    Attributes
    ----------
    points : (2, n) array
        Radius and height as drawn.
    cells : (m, 3 or 4) int array
        Triangles or quadrilaterals.
    stress : (n,) array
        Vertical stress in E* beta/R, tension positive.
    """

    points: Array
    cells: Index
    stress: Array


@dataclass(frozen=True, eq=False, repr=False)
class Surfaces(Valued):
    """Lines (2, n) of radius and height as drawn: the body's surface, undeformed and deformed, and the wall."""

    undeformed: Array
    deformed: Array
    wall: Array


def view_of(states: Sequence[State]) -> View:
    """View in which all states can be seen, of one scene.

    Parameters
    ----------
    states : sequence of State
        The states, or those that bound them: the widest contact with them.
    """
    first = states[0]
    widest = np.nanmax([first.scene.tabor**-0.5, *(state.observables[CONTACT_RADIUS] for state in states)])
    end, R = float(first.radii[-1]), first.scene.sphere_radius
    reach = min(WIDER * float(widest), end)
    heights = STEEPEST * reach / float(first.problem.profile.height(np.array([reach]))[0])
    to_scale = heights * R < TO_SCALE
    if to_scale:
        heights = 1 / R
        reach = end if reach > WHOLE * end else reach
    depth = heights * float(_own_height(first, np.array([reach]))[0]) + DEEP * reach
    if to_scale:
        depth = min(depth, -float(first.space.mesh.p[1].min()))
    largest = max(float(np.abs(state.pressure).max()) for state in states)
    top = max(float(surfaces(state, reach, heights).wall[1].max()) for state in states)
    return View(reach, depth, top, heights, min(STRONGEST, largest))


def section(state: State, view: View) -> Section:
    """Section of the whole body as a view draws it."""
    cut = cut_for(state.space, state.stress, TOLERANCE)
    u_r, u_z = cut.values(state.components)
    r, z = cut.points
    scene, own = state.scene, _own_height(state, r)
    moved = view.heights * (u_z - own) + (own / scene.sphere_radius if own.any() else 0.0)
    cells = cut.cells
    linear = cells[:, LINEAR[cells.shape[1]]]
    stress = cut.values(state.stress)[1]
    return Section(np.stack([r + u_r / scene.sphere_radius, z + moved]), linear.reshape(-1, linear.shape[2]), stress)


def surfaces(state: State, reach: float, heights: float) -> Surfaces:
    """Lines of the surfaces out to a radius in beta, with beta^2/R of height drawn as `heights` in beta."""
    functions = state.space.boundary_functions("contact")
    u_r, u_z = (state.surface.values @ state.components[:, functions].T).T
    r, own = state.radii, _own_height(state, state.radii)
    levels = np.array([-own, u_z - own, u_z - own + (state.gap + 1) / state.scene.tabor])
    shown = np.concatenate([[0.0], r[r < reach], [reach]])
    undeformed, deformed, wall = (np.stack([shown, heights * np.interp(shown, r, level)]) for level in levels)
    deformed[0] += np.interp(shown, r, u_r, left=0.0) / state.scene.sphere_radius
    return Surfaces(undeformed, deformed, wall)


def _own_height(state: State, radii: Array) -> Array:
    """Depth of the undeformed body's surface under its pole in beta^2/R, zero for a block."""
    surface = state.surface
    if not surface.depths.any():
        return np.zeros_like(radii)
    r, depth = np.append(0.0, surface.radii), np.append(0.0, surface.depths)
    return np.asarray(state.scene.sphere_radius * np.interp(radii, r, depth))
