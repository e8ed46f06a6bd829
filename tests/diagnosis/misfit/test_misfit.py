"""Misfit of Gaussian ensembles: a nominal test is one more member, and a departure is found where it is."""

import numpy as np
import pytest
from fair_score import crps
from judged_tests import CELLS, TIME, judged
from scipy.stats import kstest

from blockshake.diagnosis.misfit.misfit import misfit

COUNT = 20


def _curves(generator, count):
    """Curves with a memory: a few sines of random size."""
    phase = np.arange(1, 5)[:, None] * TIME * 3.0
    return np.einsum("ncf,ft->ntc", generator.normal(size=(count, len(CELLS), 4)), np.sin(phase))


def _test(seed, moved=0.0, name="t1", horizon=None):
    generator = np.random.default_rng(seed)
    members, measured = _curves(generator, COUNT), _curves(generator, 1)[0]
    return judged(name, measured + moved, {"nominal": members}, horizon)


def test_the_score_is_the_ranked_probability_score_until_the_horizon():
    test = _test(1, horizon=[0.5, 1.0, 2.0, 2.0, 2.0])
    found = misfit([test])
    scores = crps(test.members["nominal"].to_numpy(), test.measured.to_numpy())
    expected = [np.mean(scores[end >= TIME, cell]) for cell, end in enumerate(test.horizon)]
    np.testing.assert_allclose(found["score"].isel(test=0), expected, rtol=1e-10)
    drift = test.members["nominal"].to_numpy()[..., 4]
    own = [crps(np.delete(drift, number, axis=0), drift[number]) for number in range(COUNT)]
    assert float(found["usual"][0, 4]) == pytest.approx(np.median(np.mean(own, axis=1)), rel=1e-10)


def test_chances_of_nominal_tests_are_uniform():
    chances = [misfit([_test([seed, 3]), _test([seed, 4], name="t2")]) for seed in range(150)]
    whole = np.array([float(one["p"]) for one in chances])
    single = np.array([float(one["chance"][0, 1]) for one in chances])
    for found in (whole, single):
        # ranks of 21: spread over their steps
        jitter = np.random.default_rng(5).uniform(0.0, 1.0 / (COUNT + 1), len(found))
        assert kstest(found - jitter, "uniform").pvalue > 0.01


def test_a_departure_is_found_where_it_is():
    moved = np.zeros((len(TIME), len(CELLS)))
    moved[60:, 3] = 12.0
    found = misfit([_test(7), _test(8, moved, "t2")])
    assert float(found["p"]) == pytest.approx(1.0 / (COUNT + 1))
    assert found.attrs["where"].startswith("slip of a-b in t2, most at 1.")
    assert float(found["chance"].sel(test="t2", cell="slip a-b")) == pytest.approx(1.0 / (COUNT + 1))
    band = found["band"].sel(test="t2", cell="slip a-b")
    assert band.dims == ("quantile", "time")
    assert (band.isel(quantile=0) <= band.isel(quantile=2)).all()


def test_a_test_in_which_nothing_moves_has_no_score_and_no_misfit():
    still = misfit([_test(9, horizon=[-np.inf] * len(CELLS))])
    assert still.attrs["where"] == "no joint moves"
    assert float(still["p"]) == 1.0
    assert still["chance"].isnull().all()
