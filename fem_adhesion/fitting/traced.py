"""Curves of other laws, profiles and bodies for a fit, each traced when it is asked for."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

import halfspace
from fem_adhesion import convergence
from fem_adhesion.common.numbers import NUMBER, parse
from fem_adhesion.common.words import part_in
from fem_adhesion.fitting.model import THEORIES, attracted
from fem_adhesion.registry import PARTS, class_of
from fem_adhesion.scene import Scene
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.contact import APPROACH, LOAD
from halfspace.errors import InputError, Unsolved, tried
from halfspace.scaling import Units
from halfspace.values import Array

KINDS = ("law", "profile", "body")
RTOL = 1e-4  # of the traces
WORK, SPACING = 0.05, 0.3e-9  # J/m^2 of van der Waals' solids in air, m of an atom's diameter
SAME = 1e-3  # arclength between states that are one
PLACES = 1600  # on the spline through the states of a path: loads err by 0.03 R dgamma at most


def kind_of(word: str) -> tuple[str, bool]:
    """Kind of the part that a word names, and whether R/eps is a parameter of it; InputError if it names none."""
    name = word.partition(":")[0]
    kind = next((kind for kind in KINDS if name in PARTS[kind]), None)
    if kind is None:
        known = ", ".join(dict.fromkeys([*THEORIES, *(name for kind in KINDS for name in PARTS[kind])]))
        raise InputError(f"model = {word!r}, limit: one of {known}; choose another")
    return kind, "radius_ratio" in PARTS[kind][name].parameters


@dataclass(frozen=True)
class Traced:
    """A theory by the solvers: the atlas' contact with one part exchanged.

    Parameters
    ----------
    word : str
        The part as the command line has it: ``morse:3``, ``sphere``, ``layer:500nm``. Lengths have a unit, or are in
        beta and those of a law in eps; R/eps is left out, as the fit knows it.
    poisson : float
        Poisson's ratio of the body.
    to_load : float
        Load in R dgamma up to which the data go.
    """

    word: str
    poisson: float
    to_load: float = COMPRESSION

    def require(self, radius: float, counter: float | None) -> None:
        """Raise InputError for a word that is refused at every Tabor parameter, by a radius in m and usual adhesion.

        Or for a body, or a sphere, where there is a counter-body: it would have the pair's radius and compliance.
        """
        kind, has_size = kind_of(self.word)
        if counter and (kind == "body" or has_size):
            raise InputError(f"model = {self.word} with a counter-body, limit: laws and other profiles; leave it out")
        moduli = (WORK * math.sqrt(radius / (tabor * SPACING) ** 3) for tabor in (100.0, 1.0, 0.01))
        found = [tried(self.scene, Units(radius, E, WORK, SPACING), refusals=True) for E in moduli]
        reasons = [one.reason for one in found if isinstance(one, Unsolved)]
        if len(reasons) == len(found):
            raise InputError(f"model = {self.word}: {reasons[1]}")

    def scene(self, units: Units) -> Scene:
        """Scene of a contact; InputError if the part does not go with it."""
        kind, has_size = kind_of(self.word)
        unit = units.spacing if kind == "law" else units.length

        def length(what: str, text: str) -> float:
            return float(text) if re.fullmatch(NUMBER, text) else parse(text, what) / unit

        size = {"radius_ratio": units.radius_ratio} if has_size else {}
        material = {"material": class_of("material", "linear-elastic")(self.poisson)} if kind == "body" else {}
        part = part_in(kind, self.word, length, size, poisson=self.poisson, **material)
        return Scene(units.tabor, **{kind: part})

    def __call__(self, units: Units) -> Array:
        """Approach in eps and load in R dgamma, (2, n); beyond the first state a power of the gap."""
        scene = self.scene(units)
        if scene.left_out:
            path = convergence.trace(scene, rtol=RTOL, to_load=self.to_load)
        else:
            path = halfspace.trace(**scene.for_half_space, rtol=RTOL, to_load=self.to_load)
        points = path.points
        along = np.array([point.arclength for point in points])
        apart = np.append(True, np.diff(along) > SAME)  # parts of a path share their ends
        values = np.array([path.approach, path.load])[:, apart]
        rates = np.array([point.rates for point in points])[apart][:, [APPROACH, LOAD]]
        states = CubicHermiteSpline(along[apart], values.T, rates)
        curve = states(np.linspace(along[0], along[-1], PLACES)).T
        first, pull = curve[:, 0]
        # The power by which the load falls with the gap; none of a law that does not reach so far.
        falling = (1 - first) / pull * rates[0, 1] / rates[0, 0] if pull else 0.0
        return attracted(curve, units.tabor, falling)
