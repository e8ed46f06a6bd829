"""A recorder whose clock has another zero than the optical one is set by the slab's motion."""

import numpy as np
import pytest
import xarray as xr

from blockshake.files import HOME
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.campaigns.recorded_test import read_test
from blockshake.measurement.campaigns.recorder_clock import on_one_clock


@pytest.fixture(scope="module")
def tests():
    """Structure, and two shipped synthetic tests, a weak and a strong one."""
    campaign = load_campaign(HOME / "data" / "virtual-campaign" / "configuration-1")
    structure = load_structure(campaign.structure)
    names = [name for name, test in campaign.tests.items() if test.role != "sealed"][:3:2]
    return structure, [read_test(campaign.folder / campaign.tests[name].file, structure) for name in names]


@pytest.mark.parametrize("late", [0.2, -1.5, 3.0])
def test_a_shift_of_one_clock_is_found_and_taken_out(tests, late):
    structure, read = tests
    for test in read:
        moved = on_one_clock(test.assign_coords(time_acc=test["time_acc"] + late), structure)
        assert moved.attrs["recorder_late"] == pytest.approx(late, abs=0.011)  # a step of the comparison
        np.testing.assert_allclose(moved["time_acc"], test["time_acc"], atol=0.011)


@pytest.mark.parametrize("late", [0.0, 0.05])
def test_clocks_that_nearly_agree_are_left_to_the_parity_checks(tests, late):
    structure, read = tests
    for test in read:
        shifted = test.assign_coords(time_acc=test["time_acc"] + late)
        xr.testing.assert_identical(on_one_clock(shifted, structure), shifted)


def test_an_accelerometer_that_reads_something_else_moves_no_clock(tests):
    structure, (test, _) = tests
    noise = np.random.default_rng(1).normal(0.0, 1.0, test["accelerometer"].shape)
    other = test.assign(accelerometer=test["accelerometer"].copy(data=noise))
    xr.testing.assert_identical(on_one_clock(other, structure), other)
