"""The Greenwood study as a directory: figures, tables, and a page that shows them all."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from fem_adhesion.common.numbers import digits, joined, plus_minus, told
from fem_adhesion.common.page import Columns, Section, Table, bullets, said, titled, write_csv, write_page
from fem_adhesion.common.style import Picture, captions, draw, shown
from fem_adhesion.greenwood import claims
from fem_adhesion.greenwood.drawing import Plot, drawn, elements_beside, table
from fem_adhesion.greenwood.facts import FULL, Facts
from fem_adhesion.greenwood.figures import FIGURES, plotted
from fem_adhesion.greenwood.numerics_1997 import NODES, Attempt, Ripple
from fem_adhesion.greenwood.tables import Printed, is_rounded
from halfspace.equilibrium.devices import Cycle
from halfspace.equilibrium.events import Event
from halfspace.theories.criteria import fundamental_criterion
from halfspace.values import Estimate


def write(study: Facts, directory: Path, begin: Callable[[str], None] = lambda _: None) -> None:
    """Write every figure as SVG, PNG and CSV, every table and the captions as CSV, and ``index.html``.

    Give it a directory made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none;
    `begin` is called with what is drawn next, once for each of `FIGURES`.
    """
    plots, judged = {stem: plotted(stem, study) for stem in FIGURES}, claims.judged(study)
    pictures = [_picture(stem, plot, judged) for stem, plot in plots.items()]
    draw(pictures, study, directory, begin)
    written, held = list(tables(study)), claims.tables(judged, study)
    data = [table(stem, FIGURES[stem]["title"], plot) for stem, plot in plots.items()]
    write_csv([*held, *written, *data, captions(pictures, study)], directory)
    sections = [
        Section("figures", "Figures", figures=shown(pictures, study, directory)),
        Section("held", "Claims of the paper, held against the numbers", tables=held),
        Section("tables", "Tables", tables=written),
    ]
    title = f"Greenwood (1997), computed again{', quick run' if study.settings != FULL else ''}"
    write_page(directory, title, list(lead(study)), sections, f"{study.seconds:.1f} s, drawing apart")


def _picture(stem: str, plot: Plot, judged: Sequence[claims.Judged]) -> Picture[Facts]:
    """A plot with what is to be seen: its own sentences, how near finite elements are, and the claims it shows."""
    see = [*plot.see, elements_beside(plot.lines), claims.caption(stem, judged)]
    return Picture(stem, FIGURES[stem]["title"], lambda _: drawn(plot), lambda _: see)


def lead(study: Facts) -> Iterator[str]:
    """What kind of run it was, what failed that should not have, and what all figures have in common."""
    if study.settings != FULL:
        yield said("greenwood", "lead", "quick")
    if troubles := list(study.troubles()):
        failed = Markup("<strong>FAILED where it should not have, {} times:</strong>").format(len(troubles))
        yield failed + bullets(troubles)
    yield Markup(said("greenwood", "lead", "paper"))
    yield said("greenwood", "lead", "units")
    if math.isfinite(study.critical_tabor.value):
        yield Markup(said("greenwood", "lead", "critical", mu=plus_minus(study.critical_tabor)))


def tables(study: Facts) -> Iterator[Table]:
    """All tables in the order of the page."""
    a, b = study.asymptote
    fit = said("greenwood", "table_1", "fit", a=plus_minus(a), b=plus_minus(b))
    yield _printed("table_1", told(fit, a.value, b.value), "alpha*", study.table_1)
    yield _printed("table_2", said("greenwood", "table_2", "fit"), "mu", study.table_2)
    fit, mu = said("greenwood", "fig_4_checks", "fit"), study.settings.winding_at
    yield _printed("fig_4_checks", fit, "gap H", study.profile_checks, mu=mu)
    yield _jumps(study)
    yield _cycles(study)
    yield _relaxations(study.relaxations)
    elements = study.element_pull_offs
    pull_offs: Columns[float] = {
        "mu": lambda mu: f"{mu:.6g}",
        ("half-space, R dgamma", "half-space, error, R dgamma"): lambda mu: _cells(study.pull_offs[mu]),
        ("finite elements, R dgamma", "finite elements, error, R dgamma"): lambda mu: _cells(elements.get(mu)),
    }
    agree = sum(load.agrees(study.pull_offs[mu]) for mu, load in elements.items())
    yield Table.of(*titled("greenwood", "pull_off", agree=agree, both=len(elements)), study.pull_offs, pull_offs)
    yield _rises(study)
    yield _true_jumps(study)
    yield _constants(study)


def _printed(stem: str, see: str, column: str, entries: Sequence[Printed], **numbers: float) -> Table:
    """Printed and computed numbers; how many agree to their last digit, and which is off most."""
    columns: Columns[Printed] = {
        ("row", column, "unit", "printed"): lambda p: (p.row, f"{p.column:g}", p.unit, p.printed),
        ("computed", "error"): lambda p: _cells(p.computed),
        ("relative deviation", "note"): lambda p: (f"{p.deviation:+.1e}", p.note),
    }
    known = [entry for entry in entries if math.isfinite(entry.deviation)]
    right = sum(is_rounded(p.printed, p.computed) for p in entries)
    agreement = [f"{right} of {len(entries)} values agree to their last printed digit."]
    if known:
        worst = max(known, key=lambda entry: abs(entry.deviation))
        off = f"{abs(worst.deviation):.1e}, in {worst.row} at {worst.column:g}"
        agreement.append(f"The largest relative deviation is {off}.")
    if len(known) < len(entries):
        agreement.append(f"{len(entries) - len(known)} are not numbers.")
    return Table.of(stem, said("greenwood", stem, "title", **numbers), joined(*agreement, see), entries, columns)


def _jumps(study: Facts) -> Table:
    def of(end: str, quantity: str) -> Callable[[tuple[str, str]], tuple[str, str]]:
        return lambda ends: _cells(getattr(study.jumps[ends], end).estimate(quantity))

    columns: Columns[tuple[str, str]] = {
        "jump": " to ".join,
        ("alpha*, eps", "error of alpha*, eps"): of("take_off", "approach"),
        ("W before, R dgamma", "error of W before, R dgamma"): of("take_off", "load"),
        ("W after, R dgamma", "error of W after, R dgamma"): of("landing", "load"),
    }
    stem, title, see = titled("greenwood", "jumps", mu=study.settings.jumps_at, k=study.settings.apparatus)
    return Table.of(stem, title, see if study.jumps else said("greenwood", "jumps", "none"), study.jumps, columns)


def _cycles(study: Facts) -> Table:
    """Both jumps and the loss of every apparatus."""
    ends = ("jump on", "landing in contact", "jump off", "landing apart")
    quantities = ("alpha*, eps", "error, eps", "W, R dgamma", "error, R dgamma")

    def cells(cycle: Cycle) -> list[str]:
        states = [state for jump in (cycle.jump_on, cycle.jump_off) for state in jump.ends]
        return [cell for state in states for name in ("approach", "load") for cell in _cells(state.estimate(name))]

    columns: Columns[Cycle] = {
        "stiffness, R dgamma/eps": lambda c: "fixed grips" if math.isinf(c.stiffness) else f"{c.stiffness:g}",
        tuple(f"{end}: {what}" for end in ends for what in quantities): cells,
        ("energy lost, R dgamma eps", "error, R dgamma eps"): lambda c: _cells(c.energy_lost),
    }
    return Table.of(*titled("greenwood", "devices", mu=study.settings.devices_at), study.cycles, columns)


def _relaxations(attempts: Sequence[Attempt]) -> Table:
    """Sweeps and times of the iterations of 1997."""
    columns: Columns[Attempt] = {
        ("mu", "iteration"): lambda a: (f"{a.tabor:g}", a.method),
        "sweeps": lambda a: "not converged" if a.sweeps is None else str(a.sweeps),
        ("seconds", "Newton, seconds"): lambda a: (f"{a.seconds:.3f}", f"{a.newton_seconds:.3f}"),
        "outcome": lambda a: a.outcome,
    }
    see = []
    for name in dict.fromkeys(attempt.method for attempt in attempts):
        sweeps = [a.sweeps for a in attempts if a.method == name]
        done = [n for n in sweeps if n is not None]
        span = f", in {min(done)} to {max(done)} sweeps" if done else ""
        see.append(f"{name}: {len(done)} of {len(sweeps)} converged{span}.")
    return Table.of(*titled("greenwood", "relaxation", nodes=NODES, sweeps=joined(*see)), attempts, columns)


def _rises(study: Facts) -> Table:
    """Least loads met on grids that are too coarse, wrong on purpose."""
    columns: Columns[tuple[float, Ripple]] = {
        "spacing, beta": lambda met: f"{met[0]:g}",
        ("mu", "least load, R dgamma"): lambda met: (f"{met[1].tabor:.6g}", f"{met[1].pull_off:.4f}"),
    }
    met = [(spacing, each) for spacing, ripples in study.rises.items() for each in ripples]
    return Table.of(*titled("greenwood", "coarse_grids"), met, columns)


def _true_jumps(study: Facts) -> Table:
    """True jumps beside what the criteria predict for them."""
    usable = {f"{'alpha*' if c.of_approach else 'H0'} by {c.name}, eps": c.predict for c in study.criteria if c.predict}
    columns: Columns[tuple[float, Event]] = {
        "mu": lambda jump: f"{jump[0]:.6g}",
        ("alpha*, eps", "error of alpha*, eps"): lambda jump: _cells(jump[1].estimate("approach")),
        ("H0, eps", "error of H0, eps"): lambda jump: _cells(jump[1].estimate("central_gap")),
        "b sigma'/sigma": lambda jump: f"{fundamental_criterion(jump[1].approach, jump[1].central_gap):.5f}",
        tuple(usable): lambda jump: [f"{predict(np.array(jump[0])):.5f}" for predict in usable.values()],
    }
    return Table.of(*titled("greenwood", "criteria"), study.jumps_on.items(), columns)


def _constants(study: Facts) -> Table:
    columns = ("criterion", "formula", "constant", "printed", "refitted", "standard error", "scatter of ln(left side)")
    rows = [
        (c.name, c.formula, name, "" if printed is None else f"{printed:.6g}", *_cells(fitted), f"{c.scatter:.1e}")
        for c in study.criteria
        for name, printed, fitted in c.constants
    ]
    span = f" for mu = {min(study.jumps_on):g} to {max(study.jumps_on):g}" if study.jumps_on else ""
    return Table(*titled("greenwood", "criteria_constants", span=span), columns, rows)


def _cells(estimate: Estimate | None) -> tuple[str, str]:
    """Value and error; empty if there is none."""
    return ("", "") if estimate is None else (digits(estimate), f"{estimate.error:.1e}")
