"""The median of the largest drift, its limits, and the score of drifts, on readings with known laws."""

import numpy as np
import pytest
import xarray as xr
from scipy.stats import norm

from blockshake.diagnosis.gain.consequence import consequence

TIME = np.arange(40) / 200.0


def readings(largest, drift=None):
    """Readings whose top goes farthest to -x in every second run."""
    largest = np.asarray(largest, float)
    to_minus = np.arange(largest.size) % 2 == 0
    values = np.column_stack(
        [np.where(to_minus, 0.1, 1.0) * largest, np.where(to_minus, -1.0, -0.1) * largest]
    )
    found = xr.Dataset(
        {"value": (("run", "feature"), values)},
        {
            "feature": ["top.displacement.peak+", "top.displacement.peak-"],
            "time": TIME,
            "body": ["low", "top"],
        },
    )
    return found if drift is None else found.assign(drift=(("run", "time", "body"), drift))


def measured(largest):
    one = readings([largest]).isel(run=0)
    return one.assign(drift=(("time", "body"), np.zeros((40, 2))))


def test_median_is_that_of_both_solvers_and_its_limits_hold_the_law_s():
    inside, count, law = 0, 200, 0.05
    for seed in range(40):
        generator = np.random.default_rng(seed)
        runs = {model: readings(generator.normal(0.05, 0.01, count)) for model in ("ls-dem", "nscd-rigid")}
        found = consequence(measured(0.061), {"recalibrated": runs}).sel(kind="recalibrated")
        inside += float(found["drift_lower"]) <= law <= float(found["drift_upper"])
        assert float(found["measured"]) == pytest.approx(0.061)
    # 95 % of 40, less 4 standard errors
    assert inside / 40 > 0.95 - 4.0 * np.sqrt(0.95 * 0.05 / 40)
    # standard error of a median of 400: 0.5 / sqrt(400) / density
    error = 0.5 / np.sqrt(400) / (norm.pdf(0.0) / 0.01)
    assert float(found["drift"]) == pytest.approx(law, abs=4.0 * error)


def test_before_and_after_are_told_apart():
    generator = np.random.default_rng(1)
    kinds = {
        kind: {model: readings(generator.normal(mean, 0.002, 40)) for model in ("ls-dem", "nscd-rigid")}
        for kind, mean in (("recalibrated", 0.058), ("extended", 0.081))
    }
    found = consequence(measured(0.08), kinds)
    assert float(found["drift_upper"].sel(kind="recalibrated")) < float(
        found["drift_lower"].sel(kind="extended")
    )
    assert np.isnan(found["crps"]).all()


def test_drift_score_is_the_ranked_probability_score_and_a_run_that_ended_is_no_member():
    generator = np.random.default_rng(2)
    drift = 0.01 * generator.normal(size=(300, 40, 2))
    drift[:150, 20:] = np.nan
    runs = {"ls-dem": readings(np.ones(150), drift[:150]), "nscd-rigid": readings(np.ones(150), drift[150:])}
    found = consequence(measured(0.05), {"extended": runs})
    # of a standard normal at its mean: 2 phi(0) - 1 / sqrt(pi)
    expected = 0.01 * (2.0 * norm.pdf(0.0) - 1.0 / np.sqrt(np.pi))
    np.testing.assert_allclose(found["crps"].sel(kind="extended"), expected, rtol=0.1)
