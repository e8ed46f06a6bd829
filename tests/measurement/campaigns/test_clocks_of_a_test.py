"""The clock of a test counts from the command, whatever it showed, and however its times were written."""

import numpy as np
import pytest
import xarray as xr
from resting_stack import MOTION, resting_stack, write_campaign

from blockshake.files import HOME
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.clocks import (
    command_start,
    from_first_reading,
    on_one_clock,
    reading_rate,
    simulation_start,
)
from blockshake.measurement.campaigns.recorded_test import read_test
from blockshake.measurement.checks.campaign_check import campaign_lines

LEAD = 1.5  # s


def _with_lead(test, lead=LEAD):
    """The test with a rest before it, as long [s], by both clocks."""
    for name, rate in (("time", 200.0), ("time_acc", 512.0)):
        count = round(lead * rate)
        generator = np.random.default_rng(3)
        filled = test.pad({name: (count, 0)}, mode="edge")
        filled = filled.assign_coords({name: np.arange(filled.sizes[name]) / rate})
        for variable, noise in (("marker_displacement", 1e-4), ("accelerometer", 0.02)):
            if name in filled[variable].dims:
                part = filled[variable].values[:count]
                part[:] = generator.normal(0.0, noise, part.shape)
        test = filled
    return test


@pytest.mark.parametrize("rate", [100.0, 148.0, 200.0, 512.0, 1000.0])
@pytest.mark.parametrize("zero", [-3.0, 0.5, 43200.0, 1.7e9])
def test_an_even_clock_is_the_same_whatever_it_shows(rate, zero):
    test = resting_stack()
    time = np.arange(test.sizes["time"]) / rate
    read = from_first_reading(test.assign_coords(time=zero + time, time_acc=zero + test["time_acc"]))
    np.testing.assert_array_equal(read["time"], np.round(time, 9))
    np.testing.assert_array_equal(read["time_acc"], test["time_acc"])
    assert reading_rate(read["time"].to_numpy()) == rate


def _printed(rate, zero=0.0, seconds=10.0):
    """Times of a clock as printed in milliseconds."""
    return np.round(zero + np.arange(round(seconds * rate) + 1) / rate, 3)


# a printed clock of n rows that meets all fractions of a millisecond tells its rate to 1 ms over n of its length;
# 1000/3 Hz meets one alone, and is even within 10 us at the rate of fewest decimals
@pytest.mark.parametrize("rate", [512.0, 204.8, 480.0, 1000.0 / 3.0, 500.0, 200.0])
@pytest.mark.parametrize("zero", [0.0, 0.0002, 43200.0371, 1.7e9])
@pytest.mark.parametrize("lost", [0, 1, 100])
def test_a_clock_printed_in_milliseconds_keeps_its_rate(rate, zero, lost):
    time = _printed(rate, zero)
    time = np.delete(time, np.arange(700, 700 + lost))
    test = resting_stack().isel(time=slice(2)).reindex(time=time)
    read = from_first_reading(test.drop_dims("time_acc"))["time"].to_numpy()
    assert len(read) == len(time) + lost
    found = (len(read) - 1) / (read[-1] - read[0])
    assert found == pytest.approx(rate, rel=1.0001e-6 if rate == 1000.0 / 3.0 else 1e-9)
    assert np.ptp(np.diff(read)) < 3e-9  # nanoseconds
    assert reading_rate(read) == pytest.approx(rate, rel=1.0001e-6)
    kept = np.isin(np.arange(len(read)), np.arange(700, 700 + lost), invert=True)
    assert np.abs(read[kept] - (time - time[0])).max() <= 0.00101  # half a digit of each, and of the first


def test_an_uneven_clock_stays_uneven():
    """Also in milliseconds: its times lie farther from any even grid than half a digit."""
    jitter = np.random.default_rng(4).uniform(-1.5e-3, 1.5e-3, 2001)
    time = np.round(np.arange(2001) / 100.0 + jitter, 3)
    test = resting_stack().drop_dims("time_acc").assign_coords(time=time - time[0])
    np.testing.assert_allclose(from_first_reading(test)["time"], time - time[0], atol=1e-9)


def test_a_clock_in_hundredths_that_lacks_a_row_is_no_slower_one():
    """One row of 100 Hz that is lost may look like 99.9 Hz printed in hundredths."""
    time = np.delete(np.arange(2002) / 100.0, 900)
    test = resting_stack().drop_dims("time_acc").assign_coords(time=time)
    np.testing.assert_allclose(from_first_reading(test)["time"], np.arange(2002) / 100.0, atol=1e-9)


def test_rows_that_a_clock_lacks_become_gaps():
    whole = resting_stack()
    test = whole.isel(time=np.r_[0:100, 140:2001], time_acc=np.r_[0:900, 1000 : whole.sizes["time_acc"]])
    shifted = {name: test[name] + 43200.0 for name in ("time", "time_acc")}
    read = from_first_reading(test.assign_coords(shifted))
    assert reading_rate(read["time"].to_numpy()) == 200.0
    for name, variable, lost in (
        ("time", "marker_displacement", slice(100, 140)),
        ("time_acc", "accelerometer", slice(900, 1000)),
    ):
        np.testing.assert_allclose(read[name], whole[name], atol=1e-9)
        expected = whole[variable].transpose(name, ...).to_numpy().copy()
        expected[lost] = np.nan
        np.testing.assert_array_equal(read[variable].transpose(name, ...), expected)


@pytest.mark.parametrize("start", [-2.0, 0.0, 1.2345, 4.0])
def test_the_start_of_the_command_is_found(start):
    """The table follows by 0.9, and is read with noise; a negative start lies before the first reading."""
    time = np.arange(2001) / 200.0
    moved = 0.9 * MOTION.evaluate(time - start)[:, 0] + np.random.default_rng(1).normal(0.0, 1e-4, len(time))
    found = command_start(time, moved, MOTION)
    assert found.time == pytest.approx(start, abs=5e-4)
    assert found.correlation > 0.99
    turned = command_start(time, -moved, MOTION)
    assert (turned.time, turned.correlation) == pytest.approx((found.time, -found.correlation), abs=1e-5)


def test_a_rest_before_the_command_changes_no_remark(tmp_path):
    """The table moved by all that was commanded, and the noise is found in a half second of rest."""
    lines = campaign_lines(write_campaign(tmp_path, _with_lead(resting_stack())))
    assert "table moved by 100 % of the command" in lines[1]
    assert "in the quiet 500 ms" in lines[1]
    assert lines[-1] == "no inconsistency found"
    test = load_test(load_campaign(tmp_path), "t1")
    assert test["time"][0] == pytest.approx(-LEAD, abs=1e-3)
    assert test["time_acc"][0] == test["time"][0]


def test_axes_are_told_apart_whenever_the_command_starts(tmp_path):
    test = _with_lead(resting_stack())
    test["marker_displacement"].values[:] *= [-1.0, 1.0, 1.0]
    folder = write_campaign(tmp_path, test)
    with pytest.raises(Exception, match="x is reversed"):
        campaign_lines(folder)


def test_a_record_that_begins_after_the_strongest_shaking_is_remarked(tmp_path):
    test = resting_stack().sel(time=slice(6.0, None), time_acc=slice(6.0, None))
    test["marker_displacement"] -= test["marker_displacement"].isel(time=0)
    lines = campaign_lines(write_campaign(tmp_path, test))
    assert any("begins after the strongest shaking" in line for line in lines), lines


@pytest.mark.parametrize(
    ("first", "expected"), [(-1.5, 0.0), (0.0, 0.0), (-1.502, -0.002), (0.003, -0.002), (2.003, -0.002)]
)
def test_a_simulation_starts_with_a_reading_at_or_before_the_command(first, expected):
    assert simulation_start(first + np.arange(2000) / 200.0) == pytest.approx(expected, abs=1e-9)


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
