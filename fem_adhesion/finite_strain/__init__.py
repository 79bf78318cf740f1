"""The contact problem of a whole body, every unknown at once: a neo-Hookean sphere, or at zero stretch a linear block.

In the order of reading: `material` (stress and tangent at a point), `body` (forces, tangent and energy, with a pressure
where displacements alone would lock), `held` (what holds it, and its linear equations), `surface` (its Gauss points,
and how they move), `traction` (what the law's traction is counted per), `problem` (the equations) and `assembly` (from
its parts, or on meshes fine where the contact is), `scene` (curve and events).
"""
