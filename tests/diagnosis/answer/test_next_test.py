"""Measurements after a test: what they read by statics, and how often they split a set."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_up_decision import made_up_cause

from blockshake.diagnosis.answer.answer import COARSENING
from blockshake.diagnosis.answer.next_test import _split, next_tests, readings_of_cause
from blockshake.diagnosis.answer.places import joined_bodies, place_name
from blockshake.diagnosis.answer.static_tests import distance, expected_readings, static_tests
from blockshake.diagnosis.answer.thresholds import ODDS
from blockshake.forces.faces import find_faces
from blockshake.geometry.structure import load_structure

BASE, UPPER = {"joint": ["slab", "block-1"]}, {"joint": ["block-1", "block-2"]}


@pytest.fixture(scope="module")
def seen():
    """Three equal blocks on a slab: of a seen test the structure and its faces alone."""
    structure = load_structure("configuration-1")
    faces, free = find_faces(structure), np.flatnonzero(~structure.driven)
    none = SimpleNamespace(force=np.zeros((0, len(faces))))
    return SimpleNamespace(
        structure=structure, faces=faces, free=free, tree=len(faces) == len(free), forces=none
    )


def _moved(seen, *joints):
    """The seen test of a few instants at which some of its joints turned, and no other moved."""
    shape = (4, len(seen.faces))
    edge, rest = np.zeros((*shape, 2)), np.zeros(shape)
    for index, face in enumerate(seen.faces):
        edge[2, index, 0] = face.name in joints
    states = SimpleNamespace(edge=edge, slip=rest, lifted=rest)
    return SimpleNamespace(**vars(seen) | {"forces": SimpleNamespace(force=rest), "states": states})


def _cause(name, place, odds=0.0, when=None, **sizes):
    parameters = {
        key: {"estimate": value, "lower": 0.9 * value, "upper": 1.1 * value, "unit": "1"}
        for key, value in sizes.items()
    }
    places = {"places": (place_name(place),), "odds": odds, "parameters": parameters, "when": when or {}}
    return made_up_cause(name, place, **places)


def test_an_eccentric_block_leans_every_joint_below_it_by_its_share_of_the_mass(seen):
    """Statics: the resultant on a joint passes through the common mass centre of what it carries."""
    read = expected_readings(seen, "eccentricity", {"body": "block-2"}, {"offset": 0.06})
    assert read == pytest.approx(
        {("centre", "block-2"): 0.06, ("lean", "slab-block-1"): 0.02, ("lean", "block-1-block-2"): 0.03}
    )


def test_worn_edges_come_in_on_both_sides_and_a_push_leaves_nothing_to_read(seen):
    worn = expected_readings(seen, "reduced-bearing", {}, {"inset": 0.05})
    assert worn == {("lever", face.name): -0.05 for face in seen.faces}
    assert expected_readings(seen, "push", {"body": "block-3", "height": 0.4}, {"force": 4e3}) == {}


def test_a_slow_push_tells_a_weak_joint_from_friction_that_falls_with_rate(seen):
    (test,) = [one for one in static_tests(seen) if ("friction", "slab-block-1") in one.readings]
    weak = expected_readings(seen, "weak-joint", BASE, {"factor": 0.4})
    rate = expected_readings(seen, "rate-weakening-friction", {}, {"drop": 0.6, "scale": 0.01})
    deviation = test.readings["friction", "slab-block-1"]
    assert distance(test, weak, {}, rate, {}) == pytest.approx((0.6 / deviation) ** 2)
    assert distance(test, weak, {}, weak, {}) == 0.0


@pytest.mark.parametrize(("square", "behind"), [(12.0, 0.5), (30.0, 2.0), (4.0, 0.0)])
def test_the_chance_of_a_split_is_that_of_the_log_odds(seen, square, behind):
    """Two Gaussians R apart the log odds have the mean R/2 and the variance R."""
    true, rival = _cause("weak-joint", BASE, odds=behind), _cause("push", {})
    generator = np.random.default_rng(3)
    drawn = -behind + 0.5 * square + np.sqrt(square) * generator.standard_normal(100_000)
    assert _split(true, rival, square, 0.0, rows=False) == pytest.approx(np.mean(drawn > ODDS), abs=0.01)
    share = 1.0 / (1.0 + COARSENING * true.gain / ODDS)
    coarsened = -behind + share * (0.5 * square + np.sqrt(square) * generator.standard_normal(100_000))
    assert _split(true, rival, square, 0.0, rows=True) == pytest.approx(np.mean(coarsened > ODDS), abs=0.01)


def test_measurements_are_ranked_and_none_is_told_for_a_single_cause(seen):
    weak = _cause("weak-joint", UPPER, factor=0.3)
    rate = _cause("rate-weakening-friction", {}, odds=1.2, drop=0.7, scale=0.01)
    ranked = next_tests([weak, rate], [seen], None)
    assert "push block-2 with a jack" in ranked[0].test
    assert ranked[0].between == ("weak-joint", "rate-weakening-friction")
    assert [one.share for one in ranked] == sorted((one.share for one in ranked), reverse=True)
    assert next_tests([weak], [seen], None) == ()


def test_weighing_the_right_block_splits_an_eccentric_block_from_a_push(seen):
    heavy = _cause("eccentricity", {"body": "block-2"}, offset=0.05)
    push = _cause(
        "push", {"body": "block-3", "height": 0.4}, odds=1.0, when={"starts": {"t1": 0.0}}, force=3e3
    )
    shares = {one.test: one.share for one in next_tests([heavy, push], [seen], None)}
    assert shares["weigh block-2 on two supports"] > 0.95
    assert "weigh block-1 on two supports" not in shares


def test_where_the_block_is_not_known_weighing_one_splits_as_often_as_it_is_the_one(seen):
    heavy = _cause("eccentricity", {"body": "block-2"}, offset=0.05)
    anywhere = heavy.model_copy(update={"places": ("block-2", "block-1")})
    push = _cause(
        "push", {"body": "block-3", "height": 0.4}, odds=6.0, when={"starts": {"t1": 0.0}}, force=3e3
    )
    shares = {one.test: one.share for one in next_tests([anywhere, push], [seen], None)}
    assert shares["weigh block-2 on two supports"] == pytest.approx(0.5, abs=0.02)


def test_a_form_of_the_size_is_not_taken_for_the_size(seen):
    """For worn edges ``when`` states how the inset goes with the rotation, under the name of the size."""
    worn = _cause("reduced-bearing", {}, inset=0.05, when={"inset": "rolling"})
    ((middle, errors),) = readings_of_cause(seen, worn)
    assert set(middle.values()) == {-0.05}
    assert list(errors.values()) == pytest.approx([0.01 / 3.29] * len(seen.faces))


def test_blocks_whose_joint_opened_in_no_test_are_told_apart_by_what_opens_or_weighs_it(seen):
    moved = _moved(seen, "slab-block-1", "block-2-block-3")
    assert joined_bodies([moved]) == [{"block-1", "block-2"}]
    assert joined_bodies([moved, _moved(seen, "block-1-block-2")]) == []
    places = {"places": ("block-1", "block-2"), "gain": 85.0}
    eccentric = _cause("eccentricity", {"body": "block-1"}, offset=0.035).model_copy(update=places)
    ranked = next_tests([eccentric], [moved], None)
    assert {one.between for one in ranked} == {("block-1", "block-2")}
    shares = {one.test: one.share for one in ranked}
    assert min(shares.values()) > 0.9
    assert set(shares) == {
        "weigh block-1 on two supports",
        "weigh block-2 on two supports",
        "weigh block-2 by a wedge under each edge until block-1-block-2 opens",
        "a stronger test, in which block-1-block-2 opens",
    }
