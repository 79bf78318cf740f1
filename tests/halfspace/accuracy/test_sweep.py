"""Many curves as arrays, and as a table of the command line that goes on where it was interrupted."""

import csv
import io
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import halfspace
from fem_adhesion import cli
from fem_adhesion.common.files import open_store
from fem_adhesion.common.jobs import WorkerDied
from fem_adhesion.sweep import study
from halfspace import atlas
from halfspace.accuracy import sweep as sweeping
from halfspace.accuracy.sweep import NUMBERS, UNKNOWN, Summary, summary
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError, NotConverged
from halfspace.laws import LENNARD_JONES, Morse
from halfspace.values import Estimate

TABORS = (2.0, 0.3, 1.0)  # of which the second does not fold
RTOL = 1e-3


class _Doubled(halfspace.laws.PowerLaw):
    """A law of twice the work of adhesion that it is told to have."""

    @property
    def amplitude(self):
        return 2 * super().amplitude


ENERGIES = ("energy", "energy_lost")
UNITS = {"approach": "eps", "load": "R_dgamma", "central_gap": "eps", "contact_radius": "beta"}
ASKED = {"rtol": RTOL, "to_load": 5.0, "law": LENNARD_JONES}


@pytest.fixture(scope="module")
def found():
    return halfspace.sweep(TABORS, rtol=RTOL)


def test_arrays_hold_the_curves_in_the_order_asked(found):
    assert found.tabor.tolist() == list(TABORS)
    for i, tabor in enumerate(TABORS):
        path = halfspace.trace(tabor, rtol=RTOL)
        assert (found.energy[i], found.energy_error[i]) == (path.energy.value, path.energy.error)
        for name, series in found.events.items():
            event = path.event(name)
            for number in NUMBERS:
                expected = getattr(event, number) if event else np.nan
                np.testing.assert_equal(getattr(series, number)[i], expected)
        both = cycle(path)
        lost = both.energy_lost if both else Estimate(0.0, 0.0)
        assert (found.energy_lost[i], found.energy_lost_error[i]) == (lost.value, lost.error)
        assert found.met[i] == path.met
    assert not found.reasons


def test_a_pool_of_processes_finds_the_same(found):
    with ProcessPoolExecutor(2) as pool:
        assert halfspace.sweep(TABORS, rtol=RTOL, map=pool.map) == found


def test_a_loss_that_cannot_be_told_is_not_told():
    near = halfspace.sweep(0.697214614, rtol=RTOL)
    assert np.isnan(near.energy_lost).all()
    assert np.isfinite(near.energy).all()


def test_a_curve_that_cannot_be_traced_leaves_the_others(monkeypatch, found):
    trace = sweeping.trace

    def failing(tabor, **settings):
        if tabor == 0.3:
            raise NotConverged("it ends here; take another")
        return trace(tabor, **settings)

    monkeypatch.setattr(sweeping, "trace", failing)
    rest = halfspace.sweep(TABORS, rtol=RTOL)
    assert rest.reasons == {0.3: "it ends here; take another"}
    assert rest.met.tolist() == [True, False, True]
    assert np.isnan(rest.energy).tolist() == [False, True, False]
    np.testing.assert_array_equal(rest.events["pull_off"].load[[0, 2]], found.events["pull_off"].load[[0, 2]])


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ({"tabors": [1.0, 400.0]}, "outside"),
        ({"tabors": [1.0], "rtol": 1.0}, "outside"),
        ({"tabors": [1.0], "to_load": -1}, "outside"),
        ({"tabors": [1.6], "law": _Doubled()}, "the energy at H = 0 is -2"),
    ],
)
def test_what_is_out_of_range_is_refused_before_any_work(monkeypatch, asked, why):
    monkeypatch.setattr(sweeping, "trace", lambda *_, **__: pytest.fail("it has begun"))
    with pytest.raises(InputError, match=why):
        halfspace.sweep(**asked)


# --- the command ---


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_the_table_has_the_numbers_of_the_sweep(capsys, found):
    assert cli.main(["sweep", "--tabor", *map(str, TABORS), "--rtol", str(RTOL), "--csv", "-", "--jobs", "1"]) == 0
    out = capsys.readouterr()
    rows = rows_of(out.out)
    assert "3 of 3 curves known, 3 of them from halfspace.atlas, 2 fold, 3 as accurate as asked, rtol 0.001" in out.err
    for i, row in enumerate(rows):
        assert float(row["tabor"]) == TABORS[i]
        assert row["source"] == "atlas"
        energies = (Estimate(float(row[f"{e}_R_dgamma_eps"]), float(row[f"{e}_error_R_dgamma_eps"])) for e in ENERGIES)
        for number, name in zip(energies, ENERGIES, strict=True):
            assert number.agrees(Estimate(getattr(found, name)[i], getattr(found, f"{name}_error")[i]))
        for name, series in found.events.items():
            for number, unit in UNITS.items():
                texts = [row[f"{name}_{column}_{unit}"] for column in (number, f"{number}_error")]
                known = Estimate(getattr(series, number)[i], getattr(series, f"{number}_error")[i])
                assert (texts == ["", ""]) == bool(np.isnan(known.value))
                assert texts == ["", ""] or Estimate(*map(float, texts)).agrees(known)


def test_what_the_atlas_lacks_is_solved(capsys):
    """Beyond it, and where it cannot tell whether a curve folds: the solver's own numbers."""
    tabors = (0.005, atlas.birth_of_folds().value, 2.0)
    assert cli.main(["sweep", "--tabor", *map(repr, tabors), "--rtol", "1e-3", "--csv", "-", "--jobs", "1"]) == 0
    out = capsys.readouterr()
    assert "1 of them from halfspace.atlas" in out.err
    assert study.by_atlas([2.0], 1e-12, LENNARD_JONES) == {}
    rows, found = rows_of(out.out), halfspace.sweep(tabors, rtol=RTOL)
    assert [row["source"] for row in rows] == ["solver", "solver", "atlas"]
    for i, row in enumerate(rows[:2]):
        assert float(row["energy_R_dgamma_eps"]) == found.energy[i]
        for name, series in found.events.items():
            for number, unit in UNITS.items():
                for column in (number, f"{number}_error"):
                    told, value = row[f"{name}_{column}_{unit}"], getattr(series, column)[i]
                    assert told == ("" if np.isnan(value) else repr(float(value)))


def test_the_law_reaches_every_curve(capsys):
    assert cli.main(f"sweep --tabor 1 --law morse:3 --rtol {RTOL} --csv - --jobs 1".split()) == 0
    (row,) = rows_of(capsys.readouterr().out)
    path = halfspace.trace(1.0, law=Morse(3.0), rtol=RTOL)
    assert float(row["pull_off_load_R_dgamma"]) == path.event("pull_off").load


@pytest.mark.parametrize(
    ("text", "values"), [("0.05:50:4", [0.05, 0.5, 5.0, 50.0]), ("3:1:2", [3.0, 1.0]), ("2", [2.0])]
)
def test_a_range_is_of_equal_ratios_with_both_ends(text, values):
    from fem_adhesion.sweep.command import tabors_of

    assert tabors_of([text]) == pytest.approx(values, rel=1e-12, abs=0)
    assert tabors_of([text, text]) == tabors_of([text])


@pytest.mark.parametrize("text", ["1:2", "1:2:x", "0:1:5", "1:2:1", "1:1:3", "400", "1:inf:5", "1:2:99999999999"])
def test_what_is_no_tabor_parameter_is_refused_in_one_line(refused, tmp_path, text):
    refused(f"sweep --tabor={text} --csv", tmp_path / "table.csv", words="; ")
    assert not (tmp_path / "table.csv").exists()


def counted(tabor, **asked):
    counted.calls.append(tabor)
    return summary(tabor, **asked)


counted.calls = []


def test_what_is_kept_is_not_traced_again(tmp_path):
    store = open_store(tmp_path / "kept", "code", resume=True)
    first = study.run(TABORS[:2], ASKED, store, jobs=1, work=counted)
    again = study.run(TABORS, ASKED, open_store(tmp_path / "kept", "code", resume=True), jobs=1, work=counted)
    assert counted.calls == list(TABORS)
    assert repr(again[:2]) == repr(first)  # nan is not equal to itself
    other = open_store(tmp_path / "kept", "other code", resume=True)
    study.run(TABORS[:1], ASKED, other, jobs=1, work=counted)
    assert counted.calls == [*TABORS, TABORS[0]]
    assert list(other.notes) == ["1 case computed by other code: computed again"]
    for number, other_asked in enumerate(({"rtol": RTOL / 2}, {"to_load": 4.0}, {"law": Morse(3.0)})):
        study.run(TABORS[1:2], ASKED | other_asked, store, jobs=1, work=counted)
        assert len(counted.calls) == 5 + number


def test_what_missed_its_tolerance_survives_the_disk(tmp_path):
    store = open_store(tmp_path / "kept", "code", resume=True)
    missed = Summary(1.0, {}, UNKNOWN, UNKNOWN, {"jump_on": ("approach", "load")}, "")
    (kept,) = study.run([1.0], ASKED, store, jobs=1, work=lambda *_, **__: missed)
    (again,) = study.run([1.0], ASKED, store, jobs=1, work=counted)
    assert again.missed == kept.missed == {"jump_on": ("approach", "load")}


def test_a_curve_whose_worker_died_is_tried_again(monkeypatch, tmp_path):
    store = open_store(tmp_path / "kept", "code", resume=True)
    monkeypatch.setattr(
        "fem_adhesion.common.jobs.stream", lambda *_, **__: (item for item in [(1.0, WorkerDied("killed"))])
    )
    (died,) = study.run([1.0], ASKED, store)
    assert died == Summary(1.0, {}, UNKNOWN, UNKNOWN, {}, "killed")
    assert not list((tmp_path / "kept").rglob("*.json"))


def test_the_exit_code_says_that_a_curve_is_missing(monkeypatch, capsys, tmp_path):
    lost = Summary(0.002, {}, UNKNOWN, UNKNOWN, {}, "it ends here")
    monkeypatch.setattr(study, "run", lambda *_, **__: [lost])
    table = tmp_path / "table.csv"
    assert cli.main(["sweep", "--tabor", "0.002", "--csv", str(table)]) == 1
    out = capsys.readouterr()
    assert out.err == "fem-adhesion: tabor 0.002: it ends here\n"
    assert out.out.startswith("0 of 1 curves known, none from halfspace.atlas")
    (row,) = rows_of(table.read_text())
    assert (row["tabor"], row["reason"], row["pull_off_load_R_dgamma"]) == ("0.002", "it ends here", "")
