"""``fem-adhesion curve``: one load-approach curve, to be looked at or read by machines."""

from __future__ import annotations

import argparse
import json
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import (
    AGREE,
    Command,
    Parser,
    add_files,
    add_force,
    all_written,
    console_beside,
    require_distinct,
)
from fem_adhesion.common.scene_options import add_body, add_contact, contact_of, refuse, scene_of, stiffness_of
from fem_adhesion.common.words import part_in
from fem_adhesion.curve.settings import USUAL
from halfspace.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fem_adhesion.common.contact import Contact
    from fem_adhesion.curve.beside import LawCurves
    from fem_adhesion.curve.solve import Curves, Question, SolverName
    from fem_adhesion.scene import Scene

NOT_BY_WEAK_FORM = ("vtk", "render", "movie", "stress", "at", "other_laws", "points", "stiffness")


def add_options(command: Parser) -> None:
    """Add the options."""
    add_contact(command)
    body = command.add_argument_group("body and solver")
    which = "half-space unless the body is another, fem then; weak-form: full Newton in scikit-fem, a textbook's"
    body.add_argument("--solver", choices=("half-space", "fem", "both", "weak-form"), help=which)
    pressure = "what the half-space's pressure is made of, triangles and bands as in 1997; panels unless given"
    body.add_argument("--kernel", choices=("panels", "triangles", "bands"), help=pressure)
    add_body(body)
    others = "draw curves by other laws, as strong, in the same units beside it: morse:3 power-law:4,10, say"
    body.add_argument("--other-laws", nargs="+", help=others, metavar="LAW")
    accuracy = "relative accuracy, 1e-9 to 1e-1, 1e-5 unless given; of weak-form 1e-4 to 1e-1, 1e-3 unless given"
    body.add_argument("--rtol", type=float, help=accuracy)
    body.add_argument("--to-load", type=float, default=5.0, help="load in R dgamma at which it ends", metavar="W")
    results = command.add_argument_group("results")
    add_files(
        results, json="points, events, units and settings", csv="points and events", plot="curve, profiles and mesh"
    )
    points = f"in JSON, CSV and plot, as traced unless given; in DIR beside the events, {USUAL.inside} unless given"
    for name, metavar, kind, text in (
        ("vtk", "DIR", Path, "write the fields inside the body for ParaView, by finite elements"),
        ("points", "N", int, points),
        ("revolve", "ANGLE", float, "write the solid of revolution too, degrees"),
        ("render", "FILE", Path, "draw the body cut open, with its stress: png"),
    ):
        results.add_argument(f"--{name}", type=kind, help=text, metavar=metavar)
    where = "write a table of the stress inside, along the axis or the surface, or at points of a table r_nm,depth_nm"
    results.add_argument("--stress", nargs=2, help=where, metavar=("WHERE", "FILE"))
    events = ("pull_off", "jump_on", "jump_off", "zero_load")
    results.add_argument("--at", choices=events, help="event of --render and --stress; pull_off unless given")
    movie = "draw it up to the wall, onto it and off again: gif"
    results.add_argument("--movie", type=Path, help=movie, metavar="FILE")
    add_force(results)


def run(options: argparse.Namespace) -> int:
    """Trace the curve, write what is asked for and print the events."""
    from fem_adhesion.common.files import directory_written_aside
    from fem_adhesion.common.terminal import Prose
    from fem_adhesion.curve import terminal
    from fem_adhesion.curve.solve import solve

    question, laws = _question(options), [part_in("law", word) for word in options.other_laws or ()]
    if laws:
        from fem_adhesion.curve import beside

        beside.require(question.scene, laws)
    if options.plot:
        from fem_adhesion.common.style import require_suffix

        require_suffix(options.plot)
    if options.stress:
        from fem_adhesion.curve.stress import places_of

        options.stress[0] = places_of(options.stress[0], question.units)
    outputs = {name: getattr(options, name) for name in ("json", "csv", "plot", "render", "movie")}
    outputs["stress"] = Path(options.stress[1]) if options.stress else None
    require_distinct(*outputs.values(), options.vtk)
    with ExitStack() as stack:
        fields = options.vtk and stack.enter_context(directory_written_aside(options.vtk, force=bool(options.force)))
        files = stack.enter_context(all_written(**outputs))
        with progress_bar() as step:
            curves = solve(question, step)
            collapsed = beside.solve(curves, laws, step) if laws else None
        _write(options, curves, collapsed, files)
        if fields:
            from fem_adhesion.fields import states_along
            from fem_adhesion.paraview.write import write_states

            points = USUAL.inside if options.points is None else options.points
            states = states_along(question.scene, curves.path, points=points)
            write_states(states, fields, options.vtk, units=question.units, revolve=options.revolve)
    console = console_beside(options.json, options.csv, outputs["stress"])
    terminal.show(curves, console)
    if collapsed:
        console.print(Prose(beside.told(collapsed)))
    return AGREE


def _write(
    options: argparse.Namespace, curves: Curves, collapsed: LawCurves | None, files: Mapping[str, TextIO]
) -> None:
    """Write the files that are open, by the names of their options."""
    from fem_adhesion.common.record import write_records
    from fem_adhesion.curve import record

    if collapsed:
        from fem_adhesion.curve import beside
    if "json" in files:
        told = {"beside": beside.record(collapsed)} if collapsed else {}
        json.dump(record.record(curves) | told, files["json"], indent=1, allow_nan=False)
    if "csv" in files:
        record.write_csv(curves, files["csv"])
    stress_table = options.stress and Path(options.stress[1])
    write_records(files, lambda: record.head(curves), csv=options.csv)
    write_records(files, lambda: record.head(curves) | {"units": {}}, stress=stress_table)
    if "plot" in files:
        from fem_adhesion.common import style
        from fem_adhesion.curve import figure

        form = options.plot.suffix[1:]
        style.write(
            lambda: beside.draw(collapsed) if collapsed else figure.draw(curves), files["plot"], form, figure.LOOK
        )
    if "stress" in files:
        from fem_adhesion.curve import stress

        found = stress.stresses(curves, options.at or "pull_off", options.stress[0])
        stress.write(found, curves.question.units, files["stress"])
    if "render" in files or "movie" in files:
        from fem_adhesion.curve import pictures

        if "render" in files:
            pictures.write_picture(curves, files["render"], options.at or "pull_off")
        if "movie" in files:
            pictures.write_movie(curves, files["movie"])


def _question(options: argparse.Namespace) -> Question:
    """What is asked, with nothing given that would not be heeded."""
    from fem_adhesion.curve.solve import Question

    contact = contact_of(options)
    scene = scene_of(options, contact.units.tabor if contact else options.tabor, contact)
    inside = options.vtk or options.render or options.movie or options.stress
    plain = scene.body.name == "half-space" and not inside
    solver: SolverName = options.solver or ("half-space" if plain else "fem")
    _require_heeded(options, scene, solver, contact)
    if inside:
        _require_inside(options, scene, solver)
    for path, suffix in ((options.render, ".png"), (options.movie, ".gif")):
        if path and path.suffix != suffix:
            raise InputError(f"{path} ends in {path.suffix!r}, limit: {suffix}; rename it")
    if options.at and not (options.render or options.stress):
        raise InputError(f"at = {options.at} without --render or --stress, limit: with one; give --render FILE.png too")
    if options.render or options.movie:
        from fem_adhesion.paraview.picture import require_drawing

        require_drawing()
    points = options.points if options.json or options.csv or options.plot else None
    if options.vtk and points in (0, 1):
        points = None  # of the states in DIR alone, where there may be none between the events
    units = contact.units if contact else None
    kernel, stiffness = options.kernel or "panels", stiffness_of(options, contact)
    rtol = options.rtol or (1e-3 if solver == "weak-form" else 1e-5)
    return Question(scene, solver, rtol, options.to_load, units, stiffness, points, kernel)


def _require_inside(options: argparse.Namespace, scene: Scene, solver: SolverName) -> None:
    """Refuse what cannot be shown or written of the inside of the body before any work."""
    from fem_adhesion.fields import require_fields

    if solver == "half-space":
        what = next(name for name in ("vtk", "stress", "render", "movie") if getattr(options, name))
        raise InputError(
            f"{what} with solver = half-space, which has no fields inside, limit: fem or both; take --solver fem"
        )
    require_fields(scene)
    if options.vtk:
        from fem_adhesion.paraview.cells import require_angle
        from fem_adhesion.paraview.write import require_pyvista

        if (options.points or 0) < 0:
            raise InputError(f"points = {options.points} is outside 0 <= points; 0 writes the events only")
        if options.revolve is not None:
            require_angle(options.revolve)
        require_pyvista()


def _require_heeded(options: argparse.Namespace, scene: Scene, solver: SolverName, contact: Contact | None) -> None:
    """Refuse what the question would not depend on."""
    files = options.json or options.csv or options.plot or options.vtk
    in_tabor = solver == "half-space" and not contact and not scene.body.layered
    for unheeded, names, why in (
        (in_tabor, ("poisson",), "with a material, fem or both, as a Tabor parameter has it in it"),
        (solver not in ("half-space", "both"), ("kernel",), "with --solver half-space or both"),
        (
            solver == "weak-form",
            NOT_BY_WEAK_FORM,
            "with another solver, as the weak form gives points and events alone",
        ),
        (not options.vtk, ("revolve", "force"), "with --vtk DIR"),
        (not files, ("points",), "with --json, --csv, --plot or --vtk"),
    ):
        if unheeded:
            refuse(options, names, why)


COMMAND = Command(
    "curve",
    "trace one load-approach curve: events, stability, jumps, plots and data",
    "Trace the load-approach curve of one contact, dimensionless or, with a material, in SI; print its "
    "events with their errors, and a small plot unless piped.",
    "--tabor 2 --plot curve.svg --json curve.json",
    add_options,
    run,
)
