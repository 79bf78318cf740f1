"""Codes with real defects: each computes for itself, none by the predictions of `fem_adhesion.benchmark.causes`.

All give quantities in R dgamma, eps and beta, as their authors would.
"""

import math

import numpy as np

from fem_adhesion import Block, Scene, trace
from halfspace import atlas
from halfspace.elastic import compliance, grid
from halfspace.laws import LENNARD_JONES
from halfspace.scaling import Units
from halfspace.theories import closed_forms

KINDS = ("approach", "load", "contact_radius")


def numbers(states):
    """Numbers of states, those that there are; the load under no load is none."""
    found = {f"{name}_{kind}": float(getattr(state, kind)) for name, state in states.items() for kind in KINDS}
    return {name: value for name, value in found.items() if math.isfinite(value) and name != "zero_load_load"}


def events(tabor):
    """States that the atlas has."""
    states = {"pull_off": atlas.pull_off(tabor), "zero_load": atlas.zero_load(tabor)}
    return states | {"jump_on": atlas.jump_on(tabor).take_off, "jump_off": atlas.jump_off(tabor).take_off}


def true(tabor):
    """What the atlas has."""
    return numbers(events(tabor))


def mistaken(tabor, *, modulus=1.0, work=1.0, radius=1.0):
    """What a code computes in SI that takes E*, dgamma or R for so many times what it is, in the true units."""
    R, E, dgamma = 1e-6, 1.1e9, 0.06
    eps = math.cbrt(R * (dgamma / E) ** 2) / tabor
    own, wrong = Units(R, E, dgamma, eps), Units(R * radius, E * modulus, dgamma * work, eps)
    sizes = {"approach": 1.0, "load": wrong.load / own.load, "contact_radius": wrong.length / own.length}
    values = true(wrong.tabor).items()
    return {name: value * next(sizes[kind] for kind in KINDS if name.endswith(kind)) for name, value in values}


def clamped(tabor, size):
    """Finite elements on a block that is clamped at a radius in beta."""
    return numbers(trace(Scene(tabor, Block(radius=size, far_field="clamped")), rtol=1e-3).events)


def coarse(tabor, spacing, extent=12.0):
    """Bands of uniform pressure, equally wide, at a given central gap from step to step."""
    body = compliance.bands(grid.uniform(extent, spacing))
    r, C = body.radii, body.compliance
    gaps = atlas.curve(tabor).states(400).central_gap
    gaps = gaps[gaps < 6]
    free, alpha, rows = tabor * (r**2 - r[0] ** 2) / 2, -gaps[0], []
    H = free + gaps[0]
    for gap in gaps:
        before, H = (H, alpha), H + (gap - H[0]) * np.exp(-((r / 2) ** 2))
        H[0] = gap
        for _ in range(100):
            P = LENNARD_JONES.pressure(H, tabor)
            F = H - free + alpha - tabor * C @ P
            if np.abs(F).max() < 1e-9:
                break
            J = np.eye(r.size) - tabor * C * LENNARD_JONES.slope(H, tabor)
            J[:, 0] = 1.0  # the approach in the place of the central gap
            change = np.linalg.solve(J, -F)
            change[0], toward = 0.0, change[0]
            part = min(1.0, 0.3 / np.max(np.abs(change) / (H + 1)))
            H, alpha = H + part * change, alpha + part * toward
        else:
            H, alpha = before  # the edge leaps from node to node: on to the next gap
            continue
        rows.append((alpha, body.weights @ P))
    approach, load = np.array(rows).T
    least, last = int(np.argmin(load)), int(np.flatnonzero(load < 0)[-1])
    zero = np.interp(0.0, load[last : last + 2], approach[last : last + 2])
    found = {"pull_off_load": load[least], "pull_off_approach": approach[least], "zero_load_approach": zero}
    drop = np.maximum.accumulate(approach) - approach
    if tabor > 0.7:
        off = int(np.argmax(drop))
        on = int(np.argmax(approach[: off + 1]))
        found |= {"jump_on_approach": approach[on], "jump_on_load": load[on]}
        found |= {"jump_off_approach": approach[off], "jump_off_load": load[off]}
    return {name: float(value) for name, value in found.items()}


def stepped(tabor, step, start=0.0):
    """Curve under fixed grips, in and out, at steps of the approach: columns of approach and load."""
    curve, on, off = atlas.curve(tabor), *(jump(tabor).take_off.approach for jump in (atlas.jump_on, atlas.jump_off))
    inwards = np.arange(off - 1.0 - start, atlas.zero_load(tabor).approach + 0.3 * tabor, step)

    def loads(approaches, fold):
        apart = approaches < fold + 1e-9
        load = np.empty(approaches.size)
        load[apart] = curve.at(approach=approaches[apart], branch="separated").load
        load[~apart] = curve.at(approach=approaches[~apart], branch="contact").load
        return load

    outwards = inwards[::-1]
    return np.array([[*inwards, *outwards], [*loads(inwards, on), *loads(outwards, off)]]).T


def jkr(tabor):
    """JKR's closed forms."""
    names = ("pull_off", "jump_off", "zero_load")
    return numbers({name: getattr(closed_forms, f"jkr_{name}")(tabor) for name in names})


def hertz_radius(tabor):
    """MUSEN's: the force 4 a^3/3 - sqrt(8 pi a^3) of the overlap a^2, at its least and where it vanishes."""
    a = np.linspace(1e-3, 4, 400_001)
    W = 4 / 3 * a**3 - np.sqrt(8 * np.pi * a**3)
    least, zero = int(np.argmin(W)), int(np.flatnonzero(W < 0)[-1])
    places = {"pull_off": least, "zero_load": zero}
    states = {name: closed_forms.ContactState(tabor * a[at] ** 2, W[at], a[at]) for name, at in places.items()}
    return numbers(states) | {"jump_off_approach": 0.0}


def rounded(values, digits, noise=0.0, seed=0):
    """Values as they are written: to so many digits, with noise of a part of each."""
    rng = np.random.default_rng(seed)
    return {name: f"{value * (1 + noise * rng.standard_normal()):.{digits - 1}e}" for name, value in values.items()}
