"""A real contact in SI, checked, and its passage to the dimensionless one.

What is asked of a material is asked of it only, and never guessed: Poisson's ratios too, as they are part of E*.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from fem_adhesion.bodies.body import Body, GripName
from fem_adhesion.bodies.half_space import HalfSpace
from fem_adhesion.bodies.held import Hemisphere
from fem_adhesion.common.numbers import Measured
from fem_adhesion.registry import words_of
from fem_adhesion.scene import facing_pair
from halfspace.elastic.layers import Foundation, Layer, Layers
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import LAYER_THICKNESS, require_poisson
from halfspace.profiles import Profile, require_profile
from halfspace.scaling import Units, contact_modulus, equivalent_radius, spacing_of

RIGID = 1e-9  # part of the pair's compliance that stands for none: a rigid sphere is a counter-body all the same


@dataclass(frozen=True)
class Contact:
    """A sphere against a wall or another sphere, in SI.

    Of the sphere these are its radius in m, Young's modulus in Pa and Poisson's ratio, 0 <= poisson <= 0.499999; the
    work of adhesion is in J/m^2, the equilibrium spacing of the surface law in m. The other body is rigid unless both
    of its modulus and Poisson's ratio are given, and flat unless its radius is. The stiffness is that of the cantilever
    in N/m, infinite for fixed grips; the grip is how spheres are held at their mid-planes. With a thickness in m it is
    a rigid sphere on a thin sample, whose are `modulus` and `poisson` then, and the foundation how that stands on its
    rigid base; it is thicker than the spacing. The profile, in the units of the contact, is the undeformed gap where
    that is not a sphere's, and a mesh the file of the body, see `fem_adhesion.Meshed`, before a rigid wall.

    InputError if a value is out of range, one of the other body's two is missing, or parts do not go together.
    """

    radius: float
    modulus: float
    poisson: float
    work_of_adhesion: float
    spacing: float
    counter_modulus: float | None = None
    counter_poisson: float | None = None
    counter_radius: float = math.inf
    stiffness: float = math.inf
    grip: GripName = "sliding"
    law: Law = LENNARD_JONES
    thickness: float | None = None
    foundation: Foundation = "bonded"
    profile: Profile | None = None
    mesh: Path | None = None

    def __post_init__(self) -> None:
        require_poisson(self.poisson)
        require_law(self.law)
        if not self.stiffness > 0:
            raise InputError(
                f"stiffness = {self.stiffness:g} N/m is outside 0 < stiffness; leave it out for fixed grips"
            )
        given = {"counter_modulus": self.counter_modulus, "counter_poisson": self.counter_poisson}
        missing = [name for name, value in given.items() if value is None]
        if len(missing) == 1:
            raise InputError(f"{missing[0]} = None, limit: with both or none of {' and '.join(given)}; give it too")
        if self.thickness is not None and self.pair:
            raise InputError(
                f"thickness = {self.thickness:g} m with another elastic or round body, limit: a rigid sphere on a "
                "thin sample; leave out the counter-body"
            )
        if self.profile is not None:
            require_profile(self.profile)
        for name, other, what in (
            ("profile", math.isfinite(self.counter_radius), "another round body; a profile is the whole gap"),
            ("profile", self.mesh, "a mesh, which has its own surface; give one of both"),
            ("mesh", self.pair or self.thickness, "another body or a thin sample; a mesh meets a rigid wall"),
        ):
            if other and getattr(self, name) is not None:
                raise InputError(f"{name} = {getattr(self, name)} does not go with {what}")
        self.units, self.layer  # noqa: B018  they refuse what is not positive
        if self.thickness is not None:
            self.require_sample(self.thickness)

    def require_sample(self, thickness: float) -> None:
        """Raise InputError unless a sample is thicker than the spacing."""
        if not thickness > self.spacing:
            raise InputError(
                f"thickness = {thickness:g} m is outside {self.spacing:g} m < thickness, the equilibrium spacing; "
                "give a thicker sample, or a unit, as 500nm"
            )

    @cached_property
    def units(self) -> Units:
        """Units of the contact."""
        modulus = contact_modulus(self.modulus, self.poisson, *(self._other or ()))
        return Units(equivalent_radius(self.radius, self.counter_radius), modulus, self.work_of_adhesion, self.spacing)

    @cached_property
    def layer(self) -> Layers | None:
        """The thin sample, or None."""
        if self.thickness is None:
            return None
        beta, (least, most) = self.units.length, LAYER_THICKNESS
        if not least <= self.thickness / beta <= most:
            remedy = "give metres or a unit, as 500nm" if self.thickness < beta else "leave it out: it is a half-space"
            raise InputError(
                f"thickness = {self.thickness:g} m is outside {least * beta:.3g} m to {most * beta:.3g} m, "
                f"{least:g} to {most:g} beta; {remedy}"
            )
        return Layer(self.thickness / beta, self.poisson, self.foundation)

    @property
    def reduced_stiffness(self) -> float:
        """Stiffness of the cantilever in R dgamma/eps."""
        return self.stiffness / self.units.stiffness

    @property
    def shape(self) -> str:
        """What is given of the tip's shape, in words; nothing of a sphere."""
        return f"mesh {self.mesh}" if self.mesh else words_of(self.profile) if self.profile else ""

    @property
    def pair(self) -> bool:
        """Whether the other body is more than a rigid wall."""
        return self._other is not None or math.isfinite(self.counter_radius)

    @property
    def smaller_poisson(self) -> float:
        """Poisson's ratio of the smaller body; of the elastic one if that is rigid."""
        return self._other[1] if self._other and self.counter_radius < self.radius else self.poisson

    @property
    def larger_radius(self) -> float:
        """Radius of the larger body in radii of the smaller one."""
        ratio = self.counter_radius / self.radius
        return max(ratio, 1 / ratio)

    @cached_property
    def share(self) -> float | None:
        """Part of the compliance that is the larger body's, or None before a rigid wall."""
        if not self.pair:
            return None
        its_part = self.units.modulus * (1 - self.poisson**2) / self.modulus
        share = its_part if self.counter_radius < self.radius else 1 - its_part
        return min(max(share, RIGID), 1 - RIGID)

    @cached_property
    def counter(self) -> Body | None:
        """The larger body, or None before a rigid wall; the wall itself is a half-space."""
        if not self.pair:
            return None
        poisson = self.poisson if self.counter_radius < self.radius or self._other is None else self._other[1]
        if math.isinf(self.larger_radius):
            return HalfSpace(poisson=poisson)
        _, larger = facing_pair(self.units.radius_ratio, self.larger_radius)
        return Hemisphere(radius_ratio=larger, grip=self.grip, poisson=poisson)

    @property
    def smaller_ratio(self) -> float:
        """R/eps of the smaller body."""
        return facing_pair(self.units.radius_ratio, self.larger_radius)[0]

    @property
    def _other(self) -> tuple[float, float] | None:
        """Modulus and Poisson's ratio of the other body, None if it is rigid."""
        if self.counter_modulus is None or self.counter_poisson is None:
            return None
        return self.counter_modulus, require_poisson(self.counter_poisson)


@dataclass(frozen=True)
class Inputs:
    """What a contact is made of: its quantities as they were measured, by the names of `Contact`, and its other parts.

    The profile is made for the contact that it is given, as its lengths are known in SI.

    A Hamaker constant in J, ``hamaker``, may take the place of the spacing, which then follows from it and the work of
    adhesion.
    """

    quantities: Mapping[str, Measured]
    parts: Mapping[str, Any]
    profile: Callable[[Contact], Profile] | None = None

    def contact(self, **changed: float) -> Contact:
        """Contact of the values, some of them changed; InputError as of `Contact`."""
        values: dict[str, Any] = {name: given.value for name, given in self.quantities.items()} | changed
        if "hamaker" in values:
            values["spacing"] = spacing_of(values.pop("hamaker"), values["work_of_adhesion"])
        contact = Contact(**values, **self.parts)
        return replace(contact, profile=self.profile(contact)) if self.profile else contact

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviations of those quantities that have one."""
        return {name: given.deviation for name, given in self.quantities.items() if given.deviation}


def edge_told(law: Law) -> str:
    """Where a contact by a law ends."""
    return f"where the gap is {1 + law.edge_gap:.6g} eps, the place of the largest tension"
