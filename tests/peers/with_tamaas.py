"""Tamaas: a paraboloid on a periodic half-space, exponential attraction on a hard wall, by conjugate gradients.

It has no 3-9 law. This one is the limit of our exponential law for a hard core. Its mean gap is prescribed, and its
approach is that of a surface of no mean displacement.
"""

import numpy as np
import tamaas
from walk import run

CASES = ((64, 8.0), (64, 16.0), (128, 16.0))  # points along a side and period in beta


def problem(tabor, points, width):
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [width, width], [points, points])
    model.E, model.nu = 1.0, 0.0
    x = (np.arange(points) - points // 2) * width / points
    surface = -tabor * (x[:, None] ** 2 + x**2) / 2
    gap = tamaas.PolonskyKeerRey.gap
    solver = tamaas.PolonskyKeerRey(model, surface, 1e-8, gap, gap)
    solver.max_iter = 600
    attraction = tamaas.ExponentialAdhesionFunctional(surface)
    attraction.parameters = {"rho": 1.0, "surface_energy": tabor**2}
    solver.addFunctionalTerm(attraction)
    kept = model, surface, attraction  # the solver refers to them but does not keep them alive

    def solve(approach, _):
        """Return no load where there is no convergence, as from the fold on: the surfaces have parted."""
        converged = solver.solve(-surface.mean() - approach) < 1e-8
        return converged * kept[0].traction.mean() * width**2 / tabor, np.nan, None

    return f"exponential-{tabor:g}", solve


if __name__ == "__main__":
    tamaas.set_log_level(tamaas.LogLevel.error)
    run("tamaas", tamaas.__version__, CASES, problem)
