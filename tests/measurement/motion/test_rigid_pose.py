import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.measurement.motion.rigid_pose import fit_poses

POINTS = np.array([[0.4, 1.2, 0.8], [0.4, -1.2, 0.8], [0.4, 0.0, -0.8], [-0.4, 1.0, 0.2]])
NOISE = 1e-4


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
