"""Many curves as arrays, and as a table of the command line that goes on where it was interrupted."""

import csv
import io
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np
import pytest

import halfspace
from fem_adhesion import cli
from fem_adhesion.common.files import open_store
from fem_adhesion.common.jobs import WorkerDied
from fem_adhesion.sweep import study
from halfspace.accuracy import following
from halfspace.accuracy import sweep as sweeping
from halfspace.accuracy.following import RATIO, UNKNOWN, Known, Summary, families
from halfspace.accuracy.sweep import NUMBERS, summaries
from halfspace.equilibrium.devices import cycle
from halfspace.errors import InputError, NotConverged
from halfspace.laws import LENNARD_JONES, Dlvo, Dugdale, Morse

TABORS = (2.0, 0.3, 1.0)  # of which the second does not fold
RTOL = 1e-3


@dataclass(frozen=True)
class _Doubled(halfspace.laws.PowerLaw):
    """A law of twice the work of adhesion that it is told to have."""

    def pressure(self, gap, tabor):
        return 2 * super().pressure(gap, tabor)

    def slope(self, gap, tabor):
        return 2 * super().slope(gap, tabor)

    def energy(self, gap, tabor):
        return 2 * super().energy(gap, tabor)


ASKED = {"rtol": RTOL, "to_load": 5.0, "law": LENNARD_JONES}


@pytest.fixture(scope="module")
def found():
    return halfspace.sweep(TABORS, rtol=RTOL)


def test_the_arrays_hold_the_numbers_of_each_curve_in_the_order_asked(found):
    assert found.tabor.tolist() == list(TABORS)
    for i, tabor in enumerate(TABORS):
        path = halfspace.trace(tabor, rtol=RTOL)
        assert (found.energy[i], found.energy_error[i]) == (path.energy.value, path.energy.error)
        for name, series in found.events.items():
            event = path.event(name)
            for number in NUMBERS:
                expected = getattr(event, number) if event else np.nan
                np.testing.assert_equal(getattr(series, number)[i], expected)
        lost = cycle(path)
        assert found.energy_lost[i] == (lost.energy_lost.value if lost else 0.0)
        assert found.energy_lost_error[i] == (lost.energy_lost.error if lost else 0.0)
        assert found.met[i] == path.met
    assert not found.reasons


def test_a_pool_of_processes_finds_the_same(found):
    with ProcessPoolExecutor(2) as pool:
        assert halfspace.sweep(TABORS, rtol=RTOL, map=pool.map) == found


def test_parts_of_the_contact_reach_every_curve(found):
    other = halfspace.sweep([1.0], rtol=RTOL, profile=halfspace.profiles.Power(4), to_load=3.0)
    assert (
        other.events["pull_off"].load[0]
        == halfspace.trace(1.0, rtol=RTOL, profile=halfspace.profiles.Power(4), to_load=3.0).event("pull_off").load
    )
    assert abs(other.events["pull_off"].load[0] - found.events["pull_off"].load[2]) > 0.1


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
        ({"tabors": [1.6, 1.7, 1.8, 1.9], "law": _Doubled()}, "the energy at H = 0 is -2"),
    ],
)
def test_what_is_out_of_range_is_refused_before_any_work(monkeypatch, asked, why):
    for name in ("trace", "curves"):
        monkeypatch.setattr(sweeping, name, lambda *_, **__: pytest.fail("it has begun"))
    with pytest.raises(InputError, match=why):
        halfspace.sweep(**asked)


# --- neighbours ---


def family(first, last, count):
    """Tabor parameters between two that share their grids."""
    (tabors,) = families(np.geomspace(first, last, count).tolist(), LENNARD_JONES, halfspace.profiles.PARABOLOID, None)
    return tabors


def numbers_of(swept, i):
    """All numbers of a curve of a sweep, and their errors, by name."""
    of_events = {
        (name, number): (getattr(series, number)[i], getattr(series, f"{number}_error")[i])
        for name, series in swept.events.items()
        for number in study.UNITS
    }
    lost = {("energy", "lost"): (swept.energy_lost[i], swept.energy_lost_error[i])}
    return of_events | lost | {("energy", ""): (swept.energy[i], swept.energy_error[i])}


@pytest.fixture
def traced(monkeypatch):
    """Tabor parameters that are traced among neighbours, in turn."""
    found = []
    trace = following.Family.traced

    def counting(self, tabor):
        found.append(tabor)
        return trace(self, tabor)

    monkeypatch.setattr(following.Family, "traced", counting)
    return found


@pytest.mark.parametrize(
    ("between", "expected"),
    [
        pytest.param((1.55, 2.2), 3, id="nothing but the ends and the middle"),
        pytest.param((0.675, 0.9), 5, id="around the birth of the jumps"),
        pytest.param((3.5, 5.0), 5, id="around the birth of the next folds"),
        pytest.param((0.06, 0.08), 3, id="nearly rigid"),
        pytest.param((26.0, 38.0), 3, id="soft"),
    ],
)
def test_what_is_followed_is_what_would_be_traced(between, expected, traced):
    tabors = family(*between, 7)
    swept = halfspace.sweep(tabors, rtol=1e-5)
    assert len(traced) == expected
    assert swept.met.all()
    off = []
    for i, tabor in enumerate(tabors):
        path = halfspace.trace(tabor, rtol=1e-7)
        lost = cycle(path)
        true = {(name, number): event.estimate(number) for name, event in path.events.items() for number in study.UNITS}
        true |= {
            ("energy", ""): path.energy,
            ("energy", "lost"): lost.energy_lost if lost else halfspace.Estimate(0, 0),
        }
        for name, (value, error) in numbers_of(swept, i).items():
            assert np.isnan(value) == (name not in true or np.isnan(true[name].value)), name
            if not np.isnan(value):
                off.append(abs(value - true[name].value) / max(error + true[name].error, 1e-300))  # no loss: 0 +- 0
    assert np.mean(np.array(off) > 1) < 0.02
    assert max(off) < 3


def test_numbers_do_not_depend_on_which_neighbours_they_are_followed_from(traced):
    many = family(1.55, 2.2, 9)
    whole, part = halfspace.sweep(many, rtol=1e-5), halfspace.sweep(many[2:7], rtol=1e-5)
    assert traced == [many[0], many[4], many[8], many[2], many[4], many[6]]
    for i in range(5):
        for name, (value, error) in numbers_of(part, i).items():
            other, other_error = numbers_of(whole, i + 2)[name]
            assert value == pytest.approx(other, rel=1e-9, abs=1e-9, nan_ok=True), name
            assert error == pytest.approx(other_error, rel=1e-2, abs=2e-10, nan_ok=True), name


def test_what_is_not_where_it_is_expected_is_traced(monkeypatch, traced):
    tabors = family(1.55, 2.2, 5)
    followed = halfspace.sweep(tabors, rtol=RTOL)
    assert len(traced) == 3
    monkeypatch.setattr(following, "OFF", 0.0)
    again = halfspace.sweep(tabors, rtol=RTOL)
    assert sorted(traced[3:]) == list(tabors)
    for name, series in again.events.items():
        np.testing.assert_allclose(series.approach, followed.events[name].approach, rtol=1e-9, atol=1e-9)


def test_between_curves_of_which_one_cannot_be_traced_all_are_and_it_is_by_itself(monkeypatch, traced):
    tabors = family(1.55, 2.2, 5)
    climb = following.climb

    def failing(rtol, rung, **settings):
        if len(traced) == 1:
            raise NotConverged("it ends here; take another")
        return climb(rtol, rung, **settings)

    monkeypatch.setattr(following, "climb", failing)
    swept = halfspace.sweep(tabors, rtol=RTOL)
    assert len(traced) == 4  # the last is followed
    assert not swept.reasons
    assert swept.energy[0] == halfspace.trace(tabors[0], rtol=RTOL).energy.value

    def ending(*_, **__):
        raise NotConverged("it ends here; take another")

    monkeypatch.setattr(sweeping, "trace", ending)
    monkeypatch.setattr(following.Family, "traced", lambda _, tabor: Known(Summary.failed(tabor, "on these grids")))
    assert halfspace.sweep(tabors, rtol=RTOL).reasons == dict.fromkeys(tabors, "it ends here; take another")


def test_families_are_near_neighbours_on_the_same_grids_the_largest_first():
    tabors = np.geomspace(0.05, 50, 200).tolist()
    found = families(tabors[::-1], LENNARD_JONES, halfspace.profiles.PARABOLOID, None)
    assert sorted(tabor for part in found for tabor in part) == tabors
    assert found == sorted(found, reverse=True)
    assert all(part[-1] / part[0] <= RATIO for part in found)
    assert max(map(len, found)) > 10


def test_many_of_a_family_are_cut_for_many_cores_and_keep_its_grids():
    tabors = np.geomspace(1.55, 2.2, 40).tolist()
    parts = families(tabors, LENNARD_JONES, halfspace.profiles.PARABOLOID, None)
    assert [len(part) for part in parts] == [14, 13, 13]
    assert sorted(tabor for part in parts for tabor in part) == tabors
    settings = {"law": LENNARD_JONES, "profile": halfspace.profiles.PARABOLOID, "rtol": 1e-6, "to_load": 10.0}
    (grids,) = {(one.least, one.largest) for part in parts for one in [following.family_of(part, **settings)]}
    assert grids[0] < tabors[0] < tabors[-1] < grids[1]


@pytest.mark.parametrize(
    "parts",
    [
        {"profile": halfspace.profiles.Sphere(100.0)},
        {"body": halfspace.Layer(1.0)},
        {"law": Dlvo(0.6, 1.5)},
        {"law": Dugdale(0.1)},
        {"tabors": (1.6, 1.9)},
    ],
    ids=["a sphere", "a layer", "a second minimum", "a step", "two alone"],
)
def test_what_is_not_alike_is_traced_by_itself(parts):
    usual = {"tabors": (1.6, 1.8, 2.0), "law": LENNARD_JONES, "profile": halfspace.profiles.PARABOLOID, "body": None}
    assert set(map(len, families(**(usual | parts)))) == {1}


# --- the command ---


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_the_table_has_the_numbers_of_the_sweep(capsys, found):
    assert cli.main(["sweep", "--tabor", *map(str, TABORS), "--rtol", str(RTOL), "--csv", "-", "--jobs", "1"]) == 0
    out = capsys.readouterr()
    rows = rows_of(out.out)
    assert "3 of 3 curves solved, 2 fold, 3 as accurate as asked, rtol 0.001; written: -" in out.err
    for i, row in enumerate(rows):
        assert float(row["tabor"]) == TABORS[i]
        assert float(row["energy_R_dgamma_eps"]) == found.energy[i]
        assert float(row["energy_lost_error_R_dgamma_eps"]) == found.energy_lost_error[i]
        for name, series in found.events.items():
            for number, unit in study.UNITS.items():
                for column, values in ((number, number), (f"{number}_error", f"{number}_error")):
                    told, value = row[f"{name}_{column}_{unit}"], getattr(series, values)[i]
                    assert told == ("" if np.isnan(value) else repr(float(value)))


def test_the_law_reaches_every_curve(capsys):
    words = ["--law", "morse", "--law-parameter", "3", "--rtol", str(RTOL), "--csv", "-", "--jobs", "1"]
    assert cli.main(["sweep", "--tabor", "1", *words]) == 0
    (row,) = rows_of(capsys.readouterr().out)
    path = halfspace.trace(1.0, law=halfspace.laws.Morse(3.0), rtol=RTOL)
    assert float(row["pull_off_load_R_dgamma"]) == path.event("pull_off").load


@pytest.mark.parametrize(
    ("text", "values"),
    [("0.05:50:4", [0.05, 0.5, 5.0, 50.0]), ("3:1:2", [3.0, 1.0]), ("2", [2.0])],
)
def test_a_range_is_of_equal_ratios_with_both_ends(text, values):
    from fem_adhesion.sweep.command import tabors_of

    assert tabors_of([text]) == pytest.approx(values, rel=1e-12, abs=0)
    assert tabors_of([text, text]) == tabors_of([text])


@pytest.mark.parametrize("text", ["1:2", "a", "1:2:x", "0:1:5", "-1:2:5", "1:2:1", "1:2:3:4", "400", "nan", "1:inf:5"])
def test_what_is_no_tabor_parameter_is_refused_in_one_line(capsys, tmp_path, text):
    table = tmp_path / "table.csv"
    assert cli.main(["sweep", f"--tabor={text}", "--csv", str(table)]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert "; " in err
    assert not table.exists()


def test_a_range_of_more_parameters_than_a_table_is_for_is_refused(capsys, tmp_path):
    assert cli.main(["sweep", "--tabor", "1:2:99999999999", "--csv", str(tmp_path / "table.csv")]) == 2
    assert "COUNT 2 to 100000; write 0.05:50:200, say\n" in capsys.readouterr().err


def counted(tabors, **asked):
    counted.calls.extend(tabors)
    return summaries(tabors, **asked)


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
    assert other.notes == ("1 case computed by other code: computed again",)
    for number, other_asked in enumerate(({"rtol": RTOL / 2}, {"to_load": 4.0}, {"law": Morse(3.0)})):
        study.run(TABORS[1:2], ASKED | other_asked, store, jobs=1, work=counted)
        assert len(counted.calls) == 5 + number


def test_what_missed_its_tolerance_comes_back_from_the_disk_as_it_was(tmp_path):
    store = open_store(tmp_path / "kept", "code", resume=True)
    missed = Summary(1.0, {}, UNKNOWN, UNKNOWN, {"jump_on": ("approach", "load")}, "")
    (kept,) = study.run([1.0], ASKED, store, jobs=1, work=lambda *_, **__: [missed])
    (again,) = study.run([1.0], ASKED, store, jobs=1, work=counted)
    assert again.missed == kept.missed == {"jump_on": ("approach", "load")}


def test_a_curve_whose_worker_died_is_tried_again(monkeypatch, tmp_path):
    store = open_store(tmp_path / "kept", "code", resume=True)
    monkeypatch.setattr(
        "fem_adhesion.common.jobs.stream", lambda *_, **__: (item for item in [((1.0,), WorkerDied("killed"))])
    )
    (died,) = study.run([1.0], ASKED, store)
    assert died == Summary(1.0, {}, UNKNOWN, UNKNOWN, {}, "killed")
    assert store.get(study._inputs(1.0, ASKED)) is None


def test_of_neighbours_whose_worker_died_each_is_tried_alone(monkeypatch):
    asked = []

    def dying(work, parts, **_):
        for part in parts:
            asked.append(part)
            yield part, WorkerDied("killed") if len(part) > 1 else work(part)

    monkeypatch.setattr("fem_adhesion.common.jobs.stream", dying)
    tabors = (1.6, 1.8, 2.0, 2.2)
    curves = study.run(tabors, ASKED)
    assert asked == [tabors, *((tabor,) for tabor in tabors)]
    assert [curve.tabor for curve in curves] == list(tabors)
    assert not any(curve.reason for curve in curves)


def test_the_exit_code_says_that_a_curve_is_missing(monkeypatch, capsys, tmp_path):
    lost = Summary(2.0, {}, UNKNOWN, UNKNOWN, {}, "it ends here")
    monkeypatch.setattr(study, "run", lambda *_, **__: [lost])
    table = tmp_path / "table.csv"
    assert cli.main(["sweep", "--tabor", "2", "--csv", str(table)]) == 1
    out = capsys.readouterr()
    assert out.err == "fem-adhesion: tabor 2: it ends here\n"
    assert out.out.startswith("0 of 1 curves solved")
    (row,) = rows_of(table.read_text())
    assert (row["tabor"], row["reason"], row["pull_off_load_R_dgamma"]) == ("2.0", "it ends here", "")
