"""Path and events at finite strain: traced from far separation, or corrected from those of the linear body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from fem_adhesion.finite_strain import FiniteStrainProblem
from halfspace.compliance import Array
from halfspace.contact import APPROACH, ContactProblem
from halfspace.curve import COMPRESSION, Chart, Segment, find_events, metric_for, trace_charts
from halfspace.events import Located, relocate
from halfspace.newton import NotConverged
from halfspace.path import Metric, Steps

SMALLEST_PART = 1 / 64
"""Of delta, in which it is raised from zero where the linear body's events are too far away."""


def trace_finite(
    problem: FiniteStrainProblem, *, to_load: float = COMPRESSION, steps: Steps | None = None
) -> tuple[Segment, dict[str, Located]]:
    """Trace the load-approach curve on one mesh and solve for its events.

    Parameters
    ----------
    problem : FiniteStrainProblem
        On a mesh that is fine wherever the contact edge passes.
    to_load : float
        Compressive load at which the curve ends, in R dgamma.
    steps : Steps, optional
        Of the continuation.

    Returns
    -------
    Segment, dict of Located
        The points, and the events as `halfspace.curve.find_events` names them. They carry no error estimates, which
        take a second mesh: see `halfspace.events.estimate_event`.

    Raises
    ------
    NotConverged
        If the continuation gets stuck.
    GridTooCoarse
        If the contact edge comes to a place where the mesh is too coarse for the spike of tension there.
    """
    # The curve asks of a problem what both kinds have: the equilibrium, the Tabor parameter and the undeformed state.
    chart = Chart(cast(ContactProblem, problem), problem.body.unknowns)
    segments = trace_charts((chart,), to_load, steps)
    return segments[0], find_events(segments)


def correct_events(
    problem: FiniteStrainProblem, events: Mapping[str, Located], displacements: Mapping[str, Array]
) -> dict[str, Located]:
    """Solve for the events of the linear body again at finite strain.

    Parameters
    ----------
    problem : FiniteStrainProblem
        On the same mesh as the linear body, and with the same profile and exterior.
    events : mapping of str to Located
        Events of the linear body.
    displacements : mapping of str to (N,) arrays
        All displacements of the linear body at each of them, in beta^2/R: `CondensedBody.displacement` of the pressure.

    Returns
    -------
    dict of Located
        Under the same names.

    Raises
    ------
    NotConverged
        If an event is lost on the way from infinitesimal to finite strains.
    """
    metric = metric_for(problem.tabor)
    return {name: _corrected(event, problem, displacements[name], metric) for name, event in events.items()}


def _corrected(event: Located, problem: FiniteStrainProblem, displacement: Array, metric: Metric) -> Located:
    """Raise delta from zero, at once if Newton's method can, otherwise in parts."""
    found = event
    x = problem.stretched(0.0).state_from(float(event.point.observables[APPROACH]), displacement)
    done, part = 0.0, 1.0
    while done < 1:
        try:
            found = relocate(found, problem.stretched((done + part) * problem.stretch), x, metric)
        except NotConverged:
            part /= 2
            if part < SMALLEST_PART:
                raise
            continue
        x, done = found.point.x, done + part
    return found
