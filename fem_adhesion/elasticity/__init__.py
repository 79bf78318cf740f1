"""Linear elasticity by finite elements, down to the surface.

In the order of reading: `space` (stiffness of axisymmetric bodies), `boundaries` (names and traces), `far_field` (what
holds the body where it ends), `elimination` (all other unknowns, exactly), `condensation` (to the surface),
`incompressible` (projected dilatation for rubber), `stress` (from displacements, at any point).
"""
