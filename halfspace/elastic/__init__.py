"""The elastic half-space, linear and without a contact yet.

In the order of reading: `kernel` (the ring's elliptic integral), `grid` (radii graded about the contact edge),
`compliance` (the matrix from pressures to deflections, and what lies beyond the grid), `operators` (matrices that
follow the contact: scaled where the body is homogeneous, interpolated where it is not).
"""
