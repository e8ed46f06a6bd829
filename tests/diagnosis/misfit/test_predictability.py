"""Horizons of worlds whose twins part by a known law."""

import numpy as np
import pytest
import xarray as xr

from blockshake.diagnosis.misfit.judged_test import horizons

TIME = np.arange(501) / 50.0
NOISE = xr.DataArray([1e-4, 1e-4], dims="cell")


def _cells(values):
    return xr.DataArray(values, dims=("run", "time", "cell"), coords={"time": TIME})


def _twins(response, size=1e-4, n_twins=9):
    """Twins whose start is off by some micrometres, which the world carries on by ``response``; and their spread."""
    off = 1e-6 * np.random.default_rng(0).normal(0.0, 1.0, (n_twins, 1, 1))
    off[0] = 0.0
    values = size * np.sin(TIME)[None, :, None] + off * response(TIME)[None, :, None] * np.ones((1, 1, 2))
    return _cells(values), off.std(ddof=1)


def test_a_damped_oscillator_is_predictable_to_the_end():
    twins, _ = _twins(lambda t: np.exp(-0.3 * t) * np.cos(7.0 * t))
    np.testing.assert_array_equal(horizons(twins, NOISE), TIME[-1])


def test_an_inverted_pendulum_parts_at_the_time_of_theory():
    # theta'' = (g / l) theta: a start at rest grows as cosh
    rate = np.sqrt(9.81 / 4.0)
    twins, spread = _twins(lambda t: np.cosh(rate * t))
    found = horizons(twins, NOISE)
    assert found[0] == pytest.approx(np.arccosh(3e-4 / spread) / rate, abs=0.02)


def test_twins_part_where_their_distance_matters_beside_the_motion():
    twins, spread = _twins(lambda t: np.exp(2.0 * t), size=0.05)
    # beyond the first crest the farthest is the crest itself
    assert horizons(twins, NOISE)[0] == pytest.approx(np.log(0.3 * 0.05 / spread) / 2.0, abs=0.02)


def test_twins_of_which_one_fell_are_told_apart_and_a_lost_reading_is_not():
    twins, _ = _twins(np.ones_like)
    twins[3, 300:, 1] = np.nan
    twins[2, 0, 0] = np.nan
    twins[2, 50:60, 0] = np.nan
    found = horizons(twins, NOISE)
    np.testing.assert_array_equal(found, [TIME[-1], TIME[300]])
