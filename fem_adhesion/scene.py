"""What is asked: one contact, dimensionless, validated and frozen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from halfspace.errors import InputError
from halfspace.limits import (
    require_cap_angle,
    require_fixed_mesh,
    require_modulus,
    require_poisson,
    require_radius,
    require_radius_ratio,
    require_share,
    require_tabor,
)

FarFieldName = Literal["point_load", "clamped", "free"]
BodyName = Literal["block", "hemisphere", "sphere"]
ProfileName = Literal["paraboloid", "sphere"]
GripName = Literal["sliding", "bonded"]
TractionName = Literal["projected", "surface", "reference", "normal", "vertical"]
StrainName = Literal["small", "finite"]


@dataclass(frozen=True)
class Counter:
    """An elastic counter-body in the place of the rigid wall.

    Parameters
    ----------
    share : float
        Its part of the pair's compliance, (1 - nu2^2) E*/E2, between 0 and 1; 1/2 for equal materials.
    poisson : float
        Its Poisson's ratio.
    radius : float
        Ratio of its radius to that of the first body; infinite for a half-space.

    Raises
    ------
    InputError
        If a value is out of range.
    """

    share: float
    poisson: float = 0.3
    radius: float = math.inf

    def __post_init__(self) -> None:
        _keep(self, share=require_share(self.share, self.radius), poisson=require_poisson(self.poisson))
        _keep(self, radius=float(self.radius))

    @classmethod
    def from_moduli(
        cls, modulus: float, poisson: float, counter_modulus: float, counter_poisson: float, *, radius: float = math.inf
    ) -> Counter:
        """Counter-body by the elastic constants of both bodies, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.

        Parameters
        ----------
        modulus, poisson : float
            Young's modulus E1, in any unit, and Poisson's ratio nu1 of the first body, the scene's own.
        counter_modulus, counter_poisson : float
            E2, in the same unit, and nu2 of the counter-body.
        radius : float
            Ratio of its radius to that of the first body; infinite for a half-space.

        Raises
        ------
        InputError
            If a value is out of range.
        """
        compliances = [
            (1 - require_poisson(nu) ** 2) / require_modulus(E)
            for E, nu in ((modulus, poisson), (counter_modulus, counter_poisson))
        ]
        return cls(compliances[1] / sum(compliances), counter_poisson, radius)


@dataclass(frozen=True)
class Scene:
    """An elastic body under a rigid wall, or another body, that attracts it.

    Parameters
    ----------
    tabor : float
        Tabor parameter, positive.
    poisson : float
        Poisson's ratio, 0 <= poisson < 0.5.
    radius : float, optional
        Size L of a block in beta; chosen from the tolerance unless given.
    far_field : {"point_load", "clamped", "free"}
        What holds a block at its far boundary: a half-space beyond it that moves as under a point load, a clamp,
        or nothing but the uniform traction that balances the load.
    body : {"block", "hemisphere", "sphere"} or path
        What is elastic: the half-space as a block of finite elements, a hemisphere held at its mid-plane, a sphere held
        over a cap, or the body meshed in a file, see `fem_adhesion.mesh.file`.
    profile : {"paraboloid", "sphere"}
        Undeformed gap: r^2/2R or R - sqrt(R^2 - r^2). The body of a file has the profile of its own surface.
    radius_ratio : float, optional
        rho = R/eps; asked for by everything but a block under a paraboloid. R/beta = sqrt(rho/tabor).
    grip : {"sliding", "bonded"}
        Whether the held surface of a body may slide without friction, u_z = 0, or not at all, u = 0.
    cap_angle : float
        Half-angle in degrees of the cap over which a sphere is held.
    traction : {"projected", "surface", "reference", "normal", "vertical"}
        What the law's traction is counted per. At small strain: the projected area, exact for rigid shapes, or that of
        the surface itself. At finite strain, where the projected area is stretched, "projected" is the blend that
        conserves matter of "reference", per undeformed area, and "normal", per deformed area and normal to the surface;
        "vertical", per deformed area, does not. See `fem_adhesion.finite_strain.traction`.
    counter : Counter, optional
        An elastic counter-body; the wall is rigid unless given. R and E* are then those of the pair.
    strain : {"small", "finite"}
        Linear elasticity or neo-Hookean.

    Raises
    ------
    InputError
        If a value is out of range, or does not go with the others.
    """

    tabor: float
    poisson: float = 0.3
    radius: float | None = None
    far_field: FarFieldName = "point_load"
    body: BodyName | Path = "block"
    profile: ProfileName = "paraboloid"
    radius_ratio: float | None = None
    grip: GripName = "sliding"
    cap_angle: float = 30.0
    traction: TractionName = "projected"
    counter: Counter | None = None
    strain: StrainName = "small"

    def __post_init__(self) -> None:
        _keep(self, tabor=require_tabor(self.tabor), poisson=require_poisson(self.poisson))
        for name, names in CHOICES.items():
            _require_one_of(name, getattr(self, name), names)
        if self.radius is not None:
            _keep(self, radius=require_radius(self.radius, self.tabor))
        if self.far_field != "point_load":
            require_fixed_mesh(self.tabor)
        _keep(self, cap_angle=require_cap_angle(self.cap_angle))
        self._require_radius_ratio()
        self._require_fitting()

    @property
    def sized(self) -> bool:
        """Whether the scene has a length R of its own beside beta."""
        return self.body != "block" or self.profile == "sphere"

    @property
    def sphere_radius(self) -> float:
        """R/beta, infinite for a paraboloid on a half-space."""
        return math.sqrt(self.radius_ratio / self.tabor) if self.radius_ratio else math.inf

    @property
    def told(self) -> list[str]:
        """What it is, in words: Tabor parameter, material and body, and what else is not as usual."""
        parts = {
            "under a sphere": self.body == "block" and self.profile == "sphere",
            "bonded": self.grip == "bonded",
            f"cap of {self.cap_angle:g} degrees": self.body == "sphere",
            f"traction per {self.traction}": self.traction != "projected",
            "finite strain": self.strain == "finite",
        }
        words = [f"tabor {self.tabor:g}", f"poisson {self.poisson:g}", str(self.body)]
        words += [f"R/eps {self.radius_ratio:.4g}"] if self.radius_ratio else []
        words += [word for word, holds in parts.items() if holds]
        if self.counter:
            share, radius = self.counter.share, self.counter.radius
            words.append(f"counter-body with {share:.4g} of the compliance, radius {radius:.4g}")
        return words

    def _require_radius_ratio(self) -> None:
        if self.sized and self.radius_ratio is None:
            raise InputError(f"radius_ratio = None for {self._what()}, limit: a number; give R/eps")
        if not self.sized and self.radius_ratio is not None:
            raise InputError(
                f"radius_ratio = {self.radius_ratio:g} means nothing to a block under a paraboloid; leave it out, or "
                'take body = "hemisphere" or profile = "sphere"'
            )
        if self.radius_ratio is not None:
            _keep(self, radius_ratio=require_radius_ratio(self.radius_ratio, self.tabor))

    def _require_fitting(self) -> None:
        """Refuse options that the scene would not heed."""
        sphere, hemisphere = self.body in ("hemisphere", "sphere"), self.body == "hemisphere"
        unheeded = {
            "radius": (self.radius is not None and self.sized, "only a block under a paraboloid has a size L"),
            "far_field": (
                self.far_field != "point_load" and self.sized,
                "only a block under a paraboloid has a choice",
            ),
            "counter": (self.counter is not None and not hemisphere, "it meets a hemisphere only"),
            "strain": (self.strain == "finite" and not hemisphere, "finite strain is for the hemisphere"),
            "profile": (self.profile == "sphere" and isinstance(self.body, Path), "the mesh has a surface of its own"),
            "traction": self._unheeded_traction(sphere),
        }
        for name, (ignored, why) in unheeded.items():
            if ignored:
                raise InputError(f"{name} = {getattr(self, name)} does not go with {self._what()}; {why}")

    def _unheeded_traction(self, sphere: bool) -> tuple[bool, str]:
        if self.strain == "finite":
            return self.traction == "surface", "it is for small strain"
        if self.traction == "surface":
            return not sphere, "it differs on a curved surface only"
        return self.traction != "projected", "areas differ at finite strain only"

    def _what(self) -> str:
        return f'body = "{self.body}" and profile = "{self.profile}"'


def _keep(part: Counter | Scene, **numbers: float) -> None:
    """Let a part being made have its numbers as floats, whatever they were given as."""
    for name, number in numbers.items():
        object.__setattr__(part, name, number)


CHOICES: dict[str, Any] = {
    "far_field": get_args(FarFieldName),
    "body": get_args(BodyName),
    "profile": get_args(ProfileName),
    "grip": get_args(GripName),
    "traction": get_args(TractionName),
    "strain": get_args(StrainName),
}


def _require_one_of(name: str, value: object, names: tuple[str, ...]) -> None:
    if value not in names and not (name == "body" and isinstance(value, Path)):
        remedy = "a mesh is given as a pathlib.Path; " if name == "body" else ""
        raise InputError(f"{name} = {value!r} is not one of {', '.join(names)}; {remedy}take {names[0]}")
