"""Poses from markers: the fit of a rigid body, and what directions that no marker measures leave out."""

import numpy as np
import pytest
from known_motion import SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, ramp, seen
from scipy.spatial.transform import Rotation

from blockshake.diagnosis.nominal.histories import as_cells, read_histories
from blockshake.dynamics.motion import ground_motion
from blockshake.measurement.campaigns.clocks import from_command
from blockshake.measurement.motion.body_poses import fit_poses
from blockshake.measurement.motion.joint_histories import joint_histories
from blockshake.measurement.motion.measured_base import base_as_motion, draw_base, measure_base
from blockshake.parity.parity import check_parity

BASE = base_motion()
ANGLE = bump(TIME, 1.5, 0.6, 0.02)
SLIP = ramp(TIME, 2.5, 0.2, 0.004)
_SMALL_PRODUCT = 0.38 * 0.02**2  # m: half a block's width times the square of the largest turn
POINTS = np.array([[0.4, 1.2, 0.8], [0.4, -1.2, 0.8], [0.4, 0.0, -0.8], [-0.4, 1.0, 0.2]])
NOISE = 1e-4


def _measured(test, axes, names=None):
    """The test with readings of these axes alone, NaN along the others."""
    test = test if names is None else test.sel(marker=names)
    return test.assign(marker_displacement=test["marker_displacement"].where(test["axis"].isin(list(axes))))


@pytest.fixture(scope="module")
def run():
    return moved_run(BASE, rocking=[0.0, ANGLE], slips=[SLIP], vertical=0.2 * BASE.displacement)


def _one_a_body():
    return [f"{name}-a" for name in STRUCTURE.body_names]


def test_one_camera_tells_the_joints_in_its_plane(run):
    found = joint_histories(_measured(seen(run), "xz"), STRUCTURE, SENSORS)
    np.testing.assert_allclose(found["rotation"].to_numpy().T, [0 * TIME, ANGLE, 0 * TIME], atol=1e-12)
    np.testing.assert_allclose(found["slip"][:, 0], SLIP, atol=1e-12)


def test_displacement_transducers_at_two_heights_tell_turns_and_slips(run):
    found = joint_histories(_measured(seen(run), "x"), STRUCTURE, SENSORS)
    np.testing.assert_allclose(found["rotation"].to_numpy().T, [0 * TIME, ANGLE, 0 * TIME], atol=1e-10)
    np.testing.assert_allclose(found["slip"][:, 0], SLIP, atol=_SMALL_PRODUCT)
    np.testing.assert_allclose(found["slip"][:, 1], 0.38 * (1.0 - np.cos(ANGLE)), atol=_SMALL_PRODUCT)


def test_one_displacement_transducer_a_block_tells_its_drift_alone(run):
    found = joint_histories(_measured(seen(run), "x", _one_a_body()), STRUCTURE, SENSORS)
    np.testing.assert_allclose(found["drift"].sel(body="block-1"), SLIP, atol=1e-12)
    for name in ("slip", "rotation"):
        assert found[name].isnull().all()


@pytest.mark.parametrize(("axes", "names"), [("xz", None), ("x", None), ("x", _one_a_body())])
def test_a_test_is_read_off_without_what_was_not_measured(run, axes, names):
    test = _measured(seen(run), axes, names)
    reading = read_histories(test, STRUCTURE, SENSORS)
    assert reading["drift"].sel(body=STRUCTURE.body_names[-1]).notnull().all()
    assert as_cells(reading).notnull().all()
    assert check_parity({"t1": test}, STRUCTURE, SENSORS).findings == ()


def test_a_table_is_commanded_along_what_nobody_measured(run):
    told = {"x": BASE.displacement, "z": 0.2 * BASE.displacement}
    command = ground_motion("command", TIME, told, "displacement")
    test = from_command(_measured(seen(run), "x"), STRUCTURE, command)
    base = measure_base(test, STRUCTURE, SENSORS, command)
    assert base.attrs["unread"] == "yz"
    assert base["marker"].sel(channel=["y", "z"]).isnull().all()
    assert base["displacement_error"].sel(channel=["y", "z"]).isnull().all()
    motion = base_as_motion(base, draw_base(base, np.random.default_rng(1)), "measured", {})
    start = float(test["time"][0])
    moved = motion.evaluate(TIME + start - base.attrs["start"])
    expected = command.evaluate(TIME + start)
    np.testing.assert_allclose(moved[:, 1], 0.0, atol=1e-15)
    np.testing.assert_allclose(moved[:, 2], expected[:, 2], atol=1e-5)


def _motion(n_times, seed=0):
    rng = np.random.default_rng(seed)
    rotation = Rotation.from_rotvec(0.3 * rng.normal(size=(n_times, 3))).as_matrix()
    return rng.normal(size=(n_times, 3)), rotation


def _read(position, rotation, points=POINTS):
    return position[:, None] + np.einsum("tij,mj->tmi", rotation, points)


def test_exact_markers_give_the_exact_pose():
    position, rotation = _motion(50)
    place, turn, _ = fit_poses(POINTS, _read(position, rotation), NOISE)
    np.testing.assert_allclose(place, position, atol=1e-13)
    np.testing.assert_allclose(turn, rotation, atol=1e-13)


def test_errors_are_as_large_as_stated():
    """Monte Carlo: scores of position and rotation in the stated covariance have a mean square of 6."""
    position, rotation = _motion(4000, 1)
    readings = _read(position, rotation) + np.random.default_rng(2).normal(0.0, NOISE, (4000, 4, 3))
    place, turn, covariance = fit_poses(POINTS, readings, NOISE)
    away = Rotation.from_matrix(rotation @ turn.transpose(0, 2, 1)).as_rotvec()
    error = np.concatenate([position - place, away], axis=1)
    score = np.einsum("ti,tij,tj->t", error, np.linalg.inv(covariance), error)
    # chi-square of 6: standard error of the mean sqrt(12 / 4000)
    assert score.mean() == pytest.approx(6.0, abs=4.0 * np.sqrt(12.0 / 4000))


def test_a_marker_that_is_not_read_is_left_out():
    position, rotation = _motion(3)
    readings = _read(position, rotation)
    readings[0, 1] = np.nan
    readings[1, :2] = np.nan
    place, _, covariance = fit_poses(POINTS, readings, NOISE)
    np.testing.assert_allclose(place[[0, 2]], position[[0, 2]], atol=1e-13)
    assert np.isnan(place[1]).all()
    assert np.trace(covariance[0]) > np.trace(covariance[2])
