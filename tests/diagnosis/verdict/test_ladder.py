"""Each rung of the ladder of words, and every reason for which a cause is not called established."""

import pytest
import xarray as xr
from made_up_decision import made_up_decision

from blockshake.diagnosis.verdict.ladder import ESTABLISHED, NOTHING, ONE_OF, PROBABLE, UNKNOWN, rung
from blockshake.diagnosis.verdict.verdict import Contrast, Gain

NAMED = made_up_decision("named", ["table-pitch"])
GAINED = Contrast(estimate=0.5, lower=0.2, upper=0.8)
GAIN = Gain(recalibrated=GAINED, nominal=GAINED, discrepancy=GAINED)
SCORES = xr.Dataset({"gain": ("rival", [0.5]), "confirmed": True}, {"rival": ["recalibrated"]})
SOUND = {
    "kind": "named", "decision": NAMED, "beside_sensor": False, "effort": "standard", "n_tests": 3, "gain": GAIN,
    "scores": SCORES,
}  # fmt: skip


def _with(rival, **changed):
    return {"gain": GAIN.model_copy(update={rival: GAINED.model_copy(update=changed)})}


def test_a_cause_that_lacks_nothing_is_established():
    assert rung(**SOUND) == (ESTABLISHED, ())


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"effort": "quick"}, "quick"),
        ({"n_tests": 2}, "2 tests only"),
        ({"beside_sensor": True}, "sensor's fault acts beside"),
        ({"decision": NAMED.model_copy(update={"solver_dependent": ("ls-dem",)})}, "LS-DEM alone"),
        (
            {"decision": NAMED.model_copy(update={"constancy": {"table-pitch": 0.001}})},
            "not the same in all tests",
        ),
        ({"gain": None}, "no gain"),
        (_with("recalibrated", lower=-0.1), "nothing or a loss"),
        (_with("discrepancy", estimate=-0.2), "without a name"),
        ({"scores": SCORES.assign(confirmed=False)}, "not each solver"),
        ({"scores": SCORES.assign(gain=SCORES["gain"] * float("nan"))}, "nothing to gain"),
    ],
)
def test_established_asks_for_all_of_the_ladder(change, reason):
    word, missing = rung(**SOUND | change)
    assert word == PROBABLE
    assert len(missing) == 1
    assert reason in missing[0]


@pytest.mark.parametrize(("kind", "word"), [("none", NOTHING), ("unknown", UNKNOWN), ("ambiguous", ONE_OF)])
def test_other_answers_have_a_word_of_their_own(kind, word):
    causes = ["table-pitch", "weak-joint"] if kind == "ambiguous" else []
    assert rung(**SOUND | {"kind": kind, "decision": made_up_decision(kind, causes)}) == (word, ())


def test_a_sensor_fault_alone_is_probable_at_most():
    found = rung(**SOUND | {"decision": made_up_decision("none"), "beside_sensor": True, "gain": None})
    assert found == (
        PROBABLE, ("the sensors' checks alone found it", "no gain was measured on a sealed test")
    )  # fmt: skip
