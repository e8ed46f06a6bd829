"""Channels of blocks that a spectrum can be taken of: even times, short gaps bridged, others left out."""

import numpy as np
import xarray as xr
from numpy.testing import assert_allclose

from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.whole_channels import LONGEST_GAP, whole_channels

STRUCTURE = load_structure("configuration-1")
TIME = np.arange(513) / 512.0
TONE = np.sin(20.0 * TIME)


def _test(values, names=("slab-acc-x", "block-1-acc-x"), time=TIME):
    return xr.Dataset(
        {"accelerometer": (("time_acc", "channel"), values)}, {"time_acc": time, "channel": list(names)}
    )


def test_a_gap_is_bridged_as_far_as_it_is_short():
    values = np.tile(TONE[:, None], 3)
    values[100 : 100 + LONGEST_GAP, 1] = np.nan
    values[100 : 101 + LONGEST_GAP, 2] = np.nan
    read = whole_channels(_test(values, ("slab-acc-x", "block-1-acc-x", "block-3-acc-x")), STRUCTURE)
    assert read.names == ["block-1-acc-x"]
    assert_allclose(read.values[:, 0], TONE, atol=1e-4)


def test_uneven_times_are_made_even():
    time = TIME + 2e-4 * np.sin(np.arange(513.0)) * (np.arange(513) % 512 > 0)
    read = whole_channels(_test(np.tile(np.sin(20.0 * time)[:, None], 2), time=time), STRUCTURE)
    assert_allclose(np.diff(read.time), 1.0 / 512.0)
    assert_allclose(read.values[:, 0], TONE, atol=1e-5)


def test_the_end_after_an_abort_is_cut_off_and_a_test_of_the_slab_alone_has_none():
    values = np.tile(TONE[:, None], 2)
    values[300:] = np.nan
    assert len(whole_channels(_test(values), STRUCTURE).time) == 300
    assert whole_channels(_test(values * np.nan), STRUCTURE) is None
    assert whole_channels(_test(values[:, :1], ("slab-acc-x",)), STRUCTURE) is None
