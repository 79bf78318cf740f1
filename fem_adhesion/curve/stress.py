"""The stress inside a body as numbers: along its axis, along its contact surface, or at points of a file.

The error at a point is the largest change of a component from elements of one degree less: each passes through zero
somewhere, all hardly at once.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from fem_adhesion.common.numbers import parse
from fem_adhesion.common.record import column, lines_of
from fem_adhesion.curve.settings import USUAL
from fem_adhesion.curve.solve import Curves
from fem_adhesion.elasticity.reference import reference_functions
from fem_adhesion.elasticity.space import Space
from fem_adhesion.fields import FIELDS, State, state_at
from halfspace.equilibrium.contact import CONTACT_RADIUS
from halfspace.errors import InputError
from halfspace.scaling import Units
from halfspace.values import Array, Index

COMPONENTS = ("rr", "zz", "hoop", "rz")
LINES = ("axis", "surface")  # where points are taken without a file
PAPER: Mapping[str, tuple[float, str]] = {
    "r": (1.0, "beta"),
    "depth": (1.0, "beta"),
    "stress": (1.0, "dgamma per mu eps"),
}


Points = tuple[Array, Array]
"""Radii and depths in beta, (n,) each."""


def stresses(curves: Curves, event: str, where: str | Points) -> dict[str, Array]:
    """Solve for the stress at an event of the first curve, along one of `LINES` or at points.

    Each an array (n,), are ``r`` and ``depth`` of the points in beta, and the components ``stress_rr`` ..., tension
    positive, and the error of all, ``stress_error``, in E* beta/R.
    InputError if the curve does not have the event, or a point lies outside what is meshed of the body.
    """
    located, scene = curves.path.stages[-1].get(event), curves.question.scene
    if located is None:
        raise InputError(f"at = {event}, which the curve of tabor {scene.tabor:g} does not have; take pull_off")
    coarse, fine = (
        state_at(scene, located.problem, located.point, how=replace(FIELDS, degree=FIELDS.degree - k)) for k in (1, 0)
    )
    radii, depths = _along(fine, where) if isinstance(where, str) else where
    values, others = (values_at(state, state.stress, radii, depths) for state in (fine, coarse))
    parts = dict(zip(COMPONENTS, values, strict=True)) | {"error": np.abs(values - others).max(axis=0)}
    return {"r": radii, "depth": depths, **{f"stress_{name}": part for name, part in parts.items()}}


def values_at(state: State, coefficients: Array, radii: Array, depths: Array) -> Array:
    """Values (m, n) of fields given by coefficients (m, functions), at points by radius and depth (n,) in beta."""
    space = state.space
    cells, places = located_in(space, np.array([radii, -depths]))
    own = coefficients[:, space.scalar_dofs.element_dofs[:, cells]]
    return np.asarray(np.einsum("kin,in->kn", own, reference_functions(space.element, places)[0]))


def located_in(space: Space, points: Array) -> tuple[Index, Array]:
    """Cells (n,) with points (2, n), and the points' places (2, n) in the reference cell; InputError if one is outside.

    Newton's method is tried in every cell whose box has the point, a box somewhat larger than the cell's vertices
    have, as sides are curved; the cell is the one that the point is deepest in.
    """
    vertices = space.mesh.p[:, space.mesh.t]  # (2, corners, cells)
    low, high = vertices.min(axis=1), vertices.max(axis=1)
    middle, half = (low + high) / 2, USUAL.larger * (high - low) / 2
    which, cells = np.nonzero((np.abs(points[:, :, None] - middle[:, None]) <= half[:, None]).all(axis=0))
    places = _places(space.mesh.mapping(), points[:, which], cells)
    beyond = places.sum(axis=0) if len(space.mesh.t) == 3 else places.max(axis=0)  # of triangles, of quadrilaterals
    depth = np.nan_to_num(np.minimum(places.min(axis=0), 1 - beyond), nan=-np.inf)
    deepest = np.full(points.shape[1], -np.inf)
    np.maximum.at(deepest, which, depth)
    if np.any(outside := deepest < -USUAL.outside):
        r, z = points[:, outside][:, 0]
        raise InputError(f"the point at r = {r:.4g}, depth {-z:.4g} beta is outside the mesh of the body; leave it out")
    chosen = np.unique(which[depth == deepest[which]], return_index=True)[1]
    one = np.flatnonzero(depth == deepest[which])[chosen]
    return cells[one], places[:, one]


def _places(mapping: Any, points: Array, cells: Index) -> Array:
    """Places (2, n) in the reference cell of points (2, n) that the map of a cell each takes there, from its middle."""
    X = np.full(points.shape, 1 / 3)
    for _ in range(USUAL.steps):
        off = points - mapping.F(X[:, :, None], cells)[:, :, 0]
        by_place = mapping.DF(X[:, :, None], cells)[..., 0].transpose(2, 0, 1)
        X = np.clip(X + np.linalg.solve(by_place, off.T[:, :, None])[..., 0].T, -0.5, 1.5)
    return X


def _along(state: State, line: str) -> Points:
    """Points of a line, closer near the pole."""
    size = float(np.nan_to_num(state.observables[CONTACT_RADIUS])) or 1.0
    along = USUAL.deep * size * np.linspace(0, 1, USUAL.along) ** 2
    if line == "axis":
        return np.zeros(along.size), along[along < -state.space.mesh.p[1].min()]
    radii = along[(along > state.surface.radii[0]) & (along < state.surface.radii[-1])]
    return radii, np.interp(radii, state.surface.radii, state.surface.depths)


def places_of(where: str, units: Units | None) -> str | Points:
    """One of `LINES`, or the points of a table with the columns r and depth, their unit after the name: r_nm, depth_nm.

    InputError if it cannot be read, or has no such columns.
    """
    if where in LINES:
        return where
    path, found = Path(where), []
    columns, *rows = lines_of(path, "give axis, surface or a CSV file of points")
    for quantity in ("r", "depth"):
        name = next((name for name in columns if name.startswith(f"{quantity}_")), None)
        if name is None or not rows:
            raise InputError(f"{path} has no column {quantity} with rows; write the header as r_nm,depth_nm or in beta")
        unit = name.partition("_")[2]
        if unit != "beta" and units is None:
            raise InputError(f"{path}: {name} with --tabor, limit: beta; write {quantity}_beta, or give the material")
        size = 1.0 if units is None or unit == "beta" else parse(f"1{unit}", quantity) / units.length
        try:
            found.append(size * np.array([float(row[columns.index(name)]) for row in rows]))
        except ValueError as error:
            raise InputError(f"{path}: {name} has a row that is no number; mend it or leave it out") from error
    radii, depths = found
    return radii, depths


def write(found: Mapping[str, Array], units: Units | None, file: TextIO) -> None:
    """Write what `stresses` found as a table, in the units of the paper and, if the material is known, SI."""
    tables = [PAPER]
    if units:
        tables.append({"r": units.si("radius"), "depth": units.si("radius"), "stress": units.si("pressure")})
    columns: dict[str, Array] = {}
    for table in tables:
        for name, values in found.items():
            size, unit = table[name.partition("_")[0]]
            columns[column(name, unit)] = values * size
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(np.column_stack(list(columns.values())).tolist())
