"""Profiles, contact radius and pull-off: [G97] Figs 4a, 4b, 5 and 7, each with what is to be seen in it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from fem_adhesion.common import style
from fem_adhesion.common.numbers import listed, told
from fem_adhesion.greenwood.drawing import (
    CONTACT_RADIUS,
    ELEMENTS,
    HALF_SPACE,
    LOAD,
    MARKS,
    OF_TABOR,
    RADIUS,
    TABOR,
    Axis,
    Line,
    Plot,
    by_elements,
    elements_beside,
    half_space,
    rises,
    theory,
)
from fem_adhesion.greenwood.load_figures import at_zero_load
from fem_adhesion.greenwood.study import PRINTED_GAPS, WINDING_AT, DrawnState, Greenwood1997
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import MYD
from halfspace.theories.closed_forms import BRADLEY_PULL_OFF, JKR_PULL_OFF, jkr_jump_off, jkr_load, jkr_zero_load
from halfspace.theories.maugis import MaugisDugdale
from halfspace.values import Array, Estimate

GAP = Axis("gap", "eps", "gap $H$")
PRESSURE = Axis("pressure", "dgamma_per_mu_eps", "pressure $P$")
PULL_OFF = Axis("pull_off_force", "R_dgamma", r"pull-off force $-W_\mathrm{min}/R\Delta\gamma$")
RADII_AT = (0.5, 2.0, 5.0)  # Tabor parameters of Fig. 5
MAUGIS_AT = (0.5, 2.0)
NEAR = 0.01  # relative difference below which two heights are called the same
ATTARD_PARKER = np.array([[1.0, 1.6], [6.7, 3.4]])  # mu and force over pi, the two values that [G97] quotes
BEFORE_AND_AFTER = ((style.BLUE, "-"), (style.RED, style.DASHED))


def profile_line(state: DrawnState, axis: Axis, look: tuple[str, object]) -> Line:
    """Gap or pressure of a state along the radius."""
    values, errors = getattr(state, axis.quantity), getattr(state, f"{axis.quantity}_error")
    key = f"$H(0) = {state.central_gap:.4g}$" if abs(state.central_gap) > 1e-9 else "$H(0) = 0$"
    colour, dashes = look
    drawn = {"color": colour, "linestyle": dashes, "linewidth": 1.8}
    name = f"H(0) = {round(state.central_gap, 9):g}"
    return Line(name, WINDING_AT, state.radii, values, drawn, None, errors, label=key)


def _jump(study: Greenwood1997, axis: Axis, see: Iterator[str]) -> Plot:
    """Both states of the jump into contact."""
    pairs = zip(study.profiles, BEFORE_AND_AFTER, strict=False)
    lines = [profile_line(state, axis, look) for state, look in pairs]
    title = rf"$\mu = {WINDING_AT:g}$"
    return Plot(RADIUS.within(0, 3), axis, lines, tuple(see), title=title, legend="best")


def fig_4a(study: Greenwood1997) -> Plot:
    """Pressures before and after the jump into contact."""
    return _jump(study, PRESSURE.within(-5.6, 1.4), _see_pressures(study))


def _see_pressures(study: Greenwood1997) -> Iterator[str]:
    """Central pressures, and the spike of tension after the jump."""
    if len(study.profiles) < len(PRINTED_GAPS):
        return
    before, after = study.profiles
    centre = f"The central pressure goes from {before.pressure[0]:.4f} to {after.pressure[0]:+.4f} dgamma/(mu eps)."
    yield told(centre, before.pressure[0], after.pressure[0])
    height, strength = -after.pressure.min() / WINDING_AT, largest_tension()
    same = "is" if abs(height / strength - 1) < NEAR else "is not"
    place = after.radii[after.pressure.argmin()]
    text = (
        f"After the jump the largest tension {same} the strength of the surface law, {strength:.3f} mu: it is "
        f"{height:.3f} mu, at a radius of {place:.2f} beta."
    )
    yield told(text, height, place)


def largest_tension() -> float:
    """Strength of the surface law, in parts of mu."""
    return -float(LENNARD_JONES.pressure(np.array(LENNARD_JONES.edge_gap), 1.0))


def fig_4b(study: Greenwood1997) -> Plot:
    """Shape before and after the jump into contact."""
    return _jump(study, GAP.within(-0.3, 8), _see_shapes(study))


def _see_shapes(study: Greenwood1997) -> Iterator[str]:
    """Where on the curve the printed states lie."""
    if len(study.profiles) < len(PRINTED_GAPS):
        return
    before, after = study.profiles
    event = study.curves[WINDING_AT].events["jump_on"]
    text = (
        f"The state before the jump, H(0) = {before.central_gap:.4g}, has alpha* = {before.approach:.4f} and W = "
        f"{before.load:.4f} R dgamma, that after it, H(0) = {after.central_gap:.4g}, {after.approach:.4f} and "
        f"{after.load:.4f}; between them the curve has its fold, at alpha* = {event.approach:.4f} with H(0) = "
        f"{event.central_gap:.4f}."
    )
    yield told(text, before.central_gap, before.load, after.central_gap, after.load, event.approach)


def fig_5(study: Greenwood1997) -> Plot:
    """Contact radius against load, with JKR's and Maugis's theories."""
    radius = np.linspace(1e-3, 2.9, 400)
    lines = [half_space(study.curves[mu], LOAD, CONTACT_RADIUS) for mu in RADII_AT]
    fe = by_elements(study.elements, RADII_AT, LOAD, CONTACT_RADIUS)
    theories = [theory("JKR", jkr_load(radius), radius), *(maugis_radius(mu, radius) for mu in MAUGIS_AT)]
    axes = LOAD.within(-6.5, 5), CONTACT_RADIUS.within(0, 2.8)
    see = [*_see_radii(study), elements_beside([*lines, *fe])]
    return Plot(*axes, [*lines, *fe, *theories], see, legend="below")


def maugis_radius(tabor: float, radius: Array) -> Line:
    """Maugis's theory of the same largest tension, as a thin line."""
    look = {"color": OF_TABOR[tabor], "linewidth": 1.0}
    return Line("Maugis-Dugdale", tabor, MaugisDugdale.matched(tabor).load(radius), radius, look)


def _see_radii(study: Greenwood1997) -> Iterator[str]:
    """Radius at zero load, and below the nose, beside JKR's and Maugis's."""
    radii = at_zero_load(study, RADII_AT, "contact_radius")
    jkr = jkr_zero_load(1.0).contact_radius
    closing = "closes in" if rises(-np.abs(radii - jkr)) else "does not close in"
    below = "below" if np.all(radii < jkr) else "not always below"
    sizes = listed([f"{radius:.3f} at mu = {mu:g}" for mu, radius in zip(RADII_AT, radii, strict=True)])
    text = f"At zero load the radius is {sizes}, in beta: {below} JKR's {jkr:.3f}, on which it {closing} all along."
    yield told(text, radii)
    ends = {mu: study.curves[mu].event("jump_off") for mu in RADII_AT}
    sizes = listed([f"{event.contact_radius:.3f} at mu = {mu:g}" for mu, event in ends.items() if event])
    least = jkr_jump_off(1.0).contact_radius
    smaller = "smaller" if all(event.contact_radius < least for event in ends.values() if event) else "not smaller"
    if sizes and "nan" not in sizes:
        yield f"Where fixed grips jump off it is {sizes}, {smaller} than JKR's {least:.3f}."


def fig_7(study: Greenwood1997) -> Plot:
    """Pull-off force against the Tabor parameter: the solvers, Maugis, and Attard & Parker."""
    found = study.pull_offs
    tabor, force, error = _column([(p.tabor, p.half_space) for p in found])
    fe_tabor, fe_force, fe_error = _column([(p.tabor, p.finite_element) for p in found if p.finite_element])
    maugis = np.array([-MaugisDugdale.matched(mu).pull_off().load for mu in tabor])
    blue = {"color": style.BLUE, "linewidth": 2, "marker": "."}
    label = "half-space; Muller et al. solved the same equations"
    attard: dict[str, Any] = {"color": style.RED, "linestyle": style.DASHED, "marker": "s"}
    lines = [
        Line(HALF_SPACE, None, tabor, force, blue, None, error, label=label),
        Line(ELEMENTS, None, fe_tabor, fe_force, {"color": style.BLUE, **MARKS}, None, fe_error),
        theory("Maugis-Dugdale", tabor, maugis, color=style.GREEN, linestyle=style.CHAIN),
        theory("Attard & Parker, the two values quoted", ATTARD_PARKER[:, 0], np.pi * ATTARD_PARKER[:, 1], **attard),
    ]
    for name, limit in (("Bradley", -BRADLEY_PULL_OFF), ("JKR", -JKR_PULL_OFF)):
        lines.append(theory(name, tabor, np.full_like(tabor, limit), linewidth=1.0))
    above = (r"parameter of Muller et al., $\mu_D$", float(MYD.of(1.0)))
    return Plot(TABOR, PULL_OFF.within(4.4, 11.2), lines, tuple(_see_7(study)), above=above)


def _column(found: list[tuple[float, Estimate]]) -> tuple[Array, Array, Array]:
    """Tabor parameters, forces and their errors."""
    columns = np.reshape([(mu, -load.value, load.error) for mu, load in found], (-1, 3)).T
    return columns[0], columns[1], columns[2]


def _see_7(study: Greenwood1997) -> Iterator[str]:
    """The trend, whether finite elements agree, and how far Attard & Parker's values are off."""
    found = study.pull_offs
    forces = np.array([-p.half_space.value for p in found])
    trend = "falls" if rises(-forces) else "does not fall"
    if forces.size:
        ends = (
            f"from {forces[0]:.4f} to {forces[-1]:.4f} R dgamma at mu = {found[0].tabor:.3g} to {found[-1].tabor:.3g}"
        )
        yield told(f"The force {trend} all along, {ends}.", forces)
    if both := [p.agree for p in found if p.finite_element]:
        yield f"Finite elements agree within both errors at {sum(both)} of {len(both)} Tabor parameters."
    if forces.size > 1:
        at = np.interp(np.log(ATTARD_PARKER[:, 0]), np.log([p.tabor for p in found]), forces)
        off = np.pi * ATTARD_PARKER[:, 1] / at - 1
        words = [f"{100 * o:+.0f} % at mu = {mu:g}" for o, mu in zip(off, ATTARD_PARKER[:, 0], strict=True)]
        yield told(f"Attard & Parker's two values are off it by {listed(words)}.", off)


FIGURES = {
    "4a": (f"The jump into contact at mu = {WINDING_AT:g}: pressures before and after", fig_4a),
    "4b": (f"The jump into contact at mu = {WINDING_AT:g}: shape before and after", fig_4b),
    "5": ("Contact radius against load, with the theories of JKR and Maugis", fig_5),
    "7": ("Pull-off force against Tabor parameter, with Maugis's theory and Attard & Parker's values", fig_7),
}
