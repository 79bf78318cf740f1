"""The Greenwood study as a directory: figures, tables, and a page that shows them all.

What is to be seen in each table is counted and measured on its entries.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from fem_adhesion.common.numbers import digits, joined, plus_minus, told
from fem_adhesion.common.page import Columns, Section, Table, bullets, write_csv, write_page
from fem_adhesion.common.style import Picture, captions, draw, shown
from fem_adhesion.greenwood import beyond, claims, load_figures, state_figures
from fem_adhesion.greenwood.criteria import CriteriaStudy, JumpOn, closed_ratios
from fem_adhesion.greenwood.drawing import Plot, drawn, rises, table
from fem_adhesion.greenwood.numerics_1997 import NODES, Attempt
from fem_adhesion.greenwood.study import APPARATUS, JUMPS_AT, WINDING_AT, DeviceStudy, Greenwood1997, PullOff
from fem_adhesion.greenwood.tables import Printed
from halfspace.equilibrium.devices import Cycle
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF
from halfspace.values import Estimate

PAPER = "J. A. Greenwood, Adhesion of elastic spheres, Proc. R. Soc. Lond. A 453 (1997) 1277-1297"
DOI = "10.1098/rspa.1997.0070"
OF_PAPER = dict(sorted((load_figures.FIGURES | state_figures.FIGURES).items()))
PLOTS = {f"fig_{number}": (f"Fig. {number}: {title}", plot) for number, (title, plot) in OF_PAPER.items()} | {
    f"beyond_{name}": (f"Beyond the paper: {title}", plot) for name, (title, plot) in beyond.FIGURES.items()
}
"""Title and plot of each figure by the name of its files: those of the paper in its order, and further ones."""


def _picture(stem: str, plot: Callable[[Greenwood1997], Plot]) -> Picture[Greenwood1997]:
    return Picture(stem, PLOTS[stem][0], lambda study: drawn(plot(study)), lambda study: plot(study).see)


def _always(made: Plot) -> Callable[[Greenwood1997], Plot]:
    return lambda _: made


FIGURES = tuple(_picture(stem, plot) for stem, (_, plot) in PLOTS.items())


def write(
    study: Greenwood1997, directory: Path, begin: Callable[[str], None] = lambda _: None, asked: str = ""
) -> None:
    """Write every figure as SVG, PNG and CSV, every table and the captions as CSV, and ``index.html``.

    Give it a directory made by `fem_adhesion.common.files.directory_written_aside`, so that all files appear or none;
    `begin` is told what is drawn next, once for each of `FIGURES`, `asked` is the command line that was run.
    """
    plots = {stem: plot(study) for stem, (_, plot) in PLOTS.items()}
    pictures = [_picture(stem, _always(made)) for stem, made in plots.items()]
    draw(pictures, study, directory, begin)
    written, held = tables(study), claims.tables(study.claims)
    data = [table(stem, PLOTS[stem][0], made) for stem, made in plots.items()]
    write_csv([*held, *written, *data, captions(pictures, study)], directory)
    title = f"Greenwood (1997), computed again{', quick run' if study.quick else ''}"
    figures = Section("figures", "Figures", figures=shown(pictures, study, directory))
    sections = [
        figures,
        Section("held", "Claims of the paper, held against the numbers", tables=held),
        Section("tables", "Tables", tables=written),
    ]
    write_page(directory, title, list(lead(study)), sections, f"{study.seconds:.1f} s, drawing apart", asked)


def lead(study: Greenwood1997) -> Iterator[str]:
    """What kind of run it was, what failed that should not have, and what all figures have in common."""
    if study.quick:
        yield "A quick run: fewer points, coarser tolerances, fewer sweeps allowed to Greenwood's iteration."
    troubles = list(study.troubles())
    if troubles:
        failed = Markup("<strong>FAILED where it should not have, {} times:</strong>").format(len(troubles))
        yield failed + bullets(troubles)
    link = Markup('<a href="https://doi.org/{}">{}</a>').format(DOI, DOI)
    yield Markup("Figures and tables after {}, doi {}.").format(PAPER, link)
    yield (
        "Loads in R dgamma, positive in compression; gaps and approach in eps, the approach positive when pressed "
        "together; radii in beta; pressures P in dgamma/(mu eps). Errors are estimated by refinement."
    )
    if math.isfinite(study.critical_tabor.value):
        critical = Markup("<strong>mu = {}</strong>").format(plus_minus(study.critical_tabor))
        first = Markup("The curve under fixed grips first has a vertical tangent at {}; the paper says about 1.")
        yield first.format(critical)


EMPTY = "Nothing was computed."


def tables(study: Greenwood1997) -> list[Table]:
    """All tables in the order of the page."""
    return [
        *_printed_tables(study),
        _jumps(study),
        _cycles(study.devices),
        _relaxations(study.relaxations),
        _pull_offs(study.pull_offs),
        _rises(study),
        _true_jumps(study.criteria),
        _constants(study.criteria),
    ]


def _printed_tables(study: Greenwood1997) -> Iterator[Table]:
    printed = study.tables
    title = "Table 1: f(alpha*)/alpha*^(3/2) of the DMT force method"
    see = _see_table_1(printed.table_1, printed.asymptote)
    yield _printed("table_1", title, see, "alpha*", printed.table_1)
    title = "Table 2: jumping on and off under fixed grips"
    see = f"{_agreement(printed.table_2)} The notes say what explains the others, or that nothing does."
    yield _printed("table_2", title, see, "mu", printed.table_2)
    title, see = f"Pressures printed with Fig. 4, mu = {WINDING_AT:g}", _see_profile_checks(printed.profile_checks)
    yield _printed("fig_4_checks", title, see, "gap H", printed.profile_checks)


def _printed(stem: str, title: str, see: str, column: str, entries: Sequence[Printed]) -> Table:
    columns: Columns[Printed] = {
        "row": lambda p: p.row,
        column: lambda p: f"{p.column:g}",
        "unit": lambda p: p.unit,
        "printed": lambda p: p.printed,
        ("computed", "error"): lambda p: _cells(p.computed),
        "relative deviation": lambda p: f"{p.deviation:+.1e}",
        "note": lambda p: p.note,
    }
    return Table.of(stem, title, see, entries, columns)


def _agreement(entries: Sequence[Printed]) -> str:
    """How many entries agree to their last digit, and which is off most."""
    if not entries:
        return EMPTY
    exact = sum(entry.to_last_digit for entry in entries)
    known = [entry for entry in entries if math.isfinite(entry.deviation)]
    worst = max(known, key=lambda entry: abs(entry.deviation), default=None)
    return joined(
        f"{exact} of {len(entries)} values agree to their last printed digit.",
        f"The largest relative deviation is {abs(worst.deviation):.1e}, in {worst.row} at {worst.column:g}."
        if worst
        else "",
        "" if len(known) == len(entries) else f"{len(entries) - len(known)} are not numbers.",
    )


def _see_table_1(entries: Sequence[Printed], asymptote: tuple[Estimate, Estimate]) -> str:
    """Agreement, and the constants of the asymptote."""
    a, b = asymptote
    fit = (
        f"The asymptote f = a alpha*^(3/2) - b alpha*^2, fitted between 2e-5 and 1e-4, has a = {plus_minus(a)} and b = "
        f"{plus_minus(b)} (standard errors of the fit; the paper: 1.84 and 7.7)."
    )
    return joined(_agreement(entries), told(fit, a.value, b.value))


def _see_profile_checks(entries: Sequence[Printed]) -> str:
    """Whether the printed pressures have the sign and size of the corrected law."""
    if not entries:
        return EMPTY
    same = sum(float(entry.printed) * entry.computed.value > 0 for entry in entries)
    within = sum(entry.to_last_digit for entry in entries)
    return (
        f"{same} of {len(entries)} printed pressures have the sign of the corrected law, compression positive, and "
        f"{within} its value within the error, which is that of the rounded gap."
    )


def _jumps(study: Greenwood1997) -> Table:
    columns: Columns[tuple[str, str]] = {
        "jump": " to ".join,
        ("alpha*, eps", "error of alpha*, eps"): lambda ends: _cells(study.jumps[ends].take_off.estimate("approach")),
        ("W before, R dgamma", "error of W before, R dgamma"): lambda ends: _cells(
            study.jumps[ends].take_off.estimate("load")
        ),
        ("W after, R dgamma", "error of W after, R dgamma"): lambda ends: _cells(
            study.jumps[ends].landing.estimate("load")
        ),
    }
    see = "Where each jump takes off and lands." if study.jumps else "No jump was found."
    return Table.of(
        "jumps",
        f"Jumps of Fig. 2a, mu = {JUMPS_AT:g}, primed in an apparatus of {APPARATUS:g} R dgamma/eps",
        see,
        study.jumps,
        columns,
    )


def _cycles(devices: DeviceStudy) -> Table:
    """Both jumps and the loss of every apparatus."""
    ends = ("jump on", "landing in contact", "jump off", "landing apart")
    quantities = ("alpha*, eps", "error, eps", "W, R dgamma", "error, R dgamma")
    columns: Columns[Cycle] = {
        "stiffness, R dgamma/eps": lambda c: "fixed grips" if math.isinf(c.stiffness) else f"{c.stiffness:g}",
        tuple(f"{end}: {what}" for end in ends for what in quantities): _cycle_cells,
        ("energy lost, R dgamma eps", "error, R dgamma eps"): lambda c: _cells(c.energy_lost),
    }
    lost = np.array([cycle.energy_lost.value for cycle in devices.cycles])
    grows = "the more energy a cycle loses" if rises(lost) else "the energy that a cycle loses does not always grow"
    see = joined(told(f"The softer the apparatus, {grows}.", lost), "The loss is the work of the base round the loop.")
    return Table.of("devices", f"Cycles of an apparatus, mu = {devices.tabor:g}", see, devices.cycles, columns)


def _cycle_cells(cycle: Cycle) -> list[str]:
    """Approach and load of the four ends of both jumps."""
    states = [state for jump in (cycle.jump_on, cycle.jump_off) for state in jump.ends]
    return [cell for state in states for name in ("approach", "load") for cell in _cells(state.estimate(name))]


def _relaxations(attempts: Sequence[Attempt]) -> Table:
    """Sweeps and times of the iterations of 1997."""
    columns: Columns[Attempt] = {
        "mu": lambda a: f"{a.tabor:g}",
        "iteration": lambda a: a.method,
        "sweeps": lambda a: "not converged" if a.sweeps is None else str(a.sweeps),
        "seconds": lambda a: f"{a.seconds:.3f}",
        "Newton, seconds": lambda a: f"{a.newton_seconds:.3f}",
        "outcome": lambda a: a.outcome,
    }
    names = dict.fromkeys(attempt.method for attempt in attempts)
    see = joined(*(_iteration(name, [a for a in attempts if a.method == name]) for name in names))
    title = f"The iterations of 1997 on {NODES} uniform nodes, from the undeformed surfaces to H(0) = 0"
    return Table.of("relaxation", title, see, attempts, columns)


def _iteration(name: str, attempts: Sequence[Attempt]) -> str:
    """How many attempts of an iteration ended, and in how many sweeps."""
    sweeps = [attempt.sweeps for attempt in attempts if attempt.sweeps is not None]
    ended = f"{name}: {len(sweeps)} of {len(attempts)} converged"
    return f"{ended}, in {min(sweeps)} to {max(sweeps)} sweeps." if sweeps else f"{ended}."


def _pull_offs(found: Sequence[PullOff]) -> Table:
    columns: Columns[PullOff] = {
        "mu": lambda p: f"{p.tabor:.6g}",
        ("half-space, R dgamma", "half-space, error, R dgamma"): lambda p: _cells(p.half_space),
        ("finite elements, R dgamma", "finite elements, error, R dgamma"): lambda p: _cells(p.finite_element),
    }
    return Table.of("pull_off", "Load at pull-off, Fig. 7", _see_pull_offs(found), found, columns)


def _see_pull_offs(found: Sequence[PullOff]) -> str:
    """The ends beside their limits."""
    if not found:
        return EMPTY
    first, last = found[0], found[-1]
    text = (
        f"From {first.half_space.value:.4f} at mu = {first.tabor:.3g} to {last.half_space.value:.4f} at mu = "
        f"{last.tabor:.3g}; Bradley's is -2 pi = {BRADLEY_PULL_OFF:.4f}, JKR's -3 pi/2 = {JKR_PULL_OFF:.4f}."
    )
    return told(text, first.half_space.value, last.half_space.value) or joined()


def _rises(study: Greenwood1997) -> Table:
    """Least loads met on grids that are too coarse, wrong on purpose."""
    rows = [
        (f"{spacing:g}", f"{r.tabor:.6g}", f"{r.pull_off:.4f}")
        for spacing, rise in study.rises.items()
        for r in rise.ripples
    ]
    see = joined(*(f"{spacing:g} beta: ended as {rise.ended}." for spacing, rise in study.rises.items()))
    title = "Least load on uniform triangles that are too wide, Fig. 7: wrong on purpose, so without an error"
    return Table("coarse_grids", title, see, ("spacing, beta", "mu", "least load, R dgamma"), rows)


def _true_jumps(study: CriteriaStudy) -> Table:
    """True jumps beside what the criteria predict for them."""
    usable = {f"{'alpha*' if c.of_approach else 'H0'} by {c.name}, eps": c.predict for c in study.criteria if c.predict}
    columns: Columns[JumpOn] = {
        "mu": lambda jump: f"{jump.tabor:.6g}",
        ("alpha*, eps", "error of alpha*, eps"): lambda jump: _cells(jump.approach),
        ("H0, eps", "error of H0, eps"): lambda jump: _cells(jump.central_gap),
        "b sigma'/sigma": lambda jump: f"{jump.fundamental:.5f}",
        tuple(usable): lambda jump: [f"{predict(np.array(jump.tabor)):.5f}" for predict in usable.values()],
    }
    title = "True jumps on and the criteria's predictions"
    return Table.of("criteria", title, _see_true_jumps(study), study.jumps, columns)


def _see_true_jumps(study: CriteriaStudy) -> str:
    """What the fundamental criterion reads at the true jumps."""
    read = np.array([jump.fundamental for jump in study.jumps])
    if not read.size:
        return EMPTY
    verdict = "states that it calls unstable are stable" if read.max() < -1 else "it does not always come too soon"
    text = (
        f"The fundamental criterion (4.3) expects b sigma'/sigma = -1 at the jump, where the solution has "
        f"{read.max():.2f} to {read.min():.2f}: {verdict}."
    )
    return told(text, read) or joined()


def _constants(criteria: CriteriaStudy) -> Table:
    columns = ("criterion", "formula", "constant", "printed", "refitted", "standard error", "scatter of ln(left side)")
    rows = [
        (c.name, c.formula, name, "" if printed is None else f"{printed:.6g}", *_cells(fitted), f"{c.scatter:.1e}")
        for c in criteria.criteria
        for name, printed, fitted in c.constants
    ]
    span = f" for mu = {criteria.tabor[0]:g} to {criteria.tabor[-1]:g}" if criteria.jumps else ""
    title = f"Constants of the criteria, refitted{span}"
    return Table("criteria_constants", title, _see_constants(criteria), columns, rows)


def _see_constants(study: CriteriaStudy) -> str:
    """How far the closed criteria's printed constants are from the refitted ones."""
    printed = [
        (criterion.name, value / fitted.value)
        for criterion in study.criteria
        for name, value, fitted in criterion.constants
        if name == "k" and value is not None
    ]
    ratios = np.array([ratio for _, ratio in printed])
    if not ratios.size:
        return "Least squares of logarithms."
    low, high = min(printed, key=lambda item: item[1]), max(printed, key=lambda item: item[1])
    size = "too large" if low[1] > 1 else "too small" if high[1] < 1 else "too small and too large"
    text = f"The closed criteria's are {size}: {low[1]:.2f} times the refitted ({low[0]}) to {high[1]:.2f} ({high[0]})."
    return joined("Least squares of logarithms.", told(text, ratios, closed_ratios(study)))


def _cells(estimate: Estimate | None) -> tuple[str, str]:
    """Value and error; empty if there is none."""
    return ("", "") if estimate is None else (digits(estimate), f"{estimate.error:.1e}")
