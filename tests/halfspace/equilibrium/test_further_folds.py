"""Curves with more folds than two: their events, jumps and cycle, against closed forms, brute force and relaxation."""

import io
import re
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
from agreement import differing
from rich.console import Console
from scipy.integrate import quad
from scipy.optimize import brentq

import fem_adhesion
import halfspace
from fem_adhesion import Scene, convergence
from fem_adhesion.common import lines
from fem_adhesion.common.fold_birth import count_folds
from fem_adhesion.crosscheck.study import _compare_events
from fem_adhesion.curve import record, terminal
from fem_adhesion.curve.pictures import experiment
from fem_adhesion.curve.solve import Curves, Question
from halfspace.accuracy import refinement
from halfspace.accuracy.grids import half_space_charts, resolution_for
from halfspace.equilibrium.charts import trace_charts
from halfspace.equilibrium.conditions import FOLD
from halfspace.equilibrium.devices import cycle
from halfspace.equilibrium.events import is_fold, usual
from halfspace.equilibrium.path import Steps
from halfspace.equilibrium.search import confirmed
from halfspace.errors import InputError, NotConverged, Unsolved
from halfspace.laws import LENNARD_JONES, Dlvo, Law, PowerLaw
from halfspace.scales import Scales


@dataclass(frozen=True)
class TwoMinima(Law):
    """The 3-9 law with a well in the energy farther out."""

    depth: float = 0.3
    place: float = 4.0
    width: float = 0.5

    def _well(self, gap):
        return self.depth * np.exp(-(((gap - self.place) / self.width) ** 2) / 2)

    def pressure(self, gap, tabor):
        """P."""
        return LENNARD_JONES.pressure(gap, tabor) - tabor * self._well(gap) * (gap - self.place) / self.width**2

    def slope(self, gap, tabor):
        """dP/dH."""
        bend = (1 - ((gap - self.place) / self.width) ** 2) / self.width**2
        return LENNARD_JONES.slope(gap, tabor) - tabor * self._well(gap) * bend

    def energy(self, gap, tabor):
        """Phi."""
        return LENNARD_JONES.energy(gap, tabor) - tabor * self._well(gap)


LAW = TwoMinima()


@pytest.fixture(scope="module")
def winding():
    return halfspace.trace(2.0, law=LAW, rtol=1e-5)


@pytest.mark.parametrize(
    ("stiffness", "names"),
    [(1.0, ["jump_on", "jump_on_2", "jump_off"]), (1.5, ["jump_on", "jump_on_2", "jump_off", "jump_off_2"])],
)
def test_a_rigid_contact_jumps_as_the_closed_form_does(stiffness, names):
    """W = 2 pi Phi(-alpha) on a rigid paraboloid; the base b = alpha + W/k turns where the tension is k/(2 pi)."""
    found = cycle(halfspace.trace(1e-6, law=LAW, rtol=1e-6), stiffness)

    def load(approach):
        return 2 * np.pi * LAW.energy(-approach, 1.0)

    def base(approach):
        return approach + load(approach) / stiffness

    def turns(approach):
        return 1 + 2 * np.pi * LAW.pressure(-approach, 1.0) / stiffness

    at = np.linspace(-9, 0.3, 20001)
    folds = [brentq(turns, a, b) for a, b in pairwise(at) if turns(a) * turns(b) < 0]
    ends = [-500.0, *folds, 0.3]
    stable = list(zip(ends[::2], ends[1::2], strict=True))
    assert len(stable) == 3

    def jumps(number, way):
        """Take-off and landing of each jump from one stable stretch to the next that has its base."""
        while 0 <= number + way < len(stable):
            off = stable[number][way > 0]
            b = base(off)
            number = next(n for n in range(number + way, 3 * way, way) if base(stable[n][0]) < b < base(stable[n][1]))
            yield off, brentq(lambda x, b=b: base(x) - b, *stable[number])

    assert list(found.jumps) == names
    for jump, (off, landing) in zip(found.jumps.values(), (*jumps(0, 1), *jumps(2, -1)), strict=True):
        assert jump.take_off.approach == pytest.approx(off, abs=1e-5)
        assert jump.landing.approach == pytest.approx(landing, abs=1e-5)
        assert jump.take_off.load == pytest.approx(load(off), abs=1e-5)
        contact, _ = quad(load, landing, off, epsabs=1e-10)
        spring = (load(off) ** 2 - load(landing) ** 2) / (2 * stiffness)
        assert jump.energy.value == pytest.approx(contact + spring, rel=1e-4)


def test_all_folds_are_events_in_order_and_hold_the_truth(winding):
    truth = halfspace.trace(2.0, law=LAW, rtol=1e-7)
    names = ["pull_off", "jump_on", "fold_2", "fold_3", "jump_off", "zero_load"]
    assert list(winding.events) == list(truth.events) == names
    assert winding.event("fold_4") is None
    assert differing(winding, truth) == []
    for name in names[2:4]:
        assert max(winding.event(name).approach_error, winding.event(name).load_error) < 1e-5
    arclengths = [winding.stages[-1][name].point.arclength for name in names[1:5]]
    assert arclengths == sorted(arclengths)


def test_elements_find_the_same_folds_and_jumps(winding):
    elements = convergence.trace(Scene(2.0, law=LAW), rtol=1e-3)
    rows = [row for row in _compare_events(winding, elements, 1e-3) if row.quantity.startswith("fold")]
    assert [row.quantity for row in rows] == [
        f"fold_{n} {name}" for n in (2, 3) for name in ("approach", "load", "central_gap")
    ]
    assert {row.verdict for row in rows} == {"agree"}
    ours, theirs = cycle(winding), cycle(elements)
    assert list(ours.jumps) == list(theirs.jumps)
    for name, jump in ours.jumps.items():
        assert jump.energy.agrees(theirs.jumps[name].energy), name


def test_a_solver_that_misses_folds_disagrees():
    ordinary = halfspace.trace(5.0, rtol=1e-3)
    blind = replace(ordinary, events=usual(ordinary.events))
    rows = [row for row in _compare_events(ordinary, blind, 1e-3) if row.quantity.startswith("fold")]
    assert len(rows) == 6
    assert {row.verdict for row in rows} == {"disagree"}


def test_a_jump_lands_on_the_nearest_stable_state():
    """A spring of 1 R dgamma/eps: three states of the curve are at the base of a jump on, and of one off."""
    path = halfspace.trace(1.0, law=LAW, rtol=1e-4)
    found, base = cycle(path, 1.0), path.approach + path.load
    for jump, part in ((found.jump_on, 1), (found.jump_off, -1)):
        takes_off = int(np.hypot(path.approach - jump.take_off.approach, path.load - jump.take_off.load).argmin())
        beyond = slice(takes_off + 3, None) if part > 0 else slice(takes_off - 3, None, -1)
        off, approach = (base[beyond] - jump.take_off.approach - jump.take_off.load), path.approach[beyond]
        crossings = np.flatnonzero(off[:-1] * off[1:] < 0)
        assert crossings.size == 3
        first = crossings[0]
        assert sorted(approach[first : first + 2])[0] < jump.landing.approach < sorted(approach[first : first + 2])[1]


def test_a_curve_that_winds_more_has_all_its_folds():
    """One is between two points so far apart that only shorter steps find it."""
    tabor = 100.0
    path = halfspace.trace(tabor)
    fine = trace_charts(
        half_space_charts(Scales(tabor), resolution_for(Scales(tabor), 1e-6)), steps=Steps(longest=0.05)
    )
    turned = sum(
        a.rates[0] * b.rates[0] < 0 and abs(a.arclength - b.arclength) > 0
        for segment in fine
        for a, b in pairwise(segment.points)
    )
    between = list(path.events)[2:-2]
    assert turned == count_folds(path) == len(between) + 2
    assert between == [f"fold_{number}" for number in range(2, turned)]
    assert all(path.event(name).approach_error < 1e-6 * path.approach_scale for name in between)
    assert list(cycle(path).jumps) == ["jump_on", "jump_off"]


@pytest.mark.parametrize(
    ("tabor", "law", "rtol"),
    [(300.0, PowerLaw(3.427, 19.84), 1e-3), (20.0, LENNARD_JONES, 1e-1), (2.0, LAW, 1e-3), (0.5, LENNARD_JONES, 1e-3)],
    ids=str,
)
def test_branches_end_at_the_folds_that_are_events(tabor, law, rtol):
    """With the first two folds 5 and 6 are as close as either errs, by one shift of both: a branch was left out."""
    path = halfspace.trace(tabor, law=law, rtol=rtol)
    folds = [event for name, event in path.events.items() if is_fold(name)]
    branches = list(path.branches("approach").values())
    assert len(branches) == len(folds) + 1
    assert len(path.states(FOLD)) == len(folds)
    for fold, (before, after) in zip(folds, pairwise(branches), strict=True):
        assert min(abs(a - b) for a in before for b in after) == 0
        assert min(abs(end - fold.approach) for end in before) <= fold.approach_error


def test_folds_are_in_tables_records_and_on_the_plot():
    winding = halfspace.trace(2.0, law=LAW, rtol=1e-2)  # a file has each point's error: at 1e-5 they take 20 s
    curves = Curves(Question(Scene(2.0, law=LAW)), {"half-space": winding}, cycle(winding), cycle(winding, 3.0))
    console = Console(width=120, record=True, file=io.StringIO())
    console.print(terminal.table(curves))
    told = console.export_text()
    for words in ("fold 2", "fold 3", "jump on 2 lands, fixed grips", "jump off 2 lands, fixed grips"):
        assert words in told
    data = record.record(curves)
    assert list(data["solutions"]["half-space"]["events"])[1:5] == ["jump_on", "fold_2", "fold_3", "jump_off"]
    assert {"jump_on", "jump_on_2", "jump_off", "jump_off_2"} <= set(data["jumps"]["fixed_grips"])
    table = io.StringIO()
    record.write_csv(curves, table)
    names = [line.split(",")[1] for line in table.getvalue().splitlines()[1:]]
    assert [name for name in names if name.startswith(("jump", "fold"))] == ["jump_on", "fold_2", "fold_3", "jump_off"]
    marks = lines.folds(winding)
    assert marks[:, 0] == pytest.approx(
        [winding.events[n].approach for n in ("jump_on", "fold_2", "fold_3", "jump_off")]
    )
    plot = terminal.plot(curves).plain
    assert plot.count("B") == plot.count("D") == 2
    assert "2 to 3 folds between them" in terminal._key(curves)
    with pytest.raises(InputError, match="movie of 4 jumps, limit: one on and one off"):
        experiment(winding)


def test_a_law_tells_its_edges():
    assert LAW.innermost == pytest.approx(LENNARD_JONES.edge_gap, rel=0.03)
    assert LAW.outermost == pytest.approx(4.5, abs=0.1)
    deep = TwoMinima(depth=1.0)
    assert deep.outermost == deep.edge_gap
    assert deep.edge_gap == pytest.approx(4.5, abs=0.1)


def test_surfaces_held_apart_at_the_curves_end_are_told(monkeypatch):
    """Once: on finer grids they are as far apart. By elements it took 91 s to say so, and 1.2 GB."""
    traced = []
    monkeypatch.setattr(refinement, "trace_charts", lambda *how: traced.append(1) or trace_charts(*how))
    with pytest.raises(NotConverged, match=r"apart at the curve's end, load .*, limit: .*; take a larger to_load"):
        halfspace.trace(1.0, law=TwoMinima(depth=1.0, place=3.9))
    assert len(traced) == 1


def test_a_barrier_holds_the_surfaces_apart_up_to_a_load():
    """Of the rigid contact: 2 pi times the height of the barrier in the energy."""
    law = Dlvo(0.4, 1.0)
    barrier = 2 * np.pi * law.energy(np.linspace(0, 3, 30001), 1.0).max()
    assert barrier > 5
    path = halfspace.trace(0.1, law=law, to_load=2 * barrier, rtol=1e-4)
    assert path.load[path.central_gap > law.innermost].max() == pytest.approx(barrier, rel=0.05)
    assert path.event("pull_off").load < 0


def test_coarse_elements_name_no_wiggle_a_fold():
    """Where the last fold but one is next to the birth of contact.

    The block that follows the contact was a third as large where it took over: a fold was 0.18 eps off.
    """
    tabor = 19.829348134526555
    path, wound = fem_adhesion.trace(Scene(tabor), rtol=1e-2), halfspace.trace(tabor, rtol=1e-6)
    assert differing(path, wound) == []


def test_a_fold_that_no_finer_grid_has_is_told(monkeypatch):
    """Folds come in pairs: with one the other is in doubt as well."""
    ups = iter(range(9))

    def on_finer_grids(traced, solve, known):
        return confirmed(traced, lambda f: Unsolved("not found again") if next(ups) == 1 else solve(f), known)

    monkeypatch.setattr(refinement, "confirmed", on_finer_grids)
    path = halfspace.trace(5.0, rtol=1e-3)
    monkeypatch.undo()
    assert list(path.events) == ["pull_off", "jump_on", "jump_off", "zero_load"]
    true = halfspace.trace(5.0, rtol=1e-3)
    for fold, name in zip(sorted(path.unconfirmed, key=lambda f: -f.central_gap), ("fold_2", "fold_3"), strict=True):
        assert fold.approach == pytest.approx(true.event(name).approach, abs=1e-3)
        assert fold.load == pytest.approx(true.event(name).load, abs=1e-3)
    assert true.unconfirmed == ()
    curves = Curves(Question(Scene(5.0)), {"half-space": path}, cycle(path), None)
    told = [note for note in terminal.notes(curves) if "cannot be told" in note]
    assert len(told) == 2
    assert re.match(r"half-space: a fold near approach -4\.\d+ eps, load -0\.\d+ R dgamma cannot be told", told[0])
    solution = record.record(curves)["solutions"]["half-space"]
    assert [fold["central_gap"] for fold in solution["unconfirmed_folds"]] == [f.central_gap for f in path.unconfirmed]
