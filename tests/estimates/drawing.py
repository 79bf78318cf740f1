"""Contacts drawn at random, any part of them: for the half-space as calls of its `trace`, for the elements as scenes.

All are drawn from a `numpy.random.Generator`; numbers have three digits, so that a printed scene can be typed again.
"""

import math
from dataclasses import replace

from scenes import pair

from fem_adhesion import Block, Coated, HalfSpace, HeldSphere, Hemisphere, Layer, Layers, NeoHookean, Scene
from fem_adhesion.finite_strain.scene import WIDEST_TABOR
from halfspace import Stratum, Substrate
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import PARABOLOID, Hyperboloid, Power, RoundedPunch, Sphere


def several(draw, random, count):
    """So many scenes; what is refused when it is made, as a law that repels on the whole, is drawn again."""
    scenes = []
    while len(scenes) < count:
        try:
            scenes.append(draw(random))
        except InputError:
            continue
    return scenes


def on_layers(random):
    """Scene of any law and profile on layers."""
    return Scene(number(random, 0.3, 10), layers(random), profile(random), law=law(random))


def on_half_space(random):
    """Arguments of `halfspace.trace`: half of the laws and profiles the usual ones, a third of the bodies layers."""
    tabor = number(random, 0.01, 100)
    return {
        "tabor": tabor,
        "law": one_of(random, lambda: LENNARD_JONES, lambda: law(random)),
        "profile": one_of(random, lambda: PARABOLOID, lambda: profile(random, smallest=2.3 * tabor)),
        "body": one_of(random, lambda: None, lambda: None, lambda: layers(random).layered),
        "rtol": number(random, 1e-8, 1e-1),
        "to_load": one_of(random, lambda: 5.0, lambda: number(random, 0.1, 100)),
    }


def of_elements(random):
    """Scene for the finite elements, of any body; half of the laws and profiles are the usual ones."""
    tabor, drawn = number(random, 0.01, 20), _body(random)
    chosen = one_of(random, lambda: LENNARD_JONES, lambda: law(random))
    if isinstance(drawn, Scene):
        return replace(drawn, tabor=tabor, law=chosen)
    if drawn.material.finite:
        return Scene(min(tabor, WIDEST_TABOR), drawn, law=chosen)
    own = math.isfinite(drawn.size) or isinstance(drawn, Block)
    return Scene(tabor, drawn, None if own else one_of(random, lambda: None, lambda: profile(random)), law=chosen)


def _body(random):
    """A body, or a pair as a scene of its own."""
    nu, size = poisson(random), number(random, 2, 1e4)
    grip = random.choice(["sliding", "bonded"]).item()
    traction = random.choice(["projected", "vertical", "reference", "normal"]).item()
    far_field = random.choice(["point_load", "clamped", "free"]).item()
    larger = one_of(random, lambda: 1.0, lambda: number(random, 1, 100), lambda: math.inf)
    share, angle = round(random.uniform(0, 1), 2), round(random.uniform(5, 90))
    return one_of(
        random,
        lambda: HalfSpace(poisson=nu),
        lambda: Hemisphere(radius_ratio=size, grip=grip, poisson=nu),
        lambda: HeldSphere(radius_ratio=size, grip=grip, cap_angle=angle, poisson=nu),
        lambda: Hemisphere(radius_ratio=size, grip=grip, material=NeoHookean(nu, traction)),
        lambda: Block(radius=number(random, 10, 1000), far_field=far_field, poisson=nu),
        lambda: pair(1.0, size, share, poisson(random), larger, poisson=nu, grip=grip),
        lambda: layers(random),
        lambda: layers(random),
    )


def law(random):
    """Law but for the usual one."""
    n = round(random.uniform(2.2, 6), 2)
    return one_of(
        random,
        lambda: PowerLaw(n, round(n + random.uniform(1, 15), 2)),
        lambda: Morse(number(random, 0.3, 20)),
        lambda: Dlvo(round(random.uniform(-1, 0.5), 2), number(random, 0.3, 5)),
        lambda: Exponential(number(random, 0.3, 10), int(random.integers(3, 20))),
        lambda: Dugdale(number(random, 0.08, 0.5)),
    )


def profile(random, smallest=50.0):
    """Profile but for the paraboloid; of spheres R/eps is no less than the smallest that serves."""
    return one_of(
        random,
        lambda: Sphere(number(random, smallest, 100 * smallest), one_of(random, lambda: math.inf, lambda: 3.0)),
        lambda: Power(number(random, 1.5, 10)),
        lambda: Hyperboloid(number(random, 0.2, 5)),
        lambda: RoundedPunch(number(random, 0.15, 3)),
    )


def layers(random):
    """Layer, coating, or strata on a base."""

    def foundation():
        return random.choice(["bonded", "sliding"]).item()

    def stratum(n):
        return Stratum(number(random, 0.05, 5), poisson(random), number(random, 0.05, 20) if n else 1.0)

    nu, thickness = poisson(random), number(random, 0.05, 100)
    base = one_of(random, foundation, lambda: Substrate(number(random, 0.05, 20), poisson(random)))
    return one_of(
        random,
        lambda: Layer(thickness, foundation(), poisson=nu),
        lambda: Coated(thickness, number(random, 0.01, 100), poisson(random), poisson=nu),
        lambda: Layers([stratum(n) for n in range(random.integers(2, 4))], base),
    )


def poisson(random):
    """Poisson's ratio, a third each zero, anything and that of rubber."""
    return one_of(random, lambda: 0.0, lambda: round(random.uniform(0, 0.49), 2), lambda: 0.4999)


def number(random, least, most):
    """A number of any size, of three digits."""
    return float(f"{math.exp(random.uniform(math.log(least), math.log(most))):.3g}")


def one_of(random, *made):
    """What one of some functions makes."""
    return made[random.integers(len(made))]()
