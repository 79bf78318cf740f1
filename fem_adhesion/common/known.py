"""What is known of the half-space without solving: the events of its curves and their energies, from the atlas."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from halfspace import atlas
from halfspace.accuracy.sweep import NUMBERS
from halfspace.equilibrium.events import Event
from halfspace.values import Estimate


def known(tabors: Sequence[float]) -> Iterator[tuple[Mapping[str, Event], Estimate, Estimate]]:
    """Events by name, the energy released and the energy lost in a cycle, at each Tabor parameter from 0.01 to 300.

    Where jumps land is by ``jump_on_landing`` and ``jump_off_landing``; what a curve does not have is left out.
    """
    mu = np.array(tabors, dtype=float)
    on, off = atlas.jump_on(mu), atlas.jump_off(mu)
    states = {"pull_off": atlas.pull_off(mu), "jump_on": on.take_off, "jump_off": off.take_off}
    states |= {"zero_load": atlas.zero_load(mu), "jump_on_landing": on.landing, "jump_off_landing": off.landing}
    energies = atlas.energy_released(mu), atlas.energy_lost(mu)
    for i in range(mu.size):
        events = {
            name: Event(name, *(float(getattr(state, number)[i]) for number in NUMBERS))
            for name, state in states.items()
            if np.isfinite(state.load[i])
        }
        released, lost = (Estimate(float(part.energy[i]), float(part.energy_error[i])) for part in energies)
        yield events, released, lost
