"""The half-space's load-approach curve to an accuracy asked for.

See `halfspace.accuracy.refinement` for how the error is estimated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from functools import partial

from halfspace.accuracy.grids import GRIDS, Resolution, twin_of
from halfspace.accuracy.kernels import INTERVALS, Kernel, require_kernel
from halfspace.accuracy.layered import layered
from halfspace.accuracy.refinement import climb
from halfspace.accuracy.stages import Discretised, Rung
from halfspace.elastic.layers import LayeredBody
from halfspace.equilibrium.charts import COMPRESSION
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import ErrorRule
from halfspace.laws import LENNARD_JONES, Law
from halfspace.laws.law import require_law
from halfspace.limits import require_load, require_rtol, require_tabor
from halfspace.profiles import PARABOLOID, Profile, require_profile
from halfspace.scales import Scales


def trace(
    tabor: float,
    *,
    law: Law = LENNARD_JONES,
    profile: Profile = PARABOLOID,
    body: LayeredBody | None = None,
    kernel: str = "panels",
    rtol: float = 1e-5,
    to_load: float = COMPRESSION,
) -> EquilibriumPath:
    """Trace the load-approach curve of a rigid body on an adhesive half-space, or a layer, and solve for its events.

    Parameters
    ----------
    tabor : float
        Tabor parameter mu, mu^3 = R dgamma^2/(E*^2 eps^3), 1e-12 to 300.
    law : Law
        Of the tension between the surfaces against their gap, see `halfspace.laws`.
    profile : Profile
        Shape of the rigid body, see `halfspace.profiles`.
    body : LayeredBody, optional
        Layers on a base or a coating, see `halfspace.elastic.layers`, in the place of the half-space; E*, in the Tabor
        parameter and beta, is that of the first stratum.
    kernel : str
        How the pressure is represented: ``panels`` (polynomials, the fastest), ``triangles`` (overlapping triangles,
        [G97] section 2a) or ``bands`` (uniform bands, [G97] App. B), see `halfspace.accuracy.kernels`.
    rtol : float
        Relative accuracy asked of loads and approaches, 1e-9 to 1e-1; of approaches, which have no natural zero, in
        parts of eps and the range of those of all events.
    to_load : float
        Compressive load at which the curve ends, in R dgamma, up to 1000.

    Returns
    -------
    EquilibriumPath
        The curve, its events and their error estimates.

    Raises
    ------
    InputError
        If an input is out of range.
    halfspace.errors.NotConverged
        If the curve cannot be traced.
    """
    tabor, rtol, to_load = require_tabor(tabor), require_rtol(rtol), require_load(to_load)
    scales = Scales(tabor, require_law(law), require_profile(profile).surface(tabor), body)
    how = require_kernel(kernel, scales, rtol)
    discretise = partial(layered(body) if body else how.discretise, scales, to_load)
    return climb(rtol, partial(_rung, scales, rtol, how, discretise), to_load=to_load, most_rungs=how.most_rungs)


Discretise = Callable[[Resolution, int], Discretised]
"""Discretises a body at a resolution for a rung, 0, or for its twin, 1, which may differ in more than cells."""


def _rung(scales: Scales, rtol: float, how: Kernel, discretise: Discretise, level: int) -> Rung:
    """Rung of a level: the curve on the lowest, events on each above it and on a twin as fine as the rung below."""
    resolution, below, *coarser = how.resolutions(scales, rtol, level)
    (curve, stage), settings = discretise(resolution, 0), {"kernel": how.name, **asdict(resolution)}
    if not level:
        return Rung(curve, (stage,), settings)
    twin, before = discretise(twin_of(below), 1)[1], discretise(coarser[0], 0)[1] if coarser else None
    rule = ErrorRule(INTERVALS.crossing if scales.pieced else how.left, (GRIDS.before, 1.0), steps=scales.steps)
    return Rung(curve, (stage,), settings, twin, before, rule)
