"""The glossary: what commands print is in it, one entry or all are printed, and every command's help names it."""

import argparse
import re

import pytest
from whole_runs import ROOT

from fem_adhesion import cli
from fem_adhesion.assess import predictions, study
from fem_adhesion.common.lines import KINDS
from fem_adhesion.crosscheck.comparison import VERDICTS
from fem_adhesion.report.page import LEVELS


def printed(capsys, *words):
    """What is printed of some words."""
    assert cli.main(["words", *words]) == 0
    return capsys.readouterr().out


def test_every_model_verdict_and_level_is_explained(capsys):
    said = " ".join(printed(capsys).replace("`", "").split())
    models = {*study.THEORIES, study.HALF_SPACE, study.PROFILE, study.FINITE, study.PAIR, study.GIVEN, study.MESH}
    models |= {predictions.ON_LAYER, predictions.ATTRACTING}
    levels = {level.rstrip(":") for level in LEVELS if level} - {"length"}  # it is said as law and profile are
    states = {kind.partition(" ")[2] or kind for kind in KINDS.values()}
    for word in (*models, *VERDICTS, *levels, *states):
        assert re.search(rf"\b{re.escape(word)}\b", said), word


@pytest.mark.parametrize("width", ["40", "80", "120"])
def test_an_entry_is_whole_at_any_width(width, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", width)
    said = printed(capsys, "Budget")
    assert " ".join(said.split()) == "budget largest error with which a comparison still means something."
    assert all(len(line) <= int(width) for line in said.splitlines())


def test_a_word_that_is_not_explained_is_refused(refused):
    refused("words", "flux", "capacitor")


def test_every_help_names_the_glossary_and_the_page_shows_it():
    (commands,) = (a for a in cli.make_parser()._actions if isinstance(a, argparse._SubParsersAction))
    assert all("fem-adhesionwords" in "".join(one.format_help().split()) for one in commands.choices.values())
    assert "fem_adhesion/words/data/glossary.md" in (ROOT / "docs/reference/units.md").read_text()
