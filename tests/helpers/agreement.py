"""Which numbers of two curves differ by more than their errors."""

import math

from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.values import Estimate


def apart(one, other, quantities=OBSERVABLES):
    """Numbers of two events or states that are farther apart than both errors allow; nan is the same as nan."""
    found = []
    for quantity in quantities:
        ours, theirs = (Estimate(getattr(at, quantity), getattr(at, f"{quantity}_error")) for at in (one, other))
        if not (ours.agrees(theirs) or (math.isnan(ours.value) and math.isnan(theirs.value))):
            found.append(f"{quantity}: {ours}, {theirs}")
    return found


def differing(ours, truth, quantities=OBSERVABLES):
    """Events that one of two curves lacks, and numbers of events that are farther apart than both errors allow."""
    found = [*(ours.events.keys() ^ truth.events.keys())]
    for name in ours.events.keys() & truth.events.keys():
        found += [f"{name} {numbers}" for numbers in apart(ours.events[name], truth.events[name], quantities)]
    return found
