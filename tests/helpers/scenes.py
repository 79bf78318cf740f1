"""Scenes of spheres, as many tests ask for them: a pair by its own R/eps and the ratio of its radii."""

import math

from fem_adhesion import HalfSpace, Hemisphere, Scene
from fem_adhesion.scene import facing_pair


def hemisphere(tabor, radius_ratio, profile=None, **body):
    """Hemisphere against a rigid wall."""
    return Scene(tabor, Hemisphere(radius_ratio=radius_ratio, **body), profile)


def pair(tabor, radius_ratio, share, counter_poisson=0.3, larger=math.inf, *, poisson=0.3, grip="sliding"):
    """Hemisphere and a counter-body with a share of the compliance and so many times its radius."""
    first, second = facing_pair(radius_ratio, larger)
    counter = HalfSpace(poisson=counter_poisson)
    if math.isfinite(second):
        counter = Hemisphere(radius_ratio=second, grip=grip, poisson=counter_poisson)
    return Scene(tabor, Hemisphere(radius_ratio=first, grip=grip, poisson=poisson), counter=counter, share=share)
