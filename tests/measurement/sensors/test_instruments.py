import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.measurement.sensors.markers import marker_position

STRUCTURE = load_structure("configuration-1")
SILENT = {"marker_noise": 0.0, "accelerometer_noise": 0.0}
TIME = np.arange(401) / 200.0
MARKER = STRUCTURE.file.markers[-1].name


@pytest.fixture(scope="module")
def run():
    """Every body shifts and turns smoothly; one accelerometer channel with."""
    angle = 0.05 * np.sin(2.0 * np.pi * 1.5 * TIME) ** 2
    n_bodies = len(STRUCTURE.mass)
    position = np.tile(STRUCTURE.position, (len(TIME), 1, 1))
    position[..., 0] += 0.02 * np.sin(2.0 * np.pi * TIME)[:, None] ** 2
    turn = Rotation.from_rotvec(angle[:, None] * [0.0, 1.0, 0.0]).as_quat()[:, [3, 0, 1, 2]]
    orientation = np.repeat(turn[:, None], n_bodies, axis=1)
    return xr.Dataset(
        {
            "position": (("time", "body", "axis"), position),
            "orientation": (("time", "body", "quaternion"), orientation),
            "accelerometer": (
                ("time_acc", "channel"),
                np.sin(np.arange(1024.0))[:, None],
                {"units": "m s-2"},
            ),
        },
        {"time": TIME, "time_acc": np.arange(1024) / 512.0, "channel": ["top-x"]},
    )


def _observe(run, seed=1, **faults):
    return observe(run, STRUCTURE, Instruments(**(SILENT | faults)), seed)


def _true(run):
    places = marker_position(STRUCTURE, run["position"].to_numpy(), run["orientation"].to_numpy())
    return places - places[0]


def test_without_faults_the_truth_is_read(run):
    test = _observe(run)
    np.testing.assert_array_equal(test["marker_displacement"], _true(run))
    np.testing.assert_array_equal(test["accelerometer"], run["accelerometer"])
    assert test.attrs["synthetic"] == 1


def test_noise_has_its_size_and_the_first_reading_is_zero(run):
    error = _observe(run, marker_noise=1e-4)["marker_displacement"].to_numpy() - _true(run)
    assert (error[0] == 0.0).all()
    # the first reading's own error is in all the others of its channel
    spread = (error[1:] - error[1:].mean(axis=0)).std()
    assert spread == pytest.approx(1e-4, rel=0.03)


def test_one_fault_leaves_the_noise_of_the_others_as_it_is(run):
    plain = _observe(run, marker_noise=1e-4)
    fault = _observe(run, marker_noise=1e-4, marker_dropouts=0.1, accelerometer_offset=0.3)
    there = fault["marker_displacement"].notnull()
    xr.testing.assert_equal(fault["marker_displacement"], plain["marker_displacement"].where(there))
    offset = (fault["accelerometer"] - plain["accelerometer"]).to_numpy()
    assert np.ptp(offset, axis=0) < 1e-14
    assert (offset != 0.0).all()


def test_a_late_clock_shows_what_was(run):
    lag = 0.0123
    read = _observe(run, marker_lag=lag)["marker_displacement"].to_numpy()
    position = 0.02 * np.sin(2.0 * np.pi * np.maximum(TIME - lag, 0.0)) ** 2
    slab = [marker.body for marker in STRUCTURE.file.markers].index("slab")
    arm = np.array(STRUCTURE.file.markers[slab].position)
    angle = 0.05 * np.sin(2.0 * np.pi * 1.5 * np.maximum(TIME - lag, 0.0)) ** 2
    exact = position + arm[0] * (np.cos(angle) - 1.0) + arm[2] * np.sin(angle)
    # cubic interpolation of 200 Hz: (2 pi f h)^4 / 384 of 5 cm
    np.testing.assert_allclose(read[:, slab, 0], exact, atol=1e-7)


def test_gain_drift_and_a_marker_elsewhere(run):
    true = _true(run)
    read = _observe(
        run, marker_gain={MARKER: 1.03}, marker_drift=[1e-3, 0.0, 0.0], channel_gain={"top-x": 0.9}
    )
    displacement = read["marker_displacement"].to_numpy()
    np.testing.assert_allclose(displacement[:, -1, 0], 1.03 * true[:, -1, 0] + 1e-3 * TIME, atol=1e-15)
    np.testing.assert_allclose(displacement[:, 0, 0], true[:, 0, 0] + 1e-3 * TIME, atol=1e-15)
    np.testing.assert_allclose(read["accelerometer"], 0.9 * run["accelerometer"], rtol=1e-15)
    moved = _observe(run, marker_offset={MARKER: [0.0, 0.0, 0.1]})["marker_displacement"].to_numpy()
    angle = 0.05 * np.sin(2.0 * np.pi * 1.5 * TIME) ** 2
    # 10 cm higher on a body that turns about y: sin(angle) farther along x
    np.testing.assert_allclose(moved[:, -1, 0] - true[:, -1, 0], 0.1 * np.sin(angle), atol=1e-15)


def test_dropouts_take_their_share_in_bursts(run):
    lost = _observe(run, marker_dropouts=0.2)["marker_displacement"].isnull().all("axis").to_numpy()
    assert lost.mean() == pytest.approx(0.2, abs=0.05)
    starts = (lost[1:] & ~lost[:-1]).sum()
    assert lost.sum() / starts == pytest.approx(10.0, rel=0.3)
    assert not lost[0].any()


def test_same_seed_same_bytes(run):
    first, again, other = (
        _observe(run, seed, marker_noise=1e-4)["marker_displacement"].to_numpy().tobytes()
        for seed in (1, 1, 2)
    )
    assert first == again != other


def test_a_fault_of_no_sensor_is_an_error(run):
    with pytest.raises(InputError, match=r"marker_gain.nobody: expected one of"):
        _observe(run, marker_gain={"nobody": 1.1})
