"""The contact problem as a textbook writes it: a law, a profile, a weak form, Newton's method and a determinant.

It checks the solvers, so it shares nothing with them: it imports NumPy, SciPy and scikit-fem alone, save an exception
and how results are shown, forms every integral by scikit-fem's quadrature, keeps every displacement among its unknowns,
condenses nothing, and has no far field but a clamp so far away that what it leaves out is small. Clarity comes first:
it is right to 1e-3.

Displacements u = (u_r, u_z) are in beta^2/R = mu eps, radii in beta, the gap h and the approach alpha in eps, E* = 1.
The potential energy over mu, with the elastic form a, the energy w(h) of the surfaces per area and 2 pi r dr = dA,

    a(u, u)/2 + int w(h) dA,        h = 1 - alpha + mu (z(r) - u_z),

is stationary in u where, for all v, with w' = sigma the tension,

    a(u, v) - mu int sigma(h) v_z dA = 0;        tangent:  a(u, v) + mu^2 int sigma'(h) u_z v_z dA.

In the order of reading: `newton` (Newton's method, determinant, turning points), `contact` (law, profile, gaps, load,
energy), `body` (elasticity, meshes, what holds them).
"""
