"""Adhesive contact of elastic spheres by finite elements, checked against the integral equation of `halfspace`.

Rooms, in the order of reading: `scene` (what is asked) and its parts, `bodies` and `materials`, `mesh`, `elasticity`,
`discretise` (from a scene to an operator), `finite_strain` (every unknown at once), `convergence` (the curve that
answers), `fields` and `paraview` (inside the body), a folder for each command, and `common` for what these share;
`registry` has the names of parts. `weak_form` is the contact problem as a textbook has it and `harmonics` the whole
sphere in Legendre polynomials; both check the others.

What it is good for, and what not:

* Axisymmetric and frictionless. Small strain unless a body is `NeoHookean`. The traction acts vertically on the
  projected area; the other convention, on the surface's own area, is a material's choice and differs by O(eps/R).
* At finite strain the projected area is stretched, and what the traction is counted per matters as much as the strain:
  the default conserves the attracted matter, as the wall's potential on every particle of the body does; the other
  choices of ``traction`` are beside it, and their spread is given with each event as model uncertainty. What that
  potential does besides, the yield of the attracted layer, is a change of dgamma, which ``assess`` gives.
* R at least 1.5 beta, that is R/eps at least 2.25 mu, and at least 2: a smaller sphere is deformed as a whole. The
  curve ends where the contact reaches 0.95 R; at finite strain, which goes as far down, where what was at 0.98 R is in
  contact. The part nu/(1 - nu) of the traction that is counted per deformed area makes the equations ill-posed where it
  exceeds E* (1 - nu)/(3 - 4 nu) at the contact edge: at nu = 0.3 and mu = 3 below R/eps = 35, and 188 with
  ``traction="normal"``.
* Of a whole sphere, only the half that faces the wall attracts; the other would take O((eps/R)^2) off the load.
* Tabor parameters from 1e-12 to 300, Poisson's ratio up to 0.499999, loads up to 1000 R dgamma; the error message
  says what serves beyond, such as a closed form of `halfspace.theories`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fem_adhesion.bodies.half_space import Block, HalfSpace
    from fem_adhesion.bodies.held import HeldSphere, Hemisphere, Meshed
    from fem_adhesion.bodies.layers import Coated, Layer, Layers
    from fem_adhesion.convergence import trace
    from fem_adhesion.crosscheck.study import compare
    from fem_adhesion.fitting.study import fit
    from fem_adhesion.materials import LinearElastic, NeoHookean
    from fem_adhesion.scene import Scene, share_of

__all__ = [
    "Block",
    "Coated",
    "HalfSpace",
    "HeldSphere",
    "Hemisphere",
    "Layer",
    "Layers",
    "LinearElastic",
    "Meshed",
    "NeoHookean",
    "Scene",
    "compare",
    "fit",
    "share_of",
    "trace",
]

_HOMES = {
    **dict.fromkeys(("Block", "HalfSpace"), "bodies.half_space"),
    **dict.fromkeys(("HeldSphere", "Hemisphere", "Meshed"), "bodies.held"),
    **dict.fromkeys(("Coated", "Layer", "Layers"), "bodies.layers"),
    **dict.fromkeys(("LinearElastic", "NeoHookean"), "materials"),
    **dict.fromkeys(("Scene", "share_of"), "scene"),
    "trace": "convergence",
    "compare": "crosscheck.study",
    "fit": "fitting.study",
}


def __getattr__(name: str) -> Any:
    """Import what is public when it is first asked for, so that the command line answers at once."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
