"""Sound and defective codes by their CSV files, and the files of the command."""

import csv
import json
import math
import re
from dataclasses import replace

import defective
import numpy as np
import pytest

from fem_adhesion import cli
from fem_adhesion.benchmark import problems
from fem_adhesion.common import record
from fem_adhesion.common.page import data_rows
from fem_adhesion.registry import PARTS
from halfspace import atlas

HEADER = ("problem", "quantity", "value")


def of_problem(tabor, values):
    return [(f"half-space-{tabor:g}", name, value) for name, value in values.items()]


@pytest.fixture
def judged(tmp_path, capsys):
    def judge(rows, header=HEADER, options=()):
        their, out = tmp_path / "their.csv", tmp_path / "out.json"
        with their.open("w", newline="") as file:
            csv.writer(file).writerows([header, *rows])
        code = cli.main(["benchmark", str(their), "--json", str(out), *options])
        found = json.loads(out.read_text())
        assert code == (found["cause"] != "sound")
        return found | {"printed": capsys.readouterr().out}

    return judge


def central_gaps(tabor, sign):
    states = defective.events(tabor).items()
    return defective.numbers({name: replace(state, approach=sign * state.central_gap) for name, state in states})


def distances(tabor):
    gaps = {f"{name}_central_gap": float(1 + state.central_gap) for name, state in defective.events(tabor).items()}
    return defective.true(tabor) | gaps


def scaled_loads(tabor, factor):
    states = defective.events(tabor).items()
    return defective.numbers({name: replace(state, load=factor * state.load) for name, state in states})


def torn(tabor):
    states = defective.events(tabor)
    return defective.numbers(states | {"jump_off": states["pull_off"]})


# Cause, tabor, what such a code gives, digits written. No constant of the causes was taken from these sizes.
DEFECTS = [
    ("domain-too-small", 0.803, lambda mu: defective.clamped(mu, 55.0), 4),
    ("domain-too-small", 0.426, lambda mu: defective.clamped(mu, 50.8), 7),
    ("grid-too-coarse", 1.697, lambda mu: defective.coarse(mu, 0.17), 4),
    ("grid-too-coarse", 2.319, lambda mu: defective.coarse(mu, 0.105), 8),
    ("factor-2-pi-r", 0.2, lambda mu: scaled_loads(mu, 1 / (2 * math.pi)), 3),
    ("factor-2-pi-r", 6.0, lambda mu: scaled_loads(mu, 1 / math.pi), 7),
    ("modulus-e-for-e-star", 0.107, lambda mu: defective.mistaken(mu, modulus=2 * (1 - 0.21**2)), 8),
    ("modulus-e-for-e-star", 3.3, lambda mu: defective.mistaken(mu, modulus=1 - 0.4**2), 4),
    ("factor-2-gamma", 0.25, lambda mu: defective.mistaken(mu, work=0.5), 4),
    ("factor-2-gamma", 2.7, lambda mu: defective.mistaken(mu, work=2.0), 6),
    ("radius-of-one-body", 0.6, lambda mu: defective.mistaken(mu, radius=2.0), 3),
    ("radius-of-one-body", 4.5, lambda mu: defective.mistaken(mu, radius=2.0), 8),
    ("displacement-for-approach", 0.5, lambda mu: central_gaps(mu, -1), 5),
    ("displacement-for-approach", 5.328, lambda mu: central_gaps(mu, 1), 3),
    ("distance-for-gap", 0.9, distances, 5),
    ("distance-for-gap", 2.2, distances, 4),
    ("sign-of-loads", 0.5, lambda mu: scaled_loads(mu, -1.0), 6),
    ("sign-of-loads", 2.0, lambda mu: scaled_loads(mu, -1.0), 4),
    ("load-control-tear-off", 1.6, torn, 5),
    ("hertz-radius-in-jkr", 3.0, defective.hertz_radius, 5),
    ("jkr-for-intermediate", 0.8, defective.jkr, 4),
    ("jkr-for-intermediate", 3.5, defective.jkr, 7),
]


@pytest.mark.parametrize(("cause", "tabor", "code", "digits"), DEFECTS)
def test_a_defect_is_named(judged, cause, tabor, code, digits):
    found = judged(of_problem(tabor, defective.rounded(code(tabor), digits)))
    assert (found["cause"], found["alike"]) == (cause, [])
    assert found["remedy"] in " ".join(found["printed"].split())


def test_jumps_of_a_stepped_code_are_named(judged):
    tabor, step = 3.2, 0.11
    curve = defective.stepped(tabor, step, start=0.37 * step)
    leaps = np.abs(np.diff(curve[:, 1]))
    half = len(curve) // 2
    on, off = int(np.argmax(leaps[: half - 1])) + 1, half + int(np.argmax(leaps[half:])) + 1
    least = int(np.argmin(curve[:, 1]))
    values = {name: value for name, value in defective.true(tabor).items() if "jump" not in name}
    values |= {"jump_on_approach": curve[on, 0], "jump_off_approach": curve[off, 0]}
    values |= {"pull_off_approach": curve[least, 0], "pull_off_load": curve[least, 1]}
    found = judged(of_problem(tabor, defective.rounded(values, 7)))
    assert (found["cause"], found["alike"]) == ("sampled-jumps", [])


@pytest.mark.parametrize("seed", range(8))
def test_sound_numbers_raise_no_alarm(judged, seed):
    digits, tabor = 3 + seed % 6, float(np.random.default_rng(seed).uniform(np.log(0.05), np.log(20)))
    tabor = round(math.exp(tabor), 3)
    noise = (0.0, 10.0**-digits)[seed % 2]  # rounded, or noise with all digits written
    found = judged(of_problem(tabor, defective.rounded(defective.true(tabor), 12 if noise else digits, noise, seed)))
    assert (found["cause"], found["alike"]) == ("sound", [])


def test_a_convention_of_loads_is_not_named_where_none_is_given(judged):
    values = {name: value for name, value in defective.true(0.7).items() if not name.endswith("_load")}
    found = judged(of_problem(0.7, defective.rounded(values, 6)))
    assert (found["cause"], found["alike"]) == ("sound", [])


def test_numbers_a_per_cent_off_are_not_sound(judged):
    found = judged(of_problem(0.5, defective.rounded(defective.true(0.5), 12, noise=0.01, seed=3)))
    assert found["cause"] == "cannot-tell"
    assert "sound" not in found["printed"]


@pytest.mark.parametrize(
    ("causes", "tabor", "values"),
    [
        ({"jkr-for-intermediate", "hertz-radius-in-jkr"}, 1.0, {"pull_off_load": f"{-1.5 * math.pi:.9f}"}),
        ({"factor-2-gamma", "radius-of-one-body"}, 0.3, {"pull_off_load": f"{atlas.pull_off(0.3).load * 2:.9f}"}),
        # Five numbers of three digits do not tell a box that yields too little from a load that ripples.
        ({"domain-too-small", "grid-too-coarse"}, 0.32, defective.rounded(defective.clamped(0.32, 55.4), 3)),
    ],
)
def test_causes_that_fit_alike_are_all_named(judged, causes, tabor, values):
    found = judged(of_problem(tabor, values))
    assert {found["cause"], *found["alike"]} == causes
    assert f"cause: {' or '.join([found['cause'], *found['alike']])}, which fit alike" in found["printed"]


def test_each_problem_has_a_cause_of_its_own(judged):
    rows = of_problem(0.5, defective.rounded(defective.true(0.5), 6))
    found = judged(rows + of_problem(2.0, defective.rounded(defective.coarse(2.0, 0.13), 6)))
    assert {name: own["cause"] for name, own in found["problems"].items()} == {
        "half-space-0.5": "sound",
        "half-space-2": "grid-too-coarse",
    }
    assert found["cause"] == "grid-too-coarse"
    assert "half-space-0.5 sound" in " ".join(found["printed"].split())


def test_numbers_in_si_are_read_in_their_units(judged):
    units = problems.named("half-space-2").units
    load = -defective.true(2.0)["pull_off_load"] * units.load
    found = judged([("half-space-2", "pull_off_load", -load * 1e9, "nN")], header=(*HEADER, "unit"))
    assert found["rows"][0]["digits"] > 9


def followed(tabor):
    states = atlas.curve(tabor).states(300)
    return np.array([states.approach, states.load]).T


@pytest.mark.parametrize(
    ("cause", "code"), [("sound", followed), ("sampled-jumps", lambda mu: defective.stepped(mu, 0.05, start=0.015))]
)
def test_a_curve_has_its_events_read_off(judged, tmp_path, cause, code):
    rows = [("half-space-2", f"{at:.9f}", f"{load:.9f}") for at, load in code(2.0)]
    found = judged(rows, header=("problem", "approach", "load"), options=("--plot", str(tmp_path / "plot.png")))
    quantities = {row["quantity"] for row in found["rows"]}
    assert {"pull_off_load", "zero_load_approach", "jump_on_approach", "jump_off_approach"} <= quantities
    assert (found["cause"], found["alike"]) == (cause, [])
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")


def test_a_filled_template_agrees_with_its_sheets(judged, tmp_path):
    names = ["half-space-1", "dugdale-0.2-1"]
    assert cli.main(["benchmark", "--problems", str(tmp_path / "sheets"), "--names", *names]) == 0
    sheets = {name: (tmp_path / "sheets" / f"{name}.md").read_text() for name in names}
    ours = {name: dict(re.findall(r"\| (\w+) \| (-?[\d.]+) \|", sheet)) for name, sheet in sheets.items()}
    assert record.read(tmp_path / "sheets" / "numbers.csv")["command"].startswith("fem-adhesion benchmark --problems")
    with (tmp_path / "sheets" / "numbers.csv").open() as file:
        header, *rows = csv.reader(file)
    assert len(rows) == sum(map(len, ours.values()))
    left_empty = rows.pop()
    filled = [(problem, name, ours[problem][name], unit, "") for problem, name, _, unit, _ in rows]
    found = judged([*filled, left_empty], header=header)
    assert found["cause"] == "sound"
    assert all(row["verdict"] == "agrees" for row in found["rows"])
    assert "2.666666667 [(eps/h)^3 - (eps/h)^9]" in sheets["half-space-1"]
    assert "with w = 0.2" in sheets["dugdale-0.2-1"]


@pytest.mark.parametrize(("given", "words"), [("", "neither a CSV"), ("x.csv --problems sheets", "a CSV file and")])
def test_either_numbers_or_sheets_are_given(refused, given, words):
    refused("benchmark", given, words=words)


def test_each_body_and_law_that_has_a_name_has_a_statement(refused):
    stated = {row["name"] for row in data_rows("benchmark", "statements.csv")}
    assert stated == (PARTS["body"].keys() | PARTS["law"].keys()) - {"meshed", "tabulated", "layers"}
    words = "problem = 'layers-0.5-1', limit: a body or law"
    refused("benchmark", "--problems", "sheets", "--names", "layers-0.5-1", words=words)
