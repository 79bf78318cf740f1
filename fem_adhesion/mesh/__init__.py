"""Meshes, and nothing elastic.

`block` (tensor grids and quarter discs, graded towards the contact), `curved` (quadrilaterals with curved sides, finer
towards a point), `spheres` (meridian sections), `file` (the user's meshes, finer all over) and `checks` (what they must
be like).
"""
