"""NGSolve: axisymmetric finite elements of high order on a graded block, clamped far away, Newton's method."""

from importlib.metadata import version

import numpy as np
from ngsolve import (
    BND,
    CF,
    BilinearForm,
    Grad,
    GridFunction,
    IfPos,
    InnerProduct,
    Integrate,
    Parameter,
    Sym,
    Trace,
    Variation,
    VectorH1,
    ds,
    dx,
    x,
    y,
)
from ngsolve.meshes import MakeStructured2DMesh
from walk import run

POISSON = 0.3
CONTACT = 4.0  # beta, within which cells are of one size; beyond they double


def problem(tabor, cells, order, far):  # noqa: C901 (a problem and its solver share their forms)
    nodes = [*np.linspace(0, CONTACT, cells + 1)]
    while nodes[-1] < far:
        nodes.append(nodes[-1] * 2)
    n = len(nodes) - 1

    def place(s):
        return float(np.interp(s * n, range(n + 1), nodes))

    mesh = MakeStructured2DMesh(quads=True, nx=n, ny=n, mapping=lambda s, t: (place(s), place(t)))
    space = VectorH1(mesh, order=order, dirichletx="left|right|top", dirichlety="right|top")
    u, approach = space.TrialFunction(), Parameter(0)
    shear = (1 - POISSON) / 2  # of E* = 1
    first = shear * 2 * POISSON / (1 - 2 * POISSON)
    strain, hoop = Sym(Grad(u)), u[0] / x

    def gap(v):  # h; y points into the body
        return 1 - approach + tabor * x**2 / 2 + v[1]

    h = gap(u)
    law = tabor**2 * IfPos(h - 0.5, h**-8 / 3 - 4 / 3 * h**-2, 100 * (1 - h))
    form = BilinearForm(space, symmetric=True, condense=True)
    form += Variation(
        np.pi * x * (2 * shear * (InnerProduct(strain, strain) + hoop**2) + first * (Trace(strain) + hoop) ** 2) * dx
    )
    form += Variation(2 * np.pi * x * law.Compile() * ds("bottom", bonus_intorder=2 * order))
    solution = GridFunction(space)
    top = gap(solution)
    tension = 8 / 3 * tabor * (top**-3 - top**-9) * 2 * np.pi * x

    def step(right):
        """Solve the linearised equations, the interiors of cells eliminated."""
        found = solution.vec.CreateVector()
        right.data += form.harmonic_extension_trans * right
        found.data = form.mat.Inverse(space.FreeDofs(True), inverse="sparsecholesky") * right
        found.data += form.inner_solve * right
        found.data += form.harmonic_extension * found
        return found

    def residual():
        form.Apply(solution.vec, out := solution.vec.CreateVector())
        return out

    def newton():
        for _ in range(40):
            form.AssembleLinearization(solution.vec)
            size = InnerProduct(change := step(residual()), residual())
            energy, old, part = form.Energy(solution.vec), solution.vec.CreateVector(), 1.0
            old.data = solution.vec
            solution.vec.data = old - change
            while not form.Energy(solution.vec) <= energy + 1e-10 * abs(energy) and part > 1e-3:
                part /= 2
                solution.vec.data = old - part * change
            if abs(size) < 1e-15 * abs(energy):
                return
        raise RuntimeError(f"no equilibrium at approach {approach.Get()}")

    def solve(at, state):
        """From the state of contact at a larger approach, in steps of a tenth."""
        if state is None:
            overlap = at - tabor * x**2 / 2
            solution.Set(CF((0, IfPos(overlap, overlap, 0) / (1 + y) ** 2)))
            approach.Set(at)
            newton()
        else:
            before, solution.vec.FV().NumPy()[:] = state
            for next_one in np.linspace(before, at, 1 + int(np.ceil((before - at) / 0.1)))[1:]:
                approach.Set(float(next_one))
                newton()
        approach.Set(float(at))  # where no step was needed
        load = -Integrate(tension, mesh, BND, definedon=mesh.Boundaries("bottom"), order=4 * order)
        return load, top(mesh(0, 0, VOL_or_BND=BND)) - 1, (at, solution.vec.FV().NumPy().copy())

    return f"half-space-{tabor:g}", solve


CASES = ((8, 2, 16.0), (16, 2, 16.0), (16, 2, 64.0))  # cells in contact, order, width of the block in beta
if __name__ == "__main__":
    # At tabor 2 the Newton iteration written here fails on its way to pull-off.
    run("ngsolve", version("ngsolve"), CASES, problem, tabors=(0.5, 1.0))
