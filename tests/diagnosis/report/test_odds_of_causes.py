"""The section of odds: how the chosen cause fares on the tests to select by."""

from types import SimpleNamespace

import pytest
from made_up_decision import made_up_part

from blockshake.diagnosis.answer.decision import HeldOut
from blockshake.diagnosis.evidence.explanation import NEVER
from blockshake.diagnosis.report.odds_section import odds_section
from blockshake.pages.blocks import Text


@pytest.mark.parametrize(
    ("gain", "expected", "p", "words"),
    [
        (15.0, 16.0, 1.7e-5, "tried: p = 1.7e-05. The cause holds at the level of 0.05"),
        (2.0, 16.0, 1.0, "tried: p = 1. The cause does not hold at the level of 0.05"),
        (0.1, 0.3, 1.0, "Held out: t4 cannot tell"),
    ],
)
def test_the_cause_is_held_against_the_tests_to_select_by(gain, expected, p, words):
    held_out = HeldOut(tests=("t4",), gain=gain, tried=55, p=p, expected=expected)
    part = made_up_part("eccentricity").model_copy(update={"held_out": held_out})
    diagnosed = SimpleNamespace(decision=SimpleNamespace(parts=(part,)))
    *_, last = (one.text for one in odds_section(diagnosed).blocks if isinstance(one, Text))
    assert words in last


def test_a_cause_that_cannot_be_has_no_row():
    part = made_up_part("eccentricity", "push")
    part = part.model_copy(update={"gains": part.gains | {"push": NEVER}})
    _, table = odds_section(SimpleNamespace(decision=SimpleNamespace(parts=(part,)))).blocks
    assert [row[0] for row in table.rows] == ["eccentric mass of a block", "nothing"]
