"""``fem-adhesion curve``: what it prints and writes is what was computed, and nothing is left of what goes wrong."""

import argparse
import csv
import io
import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from page_tables import value_and_error
from rich.console import Console
from scenes import pair

from fem_adhesion import Hemisphere, cli
from fem_adhesion.common import lines as curve_lines
from fem_adhesion.common.facts import plain
from fem_adhesion.common.scene_options import law_of
from fem_adhesion.crosscheck import study as crosscheck
from fem_adhesion.curve import record as curve_record
from fem_adhesion.curve import solve as study
from fem_adhesion.curve import terminal as curve_terminal
from fem_adhesion.registry import part_from
from fem_adhesion.scene import Scene
from halfspace.equilibrium import devices
from halfspace.errors import InputError
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse
from halfspace.profiles import Paraboloid, Sphere
from halfspace.scaling import Units
from halfspace.values import Estimate

MATERIAL = "--radius 100nm --modulus 1GPa --poisson 0.3 --work-of-adhesion 50mJ/m^2 --spacing 0.3nm"
BY_HAMAKER = MATERIAL.replace("--spacing 0.3nm", "--hamaker 65zJ")
MORSE = "--law morse:3"
UNITS = Units(100e-9, 1.1e9, 0.05, 0.3e-9)
NUMBERS = ("approach", "load", "central_gap", "contact_radius")


@pytest.fixture(scope="module")
def both():
    return study.solve(study.Question(Scene(2.0), solver="both", rtol=1e-4, stiffness=1.0))


@pytest.fixture(scope="module")
def real():
    return study.solve(study.Question(Scene(UNITS.tabor), rtol=1e-4, units=UNITS, stiffness=0.2 / UNITS.stiffness))


def _rows(curves):
    """State, solver and numbers of each row; the table names the solver where there are two."""
    states, *others = (column.cells for column in curve_terminal.table(curves).columns)
    solver = [] if len(curves.paths) > 1 else [[curves.solver] * len(states)]
    return list(zip(states, *solver, *others, strict=True))


def _shown(what, width, *, terminal=True):
    console = Console(width=width, file=io.StringIO(), force_terminal=terminal, color_system=None, legacy_windows=False)
    curve_terminal.show(what, console)
    return console.file.getvalue()


def test_the_table_has_the_events_of_both_solvers(both):
    rows = _rows(both)
    for solver, path in both.paths.items():
        printed = {row[0]: row[2:] for row in rows if row[1] == solver}
        for name, event in path.events.items():
            for quantity, cell in zip(NUMBERS, printed[curve_terminal.EVENTS[name]], strict=True):
                value, error = getattr(event, quantity), getattr(event, f"{quantity}_error")
                if np.isnan(value):
                    assert cell == "-"
                elif (name, quantity) == ("zero_load", "load"):
                    assert cell == "0"
                else:
                    shown, bound = value_and_error(cell)
                    assert abs(shown - value) <= bound
                    assert error <= bound * (1 + 1e-9)


def test_table_and_notes_have_landings_and_losses(both):
    rows = {row[0]: row for row in _rows(both)}
    for device, cycle in (("fixed grips", both.grips), ("apparatus", both.apparatus)):
        shown, bound = value_and_error(rows[f"jump on lands, {device}"][3])
        assert abs(shown - cycle.jump_on.landing.load) <= bound
    for device, cycle in (("fixed grips", both.grips), ("k = 1 R dgamma/eps", both.apparatus)):
        lost = next(line for line in curve_terminal.notes(both) if device in line)
        shown, bound = value_and_error(lost.split()[-4])
        assert abs(shown - cycle.energy_lost.value) <= bound


def test_what_misses_its_tolerance_is_marked_where_it_stands(both):
    """In the table, its notes, the record and the table for machines, for a tolerance that half the numbers miss."""
    errors = [error for path in both.paths.values() for e in path.events.values() for error in relative_errors(e, path)]
    rtol = float(np.median(errors))
    paths = {name: replace(path, settings={**path.settings, "rtol": rtol}) for name, path in both.paths.items()}
    curves = replace(both, question=replace(both.question, rtol=rtol), paths=paths)
    rows, record, file = _rows(curves), curve_record.record(curves), io.StringIO()
    curve_record.write_csv(curves, file)
    lines = list(csv.DictReader(io.StringIO(file.getvalue())))
    notes, marked = list(curve_terminal.notes(curves)), 0
    for solver, path in paths.items():
        printed = {row[0]: row[2:] for row in rows if row[1] == solver}
        assert record["solutions"][solver]["met"] is path.met
        told = next(line for line in notes if line.startswith(solver))
        for name, event in path.events.items():
            missed = [
                n for n, error in zip(("approach", "load"), relative_errors(event, path), strict=False) if error > rtol
            ]
            cells = zip(NUMBERS, printed[curve_terminal.EVENTS[name]], strict=True)
            (line,) = (line for line in lines if (line["solver"], line["event"]) == (solver, name))
            assert [quantity for quantity, cell in cells if "*" in cell] == missed == line["missed_rtol"].split()
            assert record["solutions"][solver]["events"][name]["missed"] == missed
            assert (f"{name} {' and '.join(missed)}" in told) == bool(missed)
            marked += len(missed)
    assert 0 < marked < len(errors)
    assert any(line.startswith(f"*: the error is above rtol = {rtol:g}") for line in notes)
    assert not any("*" in line for line in (*curve_terminal.notes(both), *sum(_rows(both), ())))
    assert all(line.endswith("rtol 0.0001 met") for line in curve_terminal.notes(both) if "unknowns" in line)


def relative_errors(event, path):
    """Of approach and load, the latter unless it is zero by definition."""
    yield event.approach_error / path.approach_scale
    if event.name != "zero_load":
        yield event.load_error / abs(event.load)


@pytest.mark.parametrize(
    ("margin", "jumps", "said", "cycle", "verdict"),
    [
        (2e-4, False, "close to folding: it jumps with an apparatus of a compliance above {}", "no jumps", "disagree"),
        (2e-5, None, "whether it folds cannot be told, its margin being {} eps/(R dgamma)", "jumps", "inconclusive"),
        (-2e-4, True, "its folds are about to merge, by a margin of {} eps/(R dgamma)", "energy lost", "agree"),
    ],
)
def test_how_far_folds_are_is_said_and_doubt_disagrees_not(both, margin, jumps, said, cycle, verdict):
    """The half-space has its jumps, the finite elements those that the margin allows."""
    fe, hs = both.paths.values()
    events = {name: event for name, event in fe.events.items() if jumps or "jump" not in name}
    path = replace(fe, margin=Estimate(margin, 3e-5), events=events)
    assert path.jumps is jumps
    curves = replace(both, paths={"finite elements": path, "half-space": hs}, grips=devices.cycle(path))
    notes, record = list(curve_terminal.notes(curves)), curve_record.record(curves)["solutions"]
    assert any(said.format(f"{margin:g} +- 3e-05") in note for note in notes)
    assert notes[0].startswith(cycle)
    assert "fixed grips: " in notes[0]
    assert ("cannot be told" in notes[0]) == (jumps is None)
    assert record["finite elements"]["jumps"] is jumps
    assert record["finite elements"]["margin"] == vars(path.margin)
    assert record["half-space"]["margin"] is None
    assert {r.verdict for r in crosscheck._compare_events(hs, path, 1e-2) if "jump" in r.quantity} == {verdict}


def test_a_material_gives_si(real):
    table = curve_terminal.table(real)
    headers = ["approach\nnm", "load\nnN", "central gap\nnm", "contact radius\nnm"]
    assert [column.header for column in table.columns[-4:]] == headers
    pull_off, event = next(row for row in _rows(real) if row[0] == "pull-off"), real.path.event("pull_off")
    beta = (1e-14 * 0.05 / 1.1e9) ** (1 / 3) * 1e9
    wanted = event.approach * 0.3, event.load * 5, event.central_gap * 0.3, event.contact_radius * beta
    for cell, value in zip(pull_off[2:], wanted, strict=True):
        shown, bound = value_and_error(cell)
        assert abs(shown - value) <= bound
    assert f"Hamaker constant {16 * np.pi * 0.05 * 0.09e-18 * 1e21:.4g} zJ" in "".join(table.title)
    assert "k = 200 mN/m" in "".join(curve_terminal.notes(real))


PAPER = {"approach": "eps", "load": "R_dgamma", "central_gap": "eps", "contact_radius": "beta"}
SI = {
    "approach": ("m", UNITS.spacing),
    "load": ("N", UNITS.radius * UNITS.work_of_adhesion),
    "central_gap": ("m", UNITS.spacing),
    "contact_radius": ("m", np.cbrt(UNITS.radius**2 * UNITS.work_of_adhesion / UNITS.modulus)),
}


def test_each_column_of_the_csv_holds_what_its_name_says(real):
    """Values and errors of all events, in both units, and the states in the order of the curve."""
    file = io.StringIO()
    curve_record.write_csv(real, file)
    rows = list(csv.DictReader(io.StringIO(file.getvalue())))
    path = real.path
    assert np.all(np.diff([float(row["arclength"]) for row in rows]) >= 0)
    for name, event in path.events.items():
        (row,) = (row for row in rows if row["event"] == name)
        assert float(row["arclength"]) == path.stages[-1][name].point.arclength
        for quantity, unit in PAPER.items():
            for what in (quantity, f"{quantity}_error"):
                value, (si, size) = getattr(event, what), SI[quantity]
                if np.isnan(value):
                    assert row[f"{what}_{unit}"] == row[f"{what}_{si}"] == ""
                else:
                    assert float(row[f"{what}_{unit}"]) == value
                    assert float(row[f"{what}_{si}"]) == pytest.approx(value * size, rel=1e-12, abs=0)
        assert row["stable_under_fixed_grips"] == row["stable_under_dead_load"] == ""
    points = [row for row in rows if not row["event"]]
    for quantity, unit in PAPER.items():
        found = [float(row[f"{quantity}_{unit}"] or "nan") for row in points]
        np.testing.assert_array_equal(found, getattr(path, quantity))
        errors = [float(row[f"{quantity}_error_{unit}"] or "nan") for row in points]
        np.testing.assert_array_equal(errors, getattr(path, f"{quantity}_error"))
    np.testing.assert_array_equal([row["stable_under_fixed_grips"] == "1" for row in points], path.stable)
    dead = [row["stable_under_dead_load"] == "1" for row in points]
    np.testing.assert_array_equal(dead, path.stable_under_dead_load)
    assert {row["solver"] for row in rows} == {"half-space"}


def test_each_key_of_the_json_holds_what_it_says(both, real):
    record = json.loads(json.dumps(curve_record.record(both), allow_nan=False))
    for solver, path in both.paths.items():
        found = record["solutions"][solver]
        curve = {quantity: getattr(path, quantity) for quantity in ("arclength", *NUMBERS)}
        curve |= {"stable_under_fixed_grips": path.stable, "stable_under_dead_load": path.stable_under_dead_load}
        for key, values in curve.items():
            assert found["curve"][key] == plain(values)
        for name, event in path.events.items():
            numbers = {key: getattr(event, key) for one in NUMBERS for key in (one, f"{one}_error")}
            assert found["events"][name] == plain(numbers) | {"missed": []}
        assert found["energy_released"] == vars(path.energy)
        assert (found["unknowns"], found["seconds"]) == (path.unknowns, path.seconds)
    for device, cycle in (("fixed_grips", both.grips), ("apparatus", both.apparatus)):
        for name in ("jump_on", "jump_off"):
            shown, jump = record["jumps"][device][name], getattr(cycle, name)
            assert shown["take_off"]["load"] == jump.take_off.load
            assert shown["landing"]["load"] == jump.landing.load != jump.take_off.load
            assert shown["energy"] == vars(jump.energy)
        assert record["jumps"][device]["energy_lost"] == vars(cycle.energy_lost)
    stiffnesses = [record["jumps"][device]["stiffness"] for device in ("fixed_grips", "apparatus")]
    assert stiffnesses == [None, 1.0]
    assert (record["si"], record["units"]["load"], record["scene"]["tabor"]) == (None, "R dgamma", 2.0)
    si = curve_record.record(real)["si"]
    sizes = {name: (entry["unit"], entry["factor"]) for name, entry in si["units"].items()}
    for name, (unit, size) in SI.items():
        assert sizes[name] == (unit, pytest.approx(size, rel=1e-12, abs=0))
    work = UNITS.radius * UNITS.work_of_adhesion
    assert sizes["energy"] == ("J", pytest.approx(work * UNITS.spacing, rel=1e-12, abs=0))
    assert sizes["stiffness"] == ("N/m", pytest.approx(work / UNITS.spacing))
    assert si["material"] == {"radius": 1e-7, "modulus": 1.1e9, "work_of_adhesion": 0.05, "spacing": 3e-10}


@pytest.mark.parametrize("width", [150, 45])
def test_numbers_are_whole_and_the_plot_fits_at_any_width(both, real, width):
    assert "│" not in _shown(both, width, terminal=False).split("In brackets")[1], "a pipe gets no plot"
    for what in (both, real):
        text = _shown(what, width)
        assert "…" not in text
        assert max(map(len, text.splitlines())) <= width
        numbers = re.findall(r"-?[\d.]+\(\d+\)", text)
        assert set(numbers) <= set(re.findall(r"-?[\d.]+\(\d+\)", _shown(what, 150)))
        assert len(numbers) >= 2 * len(_rows(what)) - 2  # approach and load are never left out, 0 has no error
        drawn = [line for line in text.splitlines() if "│" in line and "┃" not in line and line.index("│") == 9]
        assert len(drawn) == curve_terminal.USUAL.lines
        assert {len(line) for line in drawn} == {min(width, curve_terminal.USUAL.columns + 10)}


def test_axes_in_characters_are_load_up_and_approach_right(real):
    """The figures at the ends of the axes, which the names stand beside, against the data."""
    lines = curve_terminal.plot(real).plain.split("\n")
    frame = curve_lines.around_events(real.path)
    assert lines[0] == "load, nN"
    assert float(lines[1].split("│")[0]) == pytest.approx(frame.load[1] * 5, rel=6e-3)
    assert float(lines[curve_terminal.USUAL.lines].split("│")[0]) == pytest.approx(frame.load[0] * 5, rel=6e-3)
    low, name, unit, high = lines[-1].split()
    assert (name, unit) == ("approach,", "nm")
    assert float(low) == pytest.approx(frame.approach[0] * 0.3, rel=6e-3)
    assert float(high) == pytest.approx(frame.approach[1] * 0.3, rel=6e-3)
    assert frame.approach != frame.load


def test_the_plot_in_characters_has_the_events_where_they_are(both):
    drawn = curve_terminal.plot(both).plain.split("\n")[1 : curve_terminal.USUAL.lines + 1]
    place = {letter: (drawn.index(line), line.index(letter)) for line in drawn for letter in "APCZBD" if letter in line}
    assert set(place) == set("APCZBD")
    assert place["A"][1] == place["B"][1]
    assert place["C"][1] == place["D"][1]
    assert place["Z"][0] < place["A"][0] < place["C"][0] < place["P"][0]
    assert place["C"][1] < place["A"][1] < place["P"][1] < place["Z"][1]


@pytest.mark.parametrize(
    ("word", "law"),
    [
        ("morse:0.1nm", Morse(3)),
        ("exponential:100pm,9", Exponential(3)),
        ("dlvo:-0.5,1nm", Dlvo(-0.5, 0.3)),
        ("dugdale:0.06nm", Dugdale(0.2)),
        ("morse:3", Morse(3)),
    ],
)
def test_lengths_of_a_law_are_read_in_si_beside_a_spacing(word, law):
    options = argparse.Namespace(law=word, spacing="0.3nm")
    found, H = law_of(options), np.array([-0.05, 0.0, 0.3, 3.0])
    assert type(found) is type(law)
    np.testing.assert_allclose(found.pressure(H, 1.0), law.pressure(H, 1.0), rtol=1e-12)
    for spacing, said in ((None, "plain number, in"), ("0.3+-0.1nm", "limit: no deviation")):
        options.spacing = spacing
        if "nm" in word or "pm" in word:
            with pytest.raises(InputError, match=said):
                law_of(options)


@pytest.mark.parametrize("law", ["", MORSE])
def test_hamaker_constant_and_edge_are_told_by_the_law(law, capsys):
    assert cli.main(f"curve {MATERIAL} {law} --rtol 1e-2".split()) == 0
    told = capsys.readouterr().out
    assert ("Hamaker constant" in told) == (not law)
    assert f"where the gap is {1 + np.log(2) / 3 if law else 3 ** (1 / 6):.6g} eps" in " ".join(told.split())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("", "neither --tabor nor a material"),
        ("--tabor 0", "tabor = 0 is outside 0 < tabor"),
        ("--tabor 2 --radius 100nm", "give either --tabor or a material"),
        (f"{MATERIAL} --hamaker 65zJ", "--spacing and --hamaker are given"),
        (f"{MATERIAL} --counter half-space", "--counter would have no effect, limit: with --tabor"),
        (f"{MATERIAL} --counter-modulus 1GPa", "counter_poisson = None"),
        (f"{MATERIAL} --body held-sphere --counter-radius 1um", "a hemisphere meets another or a half-space"),
        ("--tabor 2 --body half-space:sliding", "limit: half-space; leave out sliding"),
        ("--tabor 2 --poisson 0.2", "--poisson would have no effect, limit: with a material, fem or both"),
        ("--tabor 2 --counter-poisson 0.2", "--counter-poisson would have no effect, limit: with --counter"),
        ("--tabor 2 --body hemisphere:9 --counter half-space", "share"),
        ("--tabor 2 --points 5", "--points would have no effect, limit: with --json, --csv"),
        ("--tabor 2 --revolve 90 --force", "--revolve, --force would have no effect"),
        ("--tabor 2 --json - --csv -", "standard output is given for two outputs"),
        ("--tabor 2 --stiffness 1N/m", "not a plain number in R dgamma/eps"),
        ("--tabor 2 --plot a.gif", "ends in '.gif', limit: one of .png, .svg, .pdf"),
        ("--tabor 2 --profile sphere", "limit: sphere:radius_ratio,counter_radius; give radius_ratio, R/eps"),
        ("--tabor 2 --body drum:3", "body = drum, limit: one of half-space, block, hemisphere"),
        (
            f"{MATERIAL} --spacing 1m --body hemisphere",
            "1e12; it is the radius over the spacing: change one of the two",
        ),
        ("--tabor 2 --law morse:3,4", "law = morse:3,4, limit: morse:k; leave out 4"),
        ("--tabor 2 --law morse:3nm", "k = 3nm, limit: a plain number, in 1/eps; give one"),
        (f"{BY_HAMAKER} {MORSE}", "--hamaker would have no effect, limit: the 3-9 law"),
        ("--tabor 2 --solver half-space --body hemisphere:99", "take fem or both"),
        ("--tabor 2 --to-load 0", "to_load = 0"),
        ("--tabor 2 --vtk fields --solver half-space", "take --solver fem"),
        ("--tabor 2 --vtk fields --points -1", "points = -1"),
        ("--tabor 2 --vtk .", "--force"),
        (f"{MATERIAL} --body hemisphere:100", "limit: hemisphere:sliding|bonded; leave out 100"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_any_work(arguments, message, monkeypatch, tmp_path, refused):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "precious").write_text("kept")
    monkeypatch.setattr(study, "trace", lambda *_: pytest.fail("work was begun"))
    refused("curve", arguments, words=message)
    assert [file.name for file in tmp_path.iterdir()] == ["precious"]


def _asked(monkeypatch, words):
    """The question that is made of a command line."""
    asked = []
    monkeypatch.setattr(study, "solve", lambda question, _: asked.append(question) or pytest.skip.Exception)
    with pytest.raises(AttributeError):
        cli.main(["curve", *words.split()])
    return asked[0]


def test_the_material_gives_the_size_of_the_sphere(monkeypatch):
    question = _asked(monkeypatch, f"{MATERIAL} --body hemisphere:bonded --profile sphere --stiffness 0.2N/m")
    assert question.solver == "fem"
    assert question.scene.radius_ratio == pytest.approx(100 / 0.3)
    assert question.scene.tabor == pytest.approx(question.units.tabor)
    assert question.scene.body.grip == "bonded"
    assert question.scene.counter is None
    assert question.stiffness == pytest.approx(0.2 / question.units.stiffness)


def test_the_counter_body_of_a_material_is_heeded(monkeypatch):
    """In the units of two half-spaces, and as a body of its own against a hemisphere."""
    given = f"{MATERIAL} --counter-modulus 3GPa --counter-poisson 0.4 --counter-radius 300nm"
    flat = _asked(monkeypatch, given)
    modulus = 1 / ((1 - 0.3**2) / 1e9 + (1 - 0.4**2) / 3e9)
    assert flat.units.modulus == pytest.approx(modulus, rel=1e-12)
    assert flat.units.radius == pytest.approx(75e-9, rel=1e-12)
    assert flat.scene.counter is None
    on_half_space = _asked(monkeypatch, f"{given} --profile sphere").scene
    assert on_half_space.shape.radius_ratio == flat.units.radius_ratio
    assert on_half_space.shape.counter_radius == pytest.approx(3.0, rel=1e-12)
    round_ = _asked(monkeypatch, f"{given} --body hemisphere:bonded --profile sphere")
    assert (round_.scene.body.grip, round_.scene.counter.grip) == ("bonded", "bonded")
    assert round_.units == flat.units
    assert round_.scene.poisson == 0.3
    assert round_.scene.share == pytest.approx(modulus * (1 - 0.4**2) / 3e9, rel=1e-12)
    assert round_.scene.counter.material.poisson == 0.4
    assert round_.scene.counter.size / round_.scene.body.size == pytest.approx(3.0, rel=1e-12)


@pytest.mark.parametrize(
    ("radius", "recorded"),
    [(math.inf, {"name": "half-space"}), (2.0, {"name": "hemisphere", "radius_ratio": 270.0, "grip": "sliding"})],
)
def test_the_counter_body_is_in_title_and_record(both, radius, recorded):
    """JSON has no number for the radius of a flat one."""
    scene = pair(2.0, 90.0, 0.4, 0.2, radius)
    solved = replace(both, question=replace(both.question, scene=scene))
    found = json.loads(json.dumps(curve_record.record(solved), allow_nan=False))["scene"]
    material = {"name": "linear-elastic", "poisson": 0.2, "traction": "projected"}
    assert found["counter"] == recorded | {"material": material}
    assert found["share"] == 0.4
    assert part_from("body", found["body"]) == scene.body
    assert part_from("body", found["counter"]) == scene.counter
    assert f"counter-body with 0.4 of the compliance, radius {radius:g}" in _shown(solved, 150)


def test_the_counter_body_of_a_tabor_parameter_is_heeded(monkeypatch):
    body = "--tabor 1 --body hemisphere:90"
    plain = _asked(monkeypatch, body).scene
    assert plain == Scene(1.0, Hemisphere(radius_ratio=90.0))
    assert _asked(monkeypatch, f"{body} --counter half-space --share 0.4").scene == pair(1.0, 90.0, 0.4)
    words = "--counter hemisphere:200,bonded --share 0.4 --counter-poisson 0.2"
    found = _asked(monkeypatch, f"{body} {words}").scene
    assert found == replace(plain, counter=Hemisphere(radius_ratio=200.0, grip="bonded", poisson=0.2), share=0.4)


def test_the_other_solver_of_a_true_sphere_has_its_profile(monkeypatch):
    asked = {}
    monkeypatch.setattr(study.halfspace, "trace", lambda **scene: asked.update(scene))
    scene = Scene(2.0, Hemisphere(radius_ratio=100))
    study.trace(study.Question(scene, solver="both"), study.HALF_SPACE)
    assert asked["profile"] == Sphere(100)
    study.trace(study.Question(pair(2.0, 100.0, 0.5, 0.3, 2.0), solver="both"), study.HALF_SPACE)
    assert asked["profile"].counter_radius == 2.0
    assert asked["profile"].radius_ratio == pytest.approx(100, rel=1e-14)
    study.trace(study.Question(replace(scene, profile=Paraboloid()), solver="both"), study.HALF_SPACE)
    assert asked["profile"] == Paraboloid()
