"""Estimates hold what a tighter tolerance finds, in contacts each of which was once outside, or without an end."""

from dataclasses import replace

import pytest
from agreement import differing

import halfspace
from halfspace import Coated, Layer
from halfspace.accuracy import stages
from halfspace.equilibrium.contact import OBSERVABLES
from halfspace.laws import Dlvo, Dugdale, Exponential, Morse, PowerLaw
from halfspace.profiles import Hyperboloid, Power, RoundedPunch, Sphere

FILM = Coated(0.31, modulus_ratio=9.463, poisson=0.225, substrate_poisson=0.05)
SLIDING = Layer(0.0816, 0.4999, "sliding")

CONTACTS = {  # what was wrong: the contact, its tolerance, and the tighter one
    "a range of ten spacings is no power": (1.0, {"law": Exponential(0.1)}, 1e-5, 1e-7),
    "a range so short that points leapt over it": (1e-6, {"law": Exponential(50)}, 1e-4, 1e-6),
    "another in which there is one point": (0.03, {"law": Exponential(20)}, 1e-3, 1e-5),
    "another, asked closely": (0.01, {"law": Exponential(40)}, 1e-6, 1e-8),
    "a step on cells that grew threefold": (1.0, {"law": Dugdale(0.1)}, 1e-4, 1e-6),
    "the same on a sphere": (1.0, {"law": Dugdale(0.2), "profile": Sphere(30)}, 1e-4, 1e-6),
    "the same without short cells at a tip": (3.0, {"law": Dugdale(0.2), "profile": Hyperboloid(0.3)}, 1e-5, 1e-7),
    "folds lost outside the step": (50.0, {"law": Dugdale(0.2), "profile": RoundedPunch(2.0)}, 1e-4, 1e-6),
    "gaps of 1e27 eps far out": (3.0, {"profile": Power(8)}, 1e-5, 1e-7),
    "gaps turned negative on wide cells": (7.8083, {"law": Dlvo(-0.47, 0.84), "profile": Power(8.7)}, 1e-3, 1e-4),
    "the same on a coating": (
        0.4085,
        {"law": PowerLaw(2.69, 6.8), "profile": Power(9.5), "body": Coated(0.12, 0.223)},
        1e-3,
        1e-4,
    ),
    "three grids agreed by accident": (
        4.72,
        {"law": Morse(4.1), "profile": Sphere(72.5), "body": Coated(0.319, 0.218, 0.16, 0.39)},
        1e-2,
        1e-5,
    ),
    "the same on a layer": (5.93, {"law": Exponential(1.31, 10), "body": SLIDING}, 1e-2, 1e-4),
    "a barrier on a stiff coating": (2.0, {"law": Dlvo(0.3, 1.0), "body": Coated(0.2, 20)}, 1e-2, 1e-4),
    "wider than the operator was made for": (0.0434, {"law": Morse(0.63), "body": Layer(6.51, 0.413)}, 1e-3, 1e-5),
    "a cone on a soft base": (
        0.5084,
        {"law": PowerLaw(3.03, 13.9), "profile": Hyperboloid(0.42), "body": FILM},
        1e-3,
        1e-5,
    ),
    "contact born between folds": (28.9388, {"law": PowerLaw(3.32, 11.7), "profile": Sphere(973.6)}, 1e-4, 1e-6),
    "a fold passed on the axis": (10.0, {"profile": Sphere(100.0)}, 1e-7, 1e-9),
    "two neighbouring grids erred alike": (1.27, {"law": Morse(11.3)}, 1e-4, 1e-6),
    "a sharp edge on a sphere": (100.0, {"profile": Sphere(1e4)}, 1e-3, 1e-5),
    "folds that crept from grid to grid": (77.4, {"profile": Sphere(190)}, 1e-8, 1e-9),
    "a gap on the axis by polynomials in the radius": (0.3, {"profile": Sphere(10)}, 1e-1, 1e-3),
    "folds near the axis": (5.0, {"profile": Sphere(30)}, 1e-1, 1e-4),
    "the same, asked closely": (5.0, {"profile": Sphere(30)}, 1e-5, 1e-7),
    "four coarse grids agreed under no load": (4.77, {"to_load": 1.94}, 1.7e-3, 1e-5),
}


@pytest.mark.parametrize("contact", CONTACTS)
def test_estimates_hold_what_a_tighter_tolerance_finds(contact):
    tabor, parts, *tolerances = CONTACTS[contact]
    # The radius at the edge of a step is left out: at pull-off from the tip it is 1.2 times its estimate off.
    numbers = OBSERVABLES[:3] if isinstance(parts.get("law"), Dugdale) else OBSERVABLES
    rough, fine = (halfspace.trace(tabor, **parts, rtol=rtol) for rtol in tolerances)
    assert rough.met
    assert fine.met
    assert list(rough.events) == list(fine.events)
    assert not rough.unconfirmed
    assert differing(rough, fine, numbers) == []
    assert rough.energy.agrees(fine.energy)
    assert not rough.margin or rough.margin.agrees(fine.margin)


def test_the_change_before_the_last_counts_for_a_fifth_on_grids_of_the_half_space():
    path = halfspace.trace(1.0, rtol=1e-3)
    rule = path.ladder.rule
    assert path.ladder.coarser
    assert rule.change([0.0, 1.0, 1.1]) == pytest.approx(0.2 * 1.0 + 0.1)
    assert rule.estimate([[5.0, 5.0]], 0.0).error == pytest.approx(5e-3 * 1e-3 * 5.0)


def test_only_the_last_rung_is_solved_on_its_twin(monkeypatch):
    """Which makes errors no smaller: where they are too large without it, the next rung is climbed to first."""
    asked, with_twin = [], stages.with_twin

    def noting(own, twin, again):
        asked.append(twin)
        return with_twin(own, twin, again)

    monkeypatch.setattr(stages, "with_twin", noting)
    path = halfspace.trace(1.0, law=Dugdale(0.1), rtol=1e-4)
    assert path.met
    assert path.settings["events"]["nodes"] >= path.settings["curve"]["nodes"] + 3  # the second rung has three more
    twins = [twin for twin in asked if twin is not None]
    assert len(twins) >= len(path.events)
    assert all(twin is path.ladder.twin for twin in twins)


def test_a_rung_whose_twin_is_far_off_is_left_for_the_next(monkeypatch):
    """That of the first rung is pretended to be, whose own chain meets the tolerance."""
    usual = halfspace.trace(1.0, rtol=1e-4)
    firsts, with_twin = [], stages.with_twin

    def pretending(own, twin, again):
        chains = with_twin(own, twin, again)
        firsts.append(twin)
        if twin is firsts[0]:
            point = chains[1][0].point
            chains[1][0] = replace(chains[1][0], point=replace(point, observables=point.observables + 0.1))
        return chains

    monkeypatch.setattr(stages, "with_twin", pretending)
    path = halfspace.trace(1.0, rtol=1e-4)
    assert path.met
    assert path.settings["events"]["nodes"] > usual.settings["events"]["nodes"]


def test_a_layers_twin_has_images_of_its_own():
    """What their fit leaves is the same on all grids that share them: a stiff stack was five estimates off."""
    ladder = halfspace.trace(1.0, body=Layer(1.0, 0.3), rtol=1e-3).ladder
    images = [stage.charts[0].problem.interface.operator.images for stage in (*ladder.chain, ladder.twin)]
    counts = [one.depths.size for one in images]
    assert len({*counts[:-1]}) == 1
    assert counts[-1] > counts[0]
