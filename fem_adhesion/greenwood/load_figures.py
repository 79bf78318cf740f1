"""Load against approach: [G97] Figs 1a to 3c, 6a and 6b, each with what is to be seen in it, measured on its data."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fem_adhesion.common import style
from fem_adhesion.common.numbers import listed, plus_minus, told
from fem_adhesion.greenwood.drawing import (
    APPROACH,
    LOAD,
    LOAD_OF_RIGID,
    OF_TABOR,
    SCALED_APPROACH,
    Arrow,
    Line,
    Note,
    Plot,
    by_elements,
    crossings,
    elements_beside,
    half_space,
    marked,
    rises,
    theory,
)
from fem_adhesion.greenwood.study import APPARATUS, JUMPS_AT, Greenwood1997
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.equilibrium.events import FOLDS
from halfspace.theories import dmt
from halfspace.theories.closed_forms import (
    BRADLEY_PULL_OFF,
    bradley_load,
    hertz_load,
    hertz_radius_at,
    jkr_approach,
    jkr_load,
    jkr_load_at,
    jkr_zero_load,
)
from halfspace.values import Array

LOW = (0.05, 0.1, 0.2, 0.5)  # Tabor parameters of Figs 1a and 6b
NEARLY_RIGID, COMPRESSED = 0.05, 0.02  # of Figs 1b and 1c
STEEPENING = (0.5, 0.7, JUMPS_AT)  # of Fig. 2a
SOFT = (1.0, 2.0, 3.0, 5.0)  # of Fig. 2b
TWISTED = 3.0  # of Fig. 3c
DMT_AT = (0.1, 0.2, 0.5, 1.0)  # of Fig. 6a
AT_SCALED = 1.0  # alpha*/mu at which Figs 6a and 6b are compared
TWO_PI = 2 * np.pi
OFFSETS = {  # in points, of the letters in Fig. 2a
    "A": (7.0, -5.0), "B": (-15.0, -6.0), "C": (-15.0, -4.0), "D": (-15.0, 2.0),
    "A'": (9.0, -2.0), "B'": (6.0, -14.0), "C'": (7.0, -2.0), "D'": (-4.0, 8.0),
}  # fmt: skip


def _bradley(low: float, high: float) -> Line:
    approach = np.linspace(low, high, 300)
    return theory("Bradley", approach, bradley_load(approach))


def _jkr(tabor: float, load_unit: float = 1.0) -> Line:
    """JKR's whole curve, from no contact on."""
    radius = np.linspace(0, 4.2, 800)
    return theory("JKR", jkr_approach(radius, tabor), jkr_load(radius) / load_unit)


def _from_bradley(path: EquilibriumPath, where: NDArray[np.bool_]) -> float:
    """Largest distance in load from Bradley's curve at some points, in R dgamma."""
    return float(np.max(np.abs(path.load - bradley_load(path.approach))[where], initial=0.0))


def fig_1a(study: Greenwood1997) -> Plot:
    """Low Tabor parameters beside Bradley's equation."""
    paths = [study.curves[mu] for mu in LOW]
    off = np.array([_from_bradley(path, path.approach < 0) for path in paths])
    trend = "falls" if rises(off) else "does not fall all along"
    listing = listed([f"{value:.2g} at mu = {path.tabor:g}" for value, path in zip(off, paths, strict=True)])
    see = f"At alpha* < 0 the load is off Bradley's by at most, in R dgamma, {listing}: the distance {trend} with mu."
    lines = [half_space(path, APPROACH, LOAD) for path in paths]
    axes = APPROACH.within(-2.2, 0.8), LOAD.within(-6.8, 1.5)
    return Plot(*axes, [*lines, _bradley(-2.5, 0.24)], [told(see, off)], legend="below")


def fig_1b(study: Greenwood1997) -> Plot:
    """The numerical results at mu = 0.05 beside Bradley's equation."""
    path = study.curves[NEARLY_RIGID]
    event, apart = path.events["pull_off"], _from_bradley(path, path.approach < 0)
    pressed = _from_bradley(path, (path.approach > 0) & (path.load < 0))
    below = "below" if event.load > BRADLEY_PULL_OFF else "not below"
    side = "at a separation" if event.approach < 0 else "not at a separation"
    peak = (
        f"The largest tension is {100 * (event.load / BRADLEY_PULL_OFF - 1):+.2g} % off Bradley's, so {below} it, and "
        f"occurs at alpha* = {event.approach:.4f}, {side}."
    )
    see = [
        told(f"Apart, at alpha* < 0, the load is within {apart:.2g} R dgamma of Bradley's.", apart),
        told(f"Pressed together, but still under tension, it is within {pressed:.2g} R dgamma.", pressed),
        told(peak, event.load, event.approach),
    ]
    lines = [half_space(path, APPROACH, LOAD), _bradley(-4, 0.3)]
    return Plot(APPROACH.within(-3, 0.4), LOAD.within(-6.8, 2.5), lines, see)


def fig_1c(study: Greenwood1997) -> Plot:
    """Compression at mu = 0.02 beside Bradley, JKR and DMT-M."""
    path = study.curves[COMPRESSED]
    approach = np.linspace(0, 0.26, 200)
    lines = [
        half_space(path, APPROACH, LOAD),
        _bradley(-0.4, 0.36),
        _jkr(path.tabor),
        theory("DMT-M", approach, dmt.maugis_load(approach, path.tabor)),
    ]
    end, load = float(path.approach[-1]), float(path.load[-1])
    hertz = float(hertz_load(hertz_radius_at(end, path.tabor)))
    missing = {"JKR": hertz - float(jkr_load_at(end, path.tabor)), "DMT-M": TWO_PI, "the solution": hertz - load}
    listing = listed([f"{value:.2f} of {name}" for name, value in missing.items()])
    least = min(abs(load - (hertz - missing[name])) for name in ("JKR", "DMT-M"))
    text = (
        f"At alpha* = {end:.3f} the load is {load:.1f} R dgamma, {hertz - load:.1f} less than Hertz's. Of the theories "
        f"it differs by {least:.1f} at least, and by {abs(load - float(bradley_load(end))):.3g} from Bradley's. The "
        f"loads that Hertz's exceeds them by are {listing}."
    )
    axes = APPROACH.within(-0.3, 0.5), LOAD.within(-8, 50)
    return Plot(*axes, lines, [told(text, end, load)])


def fig_2a(study: Greenwood1997) -> Plot:
    """The vertical tangent at mu near 1, and the jumps at fixed grips and in an apparatus."""
    arrows, notes, lines = [], [], [half_space(study.curves[mu], APPROACH, LOAD) for mu in STEEPENING]
    for letters, jump in study.jumps.items():
        ends = [(state.approach, state.load) for state in jump.ends]
        colour = style.PINK if "'" in letters[0] else "black"
        arrows.append(Arrow(ends[0], ends[1], {"color": colour, "linewidth": 1.4}))
        notes += [Note(letter, end, OFFSETS[letter]) for letter, end in zip(letters, ends, strict=True)]
        name = f"jump {' to '.join(letters)}"
        approach, load = np.transpose(ends)
        dx, dy = np.transpose([(state.approach_error, state.load_error) for state in jump.ends])
        lines.append(Line(name, JUMPS_AT, approach, load, {"linestyle": "none"}, dx, dy, label=""))
        if "'" in letters[0]:
            lines.append(_load_line(letters, ends))
    see = [_jump_words(study), _vertical(study)]
    axes = APPROACH.within(-3.6, 0.8), LOAD.within(-6.2, 0.4)
    return Plot(*axes, lines, see, arrows, notes, legend="lower left")


def _load_line(letters: tuple[str, str], ends: list[tuple[float, float]]) -> Line:
    """Load line through both ends of a jump, of the slope of the apparatus, a little beyond them."""
    (a, W), (b, _) = ends
    approach = np.array([min(a, b) - 0.35, max(a, b) + 0.35])
    look = {"color": style.PINK, "linestyle": style.DOTTED, "linewidth": 1.2}
    label = rf"load lines, $k = {APPARATUS:g}\,R\Delta\gamma/\epsilon$" if letters[0] == "A'" else ""
    return Line(f"load line of {letters[0]}", JUMPS_AT, approach, W - APPARATUS * (approach - a), look, label=label)


def _jump_words(study: Greenwood1997) -> str:
    """Where each jump begins, and what it changes."""
    words = [
        f"from {' to '.join(letters)} at alpha* = {jump.take_off.approach:.4f}, the load from "
        f"{jump.take_off.load:.3f} to {jump.landing.load:.3f} R dgamma"
        for letters, jump in study.jumps.items()
        if np.isfinite([jump.take_off.approach, jump.take_off.load, jump.landing.load]).all()
    ]
    if not words:
        return "No jump was found."
    return f"At mu = {JUMPS_AT:g} the contact jumps {'; '.join(words)}. Primed letters are those of the apparatus."


def _vertical(study: Greenwood1997) -> str:
    critical = study.critical_tabor
    return told(f"A vertical tangent appears at mu = {plus_minus(critical)}.", critical.value, critical.error)


def fig_2b(study: Greenwood1997) -> Plot:
    """Higher Tabor parameters beside the one curve of JKR."""
    lines = [half_space(study.curves[mu], SCALED_APPROACH, LOAD_OF_RIGID) for mu in SOFT]
    fe = by_elements(study.elements, SOFT, SCALED_APPROACH, LOAD_OF_RIGID)
    ends = np.array([_scaled(study, mu, "zero_load") for mu in SOFT])
    pulls = np.array([_scaled(study, mu, "pull_off") for mu in SOFT])
    forces = np.array([study.curves[mu].events["pull_off"].load for mu in SOFT]) / TWO_PI
    jkr = jkr_zero_load(1.0).approach
    closing = "closes in" if rises(-np.abs(ends - jkr)) else "does not close in"
    falls = "falls" if rises(forces) else "does not fall all along"
    span = f"from mu = {SOFT[0]:g} to {SOFT[-1]:g}"
    zero = f"At zero load alpha*/mu goes from {ends[0]:.4f} to {ends[-1]:.4f} {span}: it {closing} on JKR's {jkr:.4f}."
    pull = (
        f"The largest tension {falls} {span}, from {-forces[0]:.4f} to {-forces[-1]:.4f} of 2 pi R dgamma, JKR's being "
        f"0.75; it occurs at alpha*/mu = {pulls[0]:.3f} to {pulls[-1]:.3f}."
    )
    see = [told(zero, ends), told(pull, forces, pulls), elements_beside([*lines, *fe])]
    axes = SCALED_APPROACH.within(-3.2, 3.2), LOAD_OF_RIGID.within(-0.95, 0.5)
    return Plot(*axes, [*lines, *fe, _jkr(1.0, TWO_PI)], see)


def _scaled(study: Greenwood1997, tabor: float, name: str) -> float:
    event = study.curves[tabor].event(name)
    return event.approach / tabor if event else float("nan")


def _fig_3(study: Greenwood1997, tabor: float, approach: tuple[float, float]) -> Plot:
    """The S-shaped curve, and states found by prescribing the central gap."""
    path = study.curves[tabor]
    line = half_space(path, APPROACH, LOAD)
    lines = [line, marked(study.specified[tabor], tabor, "central gap specified", APPROACH, LOAD)]
    folds = [path.events[name] for name in FOLDS if name in path.events]
    places = np.array([fold.approach for fold in folds])
    turned = f"It turns at alpha* = {listed([f'{place:.4f}' for place in places])}: " if folds else ""
    shape = "the curve is S-shaped" if len(folds) == 2 else "the curve is not S-shaped"
    see = [told(f"{turned}{shape}.", places) if folds else "The approach does not turn."]
    if tabor == TWISTED:
        jkr = _jkr(tabor)
        lines.append(jkr)
        see.append(_crossing_words(line, jkr))
    return Plot(
        APPROACH.within(*approach),
        LOAD.within(-5.6, 1.0),
        lines,
        see,
        title=rf"$\mu = {tabor:g}$",
        legend="lower right",
    )


def _crossing_words(line: Line, jkr: Line) -> str:
    """Where a curve crosses JKR's while both are under tension, and which of them reaches farther."""
    found = crossings(line, jkr)
    found = found[found[:, 1] < 0]
    places = listed([f"({approach:.2f}, {load:.2f})" for approach, load in found])
    farther = "beyond" if np.min(line.x[line.y < -1], initial=np.inf) < np.min(jkr.x) else "not beyond"
    where = f"at (alpha*, W) = {places}" if len(found) else "nowhere"
    text = (
        f"Under tension it crosses JKR's curve {where}; it reaches {farther} JKR's least approach, {np.min(jkr.x):.3f}."
    )
    return told(text, line.x, line.y)


def fig_3a(study: Greenwood1997) -> Plot:
    """The curve with the central gap specified, mu = 1."""
    return _fig_3(study, 1.0, (-3.5, 2.5))


def fig_3b(study: Greenwood1997) -> Plot:
    """The same, mu = 2."""
    return _fig_3(study, 2.0, (-5.5, 5.0))


def fig_3c(study: Greenwood1997) -> Plot:
    """The same, mu = 3, beside JKR."""
    return _fig_3(study, TWISTED, (-7.0, 7.0))


def _dmt_m() -> Line:
    scaled = np.linspace(0, 4, 200)
    return theory("DMT-M", scaled, dmt.maugis_load(scaled, 1.0) / TWO_PI)


def fig_6a(study: Greenwood1997) -> Plot:
    """The recalculated DMT theory: Bradley's load apart, Hertz's and that of the surface forces in contact."""
    scaled = np.concatenate([np.linspace(-4, 0, 120), np.geomspace(1e-6, 4, 200)])
    lines = []
    for mu in DMT_AT:
        apart, contact = bradley_load(mu * scaled[scaled <= 0]), dmt.force_load(mu * scaled[scaled > 0], mu)
        look = {"color": OF_TABOR[mu], "linewidth": 1.9}
        loads = np.concatenate([apart, contact]) / TWO_PI
        lines.append(Line("DMT force method", mu, scaled, loads, look, label=rf"$\mu = {mu:g}$"))
    lines.append(_dmt_m())
    axes = SCALED_APPROACH.within(-3, 3), LOAD_OF_RIGID.within(-1.45, 0.4)
    return Plot(*axes, lines, [_spread_words(study)])


def _spread_words(study: Greenwood1997) -> str:
    """How theory and solution spread over the Tabor parameter where both are in contact."""
    theory_loads = np.array([float(dmt.force_load(mu * AT_SCALED, mu)) for mu in DMT_AT])
    loads = np.array([_load_in_contact(study.curves[mu], mu * AT_SCALED) for mu in DMT_AT])
    spreads = float(np.ptp(theory_loads)), float(np.ptp(loads))
    less = "less" if spreads[0] < spreads[1] else "no less"
    orders = [1 if rises(values) else -1 if rises(-values) else 0 for values in (theory_loads, loads)]
    order = "in the opposite order" if orders[0] * orders[1] < 0 else "not in the opposite order"
    text = (
        f"At alpha*/mu = {AT_SCALED:g} the theory's loads go from {theory_loads[0]:.3f} at mu = {DMT_AT[0]:g} to "
        f"{theory_loads[-1]:.3f} R dgamma at {DMT_AT[-1]:g}, the solution's from {loads[0]:.3f} to {loads[-1]:.3f}: "
        f"the theory spreads {less}, {order}."
    )
    return told(text, theory_loads, loads)


def _load_in_contact(path: EquilibriumPath, approach: float) -> float:
    """Load at an approach on the compressed end of a curve, where both rise."""
    start = int(np.nanargmin(path.load)) if np.any(np.isfinite(path.load)) else 0
    return float(np.interp(approach, path.approach[start:], path.load[start:], left=np.nan, right=np.nan))


def fig_6b(study: Greenwood1997) -> Plot:
    """Low Tabor parameters against the scaled approach, beside the limiting case of the DMT theory."""
    lines = [*(half_space(study.curves[mu], SCALED_APPROACH, LOAD_OF_RIGID) for mu in (*LOW, 1.0)), _dmt_m()]
    off = np.array([_load_in_contact(study.curves[mu], mu * AT_SCALED) for mu in LOW]) - float(
        dmt.maugis_load(AT_SCALED, 1.0)
    )
    closing = "comes closer to" if rises(np.abs(off)) else "does not come closer to"
    text = (
        f"At alpha*/mu = {AT_SCALED:g} the load is off DMT-M's by {off[0]:+.2f} R dgamma at mu = {LOW[0]:g} and "
        f"{off[-1]:+.2f} at {LOW[-1]:g}: with falling mu it {closing} the theory."
    )
    axes = SCALED_APPROACH.within(-4, 4), LOAD_OF_RIGID.within(-1.15, 0.6)
    return Plot(*axes, lines, [told(text, off)])


def at_zero_load(study: Greenwood1997, tabors: tuple[float, ...], quantity: str) -> Array:
    """A quantity at zero load at some Tabor parameters, nan where there is none."""
    events = [study.curves[mu].event("zero_load") for mu in tabors]
    return np.array([getattr(event, quantity) if event else np.nan for event in events])


FIGURES = {
    "1a": ("Load against approach at low Tabor parameters, with Bradley's equation", fig_1a),
    "1b": (f"The numerical results at mu = {NEARLY_RIGID:g} compared with Bradley's equation", fig_1b),
    "1c": (f"Compressive loads at mu = {COMPRESSED:g}, with the theories of Bradley, JKR and DMT-M", fig_1c),
    "2a": ("Near mu = 1 the tangent becomes vertical: jumps at fixed grips and in an apparatus", fig_2a),
    "2b": ("Load against approach at higher Tabor parameters, with JKR's theory", fig_2b),
    "3a": ("Load against approach with the central gap specified, mu = 1", fig_3a),
    "3b": ("Load against approach with the central gap specified, mu = 2", fig_3b),
    "3c": ("Load against approach with the central gap specified, mu = 3, with JKR's theory", fig_3c),
    "6a": ("The recalculated DMT theory against alpha*/mu, with its limit DMT-M", fig_6a),
    "6b": ("Numerical results at low Tabor parameters against alpha*/mu, with the limit of the DMT theory", fig_6b),
}
