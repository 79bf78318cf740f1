"""What the files for ParaView hold: arrays on the nodes, and notes on their units, signs and where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from fem_adhesion import stress as stresses
from fem_adhesion.beside import Beside, is_same_contact
from fem_adhesion.fields import State
from fem_adhesion.output.lattice import Cut
from fem_adhesion.output.revolve import Solid
from fem_adhesion.scene import Scene
from halfspace.compliance import Array
from halfspace.errors import InputError
from halfspace.scaling import Units

Named = dict[str, Array]

LARGEST_STRAIN = 0.5
"""Drawn at most: the cells stay far from turning inside out."""

STRAIN_PLACES = np.stack(np.meshgrid(np.linspace(0, 0.5, 3), np.linspace(0, 0.5, 3))).reshape(2, -1)
"""Points of the reference element, triangle or square, at which the largest strain is looked for."""

TO_SCALE = 5.0
"""Magnification of the true displacement below which it is not worth its distortion."""

SAME_TABOR = 1e-6
"""Relative difference of two Tabor parameters that are one."""

COMPONENTS = {
    "displacement": ("r", "theta", "z"),
    "displacement_in_beta": ("r", "theta", "z"),
    "displacement_magnified": ("r", "theta", "z"),
    "stress_cylindrical": ("rr", "tt", "zz", "rt", "tz", "rz"),
    "stress": ("xx", "yy", "zz", "xy", "yz", "xz"),
    "principal_stresses": ("largest", "middle", "least"),
}
"""Names of the components, in VTK's order of a symmetric tensor's; in a section x, y, z are r, theta, z."""

VECTORS = ("displacement", "displacement_in_beta", "displacement_magnified")

UNITS = {
    "points": "beta = (R^2 dgamma/E*)^(1/3)",
    "displacement": "beta^2/R = mu eps",
    "displacement_in_beta": "beta",
    "displacement_magnified": "beta, not to scale: displacement times magnified_beta_per_displacement_unit",
    "stress_cylindrical": "E* beta/R = dgamma/(mu eps); in VTK's order of xx yy zz xy yz xz: rr tt zz rt tz rz",
    "stress": "E* beta/R = dgamma/(mu eps); Cartesian",
    "von_mises": "E* beta/R",
    "hydrostatic": "E* beta/R; mean of the three normal stresses",
    "principal_stresses": "E* beta/R; descending",
    "strain_energy_density": "E* (beta/R)^2",
    "pressure": "P in E* beta/R",
    "gap": "h in eps",
    "H": "h/eps - 1",
    "deflection": "w = -u_z in beta^2/R",
    "approach": "eps",
    "load": "R dgamma",
    "central_gap": "H(0), h/eps - 1",
    "contact_radius": "beta, where h = 3^(1/6) eps; nan without contact",
    "arclength": "of the load-approach curve in units of its metric; the time of the .pvd",
}

SIGNS = (
    "pressure and load positive in compression, stress positive in tension; approach positive when pressed together; "
    "displacement z upwards, out of the body; deflection positive into the body"
)


def inside(state: State, cut: Cut, scale: float) -> Named:
    """Arrays on the nodes of the section."""
    u_r, u_z = cut.values(state.components)
    stress = cut.values(state.stress)
    rr, zz, hoop, rz = stress
    none = np.zeros_like(rr)
    displacement = np.stack([u_r, none, u_z], axis=1)
    return _displacements(state, displacement, scale) | {
        "stress_cylindrical": np.stack([rr, hoop, zz, none, none, rz], axis=1),
        "von_mises": stresses.von_mises(stress),
        "hydrostatic": stresses.hydrostatic(stress),
        "principal_stresses": np.ascontiguousarray(stresses.principal(stress).T),
        "strain_energy_density": state.share * stresses.energy_density(stress, state.scene.poisson),
    }


def turned(arrays: Named, solid: Solid) -> Named:
    """Arrays on the nodes of the solid, vectors and the tensor `stress` in Cartesian components."""
    solid_arrays = {
        name: solid.vectors(values) if name in VECTORS else solid.scalars(values) for name, values in arrays.items()
    }
    return solid_arrays | {"stress": solid.tensors(arrays["stress_cylindrical"])}


def on_surface(state: State, beside: Beside, scale: float) -> Named:
    """Arrays on the nodes of the contact surface; those of the half-space say so, and whether it is another body."""
    other = "half_space" if is_same_contact(state.scene) else "half_space_which_is_another_body"
    functions = state.space.boundary_functions("contact")
    u_r, u_z = (state.surface.values @ state.components[:, functions].T).T
    displacement = np.stack([u_r, np.zeros_like(u_r), u_z], axis=1)
    return _displacements(state, displacement, scale) | {
        "pressure": state.pressure,
        "pressure_from_stress": state.recovered_pressure(),
        f"pressure_of_{other}": beside.pressure,
        "gap": state.gap + 1,
        f"gap_of_{other}": beside.gap + 1,
        "H": state.gap,
        f"H_of_{other}": beside.gap,
        "deflection": -u_z,
    }


def _displacements(state: State, displacement: Array, scale: float) -> Named:
    arrays = {"displacement": displacement, "displacement_magnified": scale * displacement}
    R = state.scene.sphere_radius
    return arrays if np.isinf(R) else arrays | {"displacement_in_beta": displacement / R}


def magnification_for(states: Sequence[State]) -> float:
    """Length in beta that a displacement of beta^2/R is drawn as, in all states alike: 1, 2 or 5 times a power of ten.

    The largest at which no strain is drawn as more than `LARGEST_STRAIN`; or to scale, 1/R, if that is little less, so
    that a sphere is drawn as flat as it is where it touches the wall.
    """
    largest = max(
        float(np.abs(stresses.strains(state.space, state.displacement, STRAIN_PLACES)).max()) for state in states
    )
    allowed = LARGEST_STRAIN / largest
    power = 10.0 ** np.floor(np.log10(allowed))
    scale = float(max(step for step in (1.0, 2.0, 5.0) if step * power <= allowed) * power)
    R = states[0].scene.sphere_radius
    return 1 / R if scale * R < TO_SCALE else scale


def notes(state: State, scale: float, units: Units | None) -> dict[str, float | str]:
    """Field data: the scene, the state, units, signs, how the displacement is magnified, and SI values."""
    alpha, load, gap, radius = map(float, state.observables)
    scene = {f"scene_{name}": _plain(value) for name, value in asdict(state.scene).items() if value is not None}
    R = state.scene.sphere_radius
    return (
        scene
        | {"tabor": state.scene.tabor, "poisson": state.scene.poisson, "event": state.name or "none"}
        | {"approach": alpha, "load": load, "central_gap": gap, "contact_radius": radius}
        | {"arclength": state.arclength, "stable_under_fixed_grips": float(state.stable)}
        | {"stable_under_dead_load": float(state.stable_under_dead_load)}
        | _magnification(scale, R)
        | ({} if np.isinf(R) else {"sphere_radius_in_beta": R})
        | {f"unit_of_{name}": unit for name, unit in UNITS.items()}
        | {"signs": SIGNS}
        | (_si(units) if units else {})
    )


def _magnification(scale: float, R: float) -> dict[str, float | str]:
    how = (
        "displacement_magnified is displacement times this, in all states alike: the largest of 1, 2, 5 times a power "
        f"of ten at which no strain is drawn as more than {LARGEST_STRAIN:g}, or to scale if that is less than "
        f"{TO_SCALE:g} times the true displacement"
    )
    true = {} if np.isinf(R) else {"magnification_of_true_displacement": scale * R}
    return {"magnified_beta_per_displacement_unit": scale, "how_magnified": how, **true}


def half_space_notes(scene: Scene, beside: Beside) -> dict[str, float | str]:
    """Field data on the half-space's values: whose they are, its approach (eps) and load (R dgamma)."""
    alpha, load = map(float, beside.observables[:2])
    numbers = {"approach_of_half_space": alpha, "load_of_half_space": load}
    where = "at the same contact radius, or central gap without contact"
    if is_same_contact(scene):
        return numbers | {"half_space": f"the same contact, solved by the integral equation {where}"}
    return numbers | {"half_space": f"another body than the scene's, under the same profile, {where}"}


def _si(units: Units) -> dict[str, float | str]:
    return {
        "SI_points_unit_in_m": units.length,
        "SI_displacement_unit_in_m": units.tabor * units.approach,
        "SI_gap_unit_in_m": units.approach,
        "SI_stress_unit_in_Pa": units.pressure,
        "SI_energy_density_unit_in_J_per_m3": units.pressure**2 / units.modulus,
        "SI_load_unit_in_N": units.load,
    }


def _plain(value: object) -> float | str:
    return float(value) if isinstance(value, int | float) else str(value)


def require_same_scene(states: Sequence[State], units: Units | None) -> None:
    """Raise InputError unless there are states, all of one scene, with the Tabor parameter of the material."""
    if not states:
        raise InputError("no states to write, limit: 1 or more; ask for points or events of the curve")
    scene = states[0].scene
    if any(state.scene != scene for state in states):
        raise InputError("states of several scenes, limit: one scene; write each to a directory of its own")
    if units is not None and abs(units.tabor - scene.tabor) > SAME_TABOR * scene.tabor:
        raise InputError(
            f"the material's tabor = {units.tabor:.9g} is not the scene's {scene.tabor:.9g}; "
            "take units.tabor for the scene"
        )
