"""The paper's ranking against made-up scores."""

import numpy as np
import pytest
import xarray as xr

from blockshake.simulation.models import MODELS
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.comparison.ranking import ELASTIC, RIGID, VISCOELASTIC, rank_viscoelastic

AS_PUBLISHED = {VISCOELASTIC: 1.0, RIGID: 2.0, ELASTIC: 3.0}  # mm
CASES = [f"configuration-{place}" for place in (1, 2, 3, 4)]


def scored(scores, half_width=0.1, samples=SURE_FROM):
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
    )


def test_the_behaviours_are_models_of_the_table():
    assert {RIGID, ELASTIC, VISCOELASTIC} <= set(MODELS)
    assert not MODELS[ELASTIC].rigid
    assert MODELS[RIGID].rigid


def test_scores_as_published_bear_all_comparisons_out():
    assert rank_viscoelastic({case: scored(AS_PUBLISHED) for case in CASES}) == (8, 0, 0, 0)


@pytest.mark.parametrize("case", CASES)
def test_one_configuration_the_other_way_round_contradicts(case):
    comparisons = {name: scored(AS_PUBLISHED) for name in CASES}
    comparisons[case] = scored({VISCOELASTIC: 3.0, RIGID: 2.0, ELASTIC: 1.0})
    assert rank_viscoelastic(comparisons) == (6, 2, 0, 0)


def test_scores_within_their_intervals_are_not_told_apart():
    found = rank_viscoelastic({case: scored(AS_PUBLISHED, half_width=1.5) for case in CASES})
    assert (found.borne_out, found.untold) == (4, 4)


def test_models_and_configurations_that_did_not_run_are_counted():
    without = {case: scored(AS_PUBLISHED) for case in CASES[:3]}
    without[CASES[0]] = scored({RIGID: 1.0})
    found = rank_viscoelastic(without)
    assert (found.borne_out, found.unknown) == (4, 4)
    without[CASES[0]] = scored(AS_PUBLISHED | {VISCOELASTIC: np.nan})
    assert rank_viscoelastic(without).unknown == 4


def test_few_samples_judge_nothing():
    found = rank_viscoelastic({case: scored(AS_PUBLISHED, samples=SURE_FROM - 1) for case in CASES})
    assert found.unknown == 8
