"""Bodies for the eye.

`arrays` and `write` (VTK files with cells of high order), `lattice` and `revolve` (solids of revolution), `cutaway` and
`solid` (pictures by pyvista).
"""
