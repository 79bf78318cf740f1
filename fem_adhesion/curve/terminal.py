"""A curve for the terminal: its events with units and errors, and a small plot in characters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from plotille import Canvas
from rich.console import Console
from rich.text import Text

from fem_adhesion.common import lines
from fem_adhesion.common.contact import edge_told
from fem_adhesion.common.numbers import engineering, sizes_told, with_error
from fem_adhesion.common.terminal import Column, Fitted, Prose, flow
from fem_adhesion.curve.settings import USUAL
from fem_adhesion.curve.solve import WEAK_FORM, Curves, Scale
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.devices import reaching
from halfspace.equilibrium.events import Event, tolerance_told
from halfspace.laws import LENNARD_JONES
from halfspace.values import Array, Estimate

MISSED = "*"  # after a number whose error is above the tolerance
EVENTS: Mapping[str, str] = {
    "pull_off": "pull-off",
    "jump_on": "jump on",
    "jump_off": "jump off",
    "zero_load": "zero load",
}
LETTERS: Mapping[str, str] = {"pull_off": "P", "jump_on": "A", "jump_off": "C", "zero_load": "Z"}
COLOURS = {lines.STABLE: "bright_blue", lines.GRIPS_ONLY: "cyan", lines.UNSTABLE: "yellow"}


def show(curves: Curves, console: Console) -> None:
    """Print everything; the plot only in a terminal."""
    console.print(table(curves))
    for line in notes(curves):
        console.print(Prose(line))
    if console.is_terminal and curves.solver != WEAK_FORM:
        console.print(plot(curves, min(USUAL.columns, console.width - USUAL.margin)))
        console.print(flow(_key(curves), ", "))


def table(curves: Curves) -> Fitted:
    """A line for each event of each solver, and for where each jump lands."""
    units, rows = curves.scales, list(_rows(curves))
    states = [Column("state", [words for words, *_ in rows], words=True)]
    if len(curves.paths) > 1:
        states.append(Column("solver", [name for _, name, *_ in rows], words=True))
    numbers = zip(*(_cells(event, units, missed) for _, _, event, missed in rows), strict=True)
    columns = [
        Column(f"{name.replace('_', ' ')}\n{units[name].unit}", texts)
        for name, texts in zip(OBSERVABLES, numbers, strict=True)
    ]
    scene, si = curves.question.scene, curves.question.units
    title = [*scene.words, *(sizes_told(si) if si else ())]
    if si and scene.law == LENNARD_JONES:
        title.append(f"Hamaker constant {engineering(si.hamaker, 'J')}")
    return Fitted([*states, *columns], title)


def _rows(curves: Curves) -> Iterator[tuple[str, str, Event, Sequence[str]]]:
    """What each row is, by which solver, its numbers, and which of them miss the tolerance.

    Rows are events, and where jumps land; where they take off too, unless that is an event of the curve.
    """
    for solver, path in curves.paths.items():
        for name, event in path.events.items():
            yield EVENTS.get(name, name.replace("_", " ")), solver, event, path.tolerance.missed_by(event)
    for device, cycle in (("fixed grips", curves.grips), ("apparatus", curves.apparatus)):
        if cycle is None:
            continue
        for name, jump in cycle.jumps.items():
            words = name.replace("_", " ")
            if device == "apparatus":
                yield f"{words}, {device}", curves.solver, jump.take_off, cycle.missed_by(name, "take_off")
            yield f"{words} lands, {device}", curves.solver, jump.landing, cycle.missed_by(name, "landing")


def _cells(event: Event, units: Mapping[str, Scale], missed: Sequence[str]) -> Iterator[str]:
    """Numbers of an event, each with the error of its last digit in brackets, and a mark if it is missed."""
    for name in OBSERVABLES:
        found = event.estimate(name)
        if np.isnan(found.value):
            yield "-" if np.isnan(found.error) else "?"
        elif abs(found.value) <= found.error < np.inf:
            yield "0"
        else:
            yield with_error(found, units[name].size, USUAL.most_digits) + (MISSED if name in missed else "")


def notes(curves: Curves) -> Iterator[str]:
    """Energies lost, how the curve is told to be smooth, cost, and how to read the table."""
    if curves.solver != WEAK_FORM:
        yield from _jumps(curves)
    for solver, path in curves.paths.items():
        if missing := curves.left_out(solver):
            yield f"{solver}: another body under the same profile, which leaves out: {', '.join(missing)}"
        if margin := getattr(path, "margin", None):
            yield f"{solver}: {_how_far(margin)}"
        for fold in getattr(path, "unconfirmed", ()):
            where = f"approach {fold.approach:.3g} eps, load {fold.load:.3g} R dgamma"
            yield f"{solver}: a fold near {where} cannot be told, no finer grid has it; a smaller rtol may"
        told = tolerance_told(path.rtol, curves.missed(solver))
        yield f"{solver}: {path.unknowns} unknowns, {len(path.load)} points, {path.seconds:.2f} s; {told}"
    rows = list(_rows(curves))
    if any(missed for *_, missed in rows):
        size = "of eps and the range of all approaches"
        yield f"{MISSED}: the error is above rtol = {curves.question.rtol:g} of the load, of an approach {size}."
    radii = [event.estimate("contact_radius") for *_, event, _ in rows]
    is_open = any(np.isnan(radius.value) and np.isinf(radius.error) for radius in radii)
    yield (
        "In brackets: error of the last digit. Compression and approach are positive. Contact radius: "
        f"{edge_told(curves.question.scene.law)}; -: no contact{'; ?: open whether there is any' * is_open}."
    )


def _jumps(curves: Curves) -> Iterator[str]:
    """Energy lost by each device, and how far models lie apart between which the assumptions leave a choice."""
    units, energy, k = curves.scales, curves.scales["energy"], curves.question.stiffness
    si = curves.question.units
    devices = {"fixed grips": curves.grips}
    if np.isfinite(k):
        apparatus = f"k = {engineering(k * si.stiffness, 'N/m')}" if si else f"k = {k:g} R dgamma/eps"
        devices[apparatus] = curves.apparatus
    for device, cycle in devices.items():
        if cycle:
            lost = with_error(cycle.energy_lost, energy.size, USUAL.most_digits)
            yield f"energy lost in a cycle, {device}: {lost} {energy.unit}"
        elif device == "fixed grips" and curves.path.jumps is None:
            yield "jumps, fixed grips: cannot be told from a contact that follows smoothly"
        else:
            yield f"no jumps, {device}: the contact follows smoothly"
    for name, spread in curves.path.spread.items():
        numbers = (
            f"{number.replace('_', ' ')} {value * units[number].size:.2g} {units[number].unit}"
            for number, value in spread.items()
            if np.isfinite(value) and not (name == "zero_load" and number == "load")
        )
        words = ", ".join(numbers) or "unknown, as one of them has none"
        yield f"model uncertainty of {EVENTS[name]}, by what the traction at finite strain is counted per: {words}"


def _how_far(margin: Estimate) -> str:
    """How far a curve is from folding, where that is near."""
    known = f"{margin.value:.2g} +- {margin.error:.1g} eps/(R dgamma)"
    if abs(margin.value) <= margin.error:
        return f"whether it folds cannot be told, its margin being {known}; a smaller rtol may"
    if margin.value < 0:
        return f"its folds are about to merge, by a margin of {known}"
    return f"close to folding: it jumps with an apparatus of a compliance above {known}"


def plot(curves: Curves, width: int = USUAL.columns) -> Text:
    """Load against approach around the events, unstable stretches thinned, events and landings as letters.

    The first path is drawn, in a width in characters without the figures beside it.
    """
    units, path = curves.scales, curves.path
    frame = lines.around_events(path)
    canvas = Canvas(width, USUAL.lines, frame.approach[0], frame.load[0], frame.approach[1], frame.load[1])
    line = lines.smooth(reaching(path, curves.question.stiffness))
    for kind, load in line.parts(line.load):
        _draw(canvas, line.approach, load, COLOURS[kind], 3 if kind == lines.UNSTABLE else 1)
    for name, event in path.events.items():
        canvas.point(event.approach, event.load, marker=LETTERS.get(name, name[-1]))
    for name, jump in curves.grips.jumps.items() if curves.grips else ():
        letter = "B" if name.startswith("jump_on") else "D"
        canvas.point(jump.landing.approach, jump.landing.load, marker=letter)
    return _framed(canvas, units["approach"], units["load"])


def _draw(canvas: Canvas, x: Array, y: Array, colour: str, every: int) -> None:
    """Draw every so manieth dot of a line through points, which nan interrupts."""
    across, up = canvas.dots_between(canvas.xmin, canvas.ymin, canvas.xmax, canvas.ymax)
    steps = np.hypot(np.diff(x) * across / (canvas.xmax - canvas.xmin), np.diff(y) * up / (canvas.ymax - canvas.ymin))
    along = np.append(0, np.cumsum(np.nan_to_num(steps)))
    at = np.arange(0, along[-1], every)
    for point in zip(np.interp(at, along, x).tolist(), np.interp(at, along, y).tolist(), strict=True):
        if np.isfinite(point).all():
            canvas.point(*point, color=colour)


def _framed(canvas: Canvas, x: Scale, y: Scale) -> Text:
    """What is drawn, with the values at its edges."""
    low, high, left, right = (
        f"{value * scale.size:.3g}"
        for value, scale in ((canvas.ymin, y), (canvas.ymax, y), (canvas.xmin, x), (canvas.xmax, x))
    )
    drawn = canvas.plot("\n").split("\n")
    text = Text(f"load, {y.unit}\n")
    for edge, row in zip([high, *[""] * (len(drawn) - 2), low], drawn, strict=True):
        text.append(f"{edge:>{USUAL.margin - 2}} │").append_text(Text.from_ansi(row)).append("\n")
    text.append(" " * (USUAL.margin - 1) + "└" + "─" * canvas.width + "\n")
    return text.append(f"{left:>{USUAL.margin}}{f'approach, {x.unit}':^{canvas.width - 10}}{right:>10}")


def _key(curves: Curves) -> list[str]:
    """What the letters and dots of the plot mean."""
    words = [f"{LETTERS[name]} {words}" for name, words in EVENTS.items() if curves.path.event(name)]
    between = [name for name in curves.path.events if name not in EVENTS]
    words += [f"2 to {len(between) + 1} folds between them"] if between else []
    more = curves.grips and len(curves.grips.jumps) > 2
    landings = [f"B, D where the jumps {'on and off' if more else 'from A and C'} land"] if curves.grips else []
    thinned = ["dots thinned: unstable"] if not curves.path.stable.all() else []
    return [*words, *landings, *thinned]
