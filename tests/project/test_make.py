"""Every target of the Makefile does what `make help` says, in the environment that the tests run in.

No target installs anything here: the stamps that say that the environment is complete are given.
"""

import re
import subprocess

import pytest
from families import FAMILIES
from page_tables import value_and_error
from whole_runs import ROOT, tables_in

MAKEFILE_AT = ROOT / "Makefile"
MAKEFILE = MAKEFILE_AT.read_text()

# How each target is run; `test` is what runs this, `check` is run beside it, and `clean` works on a copy.
COMPARE = "make compare"
HARD = "make hard OUT=hard"
TARGETS = {
    "help": "make help",
    "compare": COMPARE,
    "test": "make --dry-run test",
    "check": "make --dry-run check",
    "bench": "make bench QUICK=1",
    "honesty": "make honesty QUICK=1 SEED=77",  # a new seed each time finds what is not known yet: no test's verdict
    "hard": HARD,  # test_hard reads what it writes
    "atlas": "make atlas CHECK=2",
    "peers": "make --dry-run peers",  # it takes packages from an index, and minutes: test_peers reads what it wrote
    "docs": "make docs OUT=docs",  # test_docs reads what it builds
    "gallery": "make --dry-run gallery",  # test_docs knows whether there is something to draw
    "clean": "make clean",
}


@pytest.fixture(scope="module")
def made(whole):
    return lambda target: whole(TARGETS[target])


def test_help_lists_the_targets_with_what_they_do(made):
    run = made("help")
    assert run.code == 0
    listed = dict(line.split(maxsplit=1) for line in run.out.splitlines())
    assert listed.keys() == TARGETS.keys()
    assert listed["check"] == "check format, style and types"


def test_compare_prints_six_tables_and_agrees(made):
    run = made("compare")
    assert run.code == 0, run.err
    titles = [line.strip() for line in run.out.splitlines() if line.startswith("tabor")]
    assert titles == [f"tabor {tabor}; poisson 0.3: agree" for tabor in ("0.05", "0.5", "1", "2", "3", "5")]
    assert run.out.splitlines()[1] == "verdict: agree"  # after the command that make prints
    for table in tables_in(run.out):
        for row in table:
            assert row["verdict"] == "agree"
            error = sum(found[1] for cell in row.values() if (found := value_and_error(cell)))
            assert float(row["difference"]) <= error * 1.1  # two digits are printed


def test_bench_times_every_solver_beside_the_yardstick(made):
    run = made("bench")
    assert run.code == 0, run.out + run.err
    (section,) = re.findall(r"medians, in seconds and in yardsticks.*?\n(.*?)\n\n", run.out, re.S)
    lines = [re.fullmatch(r"(\S+) +([\d.]+) s +(\d+)", line).groups() for line in section.splitlines()]
    medians = {name.split("[")[0]: (float(seconds), int(yardsticks)) for name, seconds, yardsticks in lines}
    assert medians.keys() >= {"test_halfspace_trace", "test_finite_element_trace"}
    assert medians["test_yardstick_dgesv_of_200"][1] == 1
    for seconds, yardsticks in medians.values():
        assert seconds > 0
        assert yardsticks >= 1
    assert re.search(r"peak memory of one process: \d+ MiB", run.out)


def test_atlas_is_as_close_to_its_source_as_it_says(made):
    run = made("atlas")
    assert run.code == 0, run.out + run.err
    shares = re.findall(r"^\S+\.load +\S+ +\S+ +([\d.]+) ", run.out, re.M)
    assert shares
    assert all(float(share) <= 1 for share in shares)


def test_honesty_judges_every_family(made):
    run = made("honesty")
    assert run.code == 0, run.out + run.err
    judged = dict(re.findall(r"^(\S.*?) +(\d+) +[\d.]+% .*\d$", run.out, re.M))
    assert judged.keys() == {name for name, family in FAMILIES.items() if family.quick.scenes}
    assert all(int(count) >= 8 for count in judged.values())  # those of a curve without folds


def test_clean_removes_what_was_made_and_nothing_else(tmp_path):
    (tmp_path / "Makefile").write_text(MAKEFILE)
    for name in (".venv/bin", "build/lib", "fem_adhesion.egg-info", ".mypy_cache", "halfspace", "meshes"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "file").touch()
    subprocess.run(["make", "clean"], cwd=tmp_path, check=True, capture_output=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["Makefile", "halfspace", "meshes"]
