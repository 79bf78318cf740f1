"""What is known without solving the contact problem.

`closed_forms` (Hertz, Bradley, JKR), `dmt`, `maugis` (Dugdale's law), `exact_sphere` (a sphere's profile in the place
of a paraboloid's), `layered` (Hertz, JKR and a published series on thin samples), `criteria` (for jumping on),
`fits` (closed expressions fitted to the atlas: pull-off, contact radius, jumps, energy lost).
"""
