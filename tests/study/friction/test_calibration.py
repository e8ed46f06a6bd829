import numpy as np
import pandas as pd
import pytest
import xarray as xr

from blockshake.errors import InputError
from blockshake.study.friction.calibration import search_mean, weigh_means, with_mean
from blockshake.study.friction.search import friction_summary
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.sampling.latin_hypercube import draw_samples

N_REPLICATES = 4


def _parabola(truth, spread, floor=0.02, flat_above=np.inf):
    """Scores of an experiment whose truth is known: a valley, flat above a point, replicates that scatter."""
    asked = []

    def evaluate(mean):
        asked.append(mean)
        depth = (min(mean, flat_above) - min(truth, flat_above)) ** 2
        # what replicates share and what they do not
        own = np.random.default_rng(int(1e6 * min(mean, flat_above))).normal(0.0, spread, N_REPLICATES)
        return floor + depth + np.linspace(-1e-3, 1e-3, N_REPLICATES) + own

    return evaluate, asked


@pytest.mark.parametrize("truth", [0.42, 0.5, 0.63])
def test_a_valley_gives_an_interval_around_its_bottom(truth):
    evaluate, asked = _parabola(truth, 2e-5)
    found = search_mean(evaluate, 0.3, 0.8, 0.1, 0.0125)
    assert found.lower < truth < found.upper
    assert found.upper - found.lower < 0.1
    assert found.answer == f"between {found.lower:g} and {found.upper:g}"
    assert abs(found.best - truth) < 0.03
    # coarse candidates and a few about the bottom, not a fine grid over all
    assert len(asked) == len(set(asked)) < 16


def test_more_scatter_gives_a_wider_interval():
    narrow, wide = (search_mean(_parabola(0.5, spread)[0], 0.3, 0.8, 0.1, 0.0125) for spread in (1e-5, 1e-3))
    assert wide.upper - wide.lower > narrow.upper - narrow.lower


def test_a_shelf_is_not_informed_above_its_edge():
    """A block rocks before it slides where friction exceeds b/h (Shenton 1996): no data inform it above that."""
    found = search_mean(_parabola(0.75, 1e-6, flat_above=0.5)[0], 0.3, 0.8, 0.1, 0.0125)
    assert np.isnan(found.upper)
    first = found.table.index[found.table["accepted"]][0]
    assert found.answer == f"not informed above {first:g}"
    assert found.lower < 0.5
    assert first == pytest.approx(0.5, abs=0.02)


def test_scores_that_are_all_alike_inform_of_nothing():
    found = search_mean(lambda mean: np.full(3, 0.01) + 1e-8 * mean, 0.3, 0.8, 0.1, 0.01)
    assert found.answer == "not informed between 0.3 and 0.8"
    assert found.table["accepted"].all()
    assert len(found.table) == 6


def test_a_refused_mean_between_accepted_ones_is_accepted():
    scores = {0.3: [2e-2, 2.1e-2], 0.4: [1e-2, 1.001e-2], 0.5: [1.1e-2, 1.101e-2], 0.6: [1e-2, 1.001e-2]}
    found = weigh_means({mean: np.array(values) for mean, values in scores.items()})
    assert found.table["accepted"].tolist() == [False, True, True, True]


def test_replicates_that_agree_refuse_nothing_by_micrometres():
    scores = {0.3: np.full(3, 39.005e-3), 0.4: np.full(3, 39.0e-3), 0.5: np.full(3, 41.0e-3)}
    assert weigh_means(scores).table["accepted"].tolist() == [True, True, False]


def test_one_replicate_tells_nothing():
    with pytest.raises(InputError, match="expected at least two, not 1"):
        weigh_means({0.3: np.array([1.0])})


def test_another_mean_keeps_variation_and_pairing():
    names = ["friction.concrete.concrete", "friction.concrete.foundation"]
    design = draw_samples(20, seed=3).values
    scaled = with_mean(design, TABLE_2, names, 0.5)
    for name in names:
        np.testing.assert_allclose(scaled[name], design[name] * 0.5 / 0.75, rtol=1e-12)
    others = [name for name in design if name not in names]
    assert scaled[others].equals(design[others])


@pytest.mark.parametrize(
    ("chance", "answer"), [(0.4, "not informed above 0.4"), (0.02, "unknown: no mean fits")]
)
def test_where_no_mean_fits_nothing_is_said_of_friction(chance, answer):
    scores = {0.3: [2e-2, 2.1e-2], 0.4: [1e-2, 1.001e-2], 0.5: [1e-2, 1.002e-2]}
    found = weigh_means({mean: np.array(values) for mean, values in scores.items()})
    beside = pd.DataFrame({"chance": chance, "coverage": 0.5}, index=found.table.index)
    made = friction_summary(found, beside, {"size": 50}, xr.Dataset())
    assert made["answer"].startswith(answer)
