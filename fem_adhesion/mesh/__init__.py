"""Meshes, and nothing elastic.

`block` (tensor grids and quarter discs, graded towards the contact), `curved` (quadrilaterals with curved sides),
`spheres` and `held_sphere` (meridian sections), `refinement` (finer all over, or towards a point), `file` (the user's
meshes) and `checks` (what they must be like).
"""
