"""The claims of Greenwood (1997): each is decided by a rule from numbers, which absurd numbers turn."""

import dataclasses
import math
import types

import numpy as np
import pytest

import halfspace
from fem_adhesion.greenwood import claims, facts, formulas, measures
from fem_adhesion.greenwood.claims import CLAIMS, FAILS, HOLDS, MISPRINT, OPEN, Allowed, decide, judge
from fem_adhesion.greenwood.numerics_1997 import Rise
from fem_adhesion.greenwood.settings import QUICK
from fem_adhesion.greenwood.tables import LAST_DIGIT, TABORS
from halfspace.errors import InputError
from halfspace.laws.law import require_law
from halfspace.theories.closed_forms import bradley_load
from halfspace.values import Estimate

NAMES = [f"{number}: {claim.section}" for number, claim in enumerate(CLAIMS)]


@pytest.fixture(scope="module")
def known(study):
    """What the claims of the run were measured on, paths traced anew."""
    paths = {mu: halfspace.trace(mu, rtol=1e-5) for mu in TABORS}
    pull_offs = {p.tabor: p.half_space for p in study.pull_offs}
    rest = study.relaxations, study.rises, study.critical_tabor
    return facts.gathered(paths, QUICK, study.criteria, pull_offs, study.tables, *rest)


# --- the rule ---


def allowed(printed="", low="", high="", aim="", part="", words=""):
    """Interval of a row of the claims with these cells."""
    return Allowed.of({"printed": printed, "low": low, "high": high, "aim": aim, "part": part, "words": words})


@pytest.mark.parametrize(
    ("value", "error", "interval", "verdict"),
    [
        (1.8386, 1e-5, allowed("1.839"), HOLDS),
        (1.8384, 1e-5, allowed("1.839"), FAILS),
        (1.8386, 3e-4, allowed("1.839"), OPEN),
        (0.5, 0.0, allowed("large", low="0.5"), HOLDS),
        (0.5, 1e-9, allowed("large", low="0.5"), OPEN),
        (-4.80, 1e-3, allowed("2 %", aim="-4.712", part="0.02", words="2 %"), HOLDS),
        (-4.81, 1e-3, allowed("2 %", aim="-4.712", part="0.02", words="2 %"), FAILS),
        (math.nan, math.nan, allowed("1.839"), OPEN),
        (math.nan, math.nan, allowed("positive", low="0"), OPEN),
        (2.0, 0.0, allowed("two", low="2", high="2"), HOLDS),
    ],
)
def test_a_number_decides_with_its_error(value, error, interval, verdict):
    assert decide(Estimate(value, error), interval) == verdict


@pytest.mark.parametrize(
    ("interval", "told"),
    [
        (allowed(low="0.05", words="5 %"), "from 0.05 on: 5 %"),
        (allowed(high="0.05"), "up to 0.05: the claim's own limit"),
        (allowed("1.2"), "1.15 to 1.25: last printed digit"),
        (allowed(low="2", high="2", words="two folds"), "2: two folds"),
        (allowed("pi", aim=str(np.pi)), "3.14159: a formula"),
    ],
)
def test_an_interval_is_told_with_its_words(interval, told):
    assert interval.interval == told


def inside(allowed):
    """A number for which a claim holds."""
    low, high = max(allowed.low, -1e6), min(allowed.high, 1e6)
    return (low + high) / 2


def outside(allowed):
    """A number for which it does not."""
    return allowed.high + 1 + abs(allowed.high) if math.isfinite(allowed.high) else allowed.low - 1 - abs(allowed.low)


def verdict_of(monkeypatch, claim, value, error=0.0, read=math.nan):
    """Verdict of a claim whose number is made up, and that of its reading."""
    made = {claim: Estimate(value, error), claim.reading: Estimate(read, 0.0)}
    monkeypatch.setattr(claims.Claim, "measured", lambda self, _: made[self])
    return judge(claim, None)


@pytest.mark.parametrize("claim", CLAIMS, ids=NAMES)
def test_absurd_numbers_turn_every_verdict(claim, monkeypatch):
    """Whatever a claim's verdict is, other numbers make it the others."""
    assert verdict_of(monkeypatch, claim, inside(claim.allowed)).verdict == HOLDS
    assert verdict_of(monkeypatch, claim, outside(claim.allowed)).verdict == FAILS
    assert verdict_of(monkeypatch, claim, inside(claim.allowed), 1e9).verdict == OPEN
    assert verdict_of(monkeypatch, claim, math.nan, math.nan).verdict == OPEN


@pytest.mark.parametrize("claim", [c for c in CLAIMS if c.reading], ids=lambda claim: claim.words[:30])
def test_a_misprint_fails_as_printed_and_holds_as_read(claim, monkeypatch):
    """It is none if the reading does not hold either, nor if the print does."""
    wrong, right = outside(claim.allowed), inside(claim.reading.allowed)
    misprint = verdict_of(monkeypatch, claim, wrong, read=right)
    assert misprint.verdict == claim.reading.unit
    assert claim.reading.words in misprint.how
    neither = verdict_of(monkeypatch, claim, wrong, read=outside(claim.reading.allowed))
    assert neither.verdict == FAILS
    assert claim.reading.words not in neither.how
    assert verdict_of(monkeypatch, claim, inside(claim.allowed), read=right).verdict == HOLDS


def test_every_measure_serves_a_claim():
    used = {c.measure.split()[0] for claim in CLAIMS for c in (claim, claim.reading) if c}
    known = {
        name
        for module in (formulas, measures)
        for name, value in vars(module).items()
        if isinstance(value, types.FunctionType) and value.__module__ == module.__name__ and name[0] != "_"
    }
    assert used <= known
    assert known - used == {"tension", "maugis_radius", "displacement"}  # which others are made of


# --- what is measured ---


def scaled(record, factor):
    """A record whose numbers are all multiplied, and its errors kept."""
    numbers = {
        field.name: getattr(record, field.name) * (abs(factor) if field.name == "central_gap" else factor)
        for field in dataclasses.fields(record)
        if field.name in ("approach", "load", "central_gap", "contact_radius")
    }
    return dataclasses.replace(record, **numbers)


SOLVED = {}  # states that were asked for once


class Lying:
    """A path whose events and states have other numbers, and some folds missing or made up.

    Numbers are multiplied; a `rigid` one has the loads of Bradley's theory apart and of DMT-M in compression.
    """

    def __init__(self, path, factor, names, *, rigid):
        self.path, self.factor, self.rigid = path, factor, rigid
        events = {name: scaled(event, factor) for name, event in path.events.items()}
        folds = {"fold_2": events["pull_off"], "fold_3": events["pull_off"]}
        self.events = events | folds if names is None else {name: events[name] for name in names if name in events}

    def __getattr__(self, name):
        return getattr(self.path, name)

    def at(self, **asked):
        """Return states at what is asked for, elsewhere."""
        key = (self.path.tabor, *((name, np.asarray(value).tobytes()) for name, value in asked.items()))
        if key not in SOLVED:
            SOLVED[key] = self.path.at(**asked)
        true = SOLVED[key]
        if not self.rigid:
            spread = self.factor ** np.arange(np.size(true.approach)).reshape(np.shape(true.approach))
            return dataclasses.replace(scaled(true, self.factor), approach=true.approach * self.factor * spread)
        approach = self.path.tabor * np.cbrt(3 / 4 * (np.asarray(true.load) + 2 * np.pi)) ** 2
        return dataclasses.replace(true, load=bradley_load(true.approach), approach=approach)

    def states(self, condition):
        """Return states that meet a condition, elsewhere."""
        found = self.path.states(condition)
        return [
            dataclasses.replace(s, point=dataclasses.replace(s.point, observables=s.point.observables * self.factor))
            for s in found
        ]

    def resampled(self, points):
        """Return a curve far from where it was."""
        true = self.path.resampled(points)
        return types.SimpleNamespace(approach=true.approach, load=true.load + 100)

    @property
    def stages(self):
        """Return the last stage, with the jump on in the place of the jump off."""
        stage = dict(self.path.stages[-1])
        return (stage | {"jump_off": stage["jump_on"]} if "jump_on" in stage else stage,)


def off(estimate, factor):
    return dataclasses.replace(estimate, value=estimate.value * factor)


def other(entry, factor):
    """An entry of a table with another print and another number, right to the last digit or not at all."""
    wrong = factor * (10 if entry.row.endswith("alpha_star") else 1)
    printed = "1.610" if entry.row.endswith("over_mu") else entry.printed
    note = LAST_DIGIT if factor == 1.1 else ""
    return dataclasses.replace(entry, computed=off(entry.computed, wrong), printed=printed, note=note)


def lies(known, factor, names=None, *, rigid=False, tilt=0.0):
    """All that claims are measured on, multiplied, by more at larger mu, in the opposite order, or gone."""
    jumps = {
        mu: dataclasses.replace(
            cycle,
            on=tuple(dataclasses.replace(j, landing=scaled(j.landing, 1.2 * factor)) for j in cycle.on),
            off=tuple(dataclasses.replace(j, landing=scaled(j.landing, factor * 5)) for j in cycle.off),
            energy_lost=off(cycle.energy_lost, -1),
        )
        for mu, cycle in known.cycles.items()
    }
    constants = [
        dataclasses.replace(c, constants=tuple((name, printed, off(e, factor)) for name, printed, e in c.constants))
        for c in known.criteria.criteria
    ]
    forces = list(known.pull_offs.values())[::-1]
    entries = {name: [other(entry, factor) for entry in getattr(known.tables, name)] for name in ("table_1", "table_2")}
    asymptote = Estimate(1.839, 1e-5), Estimate(7.7, 1e-3)
    rises = {
        spacing: Rise(tuple(dataclasses.replace(r, load=r.load * factor) for r in rise.ripples), rise.ended)
        for spacing, rise in known.rises.items()
    }
    with_it = Rise(tuple(dataclasses.replace(r, load=r.load / 2) for r in known.omitted[1].ripples), "")
    return dataclasses.replace(
        known,
        paths={mu: Lying(path, factor * mu**tilt, names, rigid=rigid) for mu, path in known.paths.items()},
        cycles=jumps,
        criteria=dataclasses.replace(known.criteria, criteria=tuple(constants)),
        pull_offs=dict(zip(known.pull_offs, forces, strict=True)),
        tables=dataclasses.replace(known.tables, **entries, asymptote=asymptote),
        relaxations=[dataclasses.replace(a, sweeps=None if a.sweeps else 7) for a in known.relaxations],
        rises=rises,
        critical_tabor=off(known.critical_tabor, 4),
        omitted=(known.omitted[0], with_it),
        cores={
            gap: moved + 1e-3 * factor if i == 0 else moved * 0 for i, (gap, moved) in enumerate(known.cores.items())
        },
        coarse={key: 1 / force for key, force in known.coarse.items()},
    )


MEASURED = [claim for claim in CLAIMS if hasattr(measures, claim.measure.split()[0])]


LIES = (
    {"factor": -0.5, "names": ("pull_off", "zero_load", "jump_on", "jump_off")},
    {"factor": 0.01},
    {"factor": 0.7},
    {"factor": 0.9, "names": ("pull_off",)},
    {"factor": 0.96, "rigid": True},
    {"factor": 1.1},
    {"factor": 2.24},
    {"factor": 1.0, "tilt": 0.5},
)


def verdict_under(claim, lie):
    """Verdict of a claim under a lie; None where it asks for a state that no curve has."""
    try:
        return judge(claim, lie).verdict
    except InputError:
        return None


def test_absurd_facts_turn_the_verdict_of_every_claim_measured_on_them(known):
    """Under one lie or another, each claim that is no formula's has another verdict."""
    told = [lies(known, **lie) for lie in LIES]
    unturned = [
        (claim.section, claim.words)
        for claim in MEASURED
        if {verdict_under(claim, lie) for lie in told} <= {judge(claim, known).verdict, None}
    ]
    assert unturned == []


def test_most_claims_are_measured():
    assert len(MEASURED) > 85


# --- what the paper says, and what is so ---


def verdicts(study, words):
    """Verdicts and numbers of the claims that have these words."""
    return [(c.verdict, c.computed.value) for c in study.claims.judged if words in c.claim.words]


@pytest.mark.parametrize(
    ("words", "verdict", "value", "tolerance"),
    [
        ("At mu = 5 the pull-off force is within 2 %", HOLDS, 1.01714 * 1.5 * np.pi, 1e-4),
        ("At mu = 5 pull-off occurs at JKR's separation", FAILS, -0.792, 5e-4),
        ("separation at the jump off is within 1 %", FAILS, -1.63795, 1e-5),
        ("it is Bradley's in the tensile region", FAILS, 0.91, 0.01),
        ("almost that with pi R dgamma", HOLDS, 3.143, 5e-4),
        ("except for mu below 0.237", HOLDS, 0.23696, 1e-5),
        ("Pashley: the tension is largest", FAILS, 0.23696, 1e-5),
        ("pull-off never occurs", MISPRINT, 13, 3),
        ("Jumps on computed with", FAILS, 0, 0),
        ("Jumps off computed so", HOLDS, 4, 0),
        ("far from -1 (its value at mu = 1)", HOLDS, 14.209, 1e-3),
        ("this critical parameter is 0.6 to 0.8", FAILS, 1.695, 1e-3),
        ("The numerical result is h0 = 1.403 w(0)", FAILS, 1.768, 1e-3),
        ("At mu = 1 the gap H0 is 1.62", MISPRINT, 0.647, 1e-4),
        ("Equation (2.9) is the pressure", MISPRINT, 0.29687, 1e-5),
        ("appreciably larger", FAILS, 0.793, 1e-3),
        ("does not depend on dgamma", HOLDS, 0, 1e-6),
    ],
)
def test_known_verdicts(study, words, verdict, value, tolerance):
    ((found, computed),) = verdicts(study, words)
    assert found == verdict
    assert computed == pytest.approx(value, abs=tolerance)


def test_another_core_is_a_law_with_the_same_tension_beyond():
    law = require_law(facts.OtherCore(2.3, 0.5))
    gaps = np.array([2.3, 2.5, 4.0, 10.0])
    mu = 5 * 1.5 ** (2 / 3)  # of the same sphere with dgamma half as large again
    ours = law.pressure(gaps, mu) * 1.5 / mu
    assert ours == pytest.approx(halfspace.laws.LENNARD_JONES.pressure(gaps, 1.0), rel=1e-12)
    within_ = np.array([0.5, 1.0, 1.5])
    assert np.all(law.pressure(within_, mu) * 1.5 / mu < halfspace.laws.LENNARD_JONES.pressure(within_, 1.0))


# --- the files ---


def test_every_claim_is_a_row_in_the_order_of_the_paper(rows, study):
    assert len(rows("claims")) == len(CLAIMS) >= 100
    for row, judged in zip(rows("claims"), study.claims.judged, strict=True):
        claim, computed = judged.claim, judged.computed
        assert (row["section"], row["unit"]) == (claim.section, claim.unit)
        assert row["claim (what is measured)"] == claim.words
        assert row["printed"] == claim.allowed.printed
        assert row["verdict"].partition(":")[0] == judged.verdict
        value = pytest.approx(computed.value, rel=1e-6, abs=1e-9 + computed.error, nan_ok=True)
        assert float(row["computed"] or "nan") == value
        assert float(row["error"] or "nan") == pytest.approx(computed.error, rel=0.06, nan_ok=True)
    order = ["abs", "1", "2", "3", "4", "5", "App. A", "App. B", "App. C"]
    plain = [row["section"].removeprefix("beyond ") for row in rows("claims")]
    places = [next(i for i, start in enumerate(order) if section.startswith(start)) for section in plain]
    assert places == sorted(places)


def test_each_claim_names_files_that_show_it(rows, report):
    for row in rows("claims"):
        for name in row["shown by"].split(", "):
            assert (report / f"{name}.csv").exists(), row


def test_numbers_of_the_claims_are_in_their_table(rows, study):
    for row, number in zip(rows("claims_numbers"), study.claims.numbers, strict=True):
        assert (row["quantity"], float(row["mu"]), row["unit"]) == (number.what, number.tabor, number.unit)
        assert float(row["computed"]) == pytest.approx(number.computed.value, rel=1e-5, abs=1e-9)


def test_the_count_of_verdicts_is_told(study):
    judged = study.claims.judged
    told = claims.words(judged)
    assert told.startswith(f"Of {len(judged)} claims, ")
    assert f"{sum(c.verdict == HOLDS for c in judged)} hold" in told
    assert f"{sum(c.verdict == FAILS for c in judged)} do not" in told
    assert claims.words(()).startswith("Of 0 claims, 0 hold")
