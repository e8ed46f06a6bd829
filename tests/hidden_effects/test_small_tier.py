"""The small tier: a clean case, three effects, and one that the candidates lack, through the ordinary rules.

Its seeds were fixed before any of the cases was diagnosed, and are not changed when a test fails.
"""

import json

import pytest
from case_files import ROOT, SMALL_SEEDS, load_plan, truth_of, verdict_of
from measure_track_record import diagnose, make_cases

from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.effects.registry import EFFECTS

pytestmark = pytest.mark.hidden_effects

PLAN = load_plan(SMALL_SEEDS)
TRUTH = {case.name: case.truth for case in PLAN.cases}
CLEAN = [name for name, truth in TRUTH.items() if truth == "none"]
HIDDEN = [name for name, truth in TRUTH.items() if truth != "none"]
RESULTS = ROOT / "results" / "hidden-effects"  # beside the libraries, which stay from one call to the next
LARGEST_SET = 3
CORES = 2


def _silent(step, **facts):
    """No log."""


@pytest.fixture(scope="module")
def results():
    """Verdicts on all cases by one workflow, and on those whose effect is removed by another."""
    make_cases(PLAN, RESULTS, CORES, _silent)
    diagnose(list(TRUTH), RESULTS, "standard", CORES, None, _silent, "diagnose")
    for name in PLAN.removed:
        diagnose([name], RESULTS, "standard", CORES, TRUTH[name], _silent)
    return RESULTS


@pytest.mark.parametrize("name", CLEAN)
def test_a_clean_case_is_called_clean(name, results):
    verdict = load_verdict(verdict_of(results, name))
    assert verdict.decision == "none"
    assert set(verdict.excluded_above) <= set(EFFECTS)


@pytest.mark.parametrize("name", HIDDEN)
def test_an_effect_is_named_or_in_a_small_set(name, results):
    verdict = load_verdict(verdict_of(results, name))
    assert verdict.decision in ("named", "ambiguous")
    assert TRUTH[name] in verdict.causes
    assert len(verdict.causes) <= LARGEST_SET


@pytest.mark.parametrize("name", PLAN.removed)
def test_an_effect_that_the_candidates_lack_gets_no_others_name(name, results):
    verdict = load_verdict(verdict_of(results, name, TRUTH[name]))
    assert TRUTH[name] not in verdict.causes
    assert verdict.decision != "named"


def test_what_is_finished_is_not_done_again(results):
    before = {name: verdict_of(results, name).stat().st_mtime_ns for name in TRUTH}
    diagnose(list(TRUTH), results, "standard", CORES, None, _silent)
    assert {name: verdict_of(results, name).stat().st_mtime_ns for name in TRUTH} == before


def test_the_stop_is_reached():
    """Otherwise nothing could find it: in an open test its block goes further than its gap towards it."""
    truth = json.loads((truth_of(RESULTS, "small-3") / "truth.json").read_text())
    place, gap = truth["effect"]["place"], truth["effect"]["values"]["gap"]
    side = 1.0 if place["axis"] == "+x" else -1.0
    # the stop is 0.15 m above the upper marker
    reached = [
        max(side * end for end in truth["tests"][name]["drift"][place["body"]])
        for name in ("alkion-250", "basso-tirreno-200")
    ]
    assert max(reached) > 0.9 * gap
