"""Each rung of confidence of words, and every reason for which a cause is not called established."""

import pytest
from made_up_decision import made_up_decision

from blockshake.diagnosis.verdict.grade import ESTABLISHED, NOTHING, ONE_OF, PROBABLE, UNKNOWN, grade
from blockshake.diagnosis.verdict.verdict import NOTHING_TO_GAIN, Contrast, Gain, MeasuredGain

NAMED = made_up_decision("named", ("table-pitch",))
GAINED = Contrast(estimate=0.5, lower=0.2, upper=0.8)
GAIN = Gain(recalibrated=GAINED, nominal=GAINED, discrepancy=GAINED)
MEASURED = MeasuredGain(rows=GAIN, gain=GAIN)
SOUND = {"kind": "named", "decision": NAMED, "with_sensor_fault": False, "measured": MEASURED}


def _with(where, rival, **changed):
    gain = GAIN.model_copy(update={rival: GAINED.model_copy(update=changed)})
    return {"measured": MEASURED.model_copy(update={where: gain})}


def test_a_cause_that_lacks_nothing_is_established():
    assert grade(**SOUND) == (ESTABLISHED, ())


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"decision": NAMED.model_copy(update={"silent": ("t1",)})}, "joints moved in 2 of 3 tests only"),
        ({"decision": NAMED.model_copy(update={"tests": ("t1", "t2")})}, "it was judged by 2 tests only"),
        ({"decision": made_up_decision("combination", ("table-pitch",), ("weak-joint",))}, "two causes"),
        ({"with_sensor_fault": True}, "sensor's fault acts with"),
        ({"measured": MEASURED.model_copy(update={"gain": None})}, "responses"),
        ({"measured": MEASURED.model_copy(update={"rows": None})}, "forces"),
        (_with("rows", "recalibrated", lower=-0.1), "nothing or a loss"),
        (_with("gain", "discrepancy", estimate=-0.2), "without a name"),
        ({"measured": MEASURED.model_copy(update={"select": NOTHING_TO_GAIN})}, "not proposed"),
    ],
)
def test_established_asks_for_all_of_the_ladder(change, reason):
    word, missing = grade(**SOUND | change)
    assert word == PROBABLE
    assert len(missing) == 1
    assert reason in missing[0]


@pytest.mark.parametrize(("kind", "word"), [("none", NOTHING), ("unknown", UNKNOWN), ("ambiguous", ONE_OF)])
def test_other_answers_have_a_word_of_their_own(kind, word):
    assert grade(**SOUND | {"kind": kind}) == (word, ())


def test_a_sensor_fault_alone_is_probable_at_most():
    found = grade(**SOUND | {"decision": made_up_decision(), "with_sensor_fault": True})
    assert found == (PROBABLE, ("the sensors' checks alone found it",))
