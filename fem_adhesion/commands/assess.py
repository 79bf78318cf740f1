"""``fem-adhesion assess``: one real contact, in SI."""

from __future__ import annotations

import argparse
import json
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from fem_adhesion.commands.common import AGREE, progress_bar

if TYPE_CHECKING:
    from fem_adhesion.commands.common import Commands


def add(commands: Commands) -> None:
    """Add the command."""
    assess = commands.add_parser(
        "assess",
        help="assess a real contact in SI: forces, jumps, losses, and which model to trust",
        description="Compute what a contact does, beside the closed theories, and how wrong the half-space is for it. "
        "Quantities carry units; the spacing is asked for, never guessed.",
        epilog="example: fem-adhesion assess --radius 100nm --modulus 70GPa --poisson 0.17 "
        "--work-of-adhesion 0.1J/m^2 --spacing 0.3nm --stiffness 0.2N/m",
    )
    assess.add_argument("--radius", required=True, help="radius of the sphere, as 100nm")
    assess.add_argument("--modulus", required=True, help="Young's modulus of the sphere, as 70GPa")
    assess.add_argument("--poisson", required=True, type=float, help="its Poisson's ratio, 0 <= nu < 0.5", metavar="NU")
    assess.add_argument("--work-of-adhesion", required=True, help="as 0.1J/m^2 or 100mN/m", metavar="ENERGY")
    assess.add_argument("--spacing", required=True, help="equilibrium spacing of the surfaces, as 0.3nm")
    assess.add_argument("--counter-modulus", help="of the other body, rigid unless given", metavar="MODULUS")
    assess.add_argument("--counter-poisson", type=float, help="of the other body", metavar="NU")
    assess.add_argument("--counter-radius", help="of the other body, flat unless given", metavar="RADIUS")
    assess.add_argument("--stiffness", help="of the cantilever, as 0.2N/m; fixed grips unless given")
    assess.add_argument("--json", type=Path, help="also write the result to this file", metavar="FILE")
    assess.add_argument("--plot", type=Path, help="also draw force against distance: png, svg or pdf", metavar="FILE")
    assess.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Assess a contact, print what is found, and write the record and the figure."""
    from fem_adhesion.output import assess_plot, assess_report
    from fem_adhesion.output.files import written_aside
    from fem_adhesion.studies.assess import assess
    from fem_adhesion.studies.assess_contact import Contact
    from fem_adhesion.studies.quantities import KINDS, parse

    given = {name: text for name in KINDS if (text := getattr(options, name)) is not None}
    quantities = {name: parse(text, name) for name, text in given.items()}
    numbers = {"counter_poisson": options.counter_poisson, "poisson": options.poisson}
    contact = Contact(**quantities, **numbers)
    form = assess_plot.require_suffix(options.plot) if options.plot else ""
    with ExitStack() as stack:
        record = stack.enter_context(written_aside(options.json)) if options.json else None
        figure = stack.enter_context(written_aside(options.plot)) if options.plot else None
        with progress_bar() as step:
            assessment = assess(contact, step)
        if record:
            json.dump(assess_report.record(assessment), record, indent=1, allow_nan=False)
        if figure:
            assess_plot.write(assessment, figure, form)
    assess_report.show(assessment)
    return AGREE
