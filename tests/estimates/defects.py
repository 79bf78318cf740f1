"""Defects that the tests must notice: each is put into a copy of the project, where tests named with it must fail.

Run by hand, ``python tests/estimates/defects.py [NAME ...]``, all unless some are named; exit
code 1 if a defect survives its tests, or if its place in the code is no longer found.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
LEFT_OUT = shutil.ignore_patterns(".git", ".venv", ".*cache*", "__pycache__", "build", "*.egg-info")


class Defect(NamedTuple):
    """Text of a file that stands there once, what takes its place, and the tests each of which must fail then."""

    name: str
    file: str
    before: str
    after: str
    tests: tuple[str, ...]


DEFECTS = (
    Defect(
        "resume digest without scipy",
        "fem_adhesion/common/facts.py",
        'LIBRARIES = ("numpy", "scipy", "scikit-fem")',
        'LIBRARIES = ("numpy", "scikit-fem")',
        ("tests/project/test_code_digest.py::test_it_changes_with_the_version_of_a_library",),
    ),
    Defect(
        "memory in the exponents is the time",
        "fem_adhesion/speed/study.py",
        '("unknowns", "seconds", "memory")',
        '("unknowns", "seconds", "seconds")',
        ("tests/fem_adhesion/common/test_speed.py::test_each_cost_grows_by_its_own_exponent",),
    ),
    Defect(
        "memory too little to tell counts",
        "fem_adhesion/speed/study.py",
        "        m[m < VISIBLE] = np.nan\n",
        "",
        ("tests/fem_adhesion/common/test_speed.py::test_each_cost_grows_by_its_own_exponent",),
    ),
    Defect(
        "study gives the load the error of the approach",
        "fem_adhesion/finite_sphere/cases.py",
        'values[f"{name}_load"] = jump.estimate("load")',
        'values[f"{name}_load"] = Estimate(jump.load, jump.approach_error)',
        ("tests/fem_adhesion/finite_sphere/test_finite_sphere_study.py::test_quantities_are_those_of_the_curve",),
    ),
    Defect(
        "bias of a fit left out",
        "fem_adhesion/finite_sphere/fit.py",
        "Estimate(c.value, c.error + abs(c.value - d.value))",
        "Estimate(c.value, c.error)",
        ("tests/fem_adhesion/finite_sphere/test_finite_sphere_study.py::test_the_fit_says_up_to_where_it_holds",),
    ),
    Defect(
        "beside scales approaches by the spacing alone",
        "fem_adhesion/curve/beside.py",
        "size = first.approach_scale / first.tabor if",
        "size = 1 / first.tabor if",
        (
            "tests/fem_adhesion/curve/test_beside.py::test_jumps_differ_by_the_largest_part_in_loads_of_the_pull_off_and_in_approaches_of_their_range",
        ),
    ),
    Defect(
        "beside compares the approaches of jumps alone",
        "fem_adhesion/curve/beside.py",
        'for quantity in ("approach", "load")],',
        'for quantity in ("approach",)],',
        (
            "tests/fem_adhesion/curve/test_beside.py::test_jumps_differ_by_the_largest_part_in_loads_of_the_pull_off_and_in_approaches_of_their_range",
        ),
    ),
    Defect(
        "constant of a criterion has the scatter of one jump as error",
        "fem_adhesion/greenwood/criteria.py",
        "value * scatter / float(np.sqrt(logarithms.size))",
        "value * scatter",
        (
            "tests/fem_adhesion/greenwood/test_greenwood.py::test_the_errors_of_refitted_constants_are_the_spread_of_fits_to_scattered_jumps",
        ),
    ),
    Defect(
        "factor of a power has the error of its logarithm",
        "fem_adhesion/greenwood/criteria.py",
        "Estimate(c, c * logarithm.error)",
        "Estimate(c, logarithm.error)",
        (
            "tests/fem_adhesion/greenwood/test_greenwood.py::test_the_errors_of_refitted_constants_are_the_spread_of_fits_to_scattered_jumps",
        ),
    ),
    Defect(
        "a jump on lands on the last of several states",
        "halfspace/equilibrium/devices.py",
        "next((state for state in beyond[:-1] if state.stable), beyond[-1])",
        "beyond[-1]",
        (
            "tests/halfspace/equilibrium/test_further_folds.py::test_of_several_states_at_the_base_of_a_take_off_the_nearest_stable_one_is_landed_on",
        ),
    ),
    Defect(
        "a jump off lands apart, whatever is on its way",
        "halfspace/equilibrium/devices.py",
        "next((state for state in reversed(between) if state.stable), None)",
        "None",
        (
            "tests/halfspace/equilibrium/test_further_folds.py::test_of_several_states_at_the_base_of_a_take_off_the_nearest_stable_one_is_landed_on",
        ),
    ),
    Defect(
        "half-space beside by another law",
        "fem_adhesion/fields.py",
        "ContactProblem(operator, tabor, state.problem.law, state.problem.profile)",
        "ContactProblem(operator, tabor, profile=state.problem.profile)",
        ("tests/fem_adhesion/bodies/test_fields.py::test_the_half_space_beside_has_the_scenes_parts[law]",),
    ),
    Defect(
        "half-space beside under a paraboloid",
        "fem_adhesion/fields.py",
        "ContactProblem(operator, tabor, state.problem.law, state.problem.profile)",
        "ContactProblem(operator, tabor, state.problem.law)",
        ("tests/fem_adhesion/bodies/test_fields.py::test_the_half_space_beside_has_the_scenes_parts[profile]",),
    ),
    Defect(
        "traction per true area taken as per horizontal area",
        "fem_adhesion/fields.py",
        '(n_z if self.scene.material.area == "projected" else 1.0)',
        "n_z",
        ("tests/fem_adhesion/bodies/test_fields.py::test_traction_per_true_area_is_that_of_the_stress",),
    ),
    Defect(
        "energy density of the first material everywhere",
        "fem_adhesion/paraview/arrays.py",
        "by_region[cut.node_regions, np.arange(stress.shape[1])]",
        "by_region[0]",
        ("tests/fem_adhesion/bodies/test_layer_body.py::test_stresses_jump_at_an_interface_where_they_must",),
    ),
    Defect(
        "sheet of strata that slide is of the first one",
        "fem_adhesion/bodies/layers.py",
        "return Elastic(self.regions[0].poisson, whole / shear[0] / layers.total_thickness(self))",
        "return self.regions[0]",
        (
            "tests/fem_adhesion/bodies/test_layer_body.py::test_what_strata_that_slide_go_on_as_beyond_their_edge_has_the_stiffness_of_all",
        ),
    ),
    Defect(
        "grip of a dimensionless counter-body left out",
        "fem_adhesion/common/scene_options.py",
        'grip: GripName = options.grip or "sliding"',
        'grip: GripName = "sliding"',
        ("tests/fem_adhesion/curve/test_curve_command.py::test_the_counter_body_of_a_tabor_parameter_is_heeded",),
    ),
    Defect(
        "stratum by its thickness has a poisson's ratio of its own",
        "fem_adhesion/common/scene_options.py",
        "default = (math.nan, poisson, 1.0)",
        "default = (math.nan, POISSON, 1.0)",
        (
            "tests/fem_adhesion/bodies/test_layer_body.py::test_a_stratum_by_its_thickness_has_the_bodys_poissons_ratio_and_the_modulus_of_the_first",
        ),
    ),
    Defect(
        "ninth node of a quadrilateral from the other eight",
        "fem_adhesion/mesh/file.py",
        '    if kind == "quad8":\n        points, cells = _with_centres(points, cells)',
        '    if kind in ("quad8", "quad9"):\n        points, cells = _with_centres(points, cells[:, :8])',
        (
            "tests/fem_adhesion/bodies/test_mesh_file.py::test_the_ninth_node_of_a_quadrilateral_is_where_the_file_has_it",
        ),
    ),
    Defect(
        "report's curve with its axes exchanged",
        "fem_adhesion/report/templates/walk.js",
        "curve.line(kind, drawn.approach, drawn.load.map((load, k) => (drawn.unstable[k] ? null : load)));",
        "curve.line(kind, drawn.load, drawn.approach.map((load, k) => (drawn.unstable[k] ? null : load)));",
        (
            "tests/browser/test_report_browser.py::test_the_curve_of_each_solver_is_load_against_approach_and_marked_where_unstable",
        ),
    ),
    Defect(
        "report's curve with its solvers exchanged",
        "fem_adhesion/report/templates/walk.js",
        '[["fe", data.curves[0]], ["hs", data.curves[1]]]',
        '[["fe", data.curves[1]], ["hs", data.curves[0]]]',
        (
            "tests/browser/test_report_browser.py::test_the_curve_of_each_solver_is_load_against_approach_and_marked_where_unstable",
        ),
    ),
    Defect(
        "report's curve unstable where it is stable",
        "fem_adhesion/report/templates/walk.js",
        "(drawn.unstable[k] ? null : load)",
        "(drawn.unstable[k] ? load : null)",
        (
            "tests/browser/test_report_browser.py::test_the_curve_of_each_solver_is_load_against_approach_and_marked_where_unstable",
        ),
    ),
    Defect(
        "contact radius without the ripples of the gap",
        "halfspace/equilibrium/events.py",
        "[gap if alone else 0.0, radius]",
        "[gap if alone else 0.0, 0.0]",
        (
            "tests/halfspace/equilibrium/test_devices.py::test_a_contact_radius_is_known_no_better_than_the_gap_ripples_there",
        ),
    ),
    Defect(
        "force of the figure in nN whatever its label",
        "fem_adhesion/assess/figure.py",
        "load * self.units.load * 10.0**-self.newtons",
        "load * self.units.load * 1e9",
        ("tests/fem_adhesion/assess/test_assess.py::test_the_axes_of_the_figure_are_in_the_units_that_they_name",),
    ),
    Defect(
        "reach of Hertz without its square",
        "fem_adhesion/assess/terminal.py",
        "(sample.hertz_until.value * contact.thickness) ** 2 / contact.units.radius",
        "sample.hertz_until.value * contact.thickness**2 / contact.units.radius",
        ("tests/fem_adhesion/assess/test_thin_sample.py::test_the_reach_of_hertz_is_told_as_an_indentation",),
    ),
    Defect(
        "rigid limit by JKR's theory",
        "fem_adhesion/assess/study.py",
        'closed("rigid half-space", bradley, units.tabor',
        'closed("rigid half-space", jkr, units.tabor',
        ("tests/fem_adhesion/assess/test_assess.py::test_a_sphere_that_is_all_but_rigid_has_bradleys_force",),
    ),
)


def run(tree: Path, test: str) -> int:
    """Exit code of pytest in a copy of the project: 0 if all passes, 1 if a test fails, others if it was not run."""
    ours = {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", test]
    return subprocess.run(command, cwd=tree, env=os.environ | ours, stdout=subprocess.DEVNULL, check=False).returncode


def noticed(tree: Path, defect: Defect) -> str:
    """What becomes of a defect in a copy of the project, which is left as it was."""
    file = tree / defect.file
    sound = file.read_text()
    if sound.count(defect.before) != 1:
        return f"NOT FOUND: {sound.count(defect.before)} times in {defect.file}"
    if any(run(tree, test) for test in defect.tests):
        return "FAILS WITHOUT"
    file.write_text(sound.replace(defect.before, defect.after))
    passed = [test for test in defect.tests if run(tree, test) != 1]
    file.write_text(sound)
    return f"SURVIVED {', '.join(passed)}" if passed else "caught"


def main(names: Sequence[str]) -> int:
    """Try the defects named, or all; 1 if one is not caught."""
    chosen = [defect for defect in DEFECTS if not names or defect.name in names]
    unknown = set(names) - {defect.name for defect in chosen}
    if unknown:
        print(f"no defect {', '.join(sorted(unknown))}")
        return 1
    with tempfile.TemporaryDirectory() as place:
        tree = Path(shutil.copytree(ROOT, Path(place, "tree"), ignore=LEFT_OUT))
        fates = []
        for defect in chosen:
            fates.append(noticed(tree, defect))
            print(f"{defect.name}: {fates[-1]}", flush=True)
    return int(any(fate != "caught" for fate in fates))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
