"""Spheres at finite strain: a neo-Hookean body whose surface stretches under the law.

In the order of reading: `material` (stress and tangent at a point), `cells` and `bodies` (forces, tangent and energy of
a body, with a pressure where displacements alone would lock), `surface` (its Gauss points, and how they move),
`traction` (what the law's traction is counted per), `problem` (every unknown at once) with `solve` (its linear
equations) and `assembly` (from its parts), `meshes` (fine where the contact is), `scene` (curve and events).
"""
