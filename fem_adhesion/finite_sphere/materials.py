"""Real materials for the chart of the finite sphere: typical values and their sources.

The work of adhesion and the Hamaker constant A are what is known of a material. The spacing of the surface law follows,
eps^2 = A/(16 pi dgamma), so that law and source have the same attraction from afar: 0.14 to 0.15 nm, near the cut-off
D0 = 0.165 nm between two continua and not the diameter of an atom, of which the law between planes knows nothing.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from halfspace.scaling import Units, contact_modulus, spacing_of

FILE = Path(__file__).parent / "data" / "materials.csv"


@dataclass(frozen=True)
class Material:
    """An elastic sphere against a rigid wall.

    Attributes
    ----------
    name : str
        What, and how large.
    units : Units
        Its units, and with them the Tabor parameter, R/eps and the Hamaker constant.
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
    adhesion = float(line["work_of_adhesion_J_per_m2"])
    spacing = spacing_of(float(line["hamaker_J"]), adhesion)
    units = Units(float(line["radius_m"]), modulus, adhesion, spacing)
    return Material(line["name"], units, poisson, line["source"], line["note"])
