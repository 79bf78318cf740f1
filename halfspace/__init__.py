"""Adhesive contact of a sphere with an elastic half-space, by an integral equation, after Greenwood (1997).

All quantities are dimensionless: radii in beta = (R^2 dgamma/E*)^(1/3), gaps and approach in eps, loads in R dgamma,
pressures P = mu eps p/dgamma; compression is positive.
"""

from halfspace.accuracy import trace
from halfspace.curve import EquilibriumPath, Estimate
from halfspace.events import Event

__all__ = ["EquilibriumPath", "Estimate", "Event", "trace"]
