"""A layer on a rigid base."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from fem_adhesion.bodies.body import Body, Discretisation, FarFieldName, Layout, SolverName
from halfspace.elastic import grid, layers
from halfspace.elastic.operators import FlatCoordinate
from halfspace.errors import InputError
from halfspace.limits import require_thickness
from halfspace.scales import Scales
from halfspace.values import Array, keep

WIDTH = 800.0  # of the mesh, in widths of a rigid attraction: the load left out beyond is 1e-10 R dgamma
# Thicknesses that it is wider: what dies out falls by e^(-0.74 r/t) at least, there and back again to 1e-13. From the
# roots of what its yield is divided by, (3 - 4 nu) cosh 2x + 2 x^2 + 5 - 12 nu + 8 nu^2, the first at nu = 1/2.
DIED_OUT = 20.0


@dataclass(frozen=True)
class Layer(Body):
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

    looks: ClassVar[str] = "elastic layer"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, thickness=require_thickness(self.thickness))
        layers.require_foundation(self.foundation)

    @property
    def held(self) -> FarFieldName:
        """Its base is clamped, or slides and the layer goes on beyond its edge."""
        return "clamped" if self.foundation == "bonded" else "sheet"

    @property
    def checked_by(self) -> SolverName | None:
        """By the integral equation."""
        return "half-space"

    @property
    def layered(self) -> layers.Layer:
        """What the integral equation knows it as."""
        return layers.Layer(self.thickness, self.material.poisson, self.foundation)

    @property
    def strata(self) -> tuple[layers.Stratum, ...]:
        """As the integral equation asks for them, so that it takes this layer as well."""
        return self.layered.strata

    @property
    def base(self) -> layers.Foundation | layers.Substrate:
        """The same."""
        return self.layered.base

    @property
    def told(self) -> list[str]:
        """Its thickness and foundation."""
        return [*super().told, f"thickness {self.thickness:g} beta", self.foundation]

    def extent(self, scales: Scales) -> float:
        """Radius up to which it is meshed."""
        return scales.outer_radius((WIDTH * scales.widened) ** 2 / 2) + DIED_OUT * self.thickness

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (one for all)
        """Cells up to the end of the mesh, or of the surface over it."""
        return np.array([R]), FlatCoordinate()

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:  # noqa: ARG002 (it ends with them)
        """Cells as deep as the layer is thick."""
        from fem_adhesion.mesh.block import tensor_grid

        depths = grid.graded(0.0, min(np.diff(lines).min(), self.thickness), self.thickness, growth=how.growth)
        sides = {"far": lambda x: x[1] == -depths[-1], "edge": lambda x: x[0] == lines[-1]}
        return tensor_grid(lines, depths).with_boundaries(sides)


def as_body(part: object) -> object:
    """A body of finite elements in the place of a layer as the integral equation has it; anything else as it is."""
    if isinstance(part, layers.Layer):
        return Layer(part.thickness, part.foundation, poisson=part.poisson)
    if isinstance(part, layers.Coated | layers.Layers):
        raise InputError(f"body = {part!r} is not meshed, limit: one layer on a rigid base; take halfspace.trace")
    return part
