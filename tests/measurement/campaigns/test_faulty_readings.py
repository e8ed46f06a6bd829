"""Columns that are no readings become gaps, with a line; the good test is that of resting_stack.py."""

import numpy as np
import pytest
from resting_stack import MARKERS, MOTION, STRUCTURE, resting_stack, write_campaign

from blockshake.errors import InputError
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.faulty_readings import dropouts, without_faulty
from blockshake.measurement.checks.campaign_check import campaign_lines

OWN = MARKERS.index("block-1-lower")
Z = 2


def _spoilt(change):
    test = resting_stack()
    change(test["marker_displacement"].values)
    return test


def _kinds(test):
    return [(fault.kind, fault.column) for fault in without_faulty(test, STRUCTURE).attrs["faulty"]]


def _constant(values):
    values[:, OWN, Z] = 0.0


def _frozen(values):
    values[800:1100, OWN] = values[800, OWN]


def _clipped(values):
    values[:, OWN, 0] = np.clip(values[:, OWN, 0], -0.02, 0.02)


def _doubled(values):
    values[:, OWN, 0] = -values[:, OWN + 1, 0]


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (_constant, [("constant", "block-1-lower.z")]),
        (_frozen, [("frozen", f"block-1-lower.{axis}") for axis in "xyz"]),
        (_clipped, [("clipped", "block-1-lower.x")]),
        (_doubled, [("doubled", "block-1-lower.x"), ("doubled", "block-1-upper.x")]),
    ],
)
def test_what_is_no_reading_is_a_gap(change, expected, tmp_path):
    test = _spoilt(change)
    assert _kinds(test) == expected
    folder = write_campaign(tmp_path, test)
    remarks = campaign_lines(folder)
    for _, column in expected:
        assert any("taken as gaps" in line and column in line for line in remarks), remarks
    read = load_test(load_campaign(folder), "t1")["marker_displacement"].to_numpy()
    sound = resting_stack()["marker_displacement"].to_numpy()
    lost = np.isnan(read) & np.isfinite(sound)
    changed = test["marker_displacement"].to_numpy() != sound
    assert not (changed & ~lost & np.isfinite(sound))[:, OWN].any()
    np.testing.assert_array_equal(read[~lost & np.isfinite(sound)], sound[~lost & np.isfinite(sound)])


def test_markers_that_one_pose_without_rotation_moved_are_readings():
    """A table that its drive states by a place alone, or that the optical system holds level."""

    def of_a_pose(values):
        slab = [index for index, name in enumerate(MARKERS) if name.startswith("slab")]
        assert len(slab) > 2
        values[:, slab] = values[:, slab[:1]]
        values[:, slab[-1]] += 0.5 - 0.5 * (1.0 + 1e-12)  # rounded as a place less its first one

    assert _kinds(_spoilt(of_a_pose)) == []

    def of_the_pose_of_another_body(values):
        of_a_pose(values)
        block = [index for index, name in enumerate(MARKERS) if name.startswith("block-1")]
        values[:, block] = values[:, [MARKERS.index("slab-face")]]

    assert {kind for kind, _ in _kinds(_spoilt(of_the_pose_of_another_body))} == {"doubled"}


def test_an_optical_system_that_hangs_reads_nothing():
    def hang(values):
        values[800:900] = values[800]

    assert {kind for kind, _ in _kinds(_spoilt(hang))} == {"frozen"}
    read = without_faulty(_spoilt(hang), STRUCTURE)["marker_displacement"].to_numpy()
    assert np.isnan(read[801:899]).all()


def test_a_sound_test_loses_nothing():
    assert _kinds(resting_stack()) == []


@pytest.mark.parametrize("digits", [3, 4])
def test_coarse_digits_are_readings(digits):
    test = resting_stack()
    test["marker_displacement"].values[:] = np.round(test["marker_displacement"].values, digits)
    assert _kinds(test) == []


def test_rest_without_noise_is_a_reading():
    """A synthetic test rests exactly for 2 s, and then moves along x alone."""
    test = resting_stack()
    moved = np.zeros(test["marker_displacement"].shape)
    moved[400:, :, 0] = MOTION.evaluate(test["time"].to_numpy()[:-400])[:, :1]
    test["marker_displacement"].values[:] = moved
    assert _kinds(test) == []


def test_directions_filled_with_zeros_are_not_measured(tmp_path):
    def along_x(values):
        values[..., 1:] = 0.0

    folder = write_campaign(tmp_path, _spoilt(along_x))
    test = load_test(load_campaign(folder), "t1")
    assert test["marker_displacement"].sel(axis=["y", "z"]).isnull().all()
    assert test["marker_displacement"].sel(axis="x").notnull().any("time").all()


def test_a_dead_marker_and_a_dead_channel_are_left_out(tmp_path):
    test = resting_stack()
    test["marker_displacement"].values[:, OWN] = 0.0
    test["accelerometer"].values[:, 1] = 9.81
    read = load_test(load_campaign(write_campaign(tmp_path, test)), "t1")
    assert "block-1-lower" not in read["marker"].values
    assert read["channel"].values.tolist() == ["slab-acc-x"]


def test_a_table_without_any_reading_is_refused(tmp_path):
    def dead_slab(values):
        values[:, [place for place, name in enumerate(MARKERS) if name.startswith("slab")]] = 0.0

    folder = write_campaign(tmp_path, _spoilt(dead_slab))
    with pytest.raises(InputError, match=r"t1\.nc: marker: expected a marker of the driven body"):
        load_test(load_campaign(folder), "t1")


@pytest.mark.parametrize("value", [10.24, -0.999, 99.999, 9.96921e36])
def test_a_column_stuck_at_a_value_is_a_gap(value, tmp_path):
    """Also in a test without noise, which tells nothing of its other columns."""

    def stick(values):
        values[..., 1:] = 0.0
        values[:, OWN, 0] = value

    folder = write_campaign(tmp_path, _spoilt(stick))
    test = load_test(load_campaign(folder), "t1")
    assert "block-1-lower" not in test["marker"].values
    line = f"{value:.4g} m throughout, taken as gaps: block-1-lower.x"
    assert any(line in remark for remark in campaign_lines(folder))


def test_a_stuck_accelerometer_and_a_stuck_slab_are_named(tmp_path):
    test = resting_stack().isel(channel=[0])
    test["accelerometer"].values[:] = -999.0
    lines = campaign_lines(write_campaign(tmp_path, test))
    assert any("-999 m/s2 throughout, taken as gaps: slab-acc-x" in line for line in lines)

    def stick(values):
        values[:, [place for place, name in enumerate(MARKERS) if name.startswith("slab")]] = 10.24

    folder = write_campaign(tmp_path, _spoilt(stick))
    with pytest.raises(InputError, match=r"expected a marker of the driven body.*; 10\.24 m throughout"):
        load_test(load_campaign(folder), "t1")


@pytest.mark.parametrize("lost", [[150], [150, 151, 152], [40, 200]])
def test_zeros_between_readings_that_stand_off_are_found(lost):
    """A sine of 1 Hz about 5, in steps of at most 0.05, whose zeros stand 4 and more off."""
    values = 5.0 + np.sin(2.0 * np.pi * np.arange(300) / 100.0)
    values[lost] = 0.0
    assert np.flatnonzero(dropouts(values[:, None])).tolist() == lost


@pytest.mark.parametrize("amplitude", [0.01, 1.0, 100.0])
def test_zeros_that_a_motion_passes_are_none(amplitude):
    """Digits of a hundredth, so that many readings are 0."""
    values = np.round(amplitude * np.sin(0.1 * np.arange(600)), 2)
    assert not dropouts(values[:, None]).any()
