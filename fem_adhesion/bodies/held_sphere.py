"""The elastic sphere held over a cap."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from fem_adhesion.bodies.body import Discretisation, Held, Layout
from halfspace.elastic.operators import SurfaceCoordinate
from halfspace.limits import require_cap_angle
from halfspace.values import Array, keep


@dataclass(frozen=True, kw_only=True)
class HeldSphere(Held):
    """Sphere held over a cap around the point opposite the pole; the half that faces the wall attracts.

    Parameters
    ----------
    cap_angle : float
        Half-angle of the cap in degrees, 1 to 89.99, or 90.
    """

    cap_angle: float = 30.0

    curved: ClassVar[bool] = True
    has_fields: ClassVar[bool] = False
    singular: ClassVar[bool] = True

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, cap_angle=require_cap_angle(self.cap_angle))

    @property
    def told(self) -> list[str]:
        """Its cap too."""
        return [*super().told, f"cap of {self.cap_angle:g} degrees"]

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (rings are the cap's)
        """Layers and rings beyond the core."""
        from fem_adhesion.mesh.held_sphere import rings_at_equator
        from fem_adhesion.mesh.spheres import contact_ends

        return contact_ends(R, rings_at_equator(R, self.cap_angle)), SurfaceCoordinate(R, self.material.area)

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Graded from the contact, and towards the rim of the cap."""
        from fem_adhesion.mesh.held_sphere import held_sphere
        from fem_adhesion.mesh.spheres import graded_depths

        return held_sphere(R, lines, graded_depths(R, length, how.growth), self.cap_angle)
