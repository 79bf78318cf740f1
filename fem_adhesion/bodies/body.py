"""What there is to know of an elastic body: it is asked for that, and by nobody for its kind."""

# Annotations are evaluated here: those of fields are read again in the modules of the bodies that inherit them.
import math
from abc import ABC, abstractmethod
from dataclasses import InitVar, dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from fem_adhesion.materials import Elastic, LinearElastic, Material
from fem_adhesion.registry import name_of
from halfspace.elastic.grid import SurfaceCoordinate
from halfspace.elastic.layers import LayeredBody
from halfspace.errors import InputError
from halfspace.limits import require_one_of, require_poisson, require_radius_ratio
from halfspace.profiles import PARABOLOID, Profile, Sphere
from halfspace.scales import Scales
from halfspace.values import Array, keep

FarFieldName = Literal["point_load", "substrate", "clamped", "free", "sliding", "sheet"]
GripName = Literal["sliding", "bonded"]
SolverName = Literal["half-space", "harmonics"]

MOST_RINGS = 6  # rings around a singular corner: as many as rounding allows
BESIDE = 0.02  # of the radius where a surface ends: the cells beside it and below, where the traction ends at once
USUAL = LinearElastic()

Layout = tuple[Array, SurfaceCoordinate]
"""Ends of the last cells of a surface, which do not move with the contact, ascending; and the coordinate along it."""


@dataclass(frozen=True)
class Discretisation:
    """How finely a body is discretised, by quadrilaterals of a degree, the error falling by a decade a degree.

    `finest` is the length of the cells at the contact edge, in widths of the spike of tension there, `growth` the ratio
    of neighbouring cells, and `rings` the number of rings of cells around the corner where a mid-plane meets the free
    surface, if it is bonded. `beyond` is the size L of what is meshed of a half-space under a surface that ends, in the
    radius of that, or under strata, in the length over which they spread a load, see `layers.Stratified.spread`: the
    far field errs by O(L^-5). Each cell of a mesh that is given is cut into four as often as `refined` says.
    """

    degree: int
    finest: float = 0.6
    growth: float = 2.5
    rings: int = MOST_RINGS - 1
    beyond: float = 1e3
    refined: int = 0


class Known:
    """What others ask a body for: it follows from what the body is made from, and is known once it is made.

    R is the body's own radius of curvature at the pole.
    """

    words: list[str]  # what it is, in words
    held: FarFieldName = "point_load"  # what holds its far boundary
    regions: tuple[Elastic, ...]  # materials from the surface down, as in its mesh; most bodies have one
    interfaces: tuple[float, ...] = ()  # depths in beta at which one region ends
    beyond: Elastic  # what it goes on as beyond its mesh, if it does
    size: float = math.inf  # R/eps, infinite of a flat surface
    shape: Profile = PARABOLOID  # profile of a contact with it
    layered: LayeredBody | None = None  # strata on a base, see `halfspace.elastic.layers`
    strip: float = math.pi  # where its kernel is analytic, see `halfspace.accuracy.finite_bodies.SizedBody`
    cut_off: float | None = None  # its size in beta if it is cut off under an endless surface
    file: Path | None = None  # its mesh, if it is given; other bodies are meshed anew for every contact radius
    checked_by: SolverName | None = None  # solver without finite elements, see `fem_adhesion.crosscheck.references`
    other_cells: bool = False  # whether only other cells tell what its cells leave, not a degree more


@dataclass(frozen=True, kw_only=True)
class Body(Known, ABC):
    """An elastic body of revolution, below its contact surface, with all of the pair's compliance 1/E* unless shared.

    `poisson` is short for ``material=LinearElastic(poisson)``; to be read as ``body.material.poisson``.
    InputError if a value is out of range, or does not go with the others.
    """

    material: Material = USUAL
    poisson: InitVar[float | None] = None

    stretches: ClassVar[bool] = False  # whether it may be neo-Hookean
    curved: ClassVar[bool] = False  # whether the area of its surface differs from the projected one
    meets: ClassVar[bool] = False  # whether it may have a counter-body
    faces: ClassVar[bool] = False  # whether it may be a counter-body
    has_fields: ClassVar[bool] = True  # whether the fields inside it are to be had
    looks: ClassVar[str] = "elastic body"  # what a picture of it shows

    def __post_init__(self, poisson: float | None) -> None:
        if poisson is not None and self.material is USUAL:
            keep(self, material=LinearElastic(poisson))
        elif poisson is not None and require_poisson(poisson) != self.material.poisson:
            raise InputError(
                f"poisson = {poisson:g} and material = {self.material} are given; give one of them, not both"
            )
        if self.material.finite and not self.stretches:
            raise InputError(
                f"material = {self.material} does not go with {self.name}; finite strain is for a hemisphere"
            )
        if self.material.area != "projected" and not self.curved:
            raise InputError(
                f"traction = {self.material.traction} does not go with {self.name}; it differs on a curved surface only"
            )
        own = Elastic(self.material.poisson)
        keep(self, words=[self.name], regions=(own,), beyond=own)

    @property
    def name(self) -> str:
        """What it is called on the command line and in files."""
        return name_of(self)

    @property
    def endless(self) -> bool:
        """Whether it goes on beyond its mesh as a half-space does."""
        return self.held == "point_load"

    def extent(self, scales: Scales) -> float:  # noqa: ARG002 (few are cut off)
        """Radius in beta at which its contact surface is cut off, where nothing attracts any more."""
        return math.inf

    def check(self, tabor: float, end: float) -> None:
        """Refuse a Tabor parameter, or a radius at which the surface over it ends, out of range; raise InputError."""

    @abstractmethod
    def layout(self, R: float, how: Discretisation) -> Layout:
        """Cells of the contact surface that stand still, and the coordinate along it; see `Layout`."""

    @abstractmethod
    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Mesh with the boundaries "axis", "contact" and "far".

        R is the radius in beta, that of the surface over a half-space; infinite if neither ends. Lines (m + 1,) are the
        ends of the cells of the contact, in the coordinate, from 0 to the first of those that stand still; the length,
        in beta, is that of the cells at the contact edge. Where the surface ends neither depths nor what is beyond may
        depend on the lines: a polynomial goes through the operators at some contact radii, and those of meshes with a
        layer of cells more or less differ by what these leave.
        """

    def facing(self, R: float, lines: Array, length: float, smaller: float, how: Discretisation) -> Any:  # noqa: ARG002
        """Mesh of the body as a counter-body of one of the radius `smaller`, whose cells' ends are `lines`."""
        raise InputError(f"counter = {self.name} does not face another body; take a hemisphere or a half-space")


@dataclass(frozen=True, kw_only=True)
class Held(Body):
    """A body with a length R of its own, held at its far side; rho = R/eps is 2 to 1e12.

    The grip is "sliding", u_z = 0, if the held surface may slide without friction, or "bonded", u = 0, if not at all.
    """

    radius_ratio: float
    grip: GripName = "sliding"

    looks: ClassVar[str] = "elastic sphere"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, radius_ratio=require_radius_ratio(self.radius_ratio))
        require_one_of(self.grip, "grip", get_args(GripName))
        bonded = self.grip == "bonded"
        keep(self, held="clamped" if bonded else "sliding", words=[*self.words, *(["bonded"] if bonded else [])])
        keep(self, size=self.radius_ratio, shape=Sphere(self.radius_ratio))

    def rings(self, R: float, how: Discretisation) -> Array:  # noqa: ARG002 (most have none)
        """Sizes of the rings around the equator, in parts of the last cell."""
        return np.empty(0)

    def layout(self, R: float, how: Discretisation) -> Layout:
        """Layers and rings beyond the core of a sphere's mesh."""
        from fem_adhesion.mesh.spheres import contact_ends

        return contact_ends(R, self.rings(R, how)), SurfaceCoordinate(R, self.material.area)
