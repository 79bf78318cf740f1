"""Contacts on layers, drawn at random: any law and profile on a layer, a coating or strata."""

import math

import numpy as np

from fem_adhesion import Coated, Layer, Layers, Scene
from halfspace import Stratum, Substrate
from halfspace.errors import InputError
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Paraboloid, Power, RoundedPunch, Sphere

TABORS, THICKNESSES, MODULI = (0.3, 10.0), (0.05, 100.0), (0.01, 100.0)


def drawn(seed, count):
    """Scenes of a seed; what is refused when it is made, as a law that repels on the whole, does not count."""
    random = np.random.default_rng(seed)
    scenes = []
    while len(scenes) < count:
        try:
            tabor, body, profile = _between(random, *TABORS), _body(random), _profile(random)
            scenes.append(Scene(tabor, body, profile, law=_law(random)))
        except InputError:
            continue
    return scenes


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


def _body(random):
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
