"""Layers on a base, one or many: what `halfspace.elastic.layers` knows by waves, as a mesh of their slabs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any, ClassVar

import numpy as np

from fem_adhesion.bodies.body import BESIDE, USUAL, Body, Discretisation, Doubt, FarFieldName, Layout, SolverName
from fem_adhesion.materials import Elastic
from halfspace.elastic import grid, layers
from halfspace.elastic.grid import FLAT
from halfspace.errors import InputError
from halfspace.limits import require_film, require_poisson, require_thickness
from halfspace.scales import Scales
from halfspace.values import Array, keep

# Lengths of their spread that a half-space under strata ends farther out than one without in its own: at 100, 1e3 and
# 1e4 of these the deflection of a stiff film errs by 6e-7, 2e-8 and less than 1e-9 of itself.
FAR_OUT = 10.0
SPREAD = 0.01  # least length over which strata spread a load, in the radius of what attracts
WIDTH = 800.0  # width of the mesh in widths of a rigid attraction: the load left out beyond is 1e-10 R dgamma
# Thicknesses that the mesh is wider: what dies out falls by e^(-0.74 r/t) at least, there and back again to 1e-13. From
# the roots of the denominator of the yield, (3 - 4 nu) cosh 2x + 2 x^2 + 5 - 12 nu + 8 nu^2, the first at nu = 1/2.
DIED_OUT = 20.0
# Thicknesses up to which strata on a rigid base yield to an attraction that reaches farther: its gap is wide there, and
# they move by a part of their thickness; the stiffness along them falls short of that across by the square of this.
SLENDER = 1e5


@dataclass(frozen=True, kw_only=True)
class Stratified(Body):
    """Strata on a rigid base or on a half-space; E* is that of the first."""

    looks: ClassVar[str] = "elastic layer"
    checked_by: ClassVar[SolverName] = "half-space"
    doubt: ClassVar[Doubt] = Doubt(other_cells=True, times=2.0)
    """Cells that suit the edge of the contact may be long for the rest; twice a usual change may be left."""

    @property
    def layered(self) -> layers.Layers:
        """What the integral equation knows it as."""
        raise NotImplementedError

    @cached_property
    def strata(self) -> tuple[layers.Stratum, ...]:
        """As the integral equation asks for them, so that it takes this body as well."""
        return self.layered.strata

    @cached_property
    def base(self) -> layers.Foundation | layers.Substrate:
        """The same."""
        return self.layered.base

    @property
    def held(self) -> FarFieldName:
        """Its base is clamped, or slides and the strata go on beyond their edge, or is a half-space that goes on."""
        if isinstance(self.base, layers.Substrate):
            return "substrate"
        return "clamped" if self.base == "bonded" else "sheet"

    @property
    def regions(self) -> tuple[Elastic, ...]:
        """Of the strata, and of a half-space below."""
        parts: list[layers.Stratum | layers.Substrate] = [*self.strata]
        parts += [self.base] if isinstance(self.base, layers.Substrate) else []
        unit = 1 - self.strata[0].poisson ** 2
        return tuple(Elastic(part.poisson, part.modulus * unit / (1 - part.poisson**2)) for part in parts)

    @property
    def beyond(self) -> Elastic:
        """The half-space, or of strata that slide one with the shear stiffness of all."""
        if self.held == "substrate":
            return self.regions[-1]
        shear = [modulus * (1 - poisson) for poisson, modulus in self.regions]
        whole = sum(G * stratum.thickness for G, stratum in zip(shear, self.strata, strict=True))
        return Elastic(self.regions[0].poisson, whole / shear[0] / layers.total_thickness(self))

    @property
    def interfaces(self) -> list[float]:
        """Depths at which strata end, in beta."""
        return list(accumulate(stratum.thickness for stratum in self.strata))

    def extent(self, scales: Scales) -> float:
        """Radius up to which its surface attracts."""
        return scales.whole_radius((WIDTH * scales.widened) ** 2 / 2)

    def layout(self, R: float, how: Discretisation) -> Layout:
        """Cells up to the end of what attracts, or of the surface over it; on a rigid base those far out are rigid."""
        slender = math.inf if self.held == "substrate" else SLENDER * self.interfaces[-1]
        return grid.equal_ratios(min(R, slender), R, most=how.growth), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Cells as deep as the strata are thick, and far beyond if what carries them is a half-space."""
        from fem_adhesion.mesh.block import tensor_grid
        from fem_adhesion.mesh.spheres import with_contact_to

        R = min(R, float(lines[-1]))  # without what is rigid
        size, interfaces = self._size(R, how), self.interfaces
        depths = [0.0, *interfaces, size] if self.held == "substrate" else [0.0, *interfaces]
        # Neither the depths nor what is beyond depends on the contact radius, by which operators are interpolated.
        r = np.append(lines, R + grid.geometric(size - R, BESIDE * R, how.growth)[1:])
        finest = min(length, BESIDE * R)
        z = np.concatenate([[0.0], *(_slab(*ends, finest, how.growth) for ends in pairwise(depths))])
        mesh = with_contact_to(tensor_grid(r, z, depths[1:-1]), R)
        if self.held == "substrate":
            return mesh
        return mesh.with_boundaries({"far": lambda x: x[1] == -z[-1], "edge": lambda x: x[0] == r[-1]})

    def _size(self, R: float, how: Discretisation) -> float:
        """Radius of the mesh: where all that dies out on a rigid base has done so, or what strata spread is small."""
        moduli = [modulus for _, modulus in self.regions]
        if self.held != "substrate":
            return R + DIED_OUT * math.sqrt(max(moduli) / min(moduli)) * self.interfaces[-1]
        return max(2 * R, how.beyond * self.spread(R))

    def spread(self, R: float) -> float:
        """Length in beta over which a half-space below is loaded: where strata spread what pulls at them within R.

        It is some times longer than that of the strata, see `FAR_OUT`.
        """
        moduli = [modulus / self.beyond.modulus for _, modulus in self.regions]
        stiffness = sum(max(1.0, E) * part.thickness for E, part in zip(moduli, self.strata, strict=False))
        return FAR_OUT * max(SPREAD * R, stiffness)


def _slab(begin: float, end: float, finest: float, growth: float) -> Array:
    """Ends of cells between two depths, as long as cells that grow from the surface are there, or less."""
    length = min(finest + (growth - 1) * begin, end - begin)
    return np.asarray(begin + grid.graded(0.0, length, end - begin, growth=growth)[1:])


@dataclass(frozen=True)
class Layer(Stratified):
    """Layer on a rigid base: a thin sample.

    Parameters
    ----------
    thickness : float
        In beta, 0.01 to 1000.
    foundation : {"bonded", "sliding"}
        Whether the base holds the layer, or carries it without friction.
    """

    thickness: float
    foundation: layers.Foundation = "bonded"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, thickness=require_thickness(self.thickness))
        layers.require_foundation(self.foundation)

    @property
    def layered(self) -> layers.Layers:
        """What the integral equation knows it as."""
        return layers.Layer(self.thickness, self.material.poisson, self.foundation)

    @property
    def words(self) -> list[str]:
        """Its thickness and foundation."""
        return [*super().words, f"thickness {self.thickness:g} beta", self.foundation]


@dataclass(frozen=True)
class Coated(Stratified):
    """Half-space under a coating that is bonded to it; E* is the coating's.

    Parameters
    ----------
    thickness : float
        Of the coating, in beta, 0.01 to 1000.
    modulus_ratio : float
        Young's modulus of the coating over that of the half-space, 0.001 to 100.
    substrate_poisson : float
        Poisson's ratio of the half-space; that of the coating is the material's.
    """

    thickness: float
    modulus_ratio: float
    substrate_poisson: float = 0.3

    looks: ClassVar[str] = "coated half-space"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        sizes = {"thickness": require_thickness(self.thickness), "modulus_ratio": require_film(self.modulus_ratio)}
        keep(self, **sizes, substrate_poisson=require_poisson(self.substrate_poisson))

    @property
    def layered(self) -> layers.Layers:
        """What the integral equation knows it as."""
        return layers.Coated(self.thickness, self.modulus_ratio, self.material.poisson, self.substrate_poisson)

    @property
    def words(self) -> list[str]:
        """Its coating and what is below."""
        below = f"on a half-space of poisson {self.substrate_poisson:g}"
        return [*super().words, f"thickness {self.thickness:g} beta", f"{self.modulus_ratio:g} times as stiff", below]


@dataclass(frozen=True)
class Layers(Stratified):
    """Strata on a base: a graded or many-layered body; its material is that of the first.

    Parameters
    ----------
    strata : sequence of Stratum
        From the surface down; the modulus of the first is the unit of all.
    base : {"bonded", "sliding"} or Substrate
        A rigid one to which the last stratum is bonded, or on which it slides, or an elastic half-space.
    """

    strata: tuple[layers.Stratum, ...] = field()  # not the property that it stands for
    base: layers.Foundation | layers.Substrate = "bonded"

    looks: ClassVar[str] = "layered body"

    def __post_init__(self, poisson: float | None) -> None:
        made = self.layered
        keep(self, strata=made.strata, base=made.base)
        first, own = self.strata[0].poisson, self.material.poisson if self.material is not USUAL else None
        given = [value for value in (poisson, own) if value not in (None, first)]
        if given:
            remedy = f"leave it out, or replace material too, by LinearElastic({first:g})"
            raise InputError(f"poisson = {given[0]:g} with strata, limit: that of the first, {first:g}; {remedy}")
        super().__post_init__(first)

    @property
    def layered(self) -> layers.Layers:
        """What the integral equation knows it as."""
        return layers.Layers(self.strata, self.base)

    @property
    def words(self) -> list[str]:
        """Its strata and base."""
        parts = [
            f"{part.thickness:g} beta of modulus {part.modulus:g}, poisson {part.poisson:g}" for part in self.strata
        ]
        base = self.base
        if isinstance(base, layers.Substrate):
            return [*super().words, *parts, f"half-space of modulus {base.modulus:g}, poisson {base.poisson:g}"]
        return [*super().words, *parts, base]


def as_body(part: object) -> object:
    """A body of finite elements in the place of layers as the integral equation has them; anything else as it is."""
    match part:
        case layers.Layers((only,), layers.Substrate(modulus, poisson)):
            return Coated(only.thickness, _inverse(modulus), poisson, poisson=only.poisson)
        case layers.Layers((only,), str(foundation)):
            return Layer(only.thickness, foundation, poisson=only.poisson)
        case layers.Layers(strata, base):
            return Layers(strata, base)
    return part


def _inverse(ratio: float) -> float:
    """Shortest number of which a ratio of moduli is the inverse, as it was typed."""
    short = float(f"{1 / ratio:.12g}")
    return short if 1 / short == ratio else 1 / ratio
