"""``fem-adhesion curve``: one load-approach curve, to be looked at or read by machines."""

from __future__ import annotations

import argparse
import json
import math
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from fem_adhesion.commands.common import AGREE, progress_bar
from halfspace.errors import InputError

if TYPE_CHECKING:
    from fem_adhesion.commands.common import Commands, Parser
    from fem_adhesion.scene import BodyName, ProfileName, Scene
    from fem_adhesion.studies.curves import Curves, Question, SolverName
    from halfspace.scaling import Units

MATERIAL = ("radius", "modulus", "work_of_adhesion", "spacing")


def add(commands: Commands) -> None:
    """Add the command."""
    curve = commands.add_parser(
        "curve",
        help="trace one load-approach curve: events, stability, jumps, plots and data",
        description="Trace the load-approach curve of one contact, dimensionless or, with a material, in SI; print its "
        "events with their errors, and a small plot unless piped.",
        epilog="example: fem-adhesion curve --tabor 2 --plot curve.svg --json curve.json",
    )
    _add_contact(curve)
    _add_body(curve)
    _add_results(curve)
    curve.set_defaults(run=run)


def _add_contact(curve: Parser) -> None:
    curve.add_argument("--tabor", type=float, help="Tabor parameter, or a material instead", metavar="MU")
    curve.add_argument("--poisson", type=float, default=0.3, help="Poisson's ratio, 0 <= nu < 0.5", metavar="NU")
    curve.add_argument("--radius", help="material: radius of the sphere, as 100nm")
    curve.add_argument("--modulus", help="material: its Young's modulus, as 70GPa")
    curve.add_argument("--work-of-adhesion", help="material: as 0.1J/m^2", metavar="ENERGY")
    curve.add_argument("--spacing", help="material: equilibrium spacing of the surfaces, as 0.3nm")
    help_text = "of the cantilever, as 0.2N/m with a material, else a number in R dgamma/eps; fixed grips unless given"
    curve.add_argument("--stiffness", help=help_text, metavar="K")


def _add_body(curve: Parser) -> None:
    solvers = ("half-space", "fem", "both")
    curve.add_argument("--solver", choices=solvers, help="half-space unless the body is another, fem then")
    curve.add_argument("--body", choices=("block", "hemisphere", "sphere"), help="what is elastic; block unless given")
    curve.add_argument("--mesh", type=Path, help="file with the mesh of the body", metavar="FILE")
    curve.add_argument("--profile", choices=("paraboloid", "sphere"), help="undeformed gap; paraboloid unless given")
    curve.add_argument("--radius-ratio", type=float, help="R/eps of a body with a size", metavar="RHO")
    curve.add_argument("--grip", choices=("sliding", "bonded"), default="sliding", help="how its far side is held")
    curve.add_argument("--rtol", type=float, default=1e-5, help="relative accuracy, 1e-9 to 1e-1")
    curve.add_argument("--to-load", type=float, default=5.0, help="load in R dgamma at which it ends", metavar="W")


def _add_results(curve: Parser) -> None:
    curve.add_argument("--json", type=Path, help="write points, events, units and settings", metavar="FILE")
    curve.add_argument("--csv", type=Path, help="write points and events as a table", metavar="FILE")
    curve.add_argument("--plot", type=Path, help="draw curve, profiles and mesh: png, svg or pdf", metavar="FILE")
    curve.add_argument("--vtk", type=Path, help="write the fields inside the body for ParaView", metavar="DIR")
    curve.add_argument("--points", type=int, default=20, help="of the curve in DIR, beside its events", metavar="N")
    curve.add_argument("--revolve", type=float, help="write the solid of revolution too, degrees", metavar="ANGLE")
    curve.add_argument("--render", type=Path, help="draw the body cut open, with its stress: png", metavar="FILE")
    events = ("pull_off", "jump_on", "jump_off", "zero_load")
    curve.add_argument("--at", choices=events, help="event that is drawn; pull_off unless given")
    curve.add_argument("--movie", type=Path, help="draw it up to the wall, onto it and off again: gif", metavar="FILE")
    curve.add_argument("--force", action="store_true", help="replace files in a DIR that is not empty")


def run(options: argparse.Namespace) -> int:
    """Trace the curve, write what is asked for and print the events."""
    from fem_adhesion.output import curve_record, curve_terminal
    from fem_adhesion.output.files import directory_written_aside, written_aside
    from fem_adhesion.studies.curves import solve

    question = _question(options)
    form = _form_of(options.plot)
    with ExitStack() as stack:
        fields = options.vtk and stack.enter_context(directory_written_aside(options.vtk, force=options.force))
        data, points, figure, picture, movie = (
            stack.enter_context(written_aside(path)) if path else None
            for path in (options.json, options.csv, options.plot, options.render, options.movie)
        )
        with progress_bar() as step:
            curves = solve(question, step)
        if data:
            json.dump(curve_record.record(curves), data, indent=1, allow_nan=False)
        if points:
            curve_record.write_csv(curves, points)
        if figure:
            from fem_adhesion.output import plots

            plots.write(curves, figure, form)
        if fields:
            _write_vtk(options, curves, fields)
        _draw_body(curves, picture, options.at or "pull_off", movie)
        for file in filter(None, (data, points, figure, picture, movie)):
            file.flush()  # all on disk before the first takes its place
    curve_terminal.show(curves)
    return AGREE


def _write_vtk(options: argparse.Namespace, curves: Curves, aside: Path) -> None:
    from fem_adhesion.fields import states_along
    from fem_adhesion.output.vtk import write_states

    question = curves.question
    states = states_along(question.scene, curves.path, points=options.points)
    write_states(states, aside, options.vtk, units=question.units, revolve=options.revolve)


def _draw_body(curves: Curves, picture: TextIO | None, at: str, movie: TextIO | None) -> None:
    if picture:
        from fem_adhesion.output import render

        render.write_picture(curves, picture, at)
    if movie:
        from fem_adhesion.output.movie import write_movie

        write_movie(curves, movie)


def _require_drawing(options: argparse.Namespace, scene: Scene, solver: SolverName) -> None:
    """Refuse what cannot be drawn of the body before any work."""
    for path, suffix in ((options.render, ".png"), (options.movie, ".gif")):
        if path and path.suffix != suffix:
            raise InputError(f"{path} ends in {path.suffix!r}, limit: {suffix}; rename it")
    if options.at and not options.render:
        raise InputError(f"at = {options.at} without a picture, limit: with --render; give --render FILE.png too")
    if not (options.render or options.movie):
        return
    if solver == "half-space":
        raise InputError(
            "picture with solver = half-space, which has no fields inside, limit: fem or both; take --solver fem"
        )
    from fem_adhesion.fields import require_fields
    from fem_adhesion.output.solid_view import require_drawing

    require_fields(scene)
    require_drawing()


def _require_vtk(options: argparse.Namespace, scene: Scene, solver: SolverName) -> None:
    """Refuse what cannot be written for ParaView before any work."""
    from fem_adhesion.fields import require_fields
    from fem_adhesion.output.revolve import require_angle
    from fem_adhesion.output.vtk import require_pyvista

    if solver == "half-space":
        raise InputError(
            "vtk with solver = half-space, which has no fields inside, limit: fem or both; take --solver fem"
        )
    if options.points < 0:
        raise InputError(f"points = {options.points} is outside 0 <= points; 0 writes the events only")
    if options.revolve is not None:
        require_angle(options.revolve)
    require_fields(scene)
    require_pyvista()


def _form_of(plot: Path | None) -> str:
    """Format of the figure; matplotlib is not loaded without one."""
    if plot is None:
        return ""
    from fem_adhesion.output.plots import require_suffix

    return require_suffix(plot)


def _question(options: argparse.Namespace) -> Question:
    from fem_adhesion.studies.curves import Question

    units = _units(options)
    scene = _scene(options, units)
    inside = options.vtk or options.render or options.movie
    solver: SolverName = options.solver or ("half-space" if scene.body == "block" and not inside else "fem")
    if options.vtk:
        _require_vtk(options, scene, solver)
    _require_drawing(options, scene, solver)
    return Question(scene, solver, options.rtol, options.to_load, units, _stiffness(options, units))


def _units(options: argparse.Namespace) -> Units | None:
    """Units of the material, if one is given, whole and without a Tabor parameter."""
    from fem_adhesion.studies.assess_contact import Contact
    from fem_adhesion.studies.quantities import parse

    given = {name: text for name in MATERIAL if (text := getattr(options, name)) is not None}
    if not given:
        if options.tabor is None:
            raise InputError(
                "tabor = None and no material, limit: one of both; give --tabor 2, say, or --radius 100nm ..."
            )
        return None
    if options.tabor is not None:
        raise InputError(f"tabor = {options.tabor:g} with a material, limit: one of both; leave out --tabor")
    missing = [f"--{name.replace('_', '-')}" for name in MATERIAL if name not in given]
    if missing:
        raise InputError(f"{', '.join(missing)} missing, limit: a whole material or none; give it too")
    return Contact(poisson=options.poisson, **{name: parse(text, name) for name, text in given.items()}).units


def _scene(options: argparse.Namespace, units: Units | None) -> Scene:
    from fem_adhesion.scene import Scene

    if options.mesh and options.body:
        raise InputError(f"mesh = {options.mesh} with body = {options.body}, limit: one of both; leave out --body")
    body: BodyName | Path = options.mesh or options.body or "block"
    profile: ProfileName = options.profile or "paraboloid"
    sized = body != "block" or profile == "sphere"
    if units and options.radius_ratio is not None:
        raise InputError(
            f"radius_ratio = {options.radius_ratio:g} with a material, limit: its own {units.radius_ratio:.4g}; "
            "leave out --radius-ratio"
        )
    ratio = units.radius_ratio if units and sized else options.radius_ratio
    tabor = units.tabor if units else options.tabor
    return Scene(tabor, options.poisson, body=body, profile=profile, radius_ratio=ratio, grip=options.grip)


def _stiffness(options: argparse.Namespace, units: Units | None) -> float:
    """Stiffness of the apparatus in R dgamma/eps."""
    from fem_adhesion.studies.quantities import parse

    if options.stiffness is None:
        return math.inf
    if units:
        return parse(options.stiffness, "stiffness") / units.stiffness
    try:
        return float(options.stiffness)
    except ValueError as error:
        raise InputError(
            f"stiffness = {options.stiffness} is not a plain number in R dgamma/eps; give one, or a material"
        ) from error
