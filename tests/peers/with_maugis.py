"""Adhesion's closed solution of Maugis's theory: the pull-off load at the parameters lambda of its refinement."""

from importlib.metadata import version

import numpy as np
from scipy.optimize import minimize_scalar
from walk import record

LAMBDAS = (0.1157, 0.2, 0.5785, 1.157, 2.314, 5.785)


def pull_off(maugis):
    """Least load over the contact radius, in R dgamma."""
    from Adhesion.ReferenceSolutions.MaugisDugdale import _load  # here, as our own environment does not have it

    least = minimize_scalar(
        lambda log: _load(np.exp(log), maugis), bounds=(-4, 1), method="bounded", options={"xatol": 1e-9}
    )
    return np.pi * float(least.fun)


if __name__ == "__main__":
    with record("maugis", version("Adhesion"), "closed") as rows:
        rows += [(f"maugis-{number:g}", "pull_off_load", pull_off(number), "R dgamma", "") for number in LAMBDAS]
