"""The paper's ranking against made-up scores."""

import numpy as np
import pytest
import xarray as xr

from blockshake.simulation.models import MODELS
from blockshake.study.comparison.ranking import (
    CLAIMS,
    ELASTIC,
    FEWEST_JUDGED,
    MET,
    NOT_MET,
    OPEN,
    RIGID,
    VISCOELASTIC,
    judge,
)

BEST, POOR = CLAIMS
AS_PUBLISHED = {VISCOELASTIC: 1.0, RIGID: 2.0, ELASTIC: 3.0}  # mm
CASES = [f"configuration-{place}" for place in (1, 2, 3, 4)]


def scored(scores, half_width=0.1, synthetic=0, samples=FEWEST_JUDGED):
    """A comparison whose scores have intervals of a half width."""
    models = list(scores)
    values = np.array([scores[model] for model in models])
    difference = values[None, :] - values[:, None]
    limits = np.stack([difference - half_width, difference + half_width])
    return xr.Dataset(
        {
            "score_difference_interval": (("bound", "model", "other"), limits),
            "counted": ("model", [samples] * len(models)),
        },
        {"bound": ["lower", "upper"], "model": models, "other": models},
        {"synthetic": synthetic},
    )


def test_the_claims_name_models_of_the_table():
    assert {RIGID, ELASTIC, VISCOELASTIC} <= set(MODELS)
    assert not MODELS[ELASTIC].rigid
    assert MODELS[RIGID].rigid


def test_scores_as_published_meet_both_claims():
    comparisons = {case: scored(AS_PUBLISHED) for case in CASES}
    best, poor = judge(BEST, comparisons), judge(POOR, comparisons)
    assert (best.answer, best.borne_out) == (MET, 8)
    assert (poor.answer, poor.borne_out) == (MET, 4)


@pytest.mark.parametrize("case", CASES)
def test_one_configuration_the_other_way_round_is_enough_against_a_claim(case):
    comparisons = {name: scored(AS_PUBLISHED) for name in CASES}
    comparisons[case] = scored({VISCOELASTIC: 3.0, RIGID: 2.0, ELASTIC: 1.0})
    found = judge(BEST, comparisons)
    assert (found.answer, found.contradicted) == (NOT_MET, 2)
    # the elastic model is said to be poor for the last two configurations only
    assert judge(POOR, comparisons).answer == (NOT_MET if case in CASES[2:] else MET)


def test_scores_within_their_intervals_judge_nothing():
    found = judge(BEST, {case: scored(AS_PUBLISHED, half_width=1.5) for case in CASES})
    assert (found.answer, found.borne_out, found.untold) == (OPEN, 4, 4)


def test_models_and_configurations_that_did_not_run_are_counted():
    without = {case: scored(AS_PUBLISHED) for case in CASES[:3]}
    without[CASES[0]] = scored({RIGID: 1.0})
    found = judge(BEST, without)
    assert (found.answer, found.borne_out, found.unknown) == (OPEN, 4, 4)
    without[CASES[0]] = scored(AS_PUBLISHED | {VISCOELASTIC: np.nan})
    assert judge(BEST, without).unknown == 4


def test_few_samples_judge_nothing():
    found = judge(BEST, {case: scored(AS_PUBLISHED, samples=FEWEST_JUDGED - 1) for case in CASES})
    assert (found.answer, found.unknown) == (OPEN, 8)


def test_synthetic_tests_leave_the_answer_open_and_the_scores_said():
    found = judge(BEST, {case: scored(AS_PUBLISHED, synthetic=1) for case in CASES})
    assert (found.answer, found.by_scores, found.synthetic) == (OPEN, MET, True)
