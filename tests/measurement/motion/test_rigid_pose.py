import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
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
    found = fit_poses(POINTS, _read(position, rotation), NOISE)
    np.testing.assert_allclose(found.position, position, atol=1e-13)
    np.testing.assert_allclose(found.rotation, rotation, atol=1e-13)
    assert found.misfit.max() < 1e-13


def test_errors_are_as_large_as_stated():
    """Monte Carlo: scores of position and rotation in the stated covariance have a mean square of 6."""
    position, rotation = _motion(4000, 1)
    readings = _read(position, rotation) + np.random.default_rng(2).normal(0.0, NOISE, (4000, 4, 3))
    found = fit_poses(POINTS, readings, NOISE)
    turn = Rotation.from_matrix(rotation @ found.rotation.transpose(0, 2, 1)).as_rotvec()
    error = np.concatenate([position - found.position, turn], axis=1)
    score = np.einsum("ti,tij,tj->t", error, np.linalg.inv(found.covariance), error)
    # chi-square of 6: standard error of the mean sqrt(12 / 4000)
    assert score.mean() == pytest.approx(6.0, abs=4.0 * np.sqrt(12.0 / 4000))
    assert np.sqrt((found.misfit**2).mean()) == pytest.approx(NOISE, rel=0.03)


def test_a_marker_that_is_not_read_is_left_out():
    position, rotation = _motion(3)
    readings = _read(position, rotation)
    readings[0, 1] = np.nan
    readings[1, :2] = np.nan
    found = fit_poses(POINTS, readings, NOISE)
    np.testing.assert_allclose(found.position[[0, 2]], position[[0, 2]], atol=1e-13)
    assert np.isnan(found.position[1]).all()
    assert np.trace(found.covariance[0]) > np.trace(found.covariance[2])


def test_markers_that_cannot_tell_a_pose_are_an_error():
    with pytest.raises(InputError, match="expected at least 3 on a body, not 2"):
        fit_poses(POINTS[:2], np.zeros((1, 2, 3)), NOISE)
    line = np.array([[0.0, 0.0, z] for z in (0.0, 1.0, 2.0)])
    with pytest.raises(InputError, match="not on one line"):
        fit_poses(line, np.zeros((1, 3, 3)), NOISE)


def test_a_moved_marker_shows_in_the_misfit():
    position, rotation = _motion(1)
    readings = _read(position, rotation)
    readings[0, 2, 0] += 0.01
    # what six degrees of freedom cannot take up of 10 mm: a few millimetres
    assert fit_poses(POINTS, readings, NOISE).misfit[0] > 10.0 * NOISE
