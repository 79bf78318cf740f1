"""Linear elasticity by finite elements, down to the surface.

In the order of reading: `space` (stiffness of axisymmetric bodies), `incompressible` (projected dilatation for rubber),
`boundaries` (names and traces), `far_field` (what lies beyond a block), `condensation` (interior unknowns eliminated
exactly), `stress` (from displacements, at any point).
"""
