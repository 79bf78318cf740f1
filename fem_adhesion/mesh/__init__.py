"""Meshes, and nothing elastic.

`block` (tensor grids and quarter discs, graded towards the contact), `curved` (quadrilaterals with curved sides),
`spheres` and `held_sphere` (meridian sections), `nested` and `refinement` (finer where it matters), `file` (meshes of
the user's) and `checks` (what they must be like).
"""
