"""Which numbers of two curves differ by more than their errors."""

import math

from halfspace.equilibrium.contact import OBSERVABLES


def differing(ours, truth, quantities=OBSERVABLES):
    """Events that one of two curves lacks, and numbers of events that are farther apart than both errors allow."""
    found = [*(ours.events.keys() ^ truth.events.keys())]
    for name in ours.events.keys() & truth.events.keys():
        for quantity in quantities:
            one, other = (path.events[name].estimate(quantity) for path in (ours, truth))
            if not (one.agrees(other) or (math.isnan(one.value) and math.isnan(other.value))):
                found.append(f"{name} {quantity}: {one}, {other}")
    return found
