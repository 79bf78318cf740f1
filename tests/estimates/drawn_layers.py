"""Contacts drawn at random: any law and profile on layers, and on any body of finite elements."""

import math
from dataclasses import replace

import numpy as np
from scenes import pair

from fem_adhesion import Block, Coated, HalfSpace, HeldSphere, Hemisphere, Layer, Layers, NeoHookean, Scene
from fem_adhesion.finite_strain.scene import WIDEST_TABOR
from halfspace import Stratum, Substrate
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Paraboloid, Power, RoundedPunch, Sphere

TABORS, WIDE, THICKNESSES, MODULI = (0.3, 10.0), (0.01, 20.0), (0.05, 100.0), (0.01, 100.0)


def drawn(seed, count):
    """Scenes on layers of a seed."""
    return _drawn(seed, count, _on_layers)


def elements(seed, count):
    """Scenes of a seed for the finite elements, with any body."""
    return _drawn(seed, count, _of_elements)


def _drawn(seed, count, make):
    """Scenes; what is refused when it is made, as a law that repels on the whole, does not count."""
    random = np.random.default_rng(seed)
    scenes = []
    while len(scenes) < count:
        try:
            scenes.append(make(random))
        except InputError:
            continue
    return scenes


def _on_layers(random):
    tabor, body, profile = _between(random, *TABORS), _layers(random), _profile(random)
    return Scene(tabor, body, profile, law=_law(random))


def _of_elements(random):
    """Half with the usual law, and half of the bodies without a surface of their own under a paraboloid."""
    tabor, body = _between(random, *WIDE), _body(random)
    law = _one_of(random, lambda: LENNARD_JONES, lambda: _law(random))
    if isinstance(body, Scene):
        return replace(body, tabor=tabor, law=law)
    if body.material.finite:
        return Scene(min(tabor, WIDEST_TABOR), body, law=law)
    own = math.isfinite(body.size) or isinstance(body, Block)
    profile = None if own else _one_of(random, lambda: None, lambda: _profile(random))
    return Scene(tabor, body, profile, law=law)


def _body(random):
    """A body, or a pair as a scene of its own."""
    poisson, size = _poisson(random), _between(random, 2, 1e4)
    grip = _one_of(random, lambda: "sliding", lambda: "bonded")
    return _one_of(
        random,
        lambda: HalfSpace(poisson=poisson),
        lambda: Hemisphere(radius_ratio=size, grip=grip, poisson=poisson),
        lambda: HeldSphere(radius_ratio=size, grip=grip, cap_angle=round(random.uniform(5, 90)), poisson=poisson),
        lambda: Hemisphere(radius_ratio=size, grip=grip, material=NeoHookean(poisson, _traction(random))),
        lambda: Block(radius=_between(random, 10, 1000), far_field=_far_field(random), poisson=poisson),
        lambda: pair(
            1.0, size, round(random.uniform(0, 1), 2), _poisson(random), _larger(random), poisson=poisson, grip=grip
        ),
        lambda: _layers(random),
        lambda: _layers(random),
    )


def _traction(random):
    return _one_of(random, lambda: "projected", lambda: "vertical", lambda: "reference", lambda: "normal")


def _far_field(random):
    return _one_of(random, lambda: "point_load", lambda: "clamped", lambda: "free")


def _larger(random):
    return _one_of(random, lambda: 1.0, lambda: _between(random, 1, 100), lambda: math.inf)


def _between(random, least, most):
    """A number of any size, of three digits that can be typed again."""
    return float(f"{math.exp(random.uniform(math.log(least), math.log(most))):.3g}")


def _one_of(random, *made):
    return made[random.integers(len(made))]()


def _law(random):
    n = round(random.uniform(2.5, 5), 2)
    return _one_of(
        random,
        lambda: PowerLaw(n, round(n + random.uniform(3, 9), 2)),
        lambda: Morse(_between(random, 0.5, 8)),
        lambda: Dlvo(round(random.uniform(-1, 0.5), 2), _between(random, 0.3, 5)),
        lambda: Exponential(_between(random, 0.5, 5), int(random.integers(4, 16))),
        lambda: Dugdale(_between(random, 0.15, 0.5)),
    )


def _profile(random):
    return _one_of(
        random,
        Paraboloid,
        lambda: Sphere(_between(random, 50, 3000)),
        lambda: Power(_between(random, 1.5, 6)),
        lambda: Hyperboloid(_between(random, 0.3, 3)),
        lambda: RoundedPunch(_between(random, 0.2, 1.5)),
    )


def _layers(random):
    return _one_of(
        random,
        lambda: Layer(_between(random, *THICKNESSES), _foundation(random), poisson=_poisson(random)),
        lambda: Coated(
            _between(random, *THICKNESSES), _between(random, *MODULI), _poisson(random), poisson=_poisson(random)
        ),
        lambda: Layers([_stratum(random, n) for n in range(random.integers(2, 4))], _base(random)),
    )


def _foundation(random):
    return _one_of(random, lambda: "bonded", lambda: "sliding")


def _base(random):
    return _one_of(
        random,
        lambda: _foundation(random),
        lambda: Substrate(_between(random, 0.05, 20.0), _poisson(random)),
    )


def _stratum(random, n):
    return Stratum(_between(random, 0.05, 5.0), _poisson(random), _between(random, 0.05, 20.0) if n else 1.0)


def _poisson(random):
    return _one_of(random, lambda: 0.0, lambda: round(random.uniform(0, 0.49), 2), lambda: 0.4999)
