"""``fem-adhesion assess``: one real contact, in SI."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import AGREE, Command, Parser, add_files, all_written, console_beside
from fem_adhesion.common.scene_options import COUNTER, add_contact, add_law, add_profile, inputs_of, profile_of, refuse
from halfspace.errors import InputError

if TYPE_CHECKING:
    from fem_adhesion.common.contact import Contact, Inputs


def add_options(command: Parser) -> None:
    """Add the options."""
    add_contact(command, in_si_only=True)
    add_law(command.add_argument_group("law"))
    shape = command.add_argument_group("shape of the tip, where it is no sphere")
    own = "a sphere's unless given; lengths as 30nm; a table begins with its unit, as r_nm,z_nm, or is in m"
    add_profile(shape, own, ("radius_ratio", "counter_radius"))
    mesh = "mesh of the elastic body, in radii of its pole, before a rigid wall; see meshes/README.md"
    shape.add_argument("--mesh", type=Path, help=mesh, metavar="FILE")
    grip = "how spheres are held at their mid-planes, or a mesh is held; sliding unless given"
    command.add_argument("--grip", choices=("sliding", "bonded"), help=grip)
    sample = command.add_argument_group("thin sample on a rigid base")
    thickness = "thickness, as 500nm: the sphere is rigid then, and --modulus and --poisson are the sample's"
    sample.add_argument("--thickness", help=thickness, metavar="T")
    base = "whether the base holds the sample or carries it without friction; bonded unless given"
    sample.add_argument("--foundation", choices=("bonded", "sliding"), help=base)
    results = command.add_argument_group("results")
    digits = "of the numbers shown: 4 at most, or all with the errors of the last ones; files have all"
    results.add_argument("--digits", choices=("4", "all"), default="4", help=digits)
    add_files(results, json="what is found", plot="force against distance")


def run(options: argparse.Namespace) -> int:
    """Assess a contact, print what is found, and write the record and the figure."""
    from fem_adhesion.assess import figure, terminal
    from fem_adhesion.assess.study import assess
    from fem_adhesion.common import style
    from fem_adhesion.common.numbers import DIGITS

    inputs = _inputs(options)
    form = style.require_suffix(options.plot) if options.plot else ""
    with all_written(json=options.json, plot=options.plot) as files:
        with progress_bar() as step:
            assessment = assess(inputs.contact(), step, inputs)
        if "json" in files:
            json.dump(terminal.record(assessment), files["json"], indent=1, allow_nan=False)
        if "plot" in files:
            style.write(lambda: figure.draw(assessment), files["plot"], form)
        digits = DIGITS if options.digits == "all" else terminal.SHOWN
        report = terminal.report(assessment, digits)  # before the files take their places
    console_beside(options.json).print(report)
    return AGREE


def _inputs(options: argparse.Namespace) -> Inputs:
    """What the contact is made of, with nothing given that would not be heeded."""
    from fem_adhesion.assess.settings import USUAL
    from fem_adhesion.assess.study import require_known

    if options.thickness is None:
        refuse(options, ("foundation",), "with --thickness")
    else:
        refuse(options, ("grip", *COUNTER), "without --thickness, as a thin sample meets a rigid sphere")
    if options.profile is not None:
        refuse(options, ("grip",), "without --profile, which lies on a half-space")
    made = {"grip": options.grip or "sliding", "foundation": options.foundation or "bonded", "mesh": options.mesh}
    inputs = inputs_of(options, **made)
    if options.profile is not None:
        inputs = replace(inputs, profile=partial(profile_of, options.profile))
    contact = inputs.contact()
    _require_exact(inputs, contact)
    require_known(contact)
    tabor = contact.units.tabor
    if tabor > USUAL.finite:
        refuse(
            options, ("grip",), f"tabor <= {USUAL.finite:g}, where a finite sphere is solved, and this is {tabor:.4g}"
        )
    return inputs


def _require_exact(inputs: Inputs, contact: Contact) -> None:
    """Refuse standard deviations that a shape leaves without an answer."""
    from halfspace.profiles import Tabulated

    for name in inputs.deviations:
        why = ""
        if contact.mesh:
            why = "with --mesh, which is solved once"
        elif name == "radius" and isinstance(contact.profile, Tabulated):
            why = "with a tip's table, which has the radius in it"
        if why:
            raise InputError(f"{name} has a standard deviation, limit: none {why}; leave it out")


COMMAND = Command(
    "assess",
    "assess a real contact in SI: forces, jumps, losses, and which model to trust",
    "Compute what a contact does, beside the closed theories, and how wrong the half-space is for it.",
    "--radius 100nm --modulus 72GPa --poisson 0.17 --work-of-adhesion 0.063J/m^2 --hamaker 65zJ --stiffness 0.2N/m",
    add_options,
    run,
)
