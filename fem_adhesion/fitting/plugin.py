"""A fit model for nanite and PyJibe, written as a module of its own."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from string import Template

from fem_adhesion.common.files import written_aside
from fem_adhesion.common.page import template_text
from fem_adhesion.fitting.traced import SPACING, WORK
from halfspace.errors import InputError


def write(path: Path, *, radius: float, modulus: float, poisson: float) -> None:
    """Write the module; the quantities, in SI, are where its fits start.

    InputError if nanite could not import a module of that name, or the file cannot be written.
    """
    if path.suffix != ".py" or not path.stem.isidentifier():
        raise InputError(f"{path} cannot be imported, limit: a name of letters, digits and _, then .py; rename it")
    values = {"radius": radius, "modulus": modulus, "poisson": poisson, "work_of_adhesion": WORK, "spacing": SPACING}
    written = {name: f"{value:.12g}" for name, value in values.items()}
    text = Template(template_text("fitting", "nanite.py.txt")).substitute(written, version=version("fem-adhesion"))
    with written_aside(path) as file:
        file.write(text)
