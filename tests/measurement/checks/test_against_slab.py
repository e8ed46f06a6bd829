"""Clock and sign of the slab's accelerometer against its markers, of shakings whose lag and sign are known."""

import re

import numpy as np
import pytest
from resting_stack import ACCELEROMETER_NOISE, MOTION, NOISE, resting_stack, write_campaign

from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.checks.against_slab import clock_remarks
from blockshake.measurement.checks.campaign_check import campaign_lines

TIME, TIME_ACC = np.arange(2601) / 200.0, np.arange(6501) / 500.0
OMEGA = 2.0 * np.pi * 1.5  # rad/s


def _earthquake(time):
    return MOTION.evaluate(time - 2.0)[:, 0], MOTION.evaluate(time - 2.0, 2)[:, 0]


def _burst(time):
    """A sine of 1.5 Hz that swells and fades as sin2 over 10 s: [m], [m/s2]."""
    swell = np.pi * np.clip(time - 2.0, 0.0, 10.0) / 10.0
    phase = OMEGA * (time - 2.0)
    slow, rate = np.sin(swell) ** 2, np.pi / 10.0 * np.sin(2.0 * swell)
    bend = 2.0 * (np.pi / 10.0) ** 2 * np.cos(2.0 * swell) * (np.abs(time - 7.0) < 5.0)
    moved = slow * np.sin(phase)
    return 0.03 * moved, 0.03 * (
        -(OMEGA**2) * moved + 2.0 * OMEGA * rate * np.cos(phase) + bend * np.sin(phase)
    )


def _remarks(shaking, late=0.0, sign=1.0, moved=False, other=False):
    """Remarks where the recorder's stamps are late by so much [s]."""
    generator = np.random.default_rng(5)
    marker = shaking(TIME)[0] + generator.normal(0.0, 0.5 * NOISE, len(TIME))
    read = sign * shaking(TIME_ACC)[1] + generator.normal(0.0, ACCELEROMETER_NOISE, len(TIME_ACC))
    if other:
        read = np.random.default_rng(6).normal(0.0, 2.0, len(TIME_ACC))
    return clock_remarks(TIME, marker, TIME_ACC + late, read, 0.5 * NOISE, "t1.nc", moved)[1]


@pytest.mark.parametrize("shaking", [_earthquake, _burst])
@pytest.mark.parametrize("late", [-2.0, -0.15, -0.05, 0.012, 0.05, 0.1, 0.15, 0.3, 2.0])
def test_the_remark_tells_what_to_do_to_the_times_and_doing_it_removes_the_remark(shaking, late):
    (remark,) = _remarks(shaking, late)
    how, size, unit = re.match(
        r"(subtract|add) ([\d.]+) (ms|s) (?:from|to) the accelerometers' times", remark
    ).groups()
    change = float(size) * {"ms": 1e-3, "s": 1.0}[unit] * {"subtract": -1.0, "add": 1.0}[how]
    assert change == pytest.approx(-late, abs=0.001)
    assert _remarks(shaking, late + change) == []


def test_a_sine_that_swells_tells_its_lag_and_how_many_others_are_about_as_good():
    """Half a period off, its correlation is 1 - (1 / 3 s)^2 (pi / 10 s)^2 (4 / 3) / 2 = 0.993, of the other sign."""
    (remark,) = _remarks(_burst, 0.3)
    others = re.search(
        r"\(correlation 1.00\); 2 other lags are about as good, the nearest (\d+) ms from it, with the sign reversed$",
        remark,
    )
    assert float(others[1]) == pytest.approx(333.0, abs=5.0)  # half a period, within a reading of the markers
    assert "about as good" not in _remarks(_earthquake, 0.3)[0]


def test_a_clock_that_was_set_by_a_nearly_periodic_motion_says_so():
    assert _remarks(_burst, moved=True)[0].startswith(
        "the accelerometers' clock may be wrong by cycles of the shaking"
    )
    assert _remarks(_earthquake, moved=True) == []


def test_a_reversed_channel_is_no_lag():
    (remark,) = _remarks(_earthquake, sign=-1.0)
    assert re.fullmatch(
        r"the slab's accelerometer along x reads -(0\.99\d*|1) of what its markers do", remark
    )
    assert re.search(
        r"reads -(0\.99\d*|1) of .*; 2 other lags are about as good", _remarks(_burst, sign=-1.0)[0]
    )


def test_no_lag_is_said_where_none_makes_both_agree():
    """12 s of each remain; 3 s of both leave 9 s on either side."""
    (remark,) = _remarks(_earthquake, other=True)
    assert re.search(
        r"does not read what its markers do at any lag of its clock from -9 to (8\.99|9) s", remark
    ), remark


@pytest.mark.parametrize("late", [0.05, 1.0])
def test_a_campaign_whose_times_are_changed_as_told_is_consistent(late, tmp_path):
    """A lag of 1 s is one that reading a test removes by itself, and says so with its sign."""
    folder = write_campaign(
        tmp_path, resting_stack().assign_coords(time_acc=lambda test: test["time_acc"] + late)
    )
    told = next(line for line in campaign_lines(folder) if "the accelerometers' times" in line)
    if late == 1.0:
        assert told == "  t1: 1 s were subtracted from the accelerometers' times, by the slab's motion"
        assert load_test(load_campaign(folder), "t1").attrs["recorder_late"] == pytest.approx(1.0, abs=0.01)
        return
    size = float(re.search(r"subtract ([\d.]+) ms", told)[1])
    (folder / "t1.nc").unlink()
    mended = resting_stack().assign_coords(time_acc=lambda test: test["time_acc"] + late - 1e-3 * size)
    assert campaign_lines(write_campaign(tmp_path, mended))[-1] == "no inconsistency found"
