"""The elastic half-space, or layers on a base, linear and without a contact yet.

In the order of reading: `kernel` (the ring's elliptic integral), `grid` (radii graded about the contact edge),
`compliance` (the matrix from pressures to deflections, and what lies beyond the grid), `extrapolated` (that of
triangles and bands, from two intervals to none), `operators` (matrices that follow the contact: scaled where the body
is homogeneous, interpolated where it is not); `layers` (how strata yield to waves) and `layered` (their surface: the
half-space's and images below it).
"""
