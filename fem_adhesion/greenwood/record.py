"""Tables of the Greenwood study: cells with names, as CSV files and as HTML."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from fem_adhesion.common.numbers import digits
from fem_adhesion.common.page_tables import Table
from fem_adhesion.greenwood import remarks
from fem_adhesion.greenwood.criteria import CriteriaStudy
from fem_adhesion.greenwood.devices import DeviceStudy
from fem_adhesion.greenwood.relaxation import NODES, Attempt
from fem_adhesion.greenwood.study import JUMPS_AT, WINDING_AT, Greenwood1997
from fem_adhesion.greenwood.tables import Printed
from halfspace.equilibrium.events import Event
from halfspace.values import Estimate


def tables(study: Greenwood1997) -> list[Table]:
    """All tables in the order of the page."""
    return [
        *_printed_tables(study),
        _jumps(study),
        _cycles(study.devices),
        _relaxations(study.relaxations),
        _pull_offs(study),
        _rises(study),
        _true_jumps(study.criteria),
        _constants(study.criteria),
    ]


def _printed_tables(study: Greenwood1997) -> Iterator[Table]:
    printed = study.tables
    title = "Table 1: f(alpha*)/alpha*^(3/2) of the DMT force method"
    see = remarks.table_1(printed.table_1, printed.asymptote)
    yield _printed("table_1", title, see, "alpha*", printed.table_1)
    title = "Table 2: jumping on and off under fixed grips"
    see = f"{remarks.agreement(printed.table_2)} The notes say what explains the others."
    yield _printed("table_2", title, see, "mu", printed.table_2)
    title, see = f"Pressures printed with Fig. 4, mu = {WINDING_AT:g}", remarks.profile_checks(printed.profile_checks)
    yield _printed("fig_4_checks", title, see, "gap H", printed.profile_checks)


def _printed(stem: str, title: str, see: str, column: str, entries: Sequence[Printed]) -> Table:
    columns = ("row", column, "unit", "printed", "computed", "error", "relative deviation", "note")
    return Table(stem, title, see, columns, tuple(_entry(p) for p in entries))


def _entry(p: Printed) -> tuple[str, ...]:
    return (p.row, f"{p.column:g}", p.unit, p.printed, *_cells(p.computed), f"{p.deviation:+.1e}", p.note)


def _jumps(study: Greenwood1997) -> Table:
    loads = (f"{what} {when}, R dgamma" for when in ("before", "after") for what in ("W", "error of W"))
    columns = ("jump", "alpha*, eps", "error of alpha*, eps", *loads)
    rows = tuple(
        (f"{j.take_off} to {j.landing}", *_cells(j.approach), *_cells(j.load), *_cells(j.landing_load))
        for j in study.states.jumps
    )
    see = "Where each jump takes off and lands." if rows else "No jump was found."
    return Table("jumps", f"Jumps of Fig. 2a, mu = {JUMPS_AT:g}, fixed grips", see, columns, rows)


def _cycles(devices: DeviceStudy) -> Table:
    """Both jumps and the loss of every apparatus."""
    ends = ("jump on", "landing in contact", "jump off", "landing apart")
    parts = (
        f"{end}: {what}" for end in ends for what in ("alpha*, eps", "error, eps", "W, R dgamma", "error, R dgamma")
    )
    rows = tuple(
        (
            "fixed grips" if math.isinf(cycle.stiffness) else f"{cycle.stiffness:g}",
            *(
                cell
                for jump in (cycle.jump_on, cycle.jump_off)
                for e in (jump.take_off, jump.landing)
                for cell in _end(e)
            ),
            *_cells(cycle.energy_lost),
        )
        for cycle in devices.cycles
    )
    title = f"Cycles of an apparatus, mu = {devices.tabor:g}"
    columns = ("stiffness, R dgamma/eps", *parts, "energy lost, R dgamma eps", "error, R dgamma eps")
    return Table("devices", title, remarks.devices(devices), columns, rows)


def _end(event: Event) -> tuple[str, ...]:
    """Approach and load where a jump takes off or lands."""
    approach, load = event.estimate("approach"), event.estimate("load")
    return (*_cells(approach), *_cells(load))


def _relaxations(attempts: Sequence[Attempt]) -> Table:
    """Sweeps and times of the iterations of 1997."""
    columns = ("mu", "iteration", "sweeps", "seconds", "Newton, seconds", "outcome")
    rows = tuple(
        (
            f"{a.tabor:g}",
            a.method,
            "not converged" if a.sweeps is None else str(a.sweeps),
            f"{a.seconds:.3f}",
            f"{a.newton_seconds:.3f}",
            a.outcome,
        )
        for a in attempts
    )
    title = f"The iterations of 1997 on {NODES} uniform nodes, from the undeformed surfaces to H(0) = 0"
    return Table("relaxation", title, remarks.relaxations(attempts), columns, rows)


def _pull_offs(study: Greenwood1997) -> Table:
    solvers = ("half-space", "finite elements")
    columns = ("mu", *(f"{solver}{what}, R dgamma" for solver in solvers for what in ("", ", error")))
    rows = tuple((f"{p.tabor:.6g}", *_cells(p.half_space), *_cells(p.finite_element)) for p in study.pull_offs)
    return Table("pull_off", "Load at pull-off, Fig. 7", remarks.pull_offs(study.pull_offs), columns, rows)


def _rises(study: Greenwood1997) -> Table:
    """Least loads met on grids that are too coarse, wrong on purpose."""
    columns = ("spacing, beta", "mu", "least load, R dgamma")
    rows = tuple(
        (f"{spacing:g}", f"{r.tabor:.6g}", f"{r.pull_off:.4f}")
        for spacing, rise in study.rises.items()
        for r in rise.ripples
    )
    title = "Least load on uniform triangles that are too wide, Fig. 7: wrong on purpose, so without an error"
    return Table("coarse_grids", title, remarks.rises_of(study), columns, rows)


def _true_jumps(criteria: CriteriaStudy) -> Table:
    """True jumps beside what the criteria predict for them."""
    usable = [c for c in criteria.criteria if c.predict is not None]
    predicted = [c.predict(criteria.tabor) for c in usable if c.predict]
    names = (f"{'alpha*' if c.of_approach else 'H0'} by {c.name}, eps" for c in usable)
    errors = ("error of alpha*, eps", "error of H0, eps")
    columns = ("mu", "alpha*, eps", errors[0], "H0, eps", errors[1], "b sigma'/sigma", *names)
    rows = tuple(
        (
            f"{jump.tabor:.6g}",
            *_cells(jump.approach),
            *_cells(jump.central_gap),
            f"{jump.fundamental:.5f}",
            *(f"{values[i]:.5f}" for values in predicted),
        )
        for i, jump in enumerate(criteria.jumps)
    )
    return Table(
        "criteria", "True jumps on and the criteria's predictions", remarks.true_jumps(criteria), columns, rows
    )


def _constants(criteria: CriteriaStudy) -> Table:
    columns = ("criterion", "formula", "constant", "printed", "refitted", "standard error", "scatter of ln(left side)")
    rows = tuple(
        (c.name, c.formula, name, "" if printed is None else f"{printed:.6g}", *_cells(fitted), f"{c.scatter:.1e}")
        for c in criteria.criteria
        for name, printed, fitted in c.constants
    )
    span = f" for mu = {criteria.tabor[0]:g} to {criteria.tabor[-1]:g}" if criteria.jumps else ""
    title = f"Constants of the criteria, refitted{span}"
    return Table("criteria_constants", title, remarks.constants(criteria), columns, rows)


def _cells(estimate: Estimate | None) -> tuple[str, str]:
    """Value and error; empty if there is none."""
    return ("", "") if estimate is None else (digits(estimate), f"{estimate.error:.1e}")
