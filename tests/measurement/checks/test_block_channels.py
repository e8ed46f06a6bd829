"""Channels that read gravity or their block's motion the wrong way, on a stack that follows the table."""

import re

import numpy as np
import pytest
import xarray as xr
from resting_stack import ACCELEROMETER_NOISE, resting_stack, write_campaign

from blockshake.measurement.checks.campaign_check import campaign_lines

GRAVITY = 9.81  # m/s2


def _remarks(folder, test):
    lines = campaign_lines(write_campaign(folder, test))
    return (
        [line.removeprefix("  t1: ") for line in lines[lines.index("remarks:") + 1 :]]
        if len(lines) > 3
        else []
    )


def _with_vertical(rest):
    """A stack with vertical channels, which read this at rest [m/s2]; nothing of it moves up or down."""
    test = resting_stack()
    noise = np.random.default_rng(7).normal(0.0, ACCELEROMETER_NOISE, (test.sizes["time_acc"], len(rest)))
    vertical = xr.DataArray(
        noise + np.array(list(rest.values())), {"time_acc": test["time_acc"], "channel": list(rest)},
    )  # fmt: skip
    read = xr.concat([test["accelerometer"], vertical], "channel").transpose("time_acc", "channel")
    return test.drop_vars(["accelerometer", "channel"]).assign(accelerometer=read)


@pytest.mark.parametrize("rest", [GRAVITY, 0.0, 0.3])
def test_a_vertical_channel_reads_gravity_or_nothing_at_rest(rest, tmp_path):
    """An accelerometer with a constant part reads the specific force, +g upward; one without reads 0."""
    assert _remarks(tmp_path, _with_vertical({"slab-acc-z": rest, "block-1-acc-z": rest})) == []


def test_channels_with_gravity_the_other_way_are_to_be_reversed(tmp_path):
    remarks = _remarks(tmp_path, _with_vertical({"slab-acc-z": -GRAVITY, "block-1-acc-z": -GRAVITY}))
    assert len(remarks) == 1
    said = r"slab-acc-z and block-1-acc-z read -9\.8\d? m/s2 at rest, where gravity has the other sign: reverse them"
    assert re.fullmatch(said, remarks[0])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_channel_along_x_that_reads_gravity_lies_along_the_vertical(sign, tmp_path):
    test = resting_stack()
    test["accelerometer"][:, 1] += sign * GRAVITY
    remarks = _remarks(tmp_path, test)
    assert len(remarks) == 1
    assert re.match(
        rf"block-1-acc-x reads {sign * GRAVITY:.1f}\d? m/s2 at rest, as along the vertical", remarks[0]
    )


def test_a_logger_of_a_block_that_is_reversed_is_told_by_its_markers(tmp_path):
    """Noise of 0.02 m/s2 hardly lowers the correlation of a motion of 1 m/s2 rms: it is -1.00."""
    test = resting_stack()
    test["accelerometer"][:, 1] *= -1.0
    said = (
        "block-1-acc-x reads the opposite of what the markers of its block do: reverse it (correlation -1.00)"
    )
    assert _remarks(tmp_path, test) == [said]


def test_a_reversed_block_is_seen_through_a_clock_that_is_off(tmp_path):
    test = resting_stack()
    test["accelerometer"][:, 1] *= -1.0
    late, reversed_one = _remarks(tmp_path, test.assign_coords(time_acc=test["time_acc"] + 0.06))
    assert re.match(r"subtract (60|60\.\d|59\.\d) ms from the accelerometers' times", late)
    assert reversed_one.startswith("block-1-acc-x reads the opposite")
