"""Bodies for the eye.

`arrays` and `write` (VTK files), `cells` (sections and solids in cells of the second order), `picture` (by pyvista).
"""
