"""Fragilities of drawn motions: made-up medians and dispersions come back, and limits hold as often as told."""

import numpy as np
import pytest
import xarray as xr
from scipy.special import expit, ndtr
from scipy.stats import binom, linregress, t

from blockshake.geometry.structure import load_structure
from blockshake.study.ensembles.drift_limits import drift_limits
from blockshake.study.fragility.capacity import estimate_capacity
from blockshake.study.fragility.cloud import Cloud, _nearest, _tails, fit_cloud, logistic

LIMIT, SLOPE, DEVIATION, MEDIAN = 0.1, 1.6, 0.5, 3.0  # m, 1, 1, m/s2
REPEATS = 200


def cloud_of(generator, size=30):
    """Samples whose demand is a power of the intensity, and reaches its limit at `MEDIAN` in the median."""
    intensity = np.exp(generator.uniform(np.log(0.5), np.log(6.0), size))
    demand = LIMIT * (intensity / MEDIAN) ** SLOPE * np.exp(DEVIATION * generator.normal(size=size))
    return intensity, demand


def test_large_samples_give_the_fragility_that_they_were_made_of():
    """Without falls the curve is lognormal: its dispersion is that of the demand over the slope."""
    intensity, demand = cloud_of(np.random.default_rng(1), 40_000)
    fitted, _ = fit_cloud(intensity, demand, np.zeros(40_000, dtype=bool), LIMIT)
    assert fitted.median == pytest.approx(MEDIAN, rel=0.02)
    assert fitted.dispersion == pytest.approx(DEVIATION / SLOPE, rel=0.02)
    assert fitted.level(0.05) == pytest.approx(MEDIAN * np.exp(-1.6449 * DEVIATION / SLOPE), rel=0.03)


def test_the_regression_is_that_of_least_squares_and_its_draws_are_students():
    intensity, demand = cloud_of(np.random.default_rng(2))
    fitted, drawn = fit_cloud(intensity, demand, np.zeros(30, dtype=bool), LIMIT)
    known = linregress(np.log(intensity), np.log(demand / LIMIT))
    assert fitted.slope == pytest.approx(known.slope)
    assert fitted.intercept == pytest.approx(known.intercept)
    half = t.ppf(0.975, 28) * known.stderr
    # of 2000 draws the quantile has a standard error of about 0.05 half widths
    assert _tails(drawn.slope) == pytest.approx(known.slope + half * np.array([-1.0, 1.0]), abs=0.15 * half)


def held(limits, truth):
    return [low <= truth <= high for low, high in limits].count(True)


def test_limits_of_the_regression_hold_in_95_of_100_cases():
    generator = np.random.default_rng(3)
    told = [fit_cloud(*cloud_of(generator), np.zeros(30, dtype=bool), LIMIT)[1] for _ in range(REPEATS)]
    least, most = binom.ppf([0.001, 0.999], REPEATS, 0.95)
    for truth, of in ((MEDIAN, lambda one: one.median), (DEVIATION / SLOPE, lambda one: one.dispersion)):
        assert least <= held([_tails(of(one)) for one in told], truth) <= most


def test_falls_add_to_the_samples_that_exceed_the_limit():
    """P = P(fall) + P(no fall) P(demand above its limit): Jalayer and Cornell (2009)."""
    cloud = Cloud(np.log(1.0 / MEDIAN), 1.0, 0.4, -6.0, 4.0, 1.0)
    level = np.array([1.0, 2.0, 4.0])
    falls, exceeds = expit(-6.0 + 4.0 * np.log(level)), ndtr(np.log(level / MEDIAN) / 0.4)
    assert cloud.probability(level) == pytest.approx(1.0 - (1.0 - falls) * (1.0 - exceeds))
    assert cloud.probability(cloud.median) == pytest.approx(0.5)
    assert cloud.median < MEDIAN


def test_limits_hold_where_some_samples_fall():
    """The logistic part has the limits of many samples only: 60 are held against their 95 % from below."""
    generator, size = np.random.default_rng(6), 60
    truth = Cloud(-SLOPE * np.log(MEDIAN), SLOPE, DEVIATION, -6.0, 4.0, 1.0)
    medians, dispersions = [], []
    for _ in range(REPEATS):
        intensity, demand = cloud_of(generator, size)
        fell = generator.random(size) < expit(-6.0 + 4.0 * np.log(intensity))
        _, drawn = fit_cloud(intensity, demand, fell, LIMIT)
        medians.append(_tails(drawn.median))
        dispersions.append(_tails(drawn.dispersion))
    least = binom.ppf(0.001, REPEATS, 0.95)
    assert held(medians, truth.median) >= least
    assert held(dispersions, truth.dispersion) >= least


def test_samples_that_do_not_move_tell_nothing_of_the_line():
    intensity, demand = cloud_of(np.random.default_rng(7))
    still = np.append(intensity, [0.1, 0.2]), np.append(demand, [1e-9, 0.0])
    fitted, _ = fit_cloud(*still, np.zeros(32, dtype=bool), LIMIT)
    alone, _ = fit_cloud(intensity, demand, np.zeros(30, dtype=bool), LIMIT)
    assert fitted[:5] == alone[:5]


def test_samples_that_come_five_times_are_known_as_well_as_once():
    generator = np.random.default_rng(8)
    intensity, demand = cloud_of(generator)
    fell = generator.random(30) < 0.2
    once = fit_cloud(intensity, demand, fell, LIMIT)
    often = fit_cloud(*(np.repeat(one, 5) for one in (intensity, demand, fell)), LIMIT, 0.2)
    for one, other in zip(once, often, strict=True):
        for name in ("slope", "deviation", "intercept"):
            np.testing.assert_allclose(getattr(one, name), getattr(other, name))
    lower, upper = stripes(generator)
    wide = estimate_capacity(np.repeat(lower, 5), np.repeat(upper, 5), 0.2)
    np.testing.assert_array_equal(wide[1].median, estimate_capacity(lower, upper)[1].median)


def test_a_falling_trend_has_no_median():
    falling = Cloud(-5.0, -1.0, 0.4, -np.inf, 0.0, 0.0)
    assert np.isinf(falling.median) or falling.median == 0.0
    assert np.isinf(falling.dispersion)


def test_too_few_standing_samples_tell_nothing():
    fitted, drawn = fit_cloud(np.ones(5), np.ones(5), np.zeros(5, dtype=bool), LIMIT)
    assert np.isnan(fitted.median) or np.isnan(fitted.slope)
    assert np.isnan(drawn.slope).all()


def test_firths_logit_of_two_groups_adds_half_a_case_to_each_cell():
    """Firth (1993): for a saturated model with Jeffreys's prior, p = (events + 1/2) / (cases + 1)."""
    x = np.repeat([0.0, 1.0], 10)
    event = np.zeros(20, dtype=bool)
    event[10:14] = True  # none of ten, and four of ten: without the prior the intercept is minus infinity
    answer, covariance = logistic(x, event)
    assert expit(answer[0]) == pytest.approx(0.5 / 11.0)
    assert expit(answer.sum()) == pytest.approx(4.5 / 11.0)
    # the variance of a logit is 1 / (n p (1 - p))
    assert covariance[0, 0] == pytest.approx(1.0 / (10.0 * (0.5 / 11.0) * (10.5 / 11.0)))


def stripes(generator, size=20, levels=(1.0, 2.0, 3.0, 4.5, 6.0), dispersion=0.4):
    """Bounds of capacities from samples that pass or not, ``size`` at each level."""
    intensity = np.repeat(levels, size)
    failed = generator.random(len(intensity)) < ndtr(np.log(intensity / MEDIAN) / dispersion)
    return np.where(failed, 0.0, intensity), np.where(failed, intensity, np.inf)


def test_bounds_of_stripes_have_the_likelihood_of_bakers_binomials():
    """Baker (2015), Eq. (11): the largest product of binomial probabilities of the counts at the levels."""
    lower, upper = stripes(np.random.default_rng(4))
    fitted, *_ = estimate_capacity(lower, upper)
    level = np.where(np.isinf(upper), lower, upper)
    steps, total = np.unique(level, return_counts=True)
    count = np.array([(np.isfinite(upper) & (level == one)).sum() for one in steps])

    def likelihood(median, dispersion):
        return binom.logpmf(count, total, ndtr(np.log(steps / median) / dispersion)).sum()

    best = likelihood(*fitted)
    around = [
        likelihood(fitted.median * up, fitted.dispersion * wide)
        for up in (0.98, 1.0, 1.02)
        for wide in (0.95, 1.0, 1.05)
    ]
    assert best == pytest.approx(max(around))


def test_limits_of_stripes_hold_in_95_of_100_cases():
    generator = np.random.default_rng(5)
    medians, dispersions = [], []
    for _ in range(REPEATS):
        _, likely, limits = estimate_capacity(*stripes(generator))
        medians.append(limits(likely.median))
        dispersions.append(limits(likely.dispersion))
    least = binom.ppf(0.001, REPEATS, 0.95)
    assert held(medians, MEDIAN) >= least
    assert held(dispersions, 0.4) >= least


def test_the_demand_is_that_of_the_block_nearest_to_its_own_limit(made_pair):
    """0.2 m are more to a block of 0.3 m than 0.4 m to one of 1 m."""
    structure, limits = made_pair, drift_limits(made_pair)
    np.testing.assert_array_equal(limits, [np.nan, 0.5, 0.15])
    peak = xr.DataArray(
        [[[0.0, 0.4, 0.2], [0.0, 0.4, 0.1]]],
        {"frame": ["slab"], "marker": ["on-slab", "on-wide", "on-narrow"]},
        ["frame", "sample", "marker"],
    )
    slip = xr.DataArray([[0.3, 0.1]], {"joint": ["slab-narrow"]}, ["joint", "sample"])
    counted = xr.Dataset({"peak": peak, "joint_slip": slip})
    demand, limit = _nearest(counted, structure, None)
    np.testing.assert_array_equal(demand, [0.2, 0.4])
    np.testing.assert_array_equal(limit, [0.15, 0.5])
    demand, limit = _nearest(counted, structure, {"narrow": 0.1, "slab/narrow": 0.05})
    np.testing.assert_array_equal(demand, [0.3, 0.1])
    np.testing.assert_array_equal(limit, [0.05, 0.05])


@pytest.fixture
def made_pair(make_mapping):
    """A cube of 1 m and a block of 0.3 m side by side, a marker on each."""
    mapping = make_mapping([
        {"name": "wide", "shape": "cube", "position": [0.0, 0.0, 0.5]},
        {"name": "narrow", "shape": "narrow", "position": [0.0, 1.5, 0.5]},
    ])  # fmt: skip
    mapping["shapes"]["narrow"] = {"box": [0.5, 0.3, 1.0]}
    mapping["markers"] = [
        {"name": f"on-{body}", "body": body, "position": [0.0, 0.0, 0.0]}
        for body in ("slab", "wide", "narrow")
    ]
    return load_structure(mapping)
