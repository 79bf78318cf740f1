"""What a body is made of, and what the surface law's traction on it is counted per."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, get_args

from halfspace.limits import require_one_of, require_poisson
from halfspace.values import keep

AreaName = Literal["projected", "surface"]
TractionName = Literal["projected", "reference", "normal", "vertical"]


class Elastic(NamedTuple):
    """What a region of a body is made of: Poisson's ratio, and E/(1 - nu^2) in units of the body's E*."""

    poisson: float
    modulus: float = 1.0


@dataclass(frozen=True)
class LinearElastic:
    """Small strain, Poisson's ratio 0 to 0.499999, or InputError.

    The traction says which area the law's traction, which is vertical, is counted per: the projected one, exact for
    rigid shapes, or that of the surface itself.
    """

    poisson: float = 0.3
    traction: AreaName = "projected"

    finite: ClassVar[bool] = False
    """Whether strain is finite."""

    def __post_init__(self) -> None:
        keep(self, poisson=require_poisson(self.poisson))
        require_one_of(self.traction, "traction", get_args(AreaName))

    @property
    def area(self) -> AreaName:
        """Area of the undeformed surface that a pressure on the linear body acts on."""
        return self.traction


@dataclass(frozen=True)
class NeoHookean:
    """Finite strain; Poisson's ratio is that of small strains, 0 to 0.499999, or InputError.

    The traction says what the law's traction is counted per where the projected area is stretched: "projected" is the
    blend that conserves matter of "reference", per undeformed area, and "normal", per deformed area and normal to the
    surface; "vertical", per deformed area, does not. See `fem_adhesion.finite_strain.traction`.
    """

    poisson: float = 0.3
    traction: TractionName = "projected"

    finite: ClassVar[bool] = True
    area: ClassVar[AreaName] = "projected"

    def __post_init__(self) -> None:
        keep(self, poisson=require_poisson(self.poisson))
        require_one_of(self.traction, "traction", get_args(TractionName))


Material = LinearElastic | NeoHookean
