"""The formulas of `halfspace.theories.fits` in other languages, all from the same coefficients."""

from __future__ import annotations

import re
from importlib.metadata import version
from itertools import chain
from pathlib import Path
from string import Template

from fem_adhesion.common.page import data_text
from halfspace.theories import fits
from halfspace.theories.closed_forms import ZERO_LOAD_RADIUS

NAMES = ("adhesion.py", "adhesion.h", "adhesion.c", "adhesion.f90", "formulas.md", "formulas.tex")


def write(directory: Path) -> None:
    """Write all files into a directory."""
    words = _words()
    for name in NAMES:
        template = Template(data_text("formulas", f"{name}.template"))
        (directory / name).write_text(template.substitute(words), encoding="utf-8")


def worst_errors() -> dict[str, str]:
    """Largest relative error of each formula as `fits` states it."""
    return dict(re.findall(r"^    (\w+) +(\S+) of", fits.__doc__ or "", re.M))


def _words() -> dict[str, object]:
    """What stands for each name in the templates."""
    words: dict[str, object] = {f"worst_{name}": worst for name, worst in worst_errors().items()}
    words |= {"version": version("fem-adhesion"), "rigid_radius": repr(float(fits.RIGID_RADIUS))}
    words |= {"jkr_radius": repr(ZERO_LOAD_RADIUS), "jkr_lost": repr(fits.JKR_LOST)}
    last = ZERO_LOAD_RADIUS / float(fits.RIGID_RADIUS) * fits.CONSTANTS["zero_load_below"][-1]
    words["last_zero_load"] = repr(last)
    for name, value in fits.CONSTANTS.items():
        if isinstance(value, float):
            words[name] = repr(value)
            continue
        variable = "v" if name in ("jump_on", "jump_off", "energy_lost") else "s"
        words |= {name: repr(tuple(value)), f"c_{name}": ", ".join(map(repr, value)), f"n_{name}": len(value)}
        words[f"sum_{name}"] = _sum(value, variable)
    sphere = fits.CONSTANTS["sphere"]
    words |= {f"s{i}": f"{c:g}" for i, c in enumerate(sphere)}
    words |= {"sum_sphere_size": _sum(sphere[:3], "g"), "sum_sphere_grip": _sum(sphere[8:], "b")}
    flat = [
        [piece["from"], piece["to"], *piece["middle"], *piece["slope"], *chain(*piece["sums"])] for piece in fits.FORCE
    ]
    first = fits.FORCE[0]
    words |= {"n_pieces": len(flat), "n_cusp": len(first["middle"])}
    words |= {"n_sums": len(first["sums"]), "n_series": len(first["sums"][0])}
    words["c_pieces"] = ",\n".join("  {" + ", ".join(map(repr, numbers)) + "}" for numbers in flat)
    words["pieces"] = "[\n" + "".join(f"    {list(piece.values())},\n" for piece in fits.FORCE) + "]"
    return words


def _sum(coefficients: list[float], variable: str) -> str:
    """Polynomial as it is written by hand."""
    factors = ["", f" {variable}", *(f" {variable}^{i}" for i in range(2, len(coefficients)))]
    terms = (f"{c:+g}{factor}" for c, factor in zip(coefficients, factors, strict=False))
    return " ".join(terms).removeprefix("+").replace(" +", " + ").replace(" -", " - ")
