"""Where a placebo acts, and what an extension is in the store."""

from made_up_decision import made_up_cause

from blockshake.diagnosis.gain.extended_model import Extension, placebo_of
from blockshake.geometry.structure import load_structure

STRUCTURE = load_structure("configuration-1")
OFFSETS = ({"offset": 0.03}, {"offset": 0.04})


def _cause(place, places, name="eccentricity", members=OFFSETS, **when):
    return made_up_cause(name, place, places=places, members=members, **when)


def test_a_placebo_acts_where_the_readings_say_that_the_cause_is_not():
    causes = (_cause({"body": "block-1"}, ["block-1", "block-2"]),)
    (moved,) = placebo_of(causes, STRUCTURE)
    assert moved.place == {"body": "block-3"}
    assert moved.members == causes[0].members
    # the farthest along the stack
    (moved,) = placebo_of((_cause({"body": "block-3"}, ["block-3"]),), STRUCTURE)
    assert moved.place == {"body": "block-1"}


def test_a_height_and_a_joint_keep_what_else_says_where():
    cause = _cause({"body": "block-3", "height": 0.42}, ["block-3@0.42", "block-3@0"], "stopper-contact")
    assert placebo_of((cause,), STRUCTURE)[0].place == {"body": "block-1", "height": 0.42}
    joint = _cause({"joint": ["block-1", "block-2"]}, ["block-1-block-2", "block-2-block-3"], "weak-joint")
    assert placebo_of((joint,), STRUCTURE)[0].place == {"joint": ["slab", "block-1"]}


def test_no_placebo_where_every_place_may_be_the_cause_s_or_it_has_none():
    everywhere = _cause({"body": "block-1"}, ["block-1", "block-2", "block-3"])
    assert placebo_of((everywhere,), STRUCTURE) == ()
    assert placebo_of((_cause({}, ["all"], "table-pitch"),), STRUCTURE) == ()


def test_the_store_tells_extensions_apart_by_what_acts():
    here, there = _cause({"body": "block-1"}, ["block-1"]), _cause({"body": "block-2"}, ["block-2"])
    acting = ((here,), 0), ((here,), 1), ((there,), 0), ((here, there), 0)
    digests = [Extension(causes, number, "t1").digest for causes, number in acting]
    assert len(set(digests)) == len(digests)
    # an effect of the registry acts alike in all tests; the third member is the first again
    assert Extension((here,), 2, "t2").digest == digests[0]
    place, when = {"body": "block-1", "height": 0.0}, {"starts": {"t1": 1.0}}
    push = _cause(place, ["block-1@0"], "push", ({"force": 1e3},), when=when)
    assert Extension((push,), 0, "t1").digest != Extension((push,), 0, "t2").digest
