"""Curves by several laws on one plot: as strong, in units that all share, and how far they collapse."""

import json
from dataclasses import replace

import matplotlib.colors
import numpy as np
import pytest

import halfspace
from fem_adhesion import Hemisphere, Scene
from fem_adhesion.curve import beside
from fem_adhesion.curve.solve import Curves, Question
from halfspace.errors import InputError
from halfspace.laws import LENNARD_JONES, Morse, PowerLaw

LAWS = (Morse(3.0), PowerLaw(4, 10))


@pytest.fixture(scope="module")
def collapsed():
    question = Question(Scene(2.0), rtol=1e-4)
    return beside.solve(Curves(question, {"half-space": halfspace.trace(2.0, rtol=1e-4)}, None, None), LAWS)


@pytest.fixture(scope="module")
def drawn(collapsed):
    return beside.draw(collapsed)


def test_laws_are_as_strong_in_one_unit(collapsed):
    """The largest tension s dgamma/eps over E*, at equal R and dgamma: s^3 mu^3 R/(dgamma ...) is the same."""
    for law, path in collapsed:
        assert law.strength * path.tabor == pytest.approx(2 * LENNARD_JONES.strength, rel=1e-12)
    assert [law for law, _ in collapsed] == [LENNARD_JONES, *LAWS]


def test_the_numbers_are_those_of_the_curves(collapsed):
    first, *others = (path for _, path in collapsed)
    size = abs(first.events["pull_off"].load)
    pull_off = max(abs(path.events["pull_off"].load - first.events["pull_off"].load) for path in others) / size
    assert beside.apart(collapsed, "pull-off").value == pytest.approx(pull_off, rel=1e-12)
    assert 0 < beside.apart(collapsed, "jumps").error < 1e-3
    assert f"{100 * pull_off:.3g} +- " in beside.told(collapsed)
    assert "morse k 3 at tabor" in beside.told(collapsed)


@pytest.mark.parametrize(("name", "quantity"), [("jump_on", "approach"), ("jump_off", "load")])
def test_jumps_differ_by_their_largest_part_of_load_or_range(collapsed, name, quantity):
    """The first curve beside itself, moved in one number alone, at a Tabor parameter that scales its approaches."""
    law, path = collapsed[0]
    event, events = path.events[name], path.events
    size = {"approach": 1 + np.ptp([e.approach for e in events.values()]), "load": abs(events["pull_off"].load)}
    scaled = {
        n: replace(e, approach=1.5 * e.approach, approach_error=1.5 * e.approach_error) for n, e in events.items()
    }
    moved, error = 0.01 * size[quantity], 2 * getattr(event, f"{quantity}_error") / size[quantity]
    unit = 1.5 if quantity == "approach" else 1.0
    scaled[name] = replace(scaled[name], **{quantity: unit * (getattr(event, quantity) + moved)})
    found = [(law, path), (law, replace(path, tabor=1.5 * path.tabor, events=scaled))]
    assert beside.apart(found, "jumps").value == pytest.approx(0.01, rel=1e-9)
    assert beside.apart(found, "jumps").error == pytest.approx(error, rel=1e-6)


def test_labels_tell_the_lines_that_are_drawn(collapsed, drawn):
    left, right = drawn.axes
    lines = {line.get_label(): line for line in left.get_lines()}
    for (law, path), line in zip(collapsed, (lines[beside._name(*one)] for one in collapsed), strict=True):
        x, y = line.get_data()
        seen = np.isfinite(y)
        rates = path.load[path.stable], path.approach[path.stable] / path.tabor
        for load, approach in zip(*rates, strict=True):
            if x[seen].min() < approach < x[seen].max():
                assert np.min(np.hypot(x[seen] - approach, y[seen] - load)) < 1e-6
        color = matplotlib.colors.to_hex(line.get_color())
        marks = [one for one in left.get_lines() if one.get_marker() != "None" and one.get_color() == line.get_color()]
        events = [path.events[name] for name in ("pull_off", "jump_on", "jump_off")]
        assert [one.get_ydata()[0] for one in marks] == [event.load for event in events]
        assert [one.get_xdata()[0] for one in marks] == [event.approach / path.tabor for event in events]
        (tension,) = (one for one in right.get_lines() if matplotlib.colors.to_hex(one.get_color()) == color)
        gap, height = tension.get_data()
        assert height.max() == pytest.approx(1, abs=1e-3)
        beyond = -float(law.energy(gap[-1] / law.strength, 1.0))
        assert np.trapezoid(height[gap >= 0], gap[gap >= 0]) == pytest.approx(1 - beyond, abs=2e-3)
    assert f"{100 * beside.apart(collapsed, 'pull-off').value:.3g} +- " in left.get_title(loc="left")


def test_jumps_are_compared_where_all_laws_fold(collapsed):
    first, (law, path), _ = collapsed
    smooth = replace(path, events={name: path.events[name] for name in ("pull_off", "zero_load")})
    found = [first, (law, smooth)]
    assert beside.apart(found, "jumps") is None
    assert beside.apart(found, "pull-off").value > 0
    assert "not all fold" in beside.told(found)


def test_a_body_with_a_length_is_refused_before_any_work():
    with pytest.raises(InputError, match="other_laws with body = hemisphere, limit: a body and profile without R/eps"):
        beside.require(Scene(1.0, body=Hemisphere(radius_ratio=100.0)), [Morse(3.0)])
    with pytest.raises(InputError, match="other_laws = 6 laws, limit: 5; give fewer"):
        beside.require(Scene(1.0), [Morse(3.0)] * 6)


def test_the_record_is_json(collapsed):
    data = json.loads(json.dumps(beside.record(collapsed), allow_nan=False))
    assert [one["tabor"] for one in data["laws"]] == [path.tabor for _, path in collapsed]
    assert data["largest_relative_difference"]["jumps"]["value"] == beside.apart(collapsed, "jumps").value
