"""The figures as ``data/figures.toml`` has them, and the functions by which it says what is drawn in each.

A function that yields `Parts` has the study, the figure without lines, whose axes it heeds, and what stands in its
entry: it yields lines, notes and sentences on what is to be seen. What the figures show of the paper's claims, the
claims tell.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fem_adhesion.common import style
from fem_adhesion.common.numbers import digits, listed, plus_minus, told
from fem_adhesion.common.page import data_text
from fem_adhesion.common.style import BLUE, CHAIN, DASHED, DOTTED, GREEN, PINK, RED
from fem_adhesion.greenwood.drawing import ELEMENTS, HALF_SPACE, Axis, Line, Look, Note, Plot
from fem_adhesion.greenwood.facts import Facts
from halfspace import scaling
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.devices import Jump
from halfspace.equilibrium.events import is_fold
from halfspace.theories import closed_forms, dmt
from halfspace.theories.maugis import MaugisDugdale, carpick_pull_off, carpick_radius
from halfspace.values import Array, States

Parts = Iterator[Line | Note | str]
FIGURES = tomllib.loads(data_text("greenwood", "figures.toml"))
"""Entry of each figure by the name of its files: those of the paper, and further ones."""
AXES, LOOKS, LETTERS = (FIGURES.pop(name) for name in ("axes", "looks", "letters"))
MARKS: Look = {"linestyle": "none", "marker": "o", "markersize": 5, "markerfacecolor": "white"}


def look_of(kind: str, which: str | float, **more: Any) -> Look:
    """Colour, dashes and width of a line."""
    colour, dashes, *width = LOOKS[kind][which if isinstance(which, str) else f"{which:g}"]
    values = getattr(style, colour, colour), getattr(style, dashes, dashes), *width
    return {**dict(zip(("color", "linestyle", "linewidth"), values, strict=False)), **more}


def plotted(stem: str, study: Facts) -> Plot:
    """Plot of a figure."""
    figure = FIGURES[stem]
    x, y = (Axis(**AXES[name], limits=tuple(limits)) for name, *limits in (figure["x"], figure["y"]))
    label, scale = figure.get("above", ("", ""))
    above = (label, float(getattr(scaling, scale).of(1.0))) if scale else None
    blank = Plot(x, y, title=figure.get("heading", ""), legend=figure.get("legend", "upper left"), above=above)
    parts: list[Line | Note | str] = []
    for entry in figure["lines"]:
        (name, first), *others = entry.items()
        parts += globals()[name](study, blank, first, **dict(others))
    lines, see = [part for part in parts if isinstance(part, Line)], [part for part in parts if isinstance(part, str)]
    return replace(blank, lines=lines, see=see, notes=[part for part in parts if isinstance(part, tuple)])


# Curves


def points(name: str, states: EquilibriumPath | States, tabor: float, plot: Plot, look: Look = MARKS) -> Line:
    """States of a curve, as markers unless they look otherwise."""
    (u, u_error), (v, v_error) = plot.x.values(states, tabor), plot.y.values(states, tabor)
    return Line(name, tabor, u, v, {"color": look_of("tabor", tabor)["color"], **look}, u_error, v_error)


def half_space(study: Facts, plot: Plot, tabors: Sequence[float]) -> Parts:
    """Computed curves; stretches that are unstable under fixed grips are dotted."""
    for mu in tabors:
        path = study.curves[mu]
        yield replace(points(HALF_SPACE, path, mu, plot, look_of("tabor", mu, linewidth=1.9)), dotted=~path.stable)


def elements(study: Facts, plot: Plot, tabors: Sequence[float]) -> Parts:
    """Finite-element points, where there are any."""
    yield from (points(ELEMENTS, study.elements[mu], mu, plot) for mu in tabors if mu in study.elements)


def specified(study: Facts, plot: Plot, tabors: Sequence[float]) -> Parts:
    """States found by prescribing the central gap."""
    yield from (points("central gap specified", _specified(study, mu), mu, plot) for mu in tabors)


def _specified(study: Facts, tabor: float) -> States:
    return study.paths[tabor].at(central_gap=study.settings.specified[tabor])


def turns(study: Facts, _: Plot, tabors: Sequence[float]) -> Parts:
    """How often the approach turns."""
    found = [f"{sum(map(is_fold, study.curves[mu].events))} at mu = {mu:g}" for mu in tabors]
    yield f"The approach turns so many times: {listed(found)}."


def folds(study: Facts, plot: Plot, tabor: float) -> Parts:
    """The unstable branch, and the folds between jump-on and jump-off where the curve winds."""
    look: Look = {"linestyle": DOTTED, "linewidth": 1.9}
    yield points("unstable branch", _specified(study, tabor), tabor, plot, look)
    found = [event for name, event in study.paths[tabor].events.items() if is_fold(name)]
    rows = [(f.approach, f.central_gap, f.approach_error, f.central_gap_error) for f in found]
    x, y, dx, dy = np.reshape(rows, (-1, 4)).T
    yield Line("folds", tabor, x, y, {**MARKS, "color": "black"}, dx, dy, label="folds")
    yield from ((str(n), (x[n - 1], y[n - 1])) for n in range(2, len(rows)))
    see = f"The approach has {len(rows)} folds, at alpha* = {listed([f'{value:.4f}' for value in x])}."
    yield told(see, x)


def profiles(study: Facts, plot: Plot, which: str) -> Parts:
    """Gap or pressure of states along the radius."""
    mu, quantity = study.settings.winding_at, plot.y.quantity
    for number, state in enumerate(getattr(study, which)):
        values, errors = getattr(state, quantity), getattr(state, f"{quantity}_error")
        gap = round(state.central_gap, 9) + 0.0  # not -0
        look, label = look_of(which, number), f"$H(0) = {gap:.4g}$"
        yield Line(f"H(0) = {gap:g}", mu, state.radii, values, look, None, errors, label=label)


# Jumps


def jump_line(name: str, tabor: float, jump: Jump, look: Look, label: str = "") -> Line:
    """A jump as a line, which becomes an arrow."""
    approach, load, dx, dy = np.transpose([(s.approach, s.load, s.approach_error, s.load_error) for s in jump.ends])
    return Line(name, tabor, approach, load, look, dx, dy, label=label, arrow=True)


def jumps(study: Facts, _: Plot, margins: Sequence[float]) -> Parts:
    """The jumps at fixed grips and in an apparatus, along its load lines."""
    mu, k = study.settings.jumps_at, study.settings.apparatus
    for letters, jump in study.jumps.items():
        primed = letters[0].endswith("'")
        look: Look = {"color": PINK if primed else "black", "linewidth": 1.4}
        yield (line := jump_line(f"jump {' to '.join(letters)}", mu, jump, look))
        for letter, at in zip(letters, jump.ends, strict=True):
            yield letter, (at.approach, at.load), tuple(LETTERS[letter])
        if primed:
            approach = np.array([line.x.min() - margins[0], line.x.max() + margins[0]])
            label = rf"load lines, $k = {k:g}\,R\Delta\gamma/\epsilon$" if letters[0] == "A'" else ""
            dotted: Look = {"color": PINK, "linestyle": DOTTED, "linewidth": 1.2}
            load = line.y[0] - k * (approach - line.x[0])
            yield Line(f"load line of {letters[0]}", mu, approach, load, dotted, label=label)


def apparatus(study: Facts, _: Plot, stiffnesses: Sequence[float]) -> Parts:
    """Jumps in apparatus of several stiffnesses."""
    mu = study.settings.devices_at
    for cycle in (cycle for cycle in study.cycles if cycle.stiffness in stiffnesses):
        k = cycle.stiffness
        name, label = f"apparatus {k:g} R dgamma/eps", rf"$k = {k:g}\,R\Delta\gamma/\epsilon$"
        if math.isinf(k):
            name = label = "fixed grips"
        yield jump_line(f"{name}, jump on", mu, cycle.jump_on, look_of("stiffness", k), label)
        yield jump_line(f"{name}, jump off", mu, cycle.jump_off, look_of("stiffness", k))


def border(study: Facts, _: Plot, places: Sequence[Sequence[float]]) -> Parts:
    """Stiffness below which a contact jumps, against the Tabor parameter; words at three places."""
    critical = study.critical_tabor
    tabor, least = study.border.T
    yield Line("border", None, tabor, least, {"color": BLUE, "linewidth": 2}, label="least without a jump")
    words = "follows smoothly", "jumps", rf"fixed grips jump from $\mu = {digits(critical)}$"
    yield from ((text, (x, y)) for text, (x, y) in zip(words, places, strict=True))
    yield told(f"Fixed grips jump from mu = {plus_minus(critical)} on.", critical.value, critical.error)


# Theories


def _by_radius(a: Array, approach: Array, load: Array) -> Mapping[str, Array]:
    return {"approach": approach, "load": load, "contact_radius": a}


def _forced(approach: Array, mu: float) -> Array:
    """Load of the DMT force method: Bradley's apart."""
    apart = closed_forms.bradley_load(np.minimum(approach, 0.0))
    return np.where(approach <= 0, apart, dmt.force_load(np.maximum(approach, 0.0), mu))


THEORIES: Mapping[str, Callable[[Array, float], Mapping[str, Array]]] = {
    "Bradley": lambda x, _: {"approach": x, "load": closed_forms.bradley_load(x)},
    "JKR": lambda a, mu: _by_radius(a, closed_forms.jkr_approach(a, mu), closed_forms.jkr_load(a)),
    "Hertz": lambda a, mu: _by_radius(a, closed_forms.hertz_approach(a, mu), closed_forms.hertz_load(a)),
    "DMT-M": lambda x, mu: {"approach": x, "load": dmt.maugis_load(x, mu)},
    "DMT force method": lambda x, mu: {"approach": x, "load": _forced(x, mu)},
    "DMT thermodynamic": lambda x, mu: {"approach": x, "load": dmt.thermodynamic_load(x, mu)},
    "Maugis-Dugdale": lambda a, mu: _by_radius(
        a, MaugisDugdale.matched(mu).approach(a), MaugisDugdale.matched(mu).load(a)
    ),
}
"""Numbers of the curve of a theory, by approaches or radii and the Tabor parameter."""


def theory(
    _: Facts,
    plot: Plot,
    name: str,
    over: tuple[float, float, int],
    mu: float = 1.0,
    tabor: float | None = None,
    look: Look | None = None,
    label: str | None = None,
    *,
    coloured: bool = False,
) -> Parts:
    """Curve of a closed theory; of one Tabor parameter `tabor` if the legend says so, and in its colour if asked."""
    mu = tabor or mu
    found = THEORIES[name](np.linspace(*over), mu)
    x, y = (found[axis.quantity] / axis.size(mu) for axis in (plot.x, plot.y))
    colour = {"color": look_of("tabor", mu)["color"]} if coloured else {}
    yield Line(name, tabor, x, y, look_of("theory", name, **colour, **(look or {})), label=label)


def carpick(study: Facts, _: Plot, tabors: Sequence[float]) -> Parts:
    """Contact radii after Carpick et al., and how far they are off under no load."""
    off = []
    for mu in tabors:
        maugis = scaling.MAUGIS.of(mu)
        load = np.linspace(float(carpick_pull_off(maugis)), 5, 400)
        yield Line("Carpick et al.", mu, load, carpick_radius(load, maugis), look_of("tabor", mu, linestyle=DOTTED))
        radius = study.curves[mu].events["zero_load"].contact_radius
        off.append(f"{100 * (float(carpick_radius(0.0, maugis)) / radius - 1):+.1f} % at mu = {mu:g}")
    yield f"At zero load the radius of Carpick et al. is off the solution's by {listed(off)}."


# Numbers against the Tabor parameter


def forces(
    study: Facts, _: Plot, which: str, look: Look = MARKS, label: str | None = None, above: float = 0.0
) -> Parts:
    """Pull-off forces by a solver with their errors, above a Tabor parameter."""
    rows = [(mu, -load.value, load.error) for mu, load in getattr(study, which).items() if mu > above]
    tabor, force, error = np.reshape(rows, (-1, 3)).T
    name = HALF_SPACE if which == "pull_offs" else ELEMENTS
    yield Line(name, None, tabor, force, {"color": BLUE, **look}, None, error, label=label)


def pull_off_theories(study: Facts, _: Plot, attard: Sequence[tuple[float, float]]) -> Parts:
    """Pull-off forces after Maugis, by the values of Attard & Parker over pi that [G97] quotes, and in the limits."""
    tabor = np.array([*study.pull_offs])
    maugis = np.array([-MaugisDugdale.matched(mu).pull_off().load for mu in tabor])
    yield Line("Maugis-Dugdale", None, tabor, maugis, {"color": GREEN, "linestyle": CHAIN})
    mu, force = np.transpose(attard)
    look: Look = {"color": RED, "linestyle": DASHED, "marker": "s"}
    yield Line("Attard & Parker, the two values quoted", None, mu, np.pi * force, look)
    for name, load in (("Bradley", closed_forms.BRADLEY_PULL_OFF), ("JKR", closed_forms.JKR_PULL_OFF)):
        yield Line(name, None, tabor, np.full_like(tabor, -load), look_of("theory", name, linewidth=1.0))


def criteria(study: Facts, _: Plot, quantity: str) -> Parts:
    """Central gap or approach at jump-on plus one over mu^(3/7): true jumps as markers, and what criteria predict."""
    sign = 1 if quantity == "central_gap" else -1
    numbers = [(mu, jump.estimate(quantity)) for mu, jump in study.jumps_on.items()]
    mu, true, errors = np.reshape([(mu, number.value, number.error) for mu, number in numbers], (-1, 3)).T
    unit = mu ** (3 / 7)
    yield Line("true jumps", None, mu, (1 + sign * true) / unit, {**MARKS, "color": "black"}, None, errors / unit)
    tabor = np.geomspace(0.72, max(mu, default=1.0), 200)
    for one in study.criteria:
        if one.predict and one.of_approach == (quantity == "approach"):
            scaled = (1 + sign * one.predict(tabor)) / tabor ** (3 / 7)
            yield Line(one.name, None, tabor, scaled, look_of("criterion", one.name))


def coarse(study: Facts, _: Plot, which: str) -> Parts:
    """What uniform triangles too wide give, wrong on purpose, so without an error: pull-off forces, or curves."""

    def line(spacing: float, tabor: float | None, x: Array, y: Array) -> Line:
        look, label = look_of("spacing", spacing), rf"uniform triangles, ${spacing:g}\,\beta$"
        return Line(f"uniform triangles {spacing:g} beta", tabor, x, y, look, label=label)

    if which == "rises":
        for spacing, ripples in study.rises.items():
            yield line(spacing, None, *np.reshape([(r.tabor, -r.pull_off) for r in ripples], (-1, 2)).T)
        return
    yield from (line(r.spacing, r.tabor, r.approach, r.load) for r in study.ripples)
    least = listed([f"{-r.pull_off:.3f} at {r.spacing:g} beta" for r in study.ripples])
    resolved = -study.curves[study.settings.ripple_at].events["pull_off"].load
    yield f"The largest tension is {least}, where it is {resolved:.3f} R dgamma."
