"""Every import goes down the floors of the house, and the half-space stands alone."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

FLOORS = [
    {"fem_adhesion.__main__"},
    {"fem_adhesion.cli"},
    {
        "fem_adhesion.commands.assess",
        "fem_adhesion.commands.compare",
        "fem_adhesion.commands.curve",
        "fem_adhesion.commands.finite_sphere",
        "fem_adhesion.commands.greenwood",
        "fem_adhesion.commands.hard",
        "fem_adhesion.commands.report",
        "fem_adhesion.commands.speed",
    },
    {"fem_adhesion.commands.contact"},
    {"fem_adhesion.commands.common"},
    {"fem_adhesion.output.report", "fem_adhesion.output.movie"},
    {"fem_adhesion.output.render"},
    {"fem_adhesion.output.solid_view"},
    {"fem_adhesion.output.cutaway"},
    {
        "fem_adhesion.output.plots",
        "fem_adhesion.output.vtk",
        "fem_adhesion.output.report_levels",
        "fem_adhesion.output.report_sections",
    },
    {"fem_adhesion.output.report_parts"},
    {"fem_adhesion.output.load_plots", "fem_adhesion.output.mesh_plots", "fem_adhesion.output.vtk_arrays"},
    {
        "fem_adhesion.output.assess_plot",
        "fem_adhesion.output.finite_sphere_report",
        "fem_adhesion.output.profile_plots",
        "fem_adhesion.output.curve_terminal",
        "fem_adhesion.output.curve_record",
    },
    {"fem_adhesion.output.curve_scales"},
    {
        "fem_adhesion.output.assess_report",
        "fem_adhesion.output.speed_report",
        "fem_adhesion.output.hard_report",
        "fem_adhesion.output.greenwood_report",
        "fem_adhesion.output.finite_sphere_findings",
    },
    {"fem_adhesion.output.finite_sphere_plots"},
    {"fem_adhesion.output.finite_sphere_words"},
    {
        "fem_adhesion.output.tables",
        "fem_adhesion.output.record",
        "fem_adhesion.output.curve_lines",
        "fem_adhesion.output.braille",
        "fem_adhesion.output.speed_plots",
        "fem_adhesion.output.greenwood_plots",
        "fem_adhesion.output.finite_sphere_tables",
    },
    {
        "fem_adhesion.output.files",
        "fem_adhesion.output.terminal",
        "fem_adhesion.output.report_figures",
        "fem_adhesion.output.lattice",
        "fem_adhesion.output.revolve",
        "fem_adhesion.output.greenwood_load_plots",
        "fem_adhesion.output.greenwood_state_plots",
        "fem_adhesion.output.greenwood_trend_plots",
        "fem_adhesion.output.greenwood_device_plots",
        "fem_adhesion.output.greenwood_tables",
        "fem_adhesion.output.finite_sphere_chart",
    },
    {
        "fem_adhesion.output.greenwood_plot",
        "fem_adhesion.output.greenwood_style",
        "fem_adhesion.output.greenwood_remarks",
    },
    {"fem_adhesion.output.greenwood_captions", "fem_adhesion.output.greenwood_trend_captions"},
    {"fem_adhesion.output.greenwood_text"},
    {"fem_adhesion.output.numbers", "fem_adhesion.output.facts", "fem_adhesion.output.page_tables"},
    {
        "fem_adhesion.studies.speed",
        "fem_adhesion.studies.hard_cases",
        "fem_adhesion.studies.greenwood1997",
        "fem_adhesion.studies.finite_sphere",
        "fem_adhesion.studies.assess",
        "fem_adhesion.studies.finite_sphere_points",
        "fem_adhesion.studies.finite_sphere_chart",
    },
    {"fem_adhesion.studies.finite_sphere_fit"},
    {
        "fem_adhesion.studies.greenwood_tables",
        "fem_adhesion.studies.finite_sphere_table",
        "fem_adhesion.studies.assess_verdict",
    },
    {"fem_adhesion.studies.crosscheck"},
    {
        "fem_adhesion.studies.from_scratch",
        "fem_adhesion.studies.speed_result",
        "fem_adhesion.studies.element_methods",
        "fem_adhesion.studies.halfspace_methods",
        "fem_adhesion.studies.greenwood_curves",
        "fem_adhesion.studies.greenwood_criteria",
        "fem_adhesion.studies.greenwood_devices",
        "fem_adhesion.studies.greenwood_relaxation",
        "fem_adhesion.studies.greenwood_ripple",
        "fem_adhesion.studies.hard_bodies",
        "fem_adhesion.studies.hard_contacts",
        "fem_adhesion.studies.hard_run",
        "fem_adhesion.studies.hard_spheres",
        "fem_adhesion.studies.finite_sphere_cases",
        "fem_adhesion.studies.assess_predictions",
    },
    {
        "fem_adhesion.studies.references",
        "fem_adhesion.studies.weak_bodies",
        "fem_adhesion.studies.methods",
        "fem_adhesion.studies.curves",
        "fem_adhesion.studies.machine",
        "fem_adhesion.studies.measured",
        "fem_adhesion.studies.fold_birth",
        "fem_adhesion.studies.finite_sphere_records",
        "fem_adhesion.studies.code_digest",
        "fem_adhesion.studies.parallel",
        "fem_adhesion.studies.store",
        "fem_adhesion.studies.materials",
        "fem_adhesion.studies.bulk",
        "fem_adhesion.studies.finite_sphere_terms",
        "fem_adhesion.studies.assess_contact",
        "fem_adhesion.studies.assess_theories",
    },
    {"fem_adhesion.studies.comparison", "fem_adhesion.studies.quantities"},
    {"fem_adhesion.studies.walk"},
    {"fem_adhesion.beside"},
    {"fem_adhesion.fields"},
    {"fem_adhesion.discretised"},
    {"fem_adhesion.convergence"},
    {"fem_adhesion.stress", "fem_adhesion.harmonics"},
    {"fem_adhesion.meshed", "fem_adhesion.finite_strain_scene"},
    {"fem_adhesion.finite_strain_meshes"},
    {"fem_adhesion.sized", "fem_adhesion.finite_strain_assembly"},
    {
        "fem_adhesion.pairs",
        "fem_adhesion.monolithic",
        "fem_adhesion.finite_strain",
    },
    {"fem_adhesion.incompressible", "fem_adhesion.finite_strain_solve", "fem_adhesion.finite_strain_traction"},
    {"fem_adhesion.condensed", "fem_adhesion.finite_strain_bodies", "fem_adhesion.finite_strain_surface"},
    {"fem_adhesion.far_field", "fem_adhesion.finite_strain_cells"},
    {"fem_adhesion.boundary"},
    {"fem_adhesion.held_sphere"},
    {"fem_adhesion.bodies"},
    {"fem_adhesion.nested"},
    {"fem_adhesion.elasticity", "fem_adhesion.neo_hookean"},
    {
        "fem_adhesion.mesh",
        "fem_adhesion.scene",
        "fem_adhesion.mesh_file",
        "fem_adhesion.curved",
        "fem_adhesion.refinement",
    },
    {"fem_adhesion.mesh_checks"},
    {"halfspace.accuracy"},
    {"halfspace.ladder", "halfspace.devices", "halfspace.sized"},
    {"halfspace.reach"},
    {"halfspace.curve"},
    {"halfspace.states"},
    {"halfspace.events"},
    {"halfspace.path", "halfspace.relaxation"},
    {"halfspace.newton"},
    {"halfspace.contact"},
    {"halfspace.breathing"},
    {"halfspace.compliance", "halfspace.dmt", "halfspace.maugis", "halfspace.criteria", "halfspace.sphere_theories"},
    {
        "halfspace.kernel",
        "halfspace.profiles",
        "halfspace.lennard_jones",
        "halfspace.limits",
        "halfspace.theories",
        "halfspace.scaling",
    },
    {"halfspace.grid"},
    {"halfspace.roots"},
    {"fem_adhesion.weak_form"},
    {"halfspace.errors", "halfspace.values", "fem_adhesion.writing"},
]
FLOOR_OF = {module: number for number, modules in enumerate(FLOORS) for module in modules}


def _modules():
    for package in ("halfspace", "fem_adhesion"):
        for path in (ROOT / package).rglob("*.py"):
            if path.name != "__init__.py":
                yield ".".join(path.relative_to(ROOT).with_suffix("").parts)


def _imports(module):
    tree = ast.parse((ROOT / Path(*module.split("."))).with_suffix(".py").read_text())
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("module", sorted(_modules()))
def test_imports_go_downwards(module):
    assert module in FLOOR_OF, "give the new module a floor"
    for imported in _imports(module):
        if imported in FLOOR_OF:
            assert FLOOR_OF[imported] > FLOOR_OF[module], f"{module} imports {imported}"


@pytest.mark.parametrize("module", sorted(m for m in _modules() if m.startswith("halfspace")))
def test_the_half_space_imports_nothing_but_numpy_and_scipy(module):
    outside = {name.split(".")[0] for name in _imports(module)} & {"skfem", "meshio", "rich", "fem_adhesion"}
    assert not outside


def test_the_fourth_level_imports_nothing_of_the_solvers_it_checks():
    own = {name for name in _imports("fem_adhesion.weak_form") if name.split(".")[0] in ("halfspace", "fem_adhesion")}
    plumbing = {"errors", "errors.NotConverged", "values", "values.Valued"}  # no physics, no numbers
    assert own == {f"halfspace.{name}" for name in plumbing}


def test_the_harmonics_import_nothing_of_the_finite_elements_they_check():
    own = {name for name in _imports("fem_adhesion.harmonics") if name.split(".")[0] in ("skfem", "fem_adhesion")}
    assert own == {"fem_adhesion.scene", "fem_adhesion.scene.Scene"}
