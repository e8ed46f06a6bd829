"""From evidences to an answer: thresholds, coarsened odds, free forces and sets."""

from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from blockshake.diagnosis.answer.answer import (
    COARSENING,
    Alternative,
    coarsened,
    find_causes,
    further_need,
    rank,
    share_of,
    slab_groups,
)
from blockshake.diagnosis.answer.thresholds import ODDS, Thresholds, by_odds
from blockshake.diagnosis.outside import free_force


def rivals(**scores):
    """By falling score; the gain is the score."""
    found = [
        Alternative(name.replace("_", "-"), "there", gain, gain, ("there",)) for name, gain in scores.items()
    ]
    return sorted(found, key=lambda one: -one.score)


WEAK = "weak-joint"


def causes(group):
    return tuple(one.cause for one in group.rivals)


def test_odds_of_small_gains_are_plain_and_those_of_large_ones_a_share_of_what_is_explained():
    assert coarsened(2.0, 0.0) == 2.0
    # a form that leaves the share delta of a large gain unexplained is within the odds, just so
    assert coarsened(COARSENING * 1e6, 1e6) == pytest.approx(ODDS, rel=1e-3)


def found(ranked, more=0.0):
    """The group of the first cause, or None."""
    groups = find_causes(lambda known: [] if known else ranked, lambda cause, known: by_odds(cause) + more)
    return groups[0] if groups else None


def test_nothing_strong_is_no_answer():
    assert found(rivals(eccentricity=5.9, unknown_force=10.5)) is None
    assert causes(found(rivals(eccentricity=6.1))) == ("eccentricity",)


def test_a_rival_within_the_odds_is_in_the_set_and_forms_from_outside_are_said():
    group = found(rivals(eccentricity=30.0, push=29.0, drag=10.0))
    assert causes(group) == ("eccentricity", "push")
    assert group.gains["drag"] == 10.0


def test_a_second_cause_needs_more_beside_a_large_first_one():
    small, large = rivals(push=1e-9), rivals(push=1000.0)
    assert further_need(WEAK, False) == 0.0
    assert further_need(WEAK, False, large) - further_need(WEAK, False, small) == pytest.approx(100.0)
    assert further_need(WEAK, True, small) > further_need(WEAK, False, small) > 0.0
    assert found(rivals(weak_joint=15.0), more=10.0) is None
    assert causes(found(rivals(weak_joint=17.0), more=10.0)) == ("weak-joint",)


def test_no_form_from_outside_is_added_to_another():
    assert np.isinf(further_need("drag", False, rivals(loose_weight=400.0)))
    assert np.isfinite(further_need("drag", False, rivals(eccentricity=400.0)))
    assert np.isfinite(further_need("eccentricity", False, rivals(loose_weight=400.0)))


def test_causes_are_added_one_by_one_each_ranked_beside_those_before_it_until_none_is_strong():
    beside = [rivals(push=90.0, drag=89.0), rivals(eccentricity=40.0), rivals(weak_joint=10.0)]
    asked = []

    def ranked(known):
        asked.append([one.cause for one in known])
        return beside[len(known)]

    groups = find_causes(ranked, lambda cause, known: by_odds(cause) + share_of(known))
    assert list(map(causes, groups)) == [("push", "drag"), ("eccentricity",)]
    assert asked == [[], ["push"], ["push", "eccentricity"]]  # 10 nats are less than 6 and a tenth of 130


@pytest.mark.parametrize(
    ("bearing", "expected"), [(44.0, ("eccentricity", "reduced-bearing")), (30.0, ("changed-edge",))]
)
def test_a_cause_that_takes_up_what_two_made_gives_way_to_them_where_the_odds_tell(bearing, expected):
    """A changed edge of 179 nats; an eccentric block of 159, and 44 or 30 of a narrow bearing given that.

    The pair exceeds the edge by 21 or 7 nats: coarsened, by odds of e^5 or e^2. Odds of e^3 tell.
    """
    stages = {
        (): rivals(changed_edge=179.0, eccentricity=159.0, reduced_bearing=44.0),
        ("changed-edge",): rivals(reduced_bearing=16.0),
        ("eccentricity",): rivals(reduced_bearing=bearing, changed_edge=28.0),
        ("reduced-bearing",): rivals(eccentricity=161.0, changed_edge=155.0),
    }
    groups = find_causes(
        lambda known: stages.get(tuple(one.cause for one in known), []),
        lambda cause, known: by_odds(cause) + further_need(cause, False, known),
        in_pairs=True,
    )
    assert tuple(cause for group in groups for cause in causes(group)) == expected


def test_a_cause_within_chance_is_taken_out_before_another_is_asserted():
    """An edge of 60 nats that clean runs give too, and a blow of 40 that fits the same rows, or others."""
    needed = {"changed-edge": 300.0, "blow": 12.0, "eccentricity": 12.0}

    def groups(beside):
        stages = [rivals(changed_edge=60.0, blow=40.0, eccentricity=9.0), beside, rivals(blow=1.0)]
        return find_causes(lambda known: stages[len(known)], lambda cause, known: needed[cause])

    assert groups(rivals(blow=3.0)) == []
    chance, blow = groups(rivals(blow=35.0))
    assert (chance.asserted, blow.asserted) == (False, True)
    assert causes(blow) == ("blow",)


class OfTwoBlocks:
    """Evidence of one cause, 85 nats at block-1 and less at two others, of which the readings bear out some."""

    gains: ClassVar = {"block-1": 85.0, "block-2": 70.0, "block-3": 10.0}
    keys: ClassVar = [("eccentricity", place) for place in gains]

    def __init__(self, contrast):
        self.contrast = contrast

    def gain(self, key):
        """Over none."""
        return self.gains[key[1]]

    def apart(self, cause, places):
        """The smaller of both, plain."""
        return [min(self.gains[places[0]] - self.gains[place], self.contrast) for place in places]


@pytest.mark.parametrize(
    ("contrast", "joined", "places"),
    [
        (100.0, [], ("block-1",)),
        (1.0, [], ("block-1", "block-2", "block-3")),  # the columns hardly differ: more is no evidence
        (100.0, [{"block-1", "block-2"}], ("block-1", "block-2")),  # their joint opened in no test
        (100.0, [{"block-2", "block-3"}], ("block-1",)),
    ],
)
def test_places_are_told_apart_where_the_readings_tell_them(contrast, joined, places):
    (rival,) = rank(OfTwoBlocks(contrast), joined=joined)
    assert rival.places == places
    # with it the same cause at one of its places is no other cause
    left = [place for place in OfTwoBlocks.gains if place not in places]
    again = rank(OfTwoBlocks(contrast), joined=joined, known=[rival])
    assert [one.place for one in again] == left[:1]


def test_the_slab_s_rotation_and_its_vertical_motion_are_judged_apart():
    gains = {"table-pitch": 40.0, "base-compliance": 39.5, "vertical-motion": -200.0}
    explained = {name: SimpleNamespace(gain=gain) for name, gain in gains.items()}
    ((readings, turning),) = slab_groups(explained, Thresholds())
    assert readings == "rotation of the slab"
    assert causes(turning) == ("table-pitch", "base-compliance")
    assert slab_groups({name: SimpleNamespace(gain=-1.0) for name in gains}, Thresholds()) == []
    assert np.isfinite(turning.odds["base-compliance"])


def test_the_size_of_a_force_without_form_is_its_standard_deviation(monkeypatch):
    gains = {300.0: 1.0, 1e3: 8.0, 3e3: 6.0, 1e4: 2.0}  # by size [N]
    rows = [np.array([700.0, -400.0]), np.array([50.0])]
    monkeypatch.setattr(
        free_force, "_with_force", lambda likelihood, points, columns, size: (gains[size], [], [])
    )
    monkeypatch.setattr(free_force, "_posterior_mean", lambda *arguments: rows)
    likelihood = SimpleNamespace(keeping=lambda key, compute: [])
    best = free_force.explain_free_force(likelihood, SimpleNamespace(place="block-1")).best
    assert best.mean == [1e3]
    for column, expected in zip(best.columns, rows, strict=True):
        np.testing.assert_allclose(column @ best.mean, expected)
