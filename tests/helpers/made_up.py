"""Results that were never computed: no two of their numbers are the same, and their verdicts are of every kind."""

from types import SimpleNamespace

from fem_adhesion import Scene
from fem_adhesion.crosscheck.comparison import SOLVERS, Case, Row, solution_of
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import Event
from halfspace.values import Estimate

NUMBERS = ("approach", "load", "central_gap", "contact_radius")


def made_up_path(first, seconds, unknowns):
    """A path no two of whose numbers are the same."""
    events = {}
    for place, name in enumerate(("pull_off", "jump_on", "jump_off", "zero_load")):
        start = first + 10 * place
        values = {name: start + k + 0.5 for k, name in enumerate(NUMBERS)}
        errors = {f"{name}_error": (start + k) * 1e-6 for k, name in enumerate(NUMBERS)}
        events[name] = Event(name=name, **values, **errors)
    settings = {"rtol": 3.7e-6, "degree": unknowns + 1, "panels": {"edge": unknowns + 2}}
    ladder = SimpleNamespace(finest=SimpleNamespace(unknowns=unknowns))
    return EquilibriumPath(2.0, (), events, Estimate(first + 0.1, first * 1e-5), (), ladder, seconds, settings)


# value, error and budget of each row; the difference is that of the values
AGREE = Row("pull_off load", "R dgamma", Estimate(3.25, 2e-3), Estimate(3.2512, 5e-3), 1.2e-3, 7.5e-2)
DISAGREE = Row("jump_on approach", "eps", Estimate(-1.5, 1e-4), Estimate(-1.25, 3e-4), 0.25, 6e-2)
WIDE = Row("operator: Hertz", "beta", Estimate(0.5, 0.125), Estimate(0.53125, 0.0625), 0.03125, 4e-3)
MISSING = Row("jump_off load", "R dgamma", Estimate(-2.25, 1e-5), None, float("nan"), 2e-3)


def case(*rows, tabor=2.0):
    paths = made_up_path(100.0, 7.5, 111), made_up_path(200.0, 9.25, 222)
    return Case(Scene(tabor), dict(zip(SOLVERS, map(solution_of, paths), strict=True)), rows)


FAILED = Case(Scene(3.0), rows=(WIDE,), reason="no convergence in 40 steps; try a nearer start")

ENDINGS = {
    "agree": [case(AGREE)],
    "inconclusive": [case(AGREE, WIDE)],
    "disagree": [case(AGREE, WIDE, DISAGREE)],
    "failed": [case(AGREE), FAILED],
}
