import numpy as np
import pytest
import xarray as xr

from blockshake.measurement.virtual_test import virtual_test

NOISE = 1e-4  # m


def _run(n_times=4000):
    time = np.arange(n_times) / 200.0
    displacement = np.zeros((n_times, 2, 3))
    displacement[:, 1, 0] = 0.05 * np.sin(time)
    return xr.Dataset(
        {"marker_displacement": (("time", "marker", "axis"), displacement)},
        coords={"time": time, "marker": ["slab-face", "top"], "axis": ["x", "y", "z"]},
        attrs={
            "model": "ls-dem",
            "motion": "alkion",
            "friction.concrete.concrete": 0.7,
            "status": "completed",
        },
    )


def test_noise_has_the_deviation_asked_for_in_every_reading():
    run = _run()
    error = (virtual_test(run, seed=3, marker_noise=NOISE) - run)["marker_displacement"].to_numpy()
    np.testing.assert_array_equal(error[0], 0.0)
    # 4 standard errors of a deviation from 4000 readings: NOISE / sqrt(8000)
    np.testing.assert_allclose(error[1:].std(axis=0), NOISE, atol=4 * NOISE / np.sqrt(8000))
    # white: neighbours do not correlate, within 4 standard errors
    centred = error[1:] - error[1:].mean(axis=0)
    neighbours = (centred[1:] * centred[:-1]).mean(axis=0) / centred.var(axis=0)
    assert np.abs(neighbours).max() < 4 / np.sqrt(4000)


def test_it_says_synthetic_and_hides_the_truth():
    measured = virtual_test(_run(), seed=3)
    assert measured.attrs["synthetic"] == 1
    assert "synthetic" in measured.attrs["title"]
    assert measured.attrs["motion"] == "alkion"
    assert not any("friction" in name for name in measured.attrs)
    assert list(measured.data_vars) == ["marker_displacement"]
    assert measured["marker_displacement"].attrs["units"] == "m"


def test_same_seed_same_noise():
    same = virtual_test(_run(), seed=3)
    xr.testing.assert_identical(virtual_test(_run(), seed=3), same)
    assert not virtual_test(_run(), seed=4).equals(same)


def test_a_run_cut_short_stays_cut_short():
    run = _run()
    run["marker_displacement"][3000:] = np.nan
    measured = virtual_test(run, seed=3)["marker_displacement"]
    assert np.isnan(measured[3000:]).all()
    assert np.isfinite(measured[:3000]).all()


def test_no_noise_gives_the_run():
    read = virtual_test(_run(), seed=3, marker_noise=0.0)["marker_displacement"].to_numpy()
    assert read == pytest.approx(_run()["marker_displacement"].to_numpy(), abs=0.0)
