import pytest

from blockshake.diagnosis.answer.decision import check_frozen, freeze
from blockshake.errors import InputError


def test_a_decision_that_was_changed_after_it_was_frozen_is_refused(tmp_path):
    decision, frozen = tmp_path / "decision.json", tmp_path / "frozen.json"
    decision.write_text('{"causes": []}')
    freeze(frozen, decision, ["t1"])
    check_frozen(frozen, decision)
    decision.write_text('{"causes": ["weak-joint"]}')
    with pytest.raises(InputError, match="expected the file that was frozen"):
        check_frozen(frozen, decision)
