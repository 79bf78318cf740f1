"""Our own solver by the side of the others: its errors against its time, and Dugdale's law in Maugis's limit."""

from importlib.metadata import version

import numpy as np
from walk import TABORS, record
from with_maugis import LAMBDAS

from halfspace import trace
from halfspace.laws import Dugdale
from halfspace.theories.maugis import TENSION_TO_MAUGIS
from halfspace.values import Estimate

RTOLS = (1e-3, 1e-5, 1e-7)
WIDTHS = np.array([0.07, 0.08, 0.11, 0.16])
POWERS = (2, 10 / 3, 4)


def dugdale_limit(maugis):
    """Pull-off load at Maugis's parameter, extrapolated to no width w of the step in Dugdale's law.

    The step of the width w about the range, and the gap of the order w^2 that the core leaves in contact, both add
    terms of w^2. At the edge of the contact the gap opens as the power 3/2 of the distance, so that the core differs
    from a wall over the distance w^(4/3): terms of w^2 w^(4/3). Next is w^4. The error is the change from the
    extrapolation without the narrowest width and w^4.
    """
    loads = [trace(maugis / TENSION_TO_MAUGIS, law=Dugdale(width)).events["pull_off"].load for width in WIDTHS]

    def limit(first, powers):
        return float(np.linalg.solve(WIDTHS[first:, None] ** np.array([0, *powers]), loads[first:])[0])

    finest, coarser = limit(0, POWERS), limit(1, POWERS[:-1])
    return Estimate(finest, abs(finest - coarser))


if __name__ == "__main__":
    trace(0.7, rtol=1e-3)  # what is imported at the first call is not timed
    for rtol in RTOLS:
        with record("halfspace", version("fem-adhesion"), f"rtol {rtol:g}") as rows:
            for tabor in TABORS:
                events = trace(tabor, rtol=rtol).events
                pull_off, zero, name = events["pull_off"], events["zero_load"], f"half-space-{tabor:g}"
                rows += [
                    (name, "pull_off_load", pull_off.load, "R dgamma", pull_off.estimate("load").error),
                    (name, "pull_off_approach", pull_off.approach, "eps", pull_off.estimate("approach").error),
                    (name, "zero_load_approach", zero.approach, "eps", zero.estimate("approach").error),
                ]
    with record("halfspace", version("fem-adhesion"), "Dugdale's law") as rows:
        for maugis in LAMBDAS:
            found = dugdale_limit(maugis)
            rows.append((f"maugis-{maugis:g}", "pull_off_load", found.value, "R dgamma", found.error))
