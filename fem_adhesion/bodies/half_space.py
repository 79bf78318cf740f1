"""The elastic half-space, and the block, which is one that is cut off."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from fem_adhesion.bodies.body import BESIDE, Body, Discretisation, Layout
from halfspace.elastic import grid
from halfspace.elastic.grid import FLAT
from halfspace.errors import InputError
from halfspace.limits import require_one_of, require_radius
from halfspace.values import Array, keep

BlockFarField = Literal["point_load", "clamped", "free"]


@dataclass(frozen=True)
class HalfSpace(Body):
    """Half-space, meshed as a block that goes on beyond its mesh as under a point load."""

    checked_by = "half-space"

    faces: ClassVar[bool] = True
    looks: ClassVar[str] = "elastic half-space"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, words=[])  # it is the usual body

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (one for all)
        """Cells up to the end of the surface over it."""
        return np.array([R]), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Block as large as the lines or, where the law acts only as far as a surface reaches, larger than that."""
        from fem_adhesion.mesh.block import tensor_grid
        from fem_adhesion.mesh.spheres import with_contact_to

        if np.isinf(R):
            return _as_deep_as_wide(lines, _shortest(lines), how)
        past = grid.geometric((how.beyond - 1) * R, BESIDE * R, how.growth)[1:]
        depths = grid.graded(0.0, min(length, BESIDE * R), how.beyond * R, growth=how.growth)
        return with_contact_to(tensor_grid(np.concatenate([lines, R + past]), depths), R)

    def facing(self, R: float, lines: Array, length: float, smaller: float, how: Discretisation) -> Any:  # noqa: ARG002
        """Block whose cells end where those of the sphere do, and beyond at ever larger distances."""
        from fem_adhesion.mesh.spheres import block_under

        depths = grid.graded(0.0, length, how.beyond * smaller, growth=how.growth)
        return block_under(lines, depths, smaller, how.beyond * smaller)


@dataclass(frozen=True, kw_only=True)
class Block(Body):
    """Block of fixed size under a paraboloid, or another surface that does not end.

    Parameters
    ----------
    radius : float
        Its size L in beta.
    far_field : {"point_load", "clamped", "free"}
        What holds it at its far boundary: a half-space beyond it that moves as under a point load, a clamp, or nothing
        but the uniform traction that balances the load.
    """

    radius: float
    far_field: BlockFarField = "point_load"

    checked_by = "half-space"

    looks: ClassVar[str] = "elastic block"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, radius=require_radius(self.radius))
        require_one_of(self.far_field, "far_field", get_args(BlockFarField))
        keep(self, held=self.far_field, cut_off=self.radius)
        keep(self, words=[*self.words, f"size {self.radius:g} beta", *([] if self.endless else [self.far_field])])

    def check(self, tabor: float, end: float) -> None:
        """Refuse a block smaller than its contact, or one under a sphere."""
        if math.isfinite(end):
            raise InputError(f"profile that ends at {end:.4g} beta does not go with {self.name}; take a half-space")
        require_radius(self.radius, tabor, 5.0 if self.endless else 8.0)

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (one for all)
        """Its surface ends where it does."""
        return np.array([self.radius]), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:  # noqa: ARG002
        """Block as large as the lines, which are in contact radii where it goes on beyond them."""
        return _as_deep_as_wide(lines, _shortest(lines) if self.endless else length, how)


def _shortest(lines: Array) -> float:
    return float(np.diff(lines).min())


def _as_deep_as_wide(lines: Array, finest: float, how: Discretisation) -> Any:
    from fem_adhesion.mesh.block import tensor_grid

    return tensor_grid(lines, grid.graded(0.0, finest, float(lines[-1]), growth=how.growth))
