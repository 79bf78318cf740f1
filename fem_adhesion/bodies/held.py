"""Bodies held at their far side: the half of a sphere, the whole held over a cap, and one that is given as a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from fem_adhesion.bodies.body import Discretisation, Held, Layout
from halfspace.elastic.grid import FLAT
from halfspace.limits import require_cap_angle
from halfspace.values import Array, keep


@dataclass(frozen=True, kw_only=True)
class Hemisphere(Held):
    """Hemisphere held at its mid-plane; sliding, it is also half of a sphere squeezed between two equal walls.

    As the larger of two bodies it meets the smaller one's cells with its own, and both beyond these are rigid.
    """

    stretches: ClassVar[bool] = True
    curved: ClassVar[bool] = True
    meets: ClassVar[bool] = True
    faces: ClassVar[bool] = True

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        linear = self.material.area == "projected" and not self.material.finite
        # The whole sphere by harmonics; where a bonded mid-plane meets the free surface the stress is singular.
        checked_by = "harmonics" if self.grip == "sliding" and linear else None
        keep(self, checked_by=checked_by, other_cells=self.grip == "bonded")

    def rings(self, R: float, how: Discretisation) -> Array:  # noqa: ARG002 (in parts of the cells)
        """Sizes of the rings around the equator, where stress is singular if the mid-plane is bonded.

        There u ~ d^s, with d the distance and sin^2(s pi/2) = [4 (1 - nu)^2 - s^2]/(3 - 4 nu) (Williams 1952): s falls
        from 1 at nu = 0 to 0.6 at 1/2; each ring takes the error it leaves, as d^(2 s), down by a factor of 25 to 7.
        """
        return np.asarray(0.2 ** np.arange(1.0, (how.rings if self.grip == "bonded" else 0) + 1))

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Graded from the contact."""
        from fem_adhesion.mesh.spheres import graded_depths, hemisphere

        return hemisphere(R, lines, graded_depths(R, length, how.growth), rings=self.rings(R, how))

    def facing(self, R: float, lines: Array, length: float, smaller: float, how: Discretisation) -> Any:
        """Its cells end where those of the smaller one do, and beyond at its own core's end."""
        from fem_adhesion.mesh.spheres import graded_depths, hemisphere_over

        return hemisphere_over(lines, graded_depths(R, length, how.growth), smaller, R, self.rings(R, how))


@dataclass(frozen=True, kw_only=True)
class HeldSphere(Held):
    """Sphere held over a cap around the point opposite the pole; the half that faces the wall attracts.

    Parameters
    ----------
    cap_angle : float
        Half-angle of the cap in degrees, 1 to 89.99, or 90.
    """

    cap_angle: float = 30.0
    other_cells = True

    curved: ClassVar[bool] = True
    has_fields: ClassVar[bool] = False

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        keep(self, cap_angle=require_cap_angle(self.cap_angle))
        keep(self, words=[*self.words, f"cap of {self.cap_angle:g} degrees"])

    def rings(self, R: float, how: Discretisation) -> Array:  # noqa: ARG002 (they are the cap's)
        """Sizes of the rings around the equator, where the cap begins there or near it."""
        from fem_adhesion.mesh.spheres import rings_at_equator

        return rings_at_equator(R, self.cap_angle)

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:
        """Graded from the contact, and towards the rim of the cap."""
        from fem_adhesion.mesh.spheres import graded_depths, held_sphere

        return held_sphere(R, lines, graded_depths(R, length, how.growth), self.cap_angle)


@dataclass(frozen=True)
class Meshed(Held):
    """Body from a file, with the profile of its own surface; beside it a half-space is under the sphere's.

    Parameters
    ----------
    path : str or Path
        Of the mesh, see `fem_adhesion.mesh.file`; R is the radius of curvature at its pole.
    """

    path: str | Path

    looks: ClassVar[str] = "elastic body of a mesh"

    def __post_init__(self, poisson: float | None) -> None:
        super().__post_init__(poisson)
        path = Path(self.path)
        keep(self, path=path, file=path, words=[str(path), *self.words[1:]])

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (it is as it is)
        """None: every cell stands still."""
        return np.array([R]), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:  # noqa: ARG002
        """Mesh of the file, every cell cut into four as often as `how` says."""
        from fem_adhesion.mesh.file import read_body, refined

        mesh = read_body(self.path).scaled(R)
        for _ in range(how.refined):
            mesh = refined(mesh)
        return mesh
