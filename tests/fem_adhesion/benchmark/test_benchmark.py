"""Sound and defective codes by their CSV files, and the files of the command."""

import csv
import json
import math

import defective
import numpy as np
import pytest

from fem_adhesion import cli
from halfspace import atlas


def of_problem(tabor, values):
    return [(f"half-space-{tabor:g}", name, value) for name, value in values.items()]


@pytest.fixture
def judged(tmp_path, capsys):
    def judge(rows, header=("problem", "quantity", "value"), options=()):
        their, out = tmp_path / "their.csv", tmp_path / "out.json"
        with their.open("w", newline="") as file:
            csv.writer(file).writerows([header, *rows])
        code = cli.main(["benchmark", str(their), "--json", str(out), *options])
        found = json.loads(out.read_text())
        assert code == (found["cause"] != "sound")
        return found | {"printed": capsys.readouterr().out}

    return judge


def without(values, *words):
    return {name: value for name, value in values.items() if not any(word in name for word in words)}


def replaced(values, source, target):
    return values | {name.replace(source, target): v for name, v in values.items() if name.startswith(source)}


def central_gaps(tabor, sign):
    gaps = {"pull_off": atlas.pull_off(tabor), "zero_load": atlas.zero_load(tabor)}
    return defective.true(tabor) | {f"{name}_approach": sign * float(state.central_gap) for name, state in gaps.items()}


def scaled_loads(tabor, factor):
    return {name: v * (factor if "load" in name.split("_")[-1] else 1) for name, v in defective.true(tabor).items()}


DEFECTS = [  # cause, tabor, what such a code gives, digits written
    ("domain-too-small", 1.3, lambda mu: defective.clamped(mu, 24.0), 6),
    ("domain-too-small", 0.4, lambda mu: defective.clamped(mu, 40.0), 5),
    ("grid-too-coarse", 1.2, lambda mu: defective.coarse(mu, 0.35), 4),
    ("grid-too-coarse", 2.2, lambda mu: defective.coarse(mu, 0.12), 5),
    ("grid-too-coarse", 1.7, lambda mu: defective.coarse(mu, 0.25), 8),
    ("domain-too-small", 0.8, lambda mu: defective.clamped(mu, 80.0), 7),
    ("factor-2-pi-r", 0.2, lambda mu: scaled_loads(mu, 1 / (2 * math.pi)), 3),
    ("factor-2-pi-r", 6.0, lambda mu: scaled_loads(mu, 1 / math.pi), 7),
    ("modulus-e-for-e-star", 0.9, lambda mu: defective.mistaken(mu, modulus=1 - 0.3**2), 5),
    ("modulus-e-for-e-star", 3.3, lambda mu: defective.mistaken(mu, modulus=2 * (1 - 0.4**2)), 4),
    ("factor-2-gamma", 0.25, lambda mu: defective.mistaken(mu, work=0.5), 4),
    ("factor-2-gamma", 2.7, lambda mu: defective.mistaken(mu, work=2.0), 6),
    ("radius-of-one-body", 0.6, lambda mu: defective.mistaken(mu, radius=2.0), 3),
    ("radius-of-one-body", 4.5, lambda mu: defective.mistaken(mu, radius=2.0), 8),
    ("displacement-for-approach", 0.5, lambda mu: central_gaps(mu, -1), 5),
    (
        "displacement-for-approach",
        7.0,
        lambda mu: {n: -v if "approach" in n else v for n, v in defective.true(mu).items()},
        3,
    ),
    ("load-control-tear-off", 1.6, lambda mu: replaced(defective.true(mu), "pull_off", "jump_off"), 5),
    ("hertz-radius-in-jkr", 3.0, lambda mu: defective.hertz_radius(mu), 5),
    ("jkr-for-intermediate", 0.8, lambda mu: defective.jkr(mu), 4),
    ("jkr-for-intermediate", 3.5, lambda mu: defective.jkr(mu), 7),
]


@pytest.mark.parametrize(("cause", "tabor", "code", "digits"), DEFECTS)
def test_a_defect_is_named(judged, cause, tabor, code, digits):
    found = judged(of_problem(tabor, defective.rounded(code(tabor), digits)))
    assert (found["cause"], found["alike"]) == (cause, [])
    assert found["remedy"] in " ".join(found["printed"].split())


@pytest.mark.parametrize(("tabor", "step"), [(1.4, 0.06), (3.2, 0.11)])
def test_jumps_of_a_stepped_code_are_named(judged, tabor, step):
    curve = defective.stepped(tabor, step, start=0.37 * step)
    leaps = np.abs(np.diff(curve[:, 1]))
    half = len(curve) // 2
    on, off = int(np.argmax(leaps[: half - 1])) + 1, half + int(np.argmax(leaps[half:])) + 1
    values = without(defective.true(tabor), "jump") | {
        "jump_on_approach": curve[on, 0],
        "jump_off_approach": curve[off, 0],
    }
    least = int(np.argmin(curve[:, 1]))
    values |= {"pull_off_approach": curve[least, 0], "pull_off_load": curve[least, 1]}
    found = judged(of_problem(tabor, defective.rounded(values, 7)))
    assert (found["cause"], found["alike"]) == ("sampled-jumps", [])


@pytest.mark.parametrize("seed", range(20))
def test_sound_numbers_raise_no_alarm(judged, seed):
    digits, tabor = 3 + seed % 6, float(np.random.default_rng(seed).uniform(np.log(0.05), np.log(20)))
    tabor = round(math.exp(tabor), 3)
    noise = (0.0, 10.0**-digits)[seed % 2]  # rounded, or noise with all digits written
    found = judged(of_problem(tabor, defective.rounded(defective.true(tabor), 12 if noise else digits, noise, seed)))
    assert (found["cause"], found["alike"]) == ("sound", [])
