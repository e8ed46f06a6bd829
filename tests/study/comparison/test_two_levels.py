"""A control variate: its mean is that of the costly model, its limits hold, and its gain is that of the theory."""

import numpy as np
import pytest
import xarray as xr
from scipy.stats import binom

from blockshake.study.comparison.two_levels import two_level_mean, two_levels

MEAN, CORRELATION, FEW, MANY = 0.2, 0.9, 12, 120
REPEATS = 2000


def results(generator):
    """Results of a costly model of deviation 1, and of a cheap one with another mean and deviation."""
    common, own = generator.normal(size=(2, MANY))
    costly = MEAN + CORRELATION * common + np.sqrt(1.0 - CORRELATION**2) * own
    return costly[:FEW], 3.0 * common[:FEW] - 7.0, 3.0 * common - 7.0


@pytest.fixture(scope="module")
def told():
    generator = np.random.default_rng(1)
    return [two_level_mean(*results(generator)) for _ in range(REPEATS)]


def test_the_mean_is_that_of_the_costly_model(told):
    values = np.array([one["value"] for one in told])
    # four standard errors of the mean of the repeats
    assert abs(values.mean() - MEAN) < 4.0 * values.std() / np.sqrt(REPEATS)


def test_limits_hold_in_95_of_100_cases(told):
    least, most = binom.ppf([0.001, 0.999], REPEATS, 0.95)
    assert least <= sum(one["lower"] <= MEAN <= one["upper"] for one in told) <= most


def test_the_variance_is_that_of_two_phase_sampling(told):
    """Cochran (1977), section 12.6: s^2 / n (1 - r^2 (1 - n / N)), the first part times 1 + 1 / (n - 3) as the
    coefficient is estimated, of normal results."""
    left, carried = 1.0 - CORRELATION**2, CORRELATION**2
    theory = left / FEW * (1.0 + (1.0 - FEW / MANY) / (FEW - 3.0)) + carried / MANY
    # the relative standard error of a variance of so many repeats is sqrt(2 / 2000), 3 %
    assert np.var([one["value"] for one in told]) == pytest.approx(theory, rel=4.0 * np.sqrt(2.0 / REPEATS))
    gains = np.array([one["gain"] for one in told])
    assert np.median(gains) == pytest.approx(1.0 / FEW / theory, rel=0.2)


def test_the_coefficient_is_that_of_least_squares():
    costly, cheap, many = results(np.random.default_rng(2))
    assert two_level_mean(costly, cheap, many)["coefficient"] == pytest.approx(
        np.polyfit(cheap, costly, 1)[0]
    )


def test_a_cheap_model_that_is_the_costly_one_gives_its_mean_of_all_samples():
    _, cheap, many = results(np.random.default_rng(3))
    one = two_level_mean(cheap, cheap, many)
    assert one["value"] == pytest.approx(many.mean())
    assert one["gain"] == pytest.approx(MANY / FEW)


def test_too_few_or_equal_results_tell_nothing():
    assert np.isnan(two_level_mean(np.arange(5.0), np.arange(5.0), np.arange(9.0))["value"])
    assert np.isnan(two_level_mean(np.arange(8.0), np.ones(8), np.ones(9))["value"])


def ensemble(peaks, status="completed"):
    return xr.Dataset(
        {
            "peak": (("sample", "frame", "marker"), np.array(peaks)[:, None, None]),
            "status": ("sample", [status] * len(peaks)),
        },
        coords={"sample": np.arange(len(peaks)), "frame": ["slab"], "marker": ["face"]},
    )


def test_models_with_fewer_samples_than_rigid_nscd_are_helped_where_all_complete():
    costly, _, many = results(np.random.default_rng(4))
    found = two_levels({"ls-dem": ensemble(costly), "nscd-rigid": ensemble(many)})
    one = two_level_mean(costly, many[:FEW], many)
    assert float(found["two_level_peak"][0]) == one["value"]
    assert float(found["variance_gain"][0]) == one["gain"]
    assert np.isnan(found["two_level_peak"][1])
    fell = two_levels({"ls-dem": ensemble(costly, "collapsed"), "nscd-rigid": ensemble(many)})
    assert np.isnan(fell["two_level_peak"]).all()
