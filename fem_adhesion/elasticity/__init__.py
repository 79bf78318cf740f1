"""Linear elasticity by finite elements, down to the surface.

In the order of reading: `reference` (functions on one cell), `space` (displacements on a mesh), `cells` (strains, and
stiffness of axisymmetric bodies, with projected dilatation for rubber), `surface` (points of a boundary),
`exterior` (what holds the far one), `elimination` (all other unknowns, exactly), `condensation` (to the surface),
`stress` (from displacements, at any point).
"""
