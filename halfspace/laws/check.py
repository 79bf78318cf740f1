"""What every law must be before it is solved with: each refusal names the value, the limit and the remedy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from halfspace.errors import InputError
from halfspace.laws.law import NEAR, Law
from halfspace.values import Array

PROBES = np.array([-0.3, -0.1, 0.05, 0.3, 1.0, 3.0, 10.0])  # gaps H at which derivatives are compared
STEP, CLOSE = 1e-4, 1e-4  # of a gap, for differences; what they may be off by, in parts of the largest value around
TINY = 1e-9  # dgamma/eps, no tension
REACH = 1e-2  # of the largest tension: what may be left of it at the largest of the gaps looked at


def require_law(law: Law) -> Law:
    """Return a law, or raise InputError unless it adheres with dgamma, repels closer by and lets go farther away."""
    for value, holds, limit, remedy in _found(law):
        if not holds:
            raise InputError(f"{law}: {value}, limit: {limit}; {remedy}")
    return law


def _found(law: Law) -> list[tuple[str, bool, str, str]]:
    """What the law has of each that is asked, whether it will do, the limit and the remedy."""
    tension, core = -law.pressure(NEAR, 1.0), law.pressure(PROBES[:2], 1.0)
    strength = max(float(tension.max()), TINY)
    rest, energy = (float(value(np.array(0.0), 1.0)) for value in (law.pressure, law.energy))
    left = float(tension[-1]) / strength
    by_energy = _apart(law.pressure, lambda H: -law.energy(H, 1.0))
    by_pressure = _apart(law.slope, lambda H: law.pressure(H, 1.0))
    return [
        (f"the largest tension is {strength:.3g} dgamma/eps", strength > TINY, "above 0", "let the surfaces attract"),
        (f"the pressure at H = 0 is {rest:.3g} dgamma/eps", abs(rest) < 1e-9 * strength, "0", "move its gaps"),
        (f"the energy at H = 0 is {energy:.7g} dgamma", abs(energy + 1) < 1e-6, "-1", "divide the law by it"),
        (f"the pressure at H = -0.3 is {core[0]:.3g} dgamma/eps", core[0] > core[1] > 0, "rising", "give it a core"),
        (f"the tension far apart is {left:.3g} of its largest", left < REACH, f"{REACH:g}", "let it decay"),
        (f"the pressure is off by {by_energy:.2g} from the energy's derivative", by_energy < CLOSE, f"{CLOSE:g}", MEND),
        (f"the slope is off by {by_pressure:.2g} from the pressure's", by_pressure < CLOSE, f"{CLOSE:g}", MEND),
    ]


MEND = "mend either"


def _apart(derivative: Callable[[Array, float], Array], of: Callable[[Array], Array]) -> float:
    """Largest distance of a derivative from differences of what it is of, in parts of its size at each gap."""
    values, d = derivative(PROBES, 1.0), STEP * (1 + PROBES)
    found = (8 * (of(PROBES + d) - of(PROBES - d)) - (of(PROBES + 2 * d) - of(PROBES - 2 * d))) / (12 * d)
    return float(np.max(np.abs(values - found) / (np.abs(values) + 1e-3 * np.max(np.abs(values[2:])))))
