"""Readings of tests and samples: spectra by Parseval's theorem, displacements relative to the slab."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.study.calibration.comparison import _time_steps, has_use
from blockshake.study.calibration.readings import (
    OpenTest,
    acceleration_spectra,
    displacement_curves,
    log_spectrum,
)
from blockshake.study.calibration.settings import RESTITUTION, STIFFNESS

RATE, DURATION = 512.0, 8.0
AMPLITUDE, FREQUENCY = 0.3, 7.0  # m/s2, Hz
STRUCTURE = load_structure("configuration-1")
CHANNELS = ["slab-acc-x", "block-1-acc-x", "block-3-acc-x"]


def _read(
    frequency=FREQUENCY, noise=0.0, channels=CHANNELS, slab=0.0, block=0.0, end=DURATION, status="completed"
):
    """A test whose accelerometers read a tone, and whose markers are at the places given along x."""
    time_acc = np.arange(round(RATE * DURATION) + 1) / RATE
    time = np.arange(round(200.0 * DURATION) + 1) / 200.0
    tone = AMPLITUDE * np.sin(2.0 * np.pi * frequency * time_acc)
    generator = np.random.default_rng(1)
    values = tone[:, None] + noise * generator.normal(size=(len(time_acc), len(channels))) + 9.81
    markers = ["slab-face", "block-1-face", "block-3-face"]
    moved = np.zeros((len(time), 3, 1))
    moved[:, :, 0] = slab * time[:, None] + block * time[:, None] * np.array([0.0, 1.0, 2.0])
    moved[time > end] = np.nan
    return xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), moved, {"units": "m"}),
            "accelerometer": (("time_acc", "channel"), values, {"units": "m/s2"}),
        },
        {"time": time, "time_acc": time_acc, "marker": markers, "axis": ["x"], "channel": list(channels)},
        {"status": status},
    )


@pytest.fixture
def files(tmp_path):
    """Files of readings in a store's form; none for a run without an end."""

    def kept(tests):
        paths = []
        for place, test in enumerate(tests):
            path = tmp_path / f"{place}.nc"
            if test is not None:
                along = test[["marker_displacement"]].assign(
                    log_spectrum=log_spectrum(test, STRUCTURE, DURATION)
                )
                write_dataset(path, along.assign_attrs(test.attrs))
            paths.append(None if test is None else path)
        return paths

    return kept


def _open(measured):
    return OpenTest(
        "test", {"structure": "configuration-1", "duration": DURATION}, None, measured, Instruments()
    )


def test_a_tone_has_its_power_at_its_frequency():
    """Parseval: the density about the tone sums to half of the squared amplitude; the slab's channel is none."""
    found = log_spectrum(_read(), STRUCTURE, DURATION)
    assert found["channel"].values.tolist() == CHANNELS[1:]
    assert found["line"].values.tolist() == list(range(1, 51))
    power = np.exp(found.sel(channel="block-1-acc-x").to_numpy())
    assert int(found["line"][power.argmax()]) == FREQUENCY
    assert_allclose(power[4:9].sum(), AMPLITUDE**2 / 2.0, rtol=1e-3)


def test_white_noise_has_one_density():
    """Variance over half of the sampling rate, in the mean over lines and channels."""
    channels = [f"{body}-acc-{axis}" for body in ("block-1", "block-2", "block-3") for axis in "xz"]
    found = log_spectrum(_read(noise=20.0, channels=channels), STRUCTURE, DURATION)
    assert_allclose(np.exp(found).mean(), 20.0**2 / (RATE / 2.0), rtol=0.1)


def test_a_test_without_accelerometers_or_too_short_has_no_spectrum():
    assert not log_spectrum(_read().drop_dims("time_acc"), STRUCTURE, DURATION).size
    assert not log_spectrum(_read(), STRUCTURE, 1.5).size


def test_a_sample_that_fell_soon_and_channels_with_long_gaps_have_no_spectrum(files):
    fallen = _read(status="collapsed")
    fallen["accelerometer"][round(1.5 * RATE) :] = np.nan
    kept = files([_read(), fallen])
    measured, samples = acceleration_spectra(_open(_read()), kept)
    assert measured.shape == samples.shape[1:] == (50, 2)
    assert np.isfinite(samples[0]).all()
    assert np.isnan(samples[1]).all()
    gaps = _read()
    gaps["accelerometer"][1000:2000] = np.nan
    assert acceleration_spectra(_open(gaps), kept) is None


def test_displacements_are_those_relative_to_the_slab_and_a_collapse_stays(files):
    kept = files([_read(slab=0.5, block=0.01), None, _read(slab=0.5, block=0.1, end=4.0, status="collapsed")])
    measured, samples = displacement_curves(_open(_read(slab=0.2, block=0.03)), kept)
    assert samples.shape == (3, *measured.shape)
    assert_allclose(measured[-1], [0.03 * DURATION, 0.06 * DURATION])
    assert_allclose(samples[0, -1], [0.01 * DURATION, 0.02 * DURATION], atol=1e-6)
    assert np.isnan(samples[1]).all()
    assert_allclose(samples[2, -1], [0.1 * 4.0, 0.2 * 4.0], atol=1e-6)


def test_spectra_are_compared_on_the_channels_that_all_have(files):
    kept = files([_read(frequency=9.0), None])
    measured, samples = acceleration_spectra(_open(_read(channels=CHANNELS[:2])), kept)
    assert measured.shape == samples.shape[1:] == (50, 1)
    assert (measured[:, 0].argmax() + 1, samples[0, :, 0].argmax() + 1) == (7, 9)
    assert np.isnan(samples[1]).all()
    assert acceleration_spectra(_open(_read().drop_dims("time_acc")), kept) is None


def test_contact_springs_belong_to_the_model_that_has_them():
    assert has_use("ls-dem", STRUCTURE, RESTITUTION)
    assert not has_use("nscd-rigid", STRUCTURE, STIFFNESS)
    assert has_use("nscd-rigid", STRUCTURE, "friction.concrete.foundation")
    assert not has_use("ls-dem", STRUCTURE, "friction.concrete.steel")


def test_steps_go_with_the_period_of_the_springs():
    """A period is 2 pi over the root of the stiffness over the mass; NSCD has no springs."""
    drawn = pd.DataFrame({STIFFNESS: [0.04, 1.0, 4.0]})
    assert_allclose(_time_steps(drawn, [STIFFNESS], 1e-4), [5e-4, 1e-4, 5e-5])
    assert_allclose(_time_steps(drawn, [], 1e-3), 1e-3)
