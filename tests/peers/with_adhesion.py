"""Adhesion with ContactMechanics: a paraboloid on a free half-space by FFT, minimised by L-BFGS.

The 3-9 law of pressures is the potential 2-8, there VDW82; what is called LJ93 there is the potential 3-9.
"""

from importlib.metadata import version

import numpy as np
from Adhesion.Interactions import VDW82
from Adhesion.System import SmoothContactSystem
from ContactMechanics import FreeFFTElasticHalfSpace
from SurfaceTopography import make_sphere
from walk import run

CASES = ((32, 8.0), (64, 8.0), (64, 12.0), (96, 12.0))  # points along a side and width of the domain in beta


def problem(tabor, points, width):
    n, size = (points, points), (width, width)
    law = VDW82(c_sr=tabor**2 / 3, hamaker=16 * np.pi * tabor**2)
    assert np.isclose(law.r_min, 1)
    surface = make_sphere(1 / tabor, n, size, centre=(width / 2, width / 2), kind="paraboloid")
    system = SmoothContactSystem(FreeFFTElasticHalfSpace(n, 1.0, size), law, surface)

    def solve(approach, state):
        if state is None:  # so that the surfaces do not overlap: the potential there is infinite
            state = np.zeros(system.substrate.nb_subdomain_grid_pts)
            state[:points, :points] = np.maximum(surface.heights() + approach, 0)
        cell, options = (width / points) ** 2, {"gtol": 0, "ftol": 0, "maxiter": 3000, "maxfun": 6000, "maxcor": 20}
        for _ in range(5):  # its memory of curvatures may lead astray: begun anew, it goes on
            found = system.minimize_proxy(offset=approach - 1, initial_displacements=state, options=options)
            state = np.reshape(found.x, state.shape)
            if np.abs(system.force).max() < 1e-6 * tabor**2 * cell:
                break
        else:
            raise RuntimeError(f"no equilibrium at approach {approach}: {found.message}")
        gap = system.gap[points // 2, points // 2] - 1
        return system.compute_normal_force() / tabor, gap, state

    return f"half-space-{tabor:g}", solve


if __name__ == "__main__":
    run("adhesion", version("Adhesion"), CASES, problem)
