"""Every file of results says what it is: the contact, the command line, versions, units."""

import csv
import json

from fem_adhesion import cli
from fem_adhesion.common import page
from fem_adhesion.common.record import column, read
from fem_adhesion.registry import part_from
from halfspace.laws import Morse


def test_a_record_has_the_scene_and_the_units_of_its_numbers(tmp_path):
    file = tmp_path / "a.csv"
    assert cli.main(["curve", "--tabor", "0.3", "--law", "morse:3", "--rtol", "1e-2", "--csv", str(file)]) == 0
    found = read(file)
    assert part_from("law", found["scene"]["law"]) == Morse(3)
    with file.open() as lines:
        header = next(csv.reader(lines))
    assert {column(name, found["units"][name]) for name in ("approach", "load", "central_gap")} <= set(header)
    assert "load_error_R_dgamma" in header


def test_tables_of_a_directory_share_one_record(tmp_path):
    page.write_csv([page.Table("one", "", "", ["a"], [["1"]]), page.Table("two", "", "", ["b"], [["2"]])], tmp_path)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["csv-metadata.json", "one.csv", "two.csv"]
    assert read(tmp_path / "one.csv") == read(tmp_path / "two.csv") == read(tmp_path) != {}
    assert json.loads((tmp_path / "csv-metadata.json").read_text())["@context"] == "http://www.w3.org/ns/csvw"


def test_a_table_without_a_record_has_none(tmp_path):
    (tmp_path / "a.csv").write_text("x\n1\n")
    assert read(tmp_path / "a.csv") == {}
    (tmp_path / "csv-metadata.json").write_text("[1")
    assert read(tmp_path / "a.csv") == {}
