"""To the accuracy asked for, with the error that is left.

In the order of reading: `trace` (from a tolerance to a curve), `grids` (how fine they are, and which chart serves which
contact radius), `kernels` (the pressure by panels, or by triangles or bands as in 1997), `stages` (events from one grid
to the next, and what their changes say of the error), `refinement` (the ladder of ever finer stages), `finite_bodies`
(bodies with a length, whose operator changes with the contact), `layered` (for layers and coatings, most of which is
the half-space's), `standing` (their events, each on a grid of its own that stands still), `sweep` (many curves as
arrays).

An elastic body without a length of its own is homogeneous, so one compliance matrix serves every contact radius: the
grid breathes with the contact, the radius joins the unknowns, and the spike of tension at the contact edge, whose width
falls as 1/mu^2, stays on the same nodes. That is why 100 to 200 unknowns give eight digits.

A sphere is not homogeneous. Its compliance on a grid that follows the contact edge is still a smooth function of the
contact radius: the curve is followed on polynomials, each through some ten radii, made as the contact reaches them. An
event, whose place the curve tells, has a grid of its own that stands still: one operator. Where that grid itself makes
the path turn, as at the pull-off of a wide contact, the event keeps to grids that follow.
"""
