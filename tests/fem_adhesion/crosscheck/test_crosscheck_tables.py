"""Made-up results whose values all differ go through every table and record and are read back by their labels."""

import json
import re
from dataclasses import replace

import pytest
from made_up import AGREE, DISAGREE, ENDINGS, FAILED, MISSING, NUMBERS, WIDE, case
from page_tables import value_and_error

from fem_adhesion import cli
from fem_adhesion.crosscheck import scenes as beside
from fem_adhesion.crosscheck.comparison import columns, crosscheck_record, crosscheck_tables
from fem_adhesion.report.page import LEVELS, crosscheck_section, settings_section, verdict_words
from halfspace.values import Estimate


def require_line_of(row, cells):
    """The numbers of a line under their headers: errors rounded up, values to their last digit."""
    assert (cells["quantity"], cells["verdict"]) == (f"{row.quantity} in {row.unit}", row.verdict)
    for source, made in zip(row.between, (row.first, row.second), strict=True):
        value, error = value_and_error(cells[source])
        last = 10.0 ** -len(re.split(r"[.(]", cells[source])[1])
        assert abs(value - made.value) <= last / 2 * (1 + 1e-9)
        assert made.error * (1 - 1e-9) <= error <= made.error + last
    for name in ("difference", "budget"):
        assert float(cells[name]) == pytest.approx(getattr(row, name), rel=0.05)


def row_as_made(row):
    own = {name: getattr(row, name) for name in ("quantity", "unit", "difference", "budget", "verdict")}
    own |= {"first": row.first.value, "second": row.second.value}
    return own | {"first_error": row.first.error, "second_error": row.second.error}


MISSED = "jump_off approach, zero_load approach"  # by the first of the made-up paths
MISSED_BY_ALL = ", ".join(f"{name} approach" for name in ("pull_off", "jump_on", "jump_off", "zero_load"))


def test_each_column_of_the_table_holds_what_its_header_says():
    made = case(AGREE, DISAGREE, WIDE)
    (table,) = crosscheck_tables(made)
    headers = [column.header.replace("\n", " ") for column in table.columns]
    assert headers == list(columns())
    lines = zip(*(column.cells for column in table.columns), strict=True)
    for line, row in zip(lines, made.rows, strict=True):
        require_line_of(row, dict(zip(headers, line, strict=True)))
    ours, theirs = f"rtol 3.7e-06 not met by {MISSED}", f"rtol 3.7e-06 not met by {MISSED_BY_ALL}"
    assert list(table.caption) == [
        f"half-space 111 unknowns, 7.50 s, {ours}",
        f"finite elements 222 unknowns, 9.25 s, {theirs}",
    ]


def test_a_value_that_is_not_found_is_no_number():
    (table,) = crosscheck_tables(case(MISSING))
    (line,) = zip(*(column.cells for column in table.columns), strict=True)
    cells = dict(zip(columns(), line, strict=True))
    assert (cells["half-space"], cells["finite elements"], cells["difference"]) == ("-2.25000(1)", "none", "-")
    assert cells["verdict"] == "disagree"


def test_each_key_of_the_record_holds_what_it_says():
    made = case(AGREE, DISAGREE, WIDE, MISSING)
    record = json.loads(json.dumps(crosscheck_record([made, FAILED]), allow_nan=False))
    solved, failed = record["cases"]
    for read, row in zip(solved["comparison"], made.rows[:3], strict=False):
        error = read.pop("error")
        assert read.pop("between") == ["half-space", "finite elements"]
        assert error == row.first.error + row.second.error
        assert read == row_as_made(row)
    missing = solved["comparison"][3]
    assert (missing["first"], missing["second"], missing["error"]) == (-2.25, None, None)
    hs, fe = made.solutions.values()
    for key, path, first in (("halfspace", hs, 100.0), ("finite_element", fe, 200.0)):
        assert (solved[key]["unknowns"], solved[key]["seconds"]) == (path["unknowns"], path["seconds"])
        assert solved[key]["settings"] == path["settings"]
        assert solved[key]["rtol"] == 3.7e-6
        assert solved[key]["missed"] == {name: list(numbers) for name, numbers in path["missed"].items()}
        assert set(solved[key]["events"]) == {"pull_off", "jump_on", "jump_off", "zero_load"}
        for place, name in enumerate(("pull_off", "jump_on", "jump_off")):
            event = solved[key]["events"][name]
            assert [event[number] for number in NUMBERS] == [first + 10 * place + k + 0.5 for k in range(4)]
            assert event["approach_error"] == pytest.approx((first + 10 * place) * 1e-6)
            assert event["load_error"] == pytest.approx((first + 10 * place + 1) * 1e-6)
    assert (solved["tabor"], solved["verdict"]) == (2.0, "disagree")
    assert (failed["tabor"], failed["verdict"], failed["reason"]) == (3.0, "failed", FAILED.reason)
    assert failed["comparison"][0]["first"] == 0.5
    assert record["verdict"] == "failed"


def tables_of(section):
    """Tables of a section, each a list of lines: cells by the headers."""
    return [[dict(zip(table.columns, line, strict=True)) for line in table.rows] for table in section.tables]


def test_the_reports_levels_hold_values_under_their_headers():
    section = crosscheck_section([case(AGREE, DISAGREE), FAILED])
    summary, lost, operators, *others, events = tables_of(section)
    assert others == [[]] * (len(LEVELS) - 2)
    assert lost == [{"Tabor parameter": "3", "reason": FAILED.reason}]
    for line, row, tabor in zip([*operators, *events], (WIDE, AGREE, DISAGREE), ("3", "2", "2"), strict=True):
        assert line["Tabor parameter"] == tabor
        require_line_of(row, line)
    of_events = next(line for line in summary if line["level"] == "The events")
    counts = {name: of_events[name] for name in ("quantities", "agree", "inconclusive", "disagree")}
    assert counts == {"quantities": "2", "agree": "1", "inconclusive": "0", "disagree": "1"}
    assert float(of_events["largest difference / error"]) == pytest.approx(0.25 / 4e-4, rel=0.05)
    assert float(of_events["largest error / budget"]) == pytest.approx(7e-3 / 7.5e-2, rel=0.05)
    of_operators = next(line for line in summary if line["level"].startswith("Both elastic"))
    assert (of_operators["agree"], of_operators["inconclusive"]) == ("0", "1")
    assert "Tabor parameter 2: disagree; Tabor parameter 3: failed." in section.paragraphs[1]


def test_a_difference_without_an_error_is_in_the_summary():
    certain = replace(DISAGREE, first=Estimate(1.0, 0.0), second=Estimate(2.0, 0.0), difference=1.0)
    summary = tables_of(crosscheck_section([case(certain)]))[0]
    assert summary[-1]["largest difference / error"] == "inf"
    (missing,) = (line for line in tables_of(crosscheck_section([case(MISSING)]))[0][-1:])
    assert (missing["disagree"], missing["largest difference / error"]) == ("1", "none")


# --- the verdict, wherever it is told ---


def test_settings_and_costs_stand_beside_their_solver():
    section = settings_section([case(AGREE)], {"processor": "abacus"})
    versions, settings = tables_of(section)
    assert {"what": "processor", "which": "abacus"} in versions
    halfspace, elements = settings
    assert (halfspace["solver"], halfspace["unknowns"], halfspace["seconds"]) == ("half-space", "111", "7.50")
    assert (elements["solver"], elements["unknowns"], elements["seconds"]) == ("finite elements", "222", "9.25")
    assert halfspace["settings"] == "rtol 3.7e-06, degree 112, panels (edge 113)"
    assert halfspace["tolerance"] == f"rtol 3.7e-06 not met by {MISSED}"
    assert elements["tolerance"] == f"rtol 3.7e-06 not met by {MISSED_BY_ALL}"


CODES = {"agree": 0, "inconclusive": 1, "disagree": 1, "failed": 1}


@pytest.mark.parametrize("verdict", ENDINGS)
def test_compare_tells_the_verdict_in_text_record_and_exit_code(verdict, tmp_path, monkeypatch, capsys):
    cases = ENDINGS[verdict]
    monkeypatch.setattr(beside, "run", lambda *_, **__: cases)
    tabors = [f"{case.scene.tabor:g}" for case in cases]
    assert cli.main(["compare", "--tabor", *tabors, "--json", str(tmp_path / "a.json")]) == CODES[verdict]
    shown = capsys.readouterr().out
    assert shown.startswith(f"verdict: {verdict}\n")
    for one in cases:
        assert re.search(rf"^tabor {one.scene.tabor:g}[,;] poisson 0\.3: {one.verdict}\b", shown, re.M)
    record = json.loads((tmp_path / "a.json").read_text())
    assert record["verdict"] == verdict
    assert [one["verdict"] for one in record["cases"]][-1] == verdict


def test_mixed_verdicts_are_told_worst_first():
    cases = [case(AGREE, tabor=0.5), case(DISAGREE, tabor=1.0), FAILED, case(WIDE, tabor=5.0), case(AGREE, tabor=4.0)]
    order = "failed at .* 3.* disagree at .* 1.* too wide to tell .* 5.* agree at .* 0.5, 4"
    assert re.search(order, verdict_words(cases))
    assert not re.search("agree", verdict_words([FAILED]))
