"""Every import goes down the floors of the house, and the half-space stands alone."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

FLOORS = [
    {"fem_adhesion.__main__"},
    {"fem_adhesion.cli"},
    {
        "fem_adhesion.assess.command",
        "fem_adhesion.crosscheck.command",
        "fem_adhesion.curve.command",
        "fem_adhesion.finite_sphere.command",
        "fem_adhesion.greenwood.command",
        "fem_adhesion.hard.command",
        "fem_adhesion.report.command",
        "fem_adhesion.speed.command",
    },
    {"fem_adhesion.common.scene_options"},
    {"fem_adhesion.common.options"},
    {"fem_adhesion.report.page", "fem_adhesion.curve.movie"},
    {"fem_adhesion.curve.still"},
    {"fem_adhesion.paraview.solid"},
    {"fem_adhesion.paraview.cutaway"},
    {
        "fem_adhesion.curve.figure",
        "fem_adhesion.paraview.write",
        "fem_adhesion.report.levels",
        "fem_adhesion.report.sections",
    },
    {"fem_adhesion.report.parts"},
    {"fem_adhesion.curve.load", "fem_adhesion.curve.mesh", "fem_adhesion.paraview.arrays"},
    {
        "fem_adhesion.assess.figure",
        "fem_adhesion.finite_sphere.page",
        "fem_adhesion.curve.profiles",
        "fem_adhesion.curve.terminal",
        "fem_adhesion.curve.record",
    },
    {"fem_adhesion.curve.scales"},
    {
        "fem_adhesion.assess.terminal",
        "fem_adhesion.speed.page",
        "fem_adhesion.hard.table",
        "fem_adhesion.greenwood.page",
        "fem_adhesion.finite_sphere.findings",
    },
    {"fem_adhesion.finite_sphere.figures"},
    {"fem_adhesion.finite_sphere.words"},
    {
        "fem_adhesion.crosscheck.table",
        "fem_adhesion.crosscheck.record",
        "fem_adhesion.curve.lines",
        "fem_adhesion.curve.braille",
        "fem_adhesion.speed.figures",
        "fem_adhesion.greenwood.figures",
        "fem_adhesion.finite_sphere.tables",
    },
    {
        "fem_adhesion.common.files",
        "fem_adhesion.common.terminal",
        "fem_adhesion.report.figures",
        "fem_adhesion.paraview.lattice",
        "fem_adhesion.paraview.revolve",
        "fem_adhesion.greenwood.load_figures",
        "fem_adhesion.greenwood.state_figures",
        "fem_adhesion.greenwood.trend_figures",
        "fem_adhesion.greenwood.device_figures",
        "fem_adhesion.greenwood.record",
        "fem_adhesion.finite_sphere.chart_figure",
    },
    {
        "fem_adhesion.greenwood.plot",
        "fem_adhesion.common.style",
        "fem_adhesion.greenwood.remarks",
    },
    {"fem_adhesion.greenwood.captions", "fem_adhesion.greenwood.trend_captions"},
    {"fem_adhesion.greenwood.text"},
    {"fem_adhesion.common.numbers", "fem_adhesion.common.facts", "fem_adhesion.common.page_tables"},
    {
        "fem_adhesion.speed.study",
        "fem_adhesion.hard.cases",
        "fem_adhesion.greenwood.study",
        "fem_adhesion.finite_sphere.study",
        "fem_adhesion.assess.study",
        "fem_adhesion.finite_sphere.points",
        "fem_adhesion.finite_sphere.chart",
    },
    {"fem_adhesion.finite_sphere.fit"},
    {
        "fem_adhesion.greenwood.tables",
        "fem_adhesion.finite_sphere.table",
        "fem_adhesion.assess.verdict",
    },
    {"fem_adhesion.crosscheck.study"},
    {
        "fem_adhesion.crosscheck.from_scratch",
        "fem_adhesion.speed.result",
        "fem_adhesion.speed.element_methods",
        "fem_adhesion.speed.halfspace_methods",
        "fem_adhesion.greenwood.curves",
        "fem_adhesion.greenwood.criteria",
        "fem_adhesion.greenwood.devices",
        "fem_adhesion.greenwood.relaxation",
        "fem_adhesion.greenwood.ripple",
        "fem_adhesion.hard.bodies",
        "fem_adhesion.hard.contacts",
        "fem_adhesion.hard.run",
        "fem_adhesion.hard.spheres",
        "fem_adhesion.finite_sphere.cases",
        "fem_adhesion.assess.predictions",
    },
    {
        "fem_adhesion.crosscheck.references",
        "fem_adhesion.crosscheck.weak_bodies",
        "fem_adhesion.speed.methods",
        "fem_adhesion.curve.solve",
        "fem_adhesion.common.machine",
        "fem_adhesion.common.measured",
        "halfspace.accuracy.fold_birth",
        "fem_adhesion.finite_sphere.records",
        "fem_adhesion.common.code_digest",
        "fem_adhesion.common.jobs",
        "fem_adhesion.common.store",
        "fem_adhesion.finite_sphere.materials",
        "fem_adhesion.finite_sphere.bulk",
        "fem_adhesion.finite_sphere.terms",
        "fem_adhesion.common.contact",
        "fem_adhesion.assess.theories",
    },
    {"fem_adhesion.crosscheck.comparison", "fem_adhesion.common.units"},
    {"fem_adhesion.report.walk"},
    {"fem_adhesion.fields.beside"},
    {"fem_adhesion.fields.state"},
    {"fem_adhesion.fields.discretise"},
    {"fem_adhesion.convergence"},
    {"fem_adhesion.elasticity.stress", "fem_adhesion.harmonics"},
    {"fem_adhesion.bodies.user_mesh", "fem_adhesion.finite_strain.scene"},
    {"fem_adhesion.finite_strain.meshes"},
    {"fem_adhesion.bodies.sized", "fem_adhesion.finite_strain.assembly"},
    {
        "fem_adhesion.bodies.pair",
        "fem_adhesion.monolithic",
        "fem_adhesion.finite_strain.problem",
    },
    {
        "fem_adhesion.elasticity.incompressible",
        "fem_adhesion.finite_strain.solve",
        "fem_adhesion.finite_strain.traction",
    },
    {"fem_adhesion.elasticity.condensation", "fem_adhesion.finite_strain.bodies", "fem_adhesion.finite_strain.surface"},
    {"fem_adhesion.elasticity.far_field", "fem_adhesion.finite_strain.cells"},
    {"fem_adhesion.elasticity.boundaries"},
    {"fem_adhesion.mesh.held_sphere"},
    {"fem_adhesion.mesh.spheres"},
    {"fem_adhesion.mesh.nested"},
    {"fem_adhesion.elasticity.space", "fem_adhesion.finite_strain.material"},
    {
        "fem_adhesion.mesh.block",
        "fem_adhesion.scene",
        "fem_adhesion.mesh.file",
        "fem_adhesion.mesh.curved",
        "fem_adhesion.mesh.refinement",
    },
    {"fem_adhesion.mesh.checks"},
    {"halfspace.accuracy.trace"},
    {"halfspace.accuracy.refinement", "halfspace.equilibrium.devices", "halfspace.accuracy.finite_bodies"},
    {"halfspace.equilibrium.reach"},
    {"halfspace.equilibrium.curve"},
    {"halfspace.equilibrium.states"},
    {"halfspace.equilibrium.events"},
    {"halfspace.equilibrium.path", "halfspace.equilibrium.relaxation"},
    {"halfspace.equilibrium.newton"},
    {"halfspace.equilibrium.contact"},
    {"halfspace.elastic.operators"},
    {
        "halfspace.elastic.compliance",
        "halfspace.theories.dmt",
        "halfspace.theories.maugis",
        "halfspace.theories.criteria",
        "halfspace.theories.exact_sphere",
    },
    {
        "halfspace.elastic.kernel",
        "halfspace.profiles",
        "halfspace.lennard_jones",
        "halfspace.limits",
        "halfspace.theories.closed_forms",
        "halfspace.scaling",
    },
    {"halfspace.elastic.grid"},
    {"halfspace.roots"},
    {"fem_adhesion.weak_form"},
    {"halfspace.errors", "halfspace.values", "fem_adhesion.common.writing"},
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
