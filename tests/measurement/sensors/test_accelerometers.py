import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.signal import butter, freqz

from blockshake.geometry.structure import build_structure, load_structure
from blockshake.measurement.sensors.accelerometers import (
    CUTOFF,
    FINE_RATE,
    LONGEST_GAP,
    low_pass,
    reading_times,
    readings_of,
    specific_forces,
    whole_channels,
)

G = 9.81
ROUNDING = 1e-9  # m/s2; a velocity of 1 m/s has 1e-16, times 2048 Hz, through a filter
INTERIOR = 256  # readings at each end (0.5 s) that the filter's ends may touch
STRUCTURE = load_structure("configuration-1")
TIME = np.arange(513) / 512.0
TONE = np.sin(20.0 * TIME)


def _structure(sensors):
    """One block, without a slab."""
    sharp = {"name": "block", "shape": "sharp", "position": [0.0, 0.0, 0.8]}
    mapping = STRUCTURE.file.model_dump() | {
        "bodies": [{"material": "concrete", **sharp}],
        "accelerometers": sensors,
    }
    return build_structure(
        mapping | {"shapes": {"sharp": {"box": [0.8, 2.4, 1.6]}}, "markers": []}, "one-block", "."
    )


TOP = [{"name": "top", "body": "block", "position": [0.4, 0.0, 0.8], "axes": ["x", "z"]}]


def _readings(structure, time, *states):
    """Times and readings of every channel."""
    times = reading_times(time)
    return times, readings_of(specific_forces(structure, *states), times)


def _motion(duration):
    """Times at the fine rate with a block at rest, arrays to fill."""
    time = np.arange(round(duration * FINE_RATE) + 1) / FINE_RATE
    orientation = np.zeros((len(time), 1, 4))
    orientation[:, 0, 0] = 1.0
    return time, orientation, np.zeros((len(time), 1, 3)), np.zeros((len(time), 1, 3))


def _lean(angle):
    angle = np.asarray(angle)
    return np.stack([np.cos(angle / 2), 0 * angle, np.sin(angle / 2), 0 * angle], axis=-1)


def _gain(frequency):
    """For the low-pass run both ways: the square of the digital Butterworth's."""
    b, a = butter(4, CUTOFF, fs=FINE_RATE)
    return np.abs(freqz(b, a, worN=[frequency], fs=FINE_RATE)[1][0]) ** 2


def test_a_block_at_rest_reads_gravity_upwards():
    time, *states = _motion(0.5)
    time_acc, readings = _readings(_structure(TOP), time, *states)
    np.testing.assert_array_equal(time_acc, np.arange(257) / 512.0)
    np.testing.assert_allclose(readings, np.tile([0.0, G], (257, 1)), atol=ROUNDING)


def test_a_block_leaning_at_rest_reads_gravity_along_its_own_axes():
    time, orientation, velocity, spin = _motion(0.5)
    orientation[:, 0] = _lean(0.2)
    _, readings = _readings(_structure(TOP), time, orientation, velocity, spin)
    # leaning to +x, the body's x points down by 0.2 rad: the push from below has a part along -x
    np.testing.assert_allclose(
        readings, np.tile([-G * np.sin(0.2), G * np.cos(0.2)], (257, 1)), atol=ROUNDING
    )


def test_a_falling_block_reads_nothing():
    time, orientation, velocity, spin = _motion(0.5)
    velocity[:, 0, 2] = -G * time
    _, readings = _readings(_structure(TOP), time, orientation, velocity, spin)
    np.testing.assert_allclose(readings, 0.0, atol=1e-8)


@pytest.mark.parametrize("frequency", [2.0, 10.0, 50.0])
def test_a_sinusoid_is_read_without_lag_and_with_the_filters_gain(frequency):
    time, orientation, velocity, spin = _motion(4.0)
    omega = 2.0 * np.pi * frequency
    velocity[:, 0, 0] = -np.cos(omega * time) / omega
    time_acc, readings = _readings(_structure(TOP), time, orientation, velocity, spin)
    expected = _gain(frequency) * np.sin(omega * time_acc)
    # the mean over a fine interval loses sinc: (pi f / 2048)^2 / 6 = 1e-3 at 50 Hz; half an interval of
    # lag would show as pi f / 2048 = 3e-3 at 2 Hz
    tolerance = max((np.pi * frequency / FINE_RATE) ** 2 / 5, 1e-5)
    np.testing.assert_allclose(readings[INTERIOR:-INTERIOR, 0], expected[INTERIOR:-INTERIOR], atol=tolerance)


def test_both_passes_halve_the_amplitude_at_the_cutoff():
    # each pass is 3 dB down at 50 Hz: exactly 1/sqrt(2)
    time = np.arange(4 * 2048) / FINE_RATE
    smooth = low_pass(np.sin(2 * np.pi * CUTOFF * time)[:, None])
    assert np.abs(smooth[2048:-2048]).max() == pytest.approx(0.5, abs=1e-4)


def test_a_spinning_block_reads_the_centripetal_force_and_turning_gravity():
    time, orientation, velocity, spin = _motion(4.0)
    rate = 3.0  # rad/s about y; gravity turns at 0.48 Hz in the body's axes, where the filter's gain is 1
    orientation[:, 0] = _lean(rate * time)
    spin[:, 0, 1] = rate
    time_acc, readings = _readings(_structure(TOP), time, orientation, velocity, spin)
    angle = rate * time_acc
    expected = np.column_stack([-(rate**2) * 0.4 - G * np.sin(angle), -(rate**2) * 0.8 + G * np.cos(angle)])
    # sinc loss of the centripetal part, (w h)^2 / 24 of 7 m/s2: 1e-6
    np.testing.assert_allclose(readings[INTERIOR:-INTERIOR], expected[INTERIOR:-INTERIOR], atol=1e-5)


def test_an_impact_enters_with_its_whole_change_of_velocity():
    time, orientation, velocity, spin = _motion(2.0)
    velocity[time > 1.0001, 0, 0] = 0.3
    time_acc, readings = _readings(_structure(TOP), time, orientation, velocity, spin)
    # the low-pass keeps the area; at 512 Hz the sum is exact for what it leaves above 256 Hz (1e-6)
    assert readings[:, 0].sum() / 512.0 == pytest.approx(0.3, rel=1e-5)
    # and it is centred on the interval of the jump, 1.0 to 1.0 + 1 / 2048 s
    centre = (time_acc * readings[:, 0]).sum() / readings[:, 0].sum()
    assert centre == pytest.approx(1.0 + 0.5 / FINE_RATE, abs=1e-5)


def test_an_abort_leaves_nan_after_it_and_nothing_before():
    time, orientation, velocity, spin = _motion(2.0)
    velocity[:, 0, 0] = np.sin(2 * np.pi * time)
    cut = 2 * 2048 // 2 + 3  # states up to index 2050 exist: readings up to 512
    cut_short = [array.copy() for array in (orientation, velocity, spin)]
    for array in cut_short:
        array[cut:] = np.nan
    time_acc, readings = _readings(_structure(TOP), time, *cut_short)
    assert len(time_acc) == 1025
    np.testing.assert_array_equal(np.isfinite(readings[:, 0]), np.arange(1025) <= 512)
    # the same as a run that was to end there
    _, ended = _readings(_structure(TOP), time[:cut], *(array[:cut] for array in cut_short))
    np.testing.assert_array_equal(readings[:513], ended)
    # and as the whole run but for the filter's end
    _, whole = _readings(_structure(TOP), time, orientation, velocity, spin)
    np.testing.assert_allclose(readings[: 513 - INTERIOR], whole[: 513 - INTERIOR], atol=1e-6)


def test_a_run_aborted_at_once_reads_nothing():
    time, orientation, velocity, spin = _motion(0.1)
    velocity[1:] = np.nan
    _, readings = _readings(_structure(TOP), time, orientation, velocity, spin)
    assert np.isnan(readings).all()


def test_no_sensors_give_no_channels():
    time, *states = _motion(0.1)
    time_acc, readings = _readings(_structure([]), time, *states)
    assert readings.shape == (len(time_acc), 0)


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
