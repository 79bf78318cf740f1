"""Bodies for the eye.

`arrays` and `write` (VTK files), `lattice` and `revolve` (sections and solids in cells of the second order), `cutaway`
and `solid` (pictures by pyvista).
"""
