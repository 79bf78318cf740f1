"""Assessments: a contact that several files assess, a run of the command, text as it is shown, two models alike."""

import io
import json

import pytest
from rich.console import Console

from fem_adhesion import cli
from fem_adhesion.assess import study
from fem_adhesion.assess.predictions import QUANTITIES
from fem_adhesion.assess.study import assess

SILICA = {"radius": 100e-9, "modulus": 70e9, "poisson": 0.17, "work_of_adhesion": 0.1, "spacing": 0.3e-9}
LINE = "--radius 100nm --modulus 70GPa --poisson 0.17 --work-of-adhesion 0.1J/m^2 --spacing 0.3nm --stiffness 0.2N/m"


class Said:
    """What one run of the command computed, printed and wrote."""

    def __init__(self, line, folder):
        self.json, self.plot, found = folder / "a.json", folder / "a.svg", []
        with pytest.MonkeyPatch.context() as patch, io.StringIO() as out:
            patch.setattr(study, "assess", lambda *given: found.append(assess(*given)) or found[0])
            patch.setattr("sys.stdout", out)
            patch.delenv("COLUMNS", raising=False)
            assert cli.main(["assess", *line.split(), "--json", str(self.json), "--plot", str(self.plot)]) == 0
            self.text = out.getvalue()
        (self.assessment,) = found
        self.record = json.loads(self.json.read_text())
        self.drawn = self.plot.read_text()


def shown(part, width=150):
    """Text of a part on a terminal of a width."""
    console = Console(width=width, file=io.StringIO())
    console.print(part, crop=False)
    return console.file.getvalue()


def assert_alike(found, truth):
    """See that two models have all quantities, the same within the errors of both."""
    assert set(found) == set(truth) == set(QUANTITIES)
    for name, one in found.items():
        assert one.agrees(truth[name]), name
