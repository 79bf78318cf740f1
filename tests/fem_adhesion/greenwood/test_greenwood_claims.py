"""The claims of Greenwood (1997): each is decided by a rule from numbers, which absurd numbers turn."""

import dataclasses
import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import pytest

import halfspace
from fem_adhesion.common.page import titled
from fem_adhesion.greenwood import claims, facts
from fem_adhesion.greenwood.claims import CLAIMS, FAILS, HOLDS, MISPRINT, OPEN, Allowed, decide, judge
from halfspace.equilibrium.curve import EquilibriumPath
from halfspace.errors import InputError
from halfspace.laws.law import require_law
from halfspace.values import Estimate

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


def test_absurd_numbers_turn_every_verdict(monkeypatch):
    """Whatever a claim's verdict is, other numbers make it the others."""
    for claim in CLAIMS:
        assert verdict_of(monkeypatch, claim, inside(claim.allowed)).verdict == HOLDS, claim
        assert verdict_of(monkeypatch, claim, outside(claim.allowed)).verdict == FAILS, claim
        assert verdict_of(monkeypatch, claim, inside(claim.allowed), 1e9).verdict == OPEN, claim
        assert verdict_of(monkeypatch, claim, math.nan, math.nan).verdict == OPEN, claim


def test_a_misprint_fails_as_printed_and_holds_as_read(monkeypatch):
    """It is none if the reading does not hold either, nor if the print does."""
    for claim in (claim for claim in CLAIMS if claim.reading):
        wrong, right = outside(claim.allowed), inside(claim.reading.allowed)
        misprint = verdict_of(monkeypatch, claim, wrong, read=right)
        assert misprint.verdict == claim.reading.unit, claim
        assert claim.reading.words in misprint.how, claim
        neither = verdict_of(monkeypatch, claim, wrong, read=outside(claim.reading.allowed))
        assert neither.verdict == FAILS, claim
        assert claim.reading.words not in neither.how, claim
        assert verdict_of(monkeypatch, claim, inside(claim.allowed), read=right).verdict == HOLDS, claim


# --- what is measured ---


class Lying:
    """A path whose events, states and points have other numbers, and a fold made up or events missing."""

    def __init__(self, path, lie):
        self.path, self.lie = path, lie
        self.events = lied(dict(path.events), lie)
        self.events |= {"fold_2": self.events["pull_off"]} if lie.more else {}
        self.events = self.events if lie.power >= 1 else {"pull_off": self.events["pull_off"]}

    def __getattr__(self, name):
        found = getattr(self.path, name)
        return lied(found, self.lie) if name in ("approach", "load") else found

    def at(self, **asked):
        """Return states at what is asked for, elsewhere."""
        return lied(self.path.at(**asked), self.lie)

    def states(self, condition):
        """Return states that meet a condition, elsewhere."""
        return [dataclasses.replace(s, point=lied(s.point, self.lie)) for s in self.path.states(condition)]

    def resampled(self, points):
        """Return another curve."""
        return lied(self.path.resampled(points), self.lie)


class Lie(NamedTuple):
    """What becomes of a number x: factor |x|^power with the sign of x, and more."""

    factor: float
    power: float = 1.0
    more: float = 0.0


LIES = (
    Lie(-0.5),
    Lie(1.0, power=2.0),
    Lie(2.2),
    Lie(1.0, power=0.3),
    *(Lie(1.0, more=more) for more in (5.0, -5.0, 1.0)),
)
TRUE = ("tabor", "spacing", "relaxation", "name")


def lied(thing, lie):
    """All numbers of a thing changed, but those that say what was asked, and errors."""
    if isinstance(thing, EquilibriumPath):
        return Lying(thing, lie)
    if isinstance(thing, float) or (isinstance(thing, np.ndarray) and thing.dtype.kind == "f"):
        return lie.factor * np.sign(thing) * np.abs(thing) ** lie.power + lie.more
    if isinstance(thing, Mapping):
        return {key: lied(value, lie) for key, value in thing.items()}
    if isinstance(thing, tuple | list):
        return type(thing)(lied(value, lie) for value in thing)
    if not dataclasses.is_dataclass(thing):
        return thing
    names = [field.name for field in dataclasses.fields(thing) if field.init and field.name not in TRUE]
    found = {name: lied(getattr(thing, name), lie) for name in names if not name.endswith("error")}
    sweeps = {"sweeps": None if thing.sweeps else 7} if "sweeps" in found else {}
    return dataclasses.replace(thing, **found | sweeps)


def turns(claim, absurd):
    """Whether a claim does not hold on absurd facts; not if it asks for a state that no curve has."""
    try:
        return judge(claim, absurd).verdict != HOLDS
    except InputError:
        return False


def test_absurd_facts_turn_every_claim_that_holds(study, judged):
    """But those of formulas, which no fact enters."""
    facts_of = {field.name: getattr(study, field.name) for field in dataclasses.fields(facts.Facts)}
    facts_of = {name: value for name, value in facts_of.items() if name != "settings"}
    absurd = [dataclasses.replace(study, **lied(facts_of, lie)) for lie in LIES]
    held = [each.claim for each in judged if each.verdict == HOLDS and re.search(r"\bf\b", each.claim.measure)]
    assert len(held) > 60
    with np.errstate(invalid="ignore"):
        assert [claim.words for claim in held if not any(turns(claim, lies) for lies in absurd)] == []


# --- what the paper says, and what is so ---


def verdicts(judged, words):
    """Verdicts and numbers of the claims that have these words."""
    return [(c.verdict, c.computed.value) for c in judged if words in c.claim.words]


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
        ("Fitted between 2e-5 and 1e-4", FAILS, 1.838423, 1e-5),
        ("The same (second constant).", FAILS, 7.6152, 1e-3),
    ],
)
def test_known_verdicts(judged, words, verdict, value, tolerance):
    ((found, computed),) = verdicts(judged, words)
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


def test_every_claim_is_a_row_in_the_order_of_the_paper(rows, judged):
    assert len(rows("claims")) == len(CLAIMS) >= 100
    for row, each in zip(rows("claims"), judged, strict=True):
        claim, computed = each.claim, each.computed
        assert (row["section"], row["unit"]) == (claim.section, claim.unit)
        assert row["claim (what is measured)"] == claim.words
        assert row["printed"] == claim.allowed.printed
        assert row["verdict"].partition(":")[0] == each.verdict
        value = pytest.approx(computed.value, rel=1e-6, abs=1e-9 + computed.error, nan_ok=True)
        assert float(row["computed"] or "nan") == value
        assert float(row["error"] or "nan") == pytest.approx(computed.error, rel=0.06, nan_ok=True)
    order = ["abs", "1", "2", "3", "4", "5", "App. A", "App. B", "App. C"]
    plain = [row["section"].removeprefix("beyond ") for row in rows("claims")]
    places = [next(i for i, start in enumerate(order) if section.startswith(start)) for section in plain]
    assert places == sorted(places)


def test_numbers_of_the_claims_are_in_their_table(rows, study):
    for row, (what, mu, number, unit) in zip(rows("claims_numbers"), claims.numbers(study), strict=True):
        assert (row["quantity"], float(row["mu"]), row["unit"]) == (what, mu, unit)
        assert float(row["computed"]) == pytest.approx(number.value, rel=1e-5, abs=1e-9)


def test_the_count_of_verdicts_is_told(judged):
    told = titled("greenwood", "claims", **claims.counts(judged))[2]
    assert told.startswith(f"Of {len(judged)} claims, ")
    assert f"{sum(c.verdict == HOLDS for c in judged)} hold" in told
    assert f"{sum(c.verdict == FAILS for c in judged)} do not" in told
    assert claims.counts(())["verdicts"].startswith("0 hold")
