"""The contact problem of a whole body, every unknown at once: a neo-Hookean sphere, or at zero stretch a linear block.

In the order of reading: `body` (stress and tangent at a point, and those of all unknowns, with a pressure where
displacements alone would lock), `held` (what holds it, and its linear equations), `traction` (what the law's is counted
per, and the surface on which it acts), `problem` (the equations), `scene` (meshes, curve and events),
`settings` (numbers of the algorithms).
"""
