"""The digest of the code that computes a result: it follows every module that runs, and none that does not."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from fem_adhesion.common import facts
from fem_adhesion.common.facts import code_digest, sources

CASES = "fem_adhesion.finite_sphere.cases"
ROOT = Path(__file__).parents[2]


def digest_in(tree):
    """Digest of the code in a copy of the sources, by a fresh interpreter; and whether NumPy was loaded for it."""
    code = (
        f"import sys; from fem_adhesion.common.facts import code_digest; print(code_digest({CASES!r}), "
        "'numpy' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(tree)},
        cwd=tree,
        capture_output=True,
        text=True,
        check=True,
    )
    digest, heavy = done.stdout.split()
    return digest, heavy == "True"


@pytest.fixture
def tree(tmp_path):
    """Copy of the sources of both packages."""
    for package in ("fem_adhesion", "halfspace"):
        for file in (ROOT / package).rglob("*.py"):
            copy = tmp_path / file.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(file.read_bytes())
    return tmp_path


def test_it_is_the_same_elsewhere_and_changes_with_the_code_that_computes_alone(tree):
    known = code_digest(CASES)
    assert digest_in(tree) == (known, False), "nothing heavy is loaded"
    for name, counts in (
        ("fem_adhesion/finite_sphere/page.py", False),
        ("halfspace/elastic/kernel.py", True),
        ("fem_adhesion/finite_strain/body.py", True),  # through three others
        ("fem_adhesion/convergence.py", True),  # through __getattr__ of the package
    ):
        file, before = tree / name, (tree / name).read_text()
        file.write_text(f"{before}# edited\n")
        assert (digest_in(tree)[0] != known) == counts, name
        file.write_text(before)


def test_it_knows_every_module_that_a_case_loads():
    code = (
        "import sys, halfspace, fem_adhesion\n"
        "from fem_adhesion.finite_sphere.cases import compute, case_of\n"
        "for name in ('half_space', 'sphere'):\n"
        "    compute(case_of(name, 0.3, 100.0, 0.3, 1e-2))\n"
        "print(sorted(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {name for name in ast.literal_eval(done.stdout) if name.split(".")[0] in ("halfspace", "fem_adhesion")}
    kept = {f"fem_adhesion.common.{name}" for name in ("jobs", "facts", "files", "numbers")} | {"fem_adhesion.common"}
    assert loaded - kept <= set(sources(CASES))


@pytest.mark.parametrize("library", ["numpy", "scipy", "scikit-fem"])
def test_it_changes_with_the_version_of_a_library(library, monkeypatch):
    before, real = code_digest(CASES), facts.version
    monkeypatch.setattr(facts, "version", lambda name: "9" if name == library else real(name))
    code_digest.cache_clear()
    changed = code_digest(CASES)
    monkeypatch.undo()
    code_digest.cache_clear()
    assert changed != before
    assert code_digest(CASES) == before
