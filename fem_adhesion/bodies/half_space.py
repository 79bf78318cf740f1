"""The elastic half-space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from fem_adhesion.bodies.body import Body, Discretisation, FarFieldName, Layout, SolverName
from halfspace.elastic import grid
from halfspace.elastic.operators import FLAT
from halfspace.values import Array

BEYOND = 1e3  # size of the mesh in radii of a sphere that meets it
PAST_END = 0.02  # length of the first cell beyond the end of the surface over it, in the radius there


@dataclass(frozen=True)
class HalfSpace(Body):
    """Half-space, meshed as a block that goes on beyond its mesh as under a point load."""

    faces: ClassVar[bool] = True
    looks: ClassVar[str] = "elastic half-space"
    checked_by: ClassVar[SolverName] = "half-space"
    held: ClassVar[FarFieldName] = "point_load"

    @property
    def told(self) -> list[str]:
        """Nothing: it is the usual body."""
        return []

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (one for all)
        """Cells up to the end of the surface over it."""
        return np.array([R]), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Block as large as the lines or, where the law acts only as far as a surface reaches, larger than that."""
        from fem_adhesion.mesh.block import tensor_grid
        from fem_adhesion.mesh.spheres import with_contact_to

        if np.isinf(R):
            return tensor_grid(lines, grid.graded(0.0, np.diff(lines).min(), float(lines[-1]), growth=how.growth))
        past = grid.geometric((how.beyond - 1) * R, PAST_END * R, how.growth)[1:]
        depths = grid.graded(0.0, length, how.beyond * R, growth=how.growth)
        return with_contact_to(tensor_grid(np.concatenate([lines, R + past]), depths), R)

    def facing(
        self,
        R: float,  # noqa: ARG002 (it is flat)
        lines: Array,
        length: float,
        smaller: float,
        how: Discretisation,
    ) -> Any:
        """Block whose cells end where those of the sphere do, and beyond at ever larger distances."""
        from fem_adhesion.mesh.spheres import block_under

        depths = grid.graded(0.0, length, BEYOND * smaller, growth=how.growth)
        return block_under(lines, depths, smaller, BEYOND * smaller)
