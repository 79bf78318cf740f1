"""What the files for ParaView hold: arrays on the nodes, and notes on their units, signs and where they come from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TypeVar

import numpy as np

from fem_adhesion.common.facts import plain
from fem_adhesion.common.page import data_rows, said
from fem_adhesion.elasticity import stress as stresses
from fem_adhesion.elasticity.cells import Cells
from fem_adhesion.fields import Beside, State
from fem_adhesion.paraview.cells import Cut, Solid
from fem_adhesion.scene import Scene
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.equilibrium.events import EVENTS
from halfspace.errors import InputError
from halfspace.scaling import Units
from halfspace.values import Array

Named = dict[str, Array]
Numbers = TypeVar("Numbers", float, Array)

VECTORS = ("displacement", "displacement_in_beta", "displacement_magnified")
LARGEST_STRAIN = 0.5  # drawn at most: the cells stay far from turning inside out
TO_SCALE = 5.0  # magnification of the true displacement below which it is not worth its distortion


ARRAYS = data_rows("paraview", "arrays.csv")
UNITS = {row["array"]: (row["unit"], row["quantity"]) for row in ARRAYS if row["unit"]}
MEANINGS = {row["array"]: row["meaning"] for row in ARRAYS if row["meaning"]}
COMPONENTS = {row["array"]: tuple(row["components"].split()) for row in ARRAYS if row["components"]}
COMPONENTS_OF_SOLID = COMPONENTS | dict.fromkeys(VECTORS, ("x", "y", "z"))  # the same in the solid of revolution
"""Of arrays and of numbers in the field data: units in words with their names in `halfspace.scaling.IN_SI`, empty
without a dimension; what they are; names of their components."""


def unit_of(name: str) -> tuple[str, str]:
    """Unit of an array by its name, of the half-space's arrays too."""
    return UNITS[name.partition("_of_half_space")[0].removesuffix("_from_stress")]


def in_si(arrays: Mapping[str, Numbers], units: Units | None) -> dict[str, Numbers]:
    """Numbers or arrays in SI, the unit at the end of their names; without a dimension or a material as they are."""
    found = {}
    for name, values in arrays.items():
        _, quantity = unit_of(name)
        size, unit = units.si(quantity) if units and quantity else (1.0, "")
        found[f"{name}_{unit.replace('/', '_per_').replace('^', '')}" if unit else name] = values * size
    return found


def inside(state: State, cut: Cut, scale: float) -> Named:
    """Arrays on the nodes of the section."""
    u_r, u_z = cut.values(state.components)
    stress = cut.values(state.stress)
    rr, zz, hoop, rz = stress
    none = np.zeros_like(rr)
    displacement = np.stack([u_r, none, u_z], axis=1)
    by_region = np.array([stresses.energy_density(stress, *material) for material in state.scene.body.regions])
    return _displacements(state, displacement, scale) | {
        "stress_cylindrical": np.stack([rr, hoop, zz, none, none, rz], axis=1),
        "von_mises": stresses.von_mises(stress),
        "hydrostatic": stresses.hydrostatic(stress),
        "principal_stresses": np.ascontiguousarray(stresses.principal(stress).T),
        "strain_energy_density": state.share * by_region[cut.node_regions, np.arange(stress.shape[1])],
        **({"region": cut.node_regions.astype(float)} if len(state.scene.body.regions) > 1 else {}),
    }


def turned(arrays: Named, solid: Solid) -> Named:
    """Arrays on the nodes of the solid, vectors and the tensor `stress` in Cartesian components."""
    solid_arrays = {
        name: solid.vectors(values) if name in VECTORS else values[solid.meridian] for name, values in arrays.items()
    }
    return solid_arrays | {"stress": solid.tensors(arrays["stress_cylindrical"])}


def on_surface(state: State, beside: Beside, scale: float) -> Named:
    """Arrays on the nodes of the contact surface; those of the half-space say so, and whether it is another body."""
    other = "half_space_which_is_another_body" if state.scene.left_out else "half_space"
    u_r, u_z = state.surface_displacement
    displacement = np.stack([u_r, np.zeros_like(u_r), u_z], axis=1)
    return _displacements(state, displacement, scale) | {
        "pressure": state.pressure,
        "traction": state.traction,
        "traction_from_stress": state.recovered_traction(),
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
    strains = (stresses.strains(Cells.of(state.space), state.displacement) for state in states)
    largest = max(float(np.abs(strain).max()) for strain in strains)
    allowed = LARGEST_STRAIN / largest
    power = 10.0 ** np.floor(np.log10(allowed))
    scale = float(max(step for step in (1.0, 2.0, 5.0) if step * power <= allowed) * power)
    R = states[0].scene.sphere_radius
    return 1 / R if scale * R < TO_SCALE else scale


def numbers(state: State, scale: float, units: Units | None) -> dict[str, float]:
    """Field data: scene and state, which event it is, how the displacement is magnified, and the material.

    No words: not every reader of these files knows strings.
    """
    scene, observed = state.scene, dict(zip(OBSERVABLES, map(float, state.observables), strict=True))
    found = {"tabor": scene.tabor, "poisson": scene.poisson}
    if scene.radius_ratio is not None:
        found["radius_ratio"] = scene.radius_ratio
    found |= observed | in_si(observed, units)
    found |= {f"is_{name}": float(state.name == name) for name in EVENTS}
    found |= {"arclength": state.point.arclength, "stable_under_fixed_grips": float(state.stable)}
    found |= {"stable_under_dead_load": float(state.stable_under_dead_load)}
    found["magnified_beta_per_displacement_unit"] = scale
    R = units.radius / units.length if units else scene.sphere_radius
    if np.isfinite(R):
        found |= {"sphere_radius_in_beta": R, "magnification_of_true_displacement": scale * R}
    if units:
        found |= {"radius_m": units.radius, "contact_modulus_Pa": units.modulus}
        found |= {"work_of_adhesion_J_per_m2": units.work_of_adhesion, "spacing_m": units.spacing}
    return found


def words(scene: Scene) -> dict[str, object]:
    """What the arrays are, for people: units, meanings, components, signs."""
    other = said("paraview", "notes", "another" if scene.left_out else "same")
    return {
        "scene": plain(asdict(scene)),
        "units": {name: unit for name, (unit, _) in UNITS.items()},
        "names": said("paraview", "notes", "names"),
        "meanings": dict(MEANINGS),
        "components": dict(COMPONENTS),
        "signs": said("paraview", "notes", "signs"),
        "magnification": said("paraview", "notes", "magnification", strain=LARGEST_STRAIN, to_scale=TO_SCALE),
        "half_space": said("paraview", "notes", "half_space", other=other),
    }


def require_same_scene(states: Sequence[State], units: Units | None) -> None:
    """Raise InputError unless there are states, all of one scene, with the Tabor parameter of the material."""
    if not states:
        raise InputError("no states to write, limit: 1 or more; ask for points or events of the curve")
    scene = states[0].scene
    if any(state.scene != scene for state in states):
        raise InputError("states of several scenes, limit: one scene; write each to a directory of its own")
    if units is not None and abs(units.tabor - scene.tabor) > 1e-6 * scene.tabor:
        raise InputError(
            f"the material's tabor = {units.tabor:.9g} is not the scene's {scene.tabor:.9g}; "
            "take units.tabor for the scene"
        )
