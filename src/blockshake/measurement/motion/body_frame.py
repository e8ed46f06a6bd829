"""Markers seen from their own body: what no rigid motion explains, also where markers lie on a line."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter
from scipy.spatial.transform import Rotation

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.sensors.markers import whole_markers

_FEWEST = 3  # markers of a body, whose residual shows anything
_ITERATIONS = 4  # Gauss-Newton converges quadratically: enough for 0.3 rad
ON_LINE = 0.02  # lever of the markers about an axis, over the largest: no turn about it can be read
_WINDOW = 9  # readings in which an outlier must stand alone
_OUTLIER = 6.0  # robust standard deviations


@dataclass(frozen=True)
class BodyFrame:
    """Motion of a body and its markers' residuals."""

    # float64 (n_times, 3); of the mass centre [m]; NaN where fewer than three markers were read
    position: np.ndarray
    rotation: np.ndarray  # float64 (n_times, 3, 3); body to world
    # float64 (n_times, n_markers, 3); where the marker is read less where the structure has it, body frame
    # [m]; free of rigid motion; NaN if not read
    residual: np.ndarray
    # float64 (n_times, 3 n_markers, 3 n_markers); takes an error of the readings (body frame) to the residual, both
    # over the noise along their axes; zero where nothing is to be checked
    projector: np.ndarray


def frames_of_bodies(test, structure):
    """Columns among the markers of a campaign's test, and `BodyFrame`, of every body with three whole markers."""
    read, whole = [str(name) for name in test["marker"].values], whole_markers(test)
    displacement = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()
    starts = rotation_matrices(structure.orientation)
    for body, position, start in zip(structure.body_names, structure.position, starts, strict=True):
        markers = [
            marker for marker in structure.file.markers if marker.body == body and marker.name in whole
        ]
        if len(markers) < _FEWEST:
            continue
        points, columns = structure.arms(markers), [read.index(marker.name) for marker in markers]
        readings = position + points @ start.T + displacement[:, columns]
        yield columns, see_from_body(points, readings, position, start)


def see_from_body(points, readings, start_position, start_rotation, noise=(1.0, 1.0, 1.0)):
    """`BodyFrame`: fit the rigid motion and turn what is left into the body's frame.

    Parameters
    ----------
    points : float64 array, shape (n_markers, 3)
        Body frame [m].
    readings : float64 array, shape (n_times, n_markers, 3)
        Positions, inertial frame [m]; a marker with a NaN is not used at that time.
    start_position, start_rotation : float64 arrays, shapes (3,), (3, 3)
        Pose near the readings' first one.
    noise : float64 array, shape (3,)
        Relative standard deviation of a reading along the axes of the body: of its weighted least squares alone is the
        residual free of the error of the turn.

    Notes
    -----
    Gauss-Newton with the minimum-norm step, so that markers on a line leave the turn about it at zero, where
    `fit_poses` refuses them. Such a turn moves a marker that sits next to the line along y, by an amount nobody knows:
    there the projector drops y. A residual is orthogonal to all rigid motions to first order.
    """
    n_times, n_markers = readings.shape[:2]
    position = np.full((n_times, 3), np.nan)
    rotation = np.full((n_times, 3, 3), np.nan)
    residual = np.full((n_times, n_markers, 3), np.nan)
    projector = np.zeros((n_times, 3 * n_markers, 3 * n_markers))
    read = np.isfinite(readings).all(axis=2)
    for pattern in np.unique(read, axis=0):
        if pattern.sum() < _FEWEST:
            continue
        times, markers = np.flatnonzero((read == pattern).all(axis=1)), np.flatnonzero(pattern)
        middle = points[markers].mean(axis=0)
        arms = points[markers] - middle
        scale = np.tile(noise, len(markers))
        jacobian = rigid_jacobian(arms) / scale[:, None]
        inverse = np.linalg.pinv(jacobian, rcond=ON_LINE) / scale
        x = np.tile(start_position + start_rotation @ middle, (len(times), 1))
        turn = np.tile(start_rotation, (len(times), 1, 1))
        seen = readings[np.ix_(times, markers)]
        for step in range(_ITERATIONS + 1):
            rest = (seen - x[:, None]) @ turn - arms
            if step < _ITERATIONS:
                change = rest.reshape(len(times), -1) @ inverse.T
                x = x + (turn @ change[:, :3, None])[..., 0]
                turn = turn @ Rotation.from_rotvec(change[:, 3:]).as_matrix()
        position[times], rotation[times] = x - turn @ middle, turn
        residual[np.ix_(times, markers)] = rest
        rows = (3 * markers[:, None] + np.arange(3)).ravel()
        projector[np.ix_(times, rows, rows)] = _projector(jacobian)
    return BodyFrame(position, rotation, residual, projector)


def _projector(jacobian):
    """Residual that errors of the readings leave after a rigid motion is fitted."""
    values = np.linalg.svd(jacobian, compute_uv=False)
    if values[-1] < ON_LINE * values[0]:
        across = np.kron(np.eye(len(jacobian) // 3), np.eye(3)[:, [1]])
        jacobian = np.hstack([jacobian, across])
    inverse = np.linalg.pinv(jacobian, rcond=ON_LINE)
    return np.eye(len(jacobian)) - jacobian @ inverse


def rigid_jacobian(points):
    """Change of points (..., n_points, 3) by a displacement and a small turn, in their frame, (..., 3 n_points, 6)."""
    change = np.zeros((*points.shape, 6))
    change[..., :3] = np.eye(3)
    for axis in range(3):
        change[..., 3 + axis] = np.cross(np.eye(3)[axis], points)
    return change.reshape(*points.shape[:-2], -1, 6)


def outlying(residual):
    """Readings far from their neighbours' median: a fault of a sensor is smooth in time, an outlier is not.

    Parameters
    ----------
    residual : float64 array, shape (n_times, n_markers, 3)
        Residuals of a `BodyFrame`.

    Returns
    -------
    bool array, shape (n_times, n_markers)
        A lone outlier shows in all markers of its body; the one with the largest departure is taken to be it.
    """
    score = np.zeros(residual.shape[:2])
    for marker in range(residual.shape[1]):
        read = np.isfinite(residual[:, marker]).all(axis=1)
        if not read.any():
            continue
        known = residual[read, marker]  # neighbours are the readings before and after, over any gap
        away = np.abs(known - median_filter(known, size=(_WINDOW, 1)))
        spread = 1.4826 * np.median(away, axis=0)
        score[read, marker] = (away / np.maximum(spread, 1e-2 * spread.max() + 1e-12)).max(axis=1)
    return (score == score.max(axis=1, keepdims=True)) & (score > _OUTLIER)


def without_outliers(test, structure):
    """A campaign's test with lone wrong readings as gaps, on bodies with three markers that measure all directions."""
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    values = displacement.to_numpy().copy()
    for columns, frame in frames_of_bodies(test, structure):
        for column, wrong in zip(columns, outlying(frame.residual).T, strict=True):
            values[wrong, column] = float("nan")
    return test.assign(marker_displacement=displacement.copy(data=values))
