"""An elastic body that is given as a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from fem_adhesion.bodies.body import Discretisation, Held, Layout
from halfspace.elastic.operators import FLAT
from halfspace.values import Array, keep


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
        keep(self, path=Path(self.path))

    @property
    def file(self) -> Path:
        """The mesh."""
        return Path(self.path)

    @property
    def told(self) -> list[str]:
        """The file, and its grip."""
        return [str(self.path), *super().told[1:]]

    def layout(self, R: float, how: Discretisation) -> Layout:  # noqa: ARG002 (it is as it is)
        """None: every cell stands still."""
        return np.array([R]), FLAT

    def mesh(self, R: float, lines: Array, length: float, how: Discretisation) -> Any:  # noqa: ARG002
        """Mesh of the file, every cell cut into four until the contact has as many as there are between the lines."""
        from fem_adhesion.mesh.file import read_body, refined

        mesh = read_body(self.file).scaled(R)
        while len(mesh.boundaries["contact"]) < len(lines) - 1:
            mesh = refined(mesh)
        return mesh
