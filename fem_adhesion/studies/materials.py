"""Real materials for the chart of the finite sphere: typical values and their sources."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from halfspace.scaling import Units, contact_modulus

FILE = Path(__file__).parent / "data" / "materials.csv"


@dataclass(frozen=True)
class Material:
    """An elastic sphere against a rigid wall.

    Attributes
    ----------
    name : str
        What, and how large.
    units : Units
        Its units, and with them the Tabor parameter and R/eps.
    poisson : float
        Poisson's ratio.
    source, note : str
        Where the values are from, and what was assumed.
    """

    name: str
    units: Units
    poisson: float
    source: str
    note: str


def materials() -> tuple[Material, ...]:
    """All materials of the file ``data/materials.csv``."""
    with FILE.open(newline="") as file:
        return tuple(_material(line) for line in csv.DictReader(line for line in file if not line.startswith("#")))


def _material(line: dict[str, str]) -> Material:
    poisson = float(line["poisson"])
    modulus = contact_modulus(float(line["young_Pa"]), poisson)
    sizes = (float(line[name]) for name in ("work_of_adhesion_J_per_m2", "spacing_m"))
    return Material(
        line["name"], Units(float(line["radius_m"]), modulus, *sizes), poisson, line["source"], line["note"]
    )
