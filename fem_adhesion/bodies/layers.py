"""Layers on a base, one or many: what `halfspace.elastic.layers` knows by waves, as a mesh of their slabs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import Any, ClassVar

import numpy as np

from fem_adhesion.bodies.body import BESIDE, USUAL, Body, Discretisation, Layout
from fem_adhesion.materials import Elastic
from halfspace.elastic import grid, layers
from halfspace.elastic.grid import FLAT
from halfspace.errors import InputError
from halfspace.limits import require_film, require_poisson, require_thickness
from halfspace.scales import Scales
from halfspace.values import Array, keep


@dataclass(frozen=True)
class StrataSettings:
    """How far meshes of strata reach, and how deep their cells are.

    What dies out beside a contact falls by e^(-0.74 r/t) at least, there and back again to 1e-13: from the roots of the
    denominator of the yield, (3 - 4 nu) cosh 2x + 2 x^2 + 5 - 12 nu + 8 nu^2, the first at nu = 1/2. Slender strata on
    a rigid base yield to an attraction that reaches farther: its gap is wide there, and they move by a part of their
    thickness; the stiffness along them falls short of that across by the square of this.

    Cells as thin as at the contact edge but long, under the contact and far out, make the stiffness ill-conditioned:
    from one contact radius to the next compliances of a coating of poisson 0.4999 scattered by 1e-4, of others by 1e-6,
    as deep as they are by 5e-6 and 3e-9; under the contact by 2e-6 and 1e-8, now by 3e-8 and 5e-10. At 0.1 estimates on
    thick coatings are 1.5 times as wide.
    """

    far_out: float = 10.0  # lengths of its spread that a half-space under strata ends farther out than one without in
    # its own: at 100, 1e3 and 1e4 the deflection of a stiff film errs by 6e-7, 2e-8 and less than 1e-9 of itself
    spread: float = 0.01  # least length over which strata spread a load, in the radius of what attracts
    width: float = 800.0  # of the mesh in widths of a rigid attraction: the load beyond is 1e-10 R dgamma
    died_out: float = 20.0  # thicknesses that the mesh is wider, see above
    slender: float = 1e5  # thicknesses that are meshed; on an elastic base thicknesses or beta, whichever is more
    deeper: float = 0.03  # of the length of a column of cells, by which those in it are deeper, until all are alike


STRATA = StrataSettings()


class Strata:
    """Strata as the integral equation asks for them, so that it takes these bodies as well."""

    strata: tuple[layers.Stratum, ...]
    base: layers.Foundation | layers.Substrate


@dataclass(frozen=True, kw_only=True)
class Stratified(Strata, Body):
    """Strata on a rigid base or on a half-space; E* is that of the first."""

    checked_by = "half-space"
    strip = math.pi / 2

    looks: ClassVar[str] = "elastic layer"

    def made_of(self, layered: layers.Layers) -> None:
        """Fill in what follows from the strata as the integral equation has them.

        A rigid base is clamped, or slides and the strata go on beyond their edge; a half-space goes on. Of strata that
        slide, what goes on has the shear stiffness of all.
        """
        strata, base = layered.strata, layered.base
        below = [base] if isinstance(base, layers.Substrate) else []
        parts: list[layers.Stratum | layers.Substrate] = [*strata, *below]
        held = "substrate" if below else "clamped" if base == "bonded" else "sheet"
        unit = 1 - strata[0].poisson ** 2
        regions = [Elastic(part.poisson, part.modulus * unit / (1 - part.poisson**2)) for part in parts]
        shear = [modulus * (1 - poisson) for poisson, modulus in regions]
        whole = sum(G * stratum.thickness for G, stratum in zip(shear, strata, strict=False))
        sheet = Elastic(regions[0].poisson, whole / shear[0] / layered.thickness)
        keep(self, layered=layered, strata=strata, base=base, held=held, regions=tuple(regions))
        keep(self, beyond=regions[-1] if below else sheet)
        keep(self, interfaces=tuple(accumulate(stratum.thickness for stratum in strata)))

    def extent(self, scales: Scales) -> float:
        """Radius up to which its surface attracts."""
        return scales.whole_radius((STRATA.width * scales.widened) ** 2 / 2)

    def layout(self, R: float, how: Discretisation) -> Layout:
        """Cells up to the end of what attracts, or of the surface over it; those far out are rigid.

        An elastic base yields there by the load over the distance, which is nothing beside the gap. Cells 1e10 times as
        long as deep made the stiffness singular.
        """
        depth = self.interfaces[-1]
        slender = STRATA.slender * (max(1.0, depth) if self.held == "substrate" else depth)
        return grid.equal_ratios(min(R, slender), R, most=how.growth), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Cells as deep as the strata are thick, and far beyond if what carries them is a half-space."""
        from fem_adhesion.mesh.block import tensor_grid
        from fem_adhesion.mesh.spheres import with_contact_to

        R = min(R, float(lines[-1]))  # without what is rigid
        size, interfaces = self._size(R, how), self.interfaces
        depths = [0.0, *interfaces, *([size] if self.held == "substrate" else [])]
        # Neither the depths nor what is beyond depends on the contact radius, by which operators are interpolated.
        r = np.append(lines, R + grid.geometric(size - R, BESIDE * R, how.growth)[1:])
        finest = min(length, BESIDE * R)
        slabs = [_slab(*ends, finest, how.growth) for ends in pairwise(depths)]
        mesh = with_contact_to(tensor_grid(r, _joined(slabs), depths[1:-1]), R)
        if self.held != "substrate":
            mesh = mesh.with_boundaries({"far": lambda x: x[1] == -depths[-1], "edge": lambda x: x[0] == r[-1]})
        return _deepened(mesh, r, slabs, finest)

    def _size(self, R: float, how: Discretisation) -> float:
        """Radius of the mesh: where all that dies out on a rigid base has done so, or what strata spread is small."""
        moduli = [modulus for _, modulus in self.regions]
        if self.held != "substrate":
            return R + STRATA.died_out * math.sqrt(max(moduli) / min(moduli)) * self.interfaces[-1]
        return max(2 * R, how.beyond * self.spread(R))

    def spread(self, R: float) -> float:
        """Length in beta over which a half-space below is loaded: where strata spread what pulls at them within R.

        It is some times longer than that of the strata, see `StrataSettings.far_out`.
        """
        moduli = [modulus / self.beyond.modulus for _, modulus in self.regions]
        stiffness = sum(max(1.0, E) * part.thickness for E, part in zip(moduli, self.strata, strict=False))
        return STRATA.far_out * max(STRATA.spread * R, stiffness)


def _slab(begin: float, end: float, finest: float, growth: float) -> Array:
    """Ends of cells between two depths, as long as cells that grow from the surface are there, or less."""
    length = min(finest + (growth - 1) * begin, end - begin)
    return np.asarray(begin + grid.graded(0.0, length, end - begin, growth=growth))


def _joined(slabs: Sequence[Array]) -> Array:
    """Lines of slabs one below the other, each of which begins where the one above ends."""
    return np.concatenate([slabs[0][:1], *(slab[1:] for slab in slabs)])


def _deepened(mesh: Any, r: Array, slabs: Sequence[Array], finest: float) -> Any:
    """Mesh of slabs between lines of constant radius, the long cells in them deeper, see `StrataSettings`."""
    even = [np.linspace(slab[0], slab[-1], slab.size) for slab in slabs]
    z, towards, mean = _joined(slabs), _joined(even), _joined([np.gradient(lines) for lines in even])
    column, row = np.searchsorted(r, mesh.p[0]), np.searchsorted(z, -mesh.p[1])
    deeper = STRATA.deeper * (np.gradient(r) - finest)[column]
    depth = z[row] + deeper / (deeper + mean[row]) * (towards - z)[row]
    return replace(mesh, doflocs=np.array([mesh.p[0], -depth]))


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
        self.made_of(layers.Layer(self.thickness, self.material.poisson, self.foundation))
        keep(self, words=[*self.words, f"thickness {self.thickness:g} beta", self.foundation])


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
        self.made_of(layers.Coated(self.thickness, self.modulus_ratio, self.material.poisson, self.substrate_poisson))
        below = f"on a half-space of poisson {self.substrate_poisson:g}"
        thickness, stiffness = f"thickness {self.thickness:g} beta", f"{self.modulus_ratio:g} times as stiff"
        keep(self, words=[*self.words, thickness, stiffness, below])


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

    strata: tuple[layers.Stratum, ...]
    base: layers.Foundation | layers.Substrate = "bonded"

    looks: ClassVar[str] = "layered body"

    def __post_init__(self, poisson: float | None) -> None:
        layered = layers.Layers(self.strata, self.base)
        strata, base = layered.strata, layered.base
        first, own = strata[0].poisson, self.material.poisson if self.material is not USUAL else None
        given = [value for value in (poisson, own) if value not in (None, first)]
        if given:
            remedy = f"leave it out, or replace material too, by LinearElastic({first:g})"
            raise InputError(f"poisson = {given[0]:g} with strata, limit: that of the first, {first:g}; {remedy}")
        super().__post_init__(first)
        self.made_of(layered)
        words = [f"{part.thickness:g} beta of modulus {part.modulus:g}, poisson {part.poisson:g}" for part in strata]
        if isinstance(base, layers.Substrate):
            words.append(f"half-space of modulus {base.modulus:g}, poisson {base.poisson:g}")
        else:
            words.append(base)
        keep(self, words=[*self.words, *words])


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
