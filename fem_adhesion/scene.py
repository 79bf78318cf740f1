"""What is asked: one contact, made of parts, dimensionless, validated and frozen."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from fem_adhesion.bodies.body import Body, SolverName
from fem_adhesion.bodies.half_space import HalfSpace
from fem_adhesion.bodies.layers import as_body
from fem_adhesion.materials import Material
from fem_adhesion.registry import words_of
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import (
    require_modulus,
    require_part,
    require_poisson,
    require_radius_ratio,
    require_share,
    require_tabor,
)
from halfspace.profiles import Profile, Sphere, Surface, require_profile
from halfspace.scales import Scales
from halfspace.values import Array, Valued, keep

HALF_SPACE = HalfSpace()


@dataclass(frozen=True)
class Scene:
    """An elastic body under a rigid wall, or another body, that attracts it.

    Parameters
    ----------
    tabor : float
        Tabor parameter, positive; of two bodies with the R and E* of the pair, 1/R = 1/R1 + 1/R2.
    body : Body
        What is elastic, see `fem_adhesion.bodies`: `HalfSpace` (the default), `Block`, `Layer`, `Coated`,
        `Layers`, `Hemisphere`, `HeldSphere` or `Meshed`. Each has the R/eps of its own.
    profile : Profile, optional
        Undeformed gap, see `halfspace.profiles`; that of the bodies themselves unless given, and of a half-space a
        paraboloid.
    law : Law
        Of the tension between the surfaces, see `halfspace.laws`.
    counter : Body, optional
        A second, larger body, a `Hemisphere` or a `HalfSpace`, in the place of the rigid wall.
    share : float, optional
        Its part of the pair's compliance, (1 - nu2^2) E*/E2, between 0 and 1; 1/2 for equal materials, see `share_of`.

    Raises
    ------
    InputError
        If a value is out of range, or does not go with the others.
    """

    tabor: float
    body: Body = HALF_SPACE
    profile: Profile | None = None
    law: Law = LENNARD_JONES
    counter: Body | None = None
    share: float | None = None

    def __post_init__(self) -> None:
        keep(self, tabor=require_tabor(self.tabor), law=require_law(self.law), body=as_body(self.body))
        for name, part, kind in (("body", self.body, Body), ("counter", self.counter, Body | None)):
            if not isinstance(part, kind):
                raise InputError(f"{name} = {part!r} is no body; take fem_adhesion.Hemisphere(radius_ratio=100), say")
        if self.profile is not None:
            require_profile(self.profile)
            if self.body.file:
                raise InputError(
                    f"profile = {self.profile} does not go with {self.body.name}; the mesh has its own surface"
                )
        self._require_pair()
        if math.isfinite(self.body.size):
            require_radius_ratio(self.body.size / (1 + self._smaller), self.tabor)
        self.body.check(self.tabor, self.surface.end)

    def _require_pair(self) -> None:
        """Refuse a counter-body that cannot be, or a share without one."""
        counter, share = self.counter, self.share
        if counter is None:
            if share is not None:
                raise InputError(f"share = {share} without a counter-body; give counter too, or leave it out")
            return
        if not (self.body.meets and counter.faces):
            raise InputError(
                f"counter = {counter.name} does not go with body = {self.body.name}; a hemisphere meets another or a "
                "half-space"
            )
        keep(self, share=require_share(share))
        if not counter.size >= self.body.size:
            raise InputError(
                f"radius_ratio = {counter.size:g} of the counter-body is outside {self.body.size:g} <= radius_ratio; "
                "let the smaller body be first"
            )
        for material in (self.body.material, counter.material):
            if material.finite or material.area != "projected":
                raise InputError(f"counter = {counter.name} does not go with material = {material}; leave one out")

    @property
    def _smaller(self) -> float:
        """R1/R2, zero for a wall or a half-space."""
        return self.body.size / self.counter.size if self.counter and math.isfinite(self.counter.size) else 0.0

    @property
    def bodies(self) -> tuple[Body, ...]:
        """What is elastic: one body, or two."""
        return (self.body,) if self.counter is None else (self.body, self.counter)

    @property
    def material(self) -> Material:
        """Of the first body."""
        return self.body.material

    @property
    def poisson(self) -> float:
        """Poisson's ratio of the first body."""
        return self.material.poisson

    @property
    def checked_by(self) -> SolverName | None:
        """Solver without finite elements that knows every body, see `fem_adhesion.crosscheck.references`.

        Harmonics are not asked about a pointed tip: half of its gap's error on the axis was left by a decade of rtol,
        up to 2.2 times the estimate.
        """
        known = [body.checked_by for body in self.bodies]
        return known[0] if all(known) and not ("harmonics" in known and self.surface.pointed) else None

    @property
    def for_half_space(self) -> dict[str, Any]:
        """What `halfspace.trace` is given of the scene."""
        return {"tabor": self.tabor, "law": self.law, "profile": self.shape, "body": self.body.layered}

    @property
    def left_out(self) -> list[str]:
        """What `halfspace.trace` is not given of the scene, in words; nothing of a half-space and of strata."""
        if self.body.endless or self.body.layered:
            return []
        return [*self.body.words, f"poisson {self.poisson:g}", *self._unusual]

    def made_of(self, material: Material) -> Scene:
        """Return the same contact of another material."""
        return replace(self, body=replace(self.body, material=material))

    @property
    def shape(self) -> Profile:
        """Undeformed gap: the profile that is given, or that of both bodies."""
        if self.profile is not None:
            return self.profile
        if self._smaller:
            return Sphere(self.body.size / (1 + self._smaller), 1 / self._smaller)
        return self.body.shape

    @cached_property
    def surface(self) -> Surface:
        """Its heights in beta^2/R, up to where the smaller body ends."""
        surface, (end, *_) = self.shape.surface(self.tabor), self._own_radii
        end = min(end, self.body.extent(Scales(self.tabor, self.law, surface, self.body.layered)))
        return surface if surface.end <= end else UpTo(surface, end)

    @property
    def tension_beyond(self) -> float:
        """Tension in R dgamma beyond the cells of a layer, whose surface goes on: no discretisation counts it."""
        if not self.body.layered:
            return 0.0
        return Scales(self.tabor, self.law, self.shape.surface(self.tabor)).tension_beyond(self.surface.end)

    @cached_property
    def scales(self) -> Scales:
        """Its lengths."""
        return Scales(self.tabor, self.law, self.surface, self.body.layered)

    @property
    def sized(self) -> bool:
        """Whether the scene has a length of its own beside beta: a surface that ends."""
        return math.isfinite(self.surface.end)

    @property
    def radius_ratio(self) -> float | None:
        """Rho = R/eps of the body, the pair or the profile, None if none has one."""
        if math.isfinite(self.body.size):
            return self.body.size / (1 + self._smaller)
        return getattr(self.shape, "radius_ratio", None)

    @property
    def sphere_radius(self) -> float:
        """R/beta, infinite for a paraboloid on a half-space."""
        return math.sqrt(self.radius_ratio / self.tabor) if self.radius_ratio else math.inf

    @property
    def radii(self) -> tuple[float, ...]:
        """Radii of the bodies in beta; that of a half-space is where the surface over it ends, or infinite."""
        first, *others = self._own_radii
        return (first if math.isfinite(first) else self.surface.end, *others)

    @property
    def _own_radii(self) -> tuple[float, ...]:
        R = self.sphere_radius if math.isfinite(self.body.size) else math.inf
        if self.counter is None:
            return (R,)
        return R * (1 + self._smaller), R * (1 + 1 / self._smaller) if self._smaller else math.inf

    @property
    def shares(self) -> tuple[float, ...]:
        """Parts of the compliance 1/E* that are the bodies': each displaces as one of modulus E* times its part."""
        return (1.0,) if self.share is None else (1.0 - self.share, self.share)

    @property
    def words(self) -> list[str]:
        """What it is, in words: Tabor parameter, material and body, and what else is not as usual."""
        words = [f"tabor {self.tabor:g}", f"poisson {self.poisson:g}", *self.body.words]
        words += [f"R/eps {self.radius_ratio:.4g}"] if self.radius_ratio else []
        if self.profile not in (None, self.body.shape):
            words.append(f"under a {words_of(self.profile)}")
        if self.law != LENNARD_JONES:  # the Tabor parameters at which that has the same work, and strength or stiffness
            strong = self.tabor * self.law.strength / LENNARD_JONES.strength
            stiff = self.tabor * math.sqrt(self.law.stiffness / LENNARD_JONES.stiffness)
            like = f"as strong as the 3-9 law at tabor {strong:.4g}, as stiff at {stiff:.4g}"
            words.append(f"law {words_of(self.law)}, {like}")
        return [*words, *self._unusual]

    @property
    def _unusual(self) -> list[str]:
        """What there is of the material and a counter-body that is not as usual, in words."""
        material = self.material
        words = [f"traction per {material.traction}"] if material.traction != "projected" else []
        words += ["finite strain"] if material.finite else []
        if self.counter:
            larger = 1 / self._smaller if self._smaller else math.inf
            words.append(f"counter-body with {self.share:.4g} of the compliance, radius {larger:.4g}")
            words += [f"its poisson {self.counter.material.poisson:g}", *self.counter.words[1:]]
        return words


@dataclass(frozen=True, eq=False, repr=False)
class UpTo(Valued, Surface):
    """A surface up to a radius `end` in beta, where the body ends."""

    surface: Surface
    end: float

    @property
    def pointed(self) -> bool:
        """Whether it rises from the axis as a power of the radius."""
        return self.surface.pointed

    @property
    def pieced(self) -> bool:
        """Whether some derivative leaps between pieces of it."""
        return self.surface.pieced

    def height(self, radii: Array) -> Array:
        """Height in beta^2/R."""
        return self.surface.height(radii)

    def slope(self, radii: Array) -> Array:
        """Derivative of the height by the radius."""
        return self.surface.slope(radii)

    def first_cell(self, tolerance: float) -> float:
        """Length of the cell on the axis."""
        return self.surface.first_cell(tolerance)


def require_scene(scene: Scene) -> None:
    """Raise InputError for what is no scene."""
    require_part(scene, "scene", "counter", "fem_adhesion.Scene(tabor=1.0)")


def share_of(modulus: float, poisson: float, counter_modulus: float, counter_poisson: float) -> float:
    """Part of the compliance that a counter-body has by the elastic constants of both, 1/E* = sum (1 - nu^2)/E.

    Parameters
    ----------
    modulus, poisson : float
        Young's modulus E1, in any unit, and Poisson's ratio nu1 of the first body.
    counter_modulus, counter_poisson : float
        E2, in the same unit, and nu2 of the counter-body.

    Raises
    ------
    InputError
        If a value is out of range.
    """
    compliances = [
        (1 - require_poisson(nu) ** 2) / require_modulus(E)
        for E, nu in ((modulus, poisson), (counter_modulus, counter_poisson))
    ]
    return compliances[1] / sum(compliances)


def facing_pair(radius_ratio: float, counter_radius: float) -> tuple[float, float]:
    """R1/eps and R2/eps of two bodies from the pair's R/eps, 1/R = 1/R1 + 1/R2, and R2/R1."""
    return radius_ratio * (1 + 1 / counter_radius), radius_ratio * (1 + counter_radius)
