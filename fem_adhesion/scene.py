"""What is asked: one contact, dimensionless, validated and frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from halfspace.limits import require_fixed_mesh, require_poisson, require_radius, require_tabor

FarFieldName = Literal["point_load", "clamped", "free"]


@dataclass(frozen=True)
class Scene:
    """An elastic block under a rigid paraboloid that attracts it.

    Parameters
    ----------
    tabor : float
        Tabor parameter, positive.
    poisson : float
        Poisson's ratio, 0 <= poisson < 0.5.
    radius : float, optional
        Size L of the block in beta; chosen from the tolerance unless given.
    far_field : {"point_load", "clamped", "free"}
        What holds the block at its far boundary: a half-space beyond it that moves as under a point load, a clamp,
        or nothing but the uniform traction that balances the load.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    tabor: float
    poisson: float = 0.3
    radius: float | None = None
    far_field: FarFieldName = "point_load"

    def __post_init__(self) -> None:
        require_tabor(self.tabor)
        require_poisson(self.poisson)
        if self.radius is not None:
            require_radius(self.radius, self.tabor)
        if self.far_field not in get_args(FarFieldName):
            names = ", ".join(get_args(FarFieldName))
            raise ValueError(f"far_field = {self.far_field!r} is not one of {names}; take point_load")
        if self.far_field != "point_load":
            require_fixed_mesh(self.tabor)
