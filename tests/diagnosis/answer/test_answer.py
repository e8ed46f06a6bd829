"""From evidences to an answer: thresholds, coarsened odds, free forces and sets."""

from types import SimpleNamespace

import numpy as np
import pytest

from blockshake.diagnosis.answer.answer import (
    COARSENING,
    ODDS,
    Rival,
    coarsened,
    group_of,
    needed_beside,
    slab_groups,
)
from blockshake.diagnosis.outside import free_force


def rivals(**scores):
    """By falling score; the gain is the score."""
    found = [Rival(name.replace("_", "-"), "there", gain, gain, ("there",)) for name, gain in scores.items()]
    return sorted(found, key=lambda one: -one.score)


def causes(group):
    return tuple(one.cause for one in group.rivals)


def test_odds_of_small_gains_are_plain_and_those_of_large_ones_a_share_of_what_is_explained():
    assert coarsened(2.0, 0.0) == 2.0
    # a form that leaves the share delta of a large gain unexplained is within the odds, just so
    assert coarsened(COARSENING * 1e6, 1e6) == pytest.approx(ODDS, rel=1e-3)


def test_nothing_strong_is_no_answer():
    assert group_of(rivals(eccentricity=5.9, unknown_force=19.9)) is None
    assert causes(group_of(rivals(eccentricity=6.1))) == ("eccentricity",)


def test_a_rival_within_the_odds_is_in_the_set_and_forms_from_outside_are_said():
    group = group_of(rivals(eccentricity=30.0, push=29.0, drag=10.0))
    assert causes(group) == ("eccentricity", "push")
    assert group.gains["drag"] == 10.0


def test_a_second_cause_needs_more_beside_a_large_first_one():
    assert needed_beside(False) == 0.0
    assert needed_beside(False, 1000.0) - needed_beside(False, 0.0) == pytest.approx(100.0)
    assert needed_beside(True, 0.0) > needed_beside(False, 0.0) > 0.0
    assert group_of(rivals(weak_joint=15.0), needed=10.0) is None
    assert causes(group_of(rivals(weak_joint=17.0), needed=10.0)) == ("weak-joint",)


def test_lost_friction_needs_more_where_no_normal_force_is_known():
    assert group_of(rivals(weak_joint=39.0), tree=False) is None
    assert causes(group_of(rivals(weak_joint=41.0), tree=False)) == ("weak-joint",)
    assert causes(group_of(rivals(eccentricity=9.0), tree=False)) == ("eccentricity",)


def test_the_slab_s_rotation_and_its_vertical_motion_are_judged_apart():
    gains = {"table-pitch": 40.0, "base-compliance": 39.5, "vertical-motion": -200.0}
    explained = {name: SimpleNamespace(gain=gain) for name, gain in gains.items()}
    ((readings, turning),) = slab_groups(explained)
    assert readings == "rotation of the slab"
    assert causes(turning) == ("table-pitch", "base-compliance")
    assert slab_groups({name: SimpleNamespace(gain=-1.0) for name in gains}) == []
    assert np.isfinite(turning.odds["base-compliance"])


def test_the_size_of_a_force_without_form_is_its_standard_deviation(monkeypatch):
    gains = {300.0: 1.0, 1e3: 8.0, 3e3: 6.0, 1e4: 2.0}  # by size [N]
    rows = [np.array([700.0, -400.0]), np.array([50.0])]
    monkeypatch.setattr(free_force, "_with_force", lambda likelihood, points, size: (gains[size], rows))
    best = free_force.explain_free_force(None, SimpleNamespace(place="block-1")).best
    assert best.mean == [1e3]
    for column, expected in zip(best.columns, rows, strict=True):
        np.testing.assert_allclose(column @ best.mean, expected)
