"""Limits of the inputs, checked where they enter; each refusal names the value, the limit and the remedy."""

from __future__ import annotations

import math


def require_tabor(tabor: float) -> float:
    """Return the Tabor parameter, or raise ValueError unless it is finite and positive."""
    return _require(tabor, "tabor", 0 < tabor < math.inf, "0 < tabor", "give the Tabor parameter of the contact")


def require_poisson(poisson: float) -> float:
    """Return Poisson's ratio, or raise ValueError unless 0 <= poisson < 0.5."""
    return _require(poisson, "poisson", 0 <= poisson < 0.5, "0 <= poisson < 0.5", "take 0.49 for rubber")


def require_rtol(rtol: float) -> float:
    """Return the relative tolerance, or raise ValueError unless 1e-9 <= rtol <= 1e-1."""
    return _require(rtol, "rtol", 1e-9 <= rtol <= 1e-1, "1e-9 <= rtol <= 1e-1", "take 1e-5 if in doubt")


def _require(value: float, name: str, holds: bool, limit: str, remedy: str) -> float:
    if not holds or not math.isfinite(value):
        raise ValueError(f"{name} = {value:g} is outside {limit}; {remedy}")
    return float(value)
