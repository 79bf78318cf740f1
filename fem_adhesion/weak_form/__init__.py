"""The contact problem as a textbook writes it: a law, a profile, a weak form and Newton's method, in scikit-fem.

This is the method of the project, in its plainest form. `trace` gives the whole load-approach curve by it: every
displacement is an unknown, and nothing is condensed. The solver `fem_adhesion.trace` solves the same equations after
an exact elimination of all displacements but those of the surface, which is why it is fast.

Displacements u = (u_r, u_z) are in beta^2/R = mu eps, radii in beta, the gap h and the approach alpha in eps, E* = 1.
The potential energy over mu, with the elastic form a, the energy w(h) of the surfaces per area and 2 pi r dr = dA,

    a(u, u)/2 + int w(h) dA,        h = 1 - alpha + mu (z(r) - u_z),

is stationary in u where, for all v, with w' = sigma the tension,

    F(u, alpha) v = a(u, v) - mu int sigma(h) v_z dA = 0;     tangent:  a(u, v) + mu^2 int sigma'(h) u_z v_z dA.

The curve is followed through its folds by a number that does not turn back there: the contact radius, or the gap on
the axis before there is one. It is prescribed by a further equation, with alpha as a further unknown. Events are roots
along it: d(alpha) = 0 at jump_on and jump_off, dW = 0 at pull_off, W = 0 at zero_load.

In the order of reading: `body` (the form, a mesh, its contact surface), `contact` (law, profile, gaps, load, energy),
`newton` (Newton's method with a border, equilibria), `curve` (the path, events, a scene's curve with its errors). The
check of the solvers (`fem_adhesion.crosscheck.from_scratch`) goes the same road up to `newton`, on bodies that are made
in `fem_adhesion.crosscheck.weak_bodies`.

The room checks the solvers, so it shares no physics with them: it imports NumPy, SciPy and scikit-fem, and of the house
exceptions, limits of the inputs, containers of results, and the parts by which a scene is known.
"""

from fem_adhesion.weak_form.curve import Curve, trace

__all__ = ["Curve", "trace"]
