"""The small tier: a clean case and three effects, made, diagnosed and held against their truths.

Its seeds were fixed before any of the cases was diagnosed, and are not changed when a test fails.
"""

import pytest
from answers import Scored
from case_files import ROOT, SMALL_SEEDS, load_plan, truth_of, verdict_of
from measure_track_record import diagnose, make_cases

from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.effects.registry import EFFECTS
from blockshake.files import load_json

pytestmark = pytest.mark.hidden_effects

PLAN = load_plan(SMALL_SEEDS)
CASES = {case.name: case for case in PLAN.cases}
CLEAN = [name for name, case in CASES.items() if not case.causes]
HIDDEN = [name for name, case in CASES.items() if case.causes]
RESULTS = ROOT / "results" / "hidden-effects"
LARGEST_SET = 3
CORES = 2


def _silent(step, **facts):
    """No log."""


@pytest.fixture(scope="module")
def scored():
    """Cases with their verdicts."""
    make_cases(PLAN.cases, RESULTS, CORES, _silent)
    diagnose(PLAN.cases, RESULTS, CORES, _silent)
    return {
        name: Scored(name, load_json(truth_of(RESULTS, name)), load_verdict(verdict_of(RESULTS, name)))
        for name in CASES
    }


@pytest.mark.parametrize("name", CLEAN)
def test_a_clean_case_is_called_clean(name, scored):
    assert scored[name].verdict.decision == "none"
    assert set(scored[name].verdict.excluded_above) <= set(EFFECTS)


@pytest.mark.parametrize("name", HIDDEN)
def test_an_effect_is_named_or_in_a_small_set(name, scored):
    """A stop that its block does not reach would be nothing to find."""
    assert scored[name].can_be_seen
    assert scored[name].answer in ("right", "set_with")
    assert len(scored[name].verdict.causes) <= LARGEST_SET


def test_what_is_finished_is_not_done_again(scored):
    before = {name: verdict_of(RESULTS, name).stat().st_mtime_ns for name in scored}
    diagnose(PLAN.cases, RESULTS, CORES, _silent)
    assert {name: verdict_of(RESULTS, name).stat().st_mtime_ns for name in scored} == before
