"""Do the two solvers agree? The command ``compare``.

In the order of reading: `comparison` (two numbers with errors, a budget, a verdict; what is told of them), `study`
(operators, residuals, events; of spheres, `references`), `from_scratch` (what both share, against
`fem_adhesion.weak_form`), `elimination` (condensed or not, the same), `definitions` (what law, profile and lengths must
be), `settings` (budgets, and the bodies of all levels), `scenes` (many of them beside each other), `command`.

How independent the two solvers are:

* Elasticity: the ring kernel's elliptic integrals against scikit-fem's axisymmetric forms, condensed to the surface.
  Nothing is shared; a uniform disc, Hertz and Boussinesq check each alone.
* Body: the half-space against a block of finite size, its far field as under a point load. The error against the
  block's size is measured: of fifth order.
* Beyond grid and block both use cells up to infinity, by inversion of the ring kernel. Shared; checked by pressures
  without end in closed form, and by the load as derivative of the energy.
* Surface law, contact problem, Newton's method, continuation, events: shared. Checked by the rigid (Bradley) and soft
  (JKR) limits, the printed values of the paper, energies against work, converged reference values.
* The pressure on the half-space: panels against the overlapping triangles of [G97], a curve of its own whose pull-off
  and jumps are compared with the finite elements as well. Shared with the panels are the ring kernel, where cells begin
  and end, and the infinite one.
* Where cells begin and end: the same radial lines; error estimates by refinement on each side.
* All that is shared is checked by a weak form with its own law, profile, energy and Newton's method. For half-spaces it
  has a mesh of its own, and takes of the solvers only how fine cells must be and the function that grades them; other
  bodies it solves on their mesh. Lengths and profiles are from formulas of its own (`definitions`); of laws but the 3-9
  it is told the potential alone, of profiles of the user's the height. Each event of the finite elements is put into
  it: do the gaps balance, do the tensions across them make the load, are central gap and contact radius those of the
  equilibrium nearby, does the approach turn along the load at a fold? It comes to jump_on on a way of its own, from
  undeformed surfaces far apart, and tells the jumps apart by the side on which states are stable. The energy is that
  between two states which it solves for at approaches of its own. Law, load, residual and tangent are compared at a
  state made up as well, so that a solver which does not converge is told what is wrong with it. It looks for mistakes,
  not digits: its budget is a part in a thousand, ten of gaps and radii. Beyond a Tabor parameter of 6, or at an edge as
  sharp, it only checks that pull-off and jump-off are equilibria, not that they turn there, nor which jump a fold is. A
  contact edge that is defined 2 % off moves the radius by less than that budget: the law's numbers show it.
* That the condensed solver eliminates exactly: one small discretisation is solved with every displacement kept by
  `fem_adhesion.weak_form.trace`'s Newton as well; both agree to rounding. Half-spaces alone.
* Parameters of laws and profiles, radii and shares of pairs: closed numbers that each must make (depth, stiffness,
  strength, edge and range of a law; height, slope and curvature of a profile), by the formula that it is named after.
  Laws and profiles from tables or of the user's have no second formula: their numbers are those of what they tell.

A hemisphere that slides, or a pair, is compared with whole spheres in Legendre polynomials in the place of the
half-space (`fem_adhesion.harmonics`), whose elasticity is summed mode by mode. Bonded bodies, spheres held over a cap
or under a pointed tip, and meshes of the user's have the weak form alone (`weak_bodies`); it shares with the solver
what draws the mesh.

A quantity agrees only if the difference is within the sum of both error estimates and that sum is within the budget.
Seven defects of one side - no hoop strain, E for E*, 2 pi r forgotten, half the shear modulus, a shifted approach,
wrong exponents, a clamped block of ten beta -, four of the triangles - one half alone, no far side of the ring, the
modulus for the parameter of K, uniform for linear - and those that both sides share - 1 % on the law, the profile, the
load, its slope or the elastic term, jumps taken on a spring, jump_on in the place of jump_off, the energy without its
half or to another state, contact edge, radius or central gap off, each parameter of each law and profile 2 % off,
R/beta 1 % off, the shares of a pair exchanged - are injected in the tests, and each is rejected.
"""
