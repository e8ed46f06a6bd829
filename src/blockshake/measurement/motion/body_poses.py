"""Poses of all bodies from whatever markers each has, and what is known of those that have too few."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.rigid_pose import fit_poses
from blockshake.measurement.sensors.markers import marker_position

_TABLE_ROLL = 1e-4  # rad, standard deviation of a driven body's rotation about x before anything is read
POSE, PLANAR, TRANSLATION, NOTHING = "pose", "planar", "translation", "nothing"


@dataclass(frozen=True)
class BodyPoses:
    """Poses of all bodies in time.

    Attributes
    ----------
    position : float64 array, shape (n_times, n_bodies, 3)
        Of the mass centres, inertial frame [m]; NaN where unknown.
    rotation : float64 array, shape (n_times, n_bodies, 3, 3)
        Body to world; NaN where unknown.
    covariance : float64 array, shape (n_bodies, 6, 6)
        Scatter by the readings' noise of position [m] and small rotation, world frame [rad], mean over the known times;
        NaN where unknown.
    known : list of str, length n_bodies
        ``pose``; ``planar``: two markers, or several on a line, roll and yaw taken as none; ``translation``: one
        marker, rotation unknown, of a driven body taken as none; ``nothing``: no marker.
    """

    position: np.ndarray
    rotation: np.ndarray
    covariance: np.ndarray
    known: list


def body_poses(test, structure, marker_noise, asked=None):
    """`BodyPoses` of bodies from the markers of a test.

    Parameters
    ----------
    test : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], inertial frame, since the first reading; NaN is a gap.
    structure : Structure
    marker_noise : float
        Standard deviation of a reading along an axis [m].
    asked : bool array, shape (n_bodies,), optional
        Bodies whose markers are read, the others count as without; all by default.

    Notes
    -----
    Markers start where the structure file has them: a marker that sits elsewhere, which nobody told, errs by its
    offset times the rotation, in simulated readings as in measured ones. A driven body's rotation about x, the axis of
    shaking, is taken as none within 0.1 mrad: where its markers are nearly on a line along x, as on one
    face of the slab, their noise would else turn it by milliradians and open every joint on it.
    """
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    read = [str(name) for name in displacement["marker"].values]
    names = [marker.name for marker in structure.file.markers]
    for name in read:
        if name not in names:
            raise InputError("body poses", name, f"expected a marker of {structure.source}")
    places = marker_position(structure, structure.position, structure.orientation)
    own = np.array([names.index(name) for name in read])
    arms = structure.arms(structure.file.markers)[own]
    readings = places[own] + displacement.to_numpy()
    bodies = structure.carriers(structure.file.markers)[own]
    start = rotation_matrices(structure.orientation)
    n_times, n_bodies = len(readings), len(structure.mass)
    position = np.full((n_times, n_bodies, 3), np.nan)
    rotation = np.full((n_times, n_bodies, 3, 3), np.nan)
    covariance = np.full((n_bodies, 6, 6), np.nan)
    known = [NOTHING] * n_bodies
    for body in np.unique(bodies if asked is None else bodies[asked[bodies]]):
        mine = np.flatnonzero(bodies == body)
        known[body], fit = _best_fit(
            arms[mine], readings[:, mine], start[body], structure.driven[body], marker_noise
        )
        if structure.driven[body] and known[body] == POSE:
            fit = _hardly_rolling(*fit, start[body])
        position[:, body], rotation[:, body], covariance[body] = fit
    return BodyPoses(position, rotation, covariance, known)


def driven_body(structure, poses):
    """Index of the first driven body that is seen."""
    for body in np.flatnonzero(structure.driven):
        if poses.known[body] != NOTHING:
            return int(body)
    raise InputError("body poses", "marker", "expected a marker of the driven body")


def _best_fit(points, readings, start, driven, noise):
    """The fullest pose that the markers allow: what is known, and position, rotation, mean covariance."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    arms = points @ start.T
    if len(points) > 2 and spread[1] > 1e-3 * spread[0]:
        found = fit_poses(points, readings, noise)
        fitted = np.isfinite(found.position[:, 0])
        mean = found.covariance[fitted].mean(axis=0) if fitted.any() else np.full((6, 6), np.nan)
        return POSE, (found.position, found.rotation, mean)
    planar = arms[:, [0, 2]] - arms[:, [0, 2]].mean(axis=0)
    if (planar**2).sum() > 1e-4:
        return PLANAR, _planar_fit(arms, planar, readings, start, noise)
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = np.eye(3) * noise**2 / len(points)
    turn = start if driven else np.full((3, 3), np.nan)
    position = readings.mean(axis=1) - arms.mean(axis=0)
    return TRANSLATION, (position, np.tile(turn, (len(readings), 1, 1)), covariance)


def _hardly_rolling(position, rotation, covariance, start):
    """Poses updated by the knowledge that the rotation about x is none within `_TABLE_ROLL`."""
    turned = rotation @ start.T
    roll = 0.5 * (turned[:, 2, 1] - turned[:, 1, 2])
    gain = covariance[:, 3] / (covariance[3, 3] + _TABLE_ROLL**2)
    kept = np.eye(6) - np.outer(gain, np.eye(6)[3])
    back = np.zeros((len(roll), 3))
    known = np.isfinite(roll)
    back[known] = -roll[known, None] * gain[3:]
    return (
        position - roll[:, None] * gain[:3],
        Rotation.from_rotvec(back).as_matrix() @ rotation,
        kept @ covariance @ kept.T,
    )


def _planar_fit(arms, planar, readings, start, noise):
    """Least squares over displacement and a turn about y from the start; ``arms`` at the start, world frame [m]."""
    middle = readings.mean(axis=1)
    away = readings[..., [0, 2]] - middle[:, None, [0, 2]]
    x, z = planar.T
    # about y: x' = c x + s z, z' = c z - s x
    angle = np.arctan2(
        (away[..., 0] * z - away[..., 1] * x).sum(axis=1), (away[..., 0] * x + away[..., 1] * z).sum(axis=1)
    )
    vectors = np.zeros((len(angle), 3))
    vectors[:, 1] = np.where(np.isfinite(angle), angle, 0.0)
    turn = Rotation.from_rotvec(vectors).as_matrix()
    turn[~np.isfinite(angle)] = np.nan
    position = middle - turn @ arms.mean(axis=0)
    angle_variance = noise**2 / (planar**2).sum()
    lever = np.array([-arms[:, 2].mean(), 0.0, arms[:, 0].mean()])  # of the centre about the markers' middle
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = np.eye(3) * noise**2 / len(arms) + np.outer(lever, lever) * angle_variance
    covariance[:3, 4] = covariance[4, :3] = lever * angle_variance
    covariance[4, 4] = angle_variance
    return position, turn @ start, covariance
