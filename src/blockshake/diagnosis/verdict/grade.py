"""The ladder of words: how strong a statement a diagnosis makes, and the reasons why it is not a stronger one."""

from typing import NamedTuple

from blockshake.diagnosis.answer.decision import HELD_OUT_LEVEL
from blockshake.pages.wording import count_words, listed

ESTABLISHED, PROBABLE, ONE_OF = "established", "probable", "one of"
UNKNOWN, NOTHING = "something acts, cause unknown", "no misfit larger than chance"
NOT_JUDGED = "no test could be judged"
_TESTS_TO_ESTABLISH = 3
_NOT_HELD = "by {} alone, to select by, it is not more than chance at the level of {:g}"


class Grade(NamedTuple):
    """Word of a verdict, and what a probable cause lacks to be called established (empty on other levels)."""

    word: str
    missing: tuple


def grade(kind, decision, with_sensor_fault, measured):
    """`Grade` of confidence on which a verdict stands.

    Parameters
    ----------
    kind : str
        Decision of the verdict, sensor faults included.
    decision : Decision
        On physical causes.
    with_sensor_fault : bool
        Whether a sensor fault is among the causes.
    measured : MeasuredGain
    """
    if kind == "none":
        return Grade(NOTHING if decision.tests else NOT_JUDGED, ())
    if kind == "unknown":
        return Grade(UNKNOWN, ())
    if kind == "ambiguous":
        return Grade(ONE_OF, ())
    missing = []
    if len(decision.parts) > 1:
        missing.append("two causes act together")
    if decision.causes and with_sensor_fault:
        missing.append("a sensor's fault acts with it")
    if decision.forms:
        missing.append("a force from outside acts with it")
    if any(path.beats for path in decision.histories):
        missing.append("sizes that change from test to test explain more")
    moved, tests = len(decision.moved), count_words(len(decision.tests), "test")
    if decision.n_rows and moved < _TESTS_TO_ESTABLISH:
        missing.append(
            f"joints moved in {moved} of {tests} only"
            if decision.silent
            else f"it was judged by {tests} only"
        )
    tested = (part.held_out for part in decision.parts if part.held_out)
    missing += [
        _NOT_HELD.format(listed(one.tests), HELD_OUT_LEVEL) for one in tested if one.tells and not one.holds
    ]
    missing += _of_gain(measured) if decision.causes else ["the sensors' checks alone found it"]
    return Grade(PROBABLE if missing else ESTABLISHED, tuple(missing))


def _of_gain(measured):
    missing = []
    if not measured.proposes:
        missing.append("the model with it gains nothing on the tests to select by, and is not proposed")
    for gain, what in ((measured.rows, "forces"), (measured.gain, "responses")):
        if gain is None:
            missing.append(f"no gain was measured on the {what} of a sealed test")
        elif gain.recalibrated.lower <= 0.0:
            missing.append(f"the gain on the {what} of sealed tests may be nothing or a loss")
        elif gain.discrepancy.estimate < 0.0:
            missing.append(f"a discrepancy without a name predicts the {what} of sealed tests better")
    return missing
