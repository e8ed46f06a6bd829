"""Poses of all bodies from whatever markers each has, and what is known of those that have too few."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_frame import rigid_jacobian
from blockshake.measurement.sensors.markers import directions_read, marker_position

_TABLE_ROLL = 1e-4  # rad, standard deviation of a driven body's rotation about x before anything is read
_ROUNDS = 6  # of a turn by its sine: the error falls by the turn itself in each
POSE, PLANAR, TRANSLATION, NOTHING = "pose", "planar", "translation", "nothing"
_FEWEST_POINTS = 3
# Two markers' spread over the largest below which they lie on a line.
COLLINEAR = 1e-3


@dataclass(frozen=True)
class BodyPoses:
    """Poses of all bodies in time."""

    # float64 (n_times, n_bodies, 3); of the mass centres, inertial frame [m]; NaN where unknown. Along a
    # direction that is not read, that of the structure file, so that the other directions can be computed
    # with
    position: np.ndarray
    rotation: np.ndarray  # float64 (n_times, n_bodies, 3, 3); body to world; NaN where unknown
    # float64 (n_bodies, 6, 6); scatter by the readings' noise of position [m] and small rotation, world frame
    # [rad], mean over the known times; NaN where unknown
    covariance: np.ndarray
    # of str, length n_bodies; ``pose``; ``planar``: two markers, or several on a line or without readings
    # along y, roll and yaw taken as none; ``translation``: one marker, or several whose readings do not tell
    # a turn, rotation unknown, of a driven body taken as none; ``nothing``: no marker
    known: list
    axes_read: np.ndarray  # bool (n_bodies, 3); whether the position along x, y and z is read


def body_poses(test, structure, marker_noise, selected=None):
    """`BodyPoses` of bodies from the markers of a test.

    Parameters
    ----------
    test : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], inertial frame, since the first reading; NaN is a gap.
    structure : Structure
    marker_noise : float
        Standard deviation of a reading along an axis [m].
    selected : bool array, shape (n_bodies,), optional
        Bodies whose markers are read, the others count as without; all by default.

    Notes
    -----
    Markers start where the structure file has them: a marker that sits elsewhere without a word in the file errs by its
    offset times the rotation, in simulated readings as in measured ones. A driven body's rotation about x, the axis of
    shaking, is taken as none within 0.1 mrad: where its markers are nearly on a line along x, as on one
    face of the slab, their noise would else turn it by milliradians and open every joint on it.

    Markers that do not measure all three directions enter where those that do give no pose: with x and z as a planar
    motion, with x alone at two heights or more as a pitch and a displacement along x, else as a displacement along each
    direction that is read.
    """
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    read = [str(name) for name in displacement["marker"].values]
    names = [marker.name for marker in structure.file.markers]
    for name in read:
        if name not in names:
            raise InputError("body poses", name, f"expected a marker of {structure.source}")
    places = marker_position(structure, structure.position, structure.orientation)
    index = np.array([names.index(name) for name in read])
    arms = structure.arms(structure.file.markers)[index]
    moved = displacement.to_numpy()
    measured = directions_read(moved)
    readings = places[index] + np.where(measured, moved, 0.0)
    bodies = structure.carriers(structure.file.markers)[index]
    start = rotation_matrices(structure.orientation)
    n_times, n_bodies = len(readings), len(structure.mass)
    position = np.full((n_times, n_bodies, 3), np.nan)
    rotation = np.full((n_times, n_bodies, 3, 3), np.nan)
    covariance = np.full((n_bodies, 6, 6), np.nan)
    known, axes_read = [NOTHING] * n_bodies, np.zeros((n_bodies, 3), dtype=bool)
    for body in np.unique(bodies if selected is None else bodies[selected[bodies]]):
        mine = np.flatnonzero(bodies == body)
        known[body], axes_read[body], fit = _best_fit(
            arms[mine], readings[:, mine], measured[mine], start[body], structure.driven[body], marker_noise
        )
        if structure.driven[body] and known[body] == POSE:
            fit = _hardly_rolling(*fit, start[body])
        position[:, body], rotation[:, body], covariance[body] = fit
        position[:, body, ~axes_read[body]] = structure.position[body, ~axes_read[body]]
    return BodyPoses(position, rotation, covariance, known, axes_read)


def driven_body(structure, poses):
    """Index of the first driven body that is seen."""
    for body in np.flatnonzero(structure.driven):
        if poses.known[body] != NOTHING:
            return int(body)
    raise InputError("body poses", "marker", "expected a marker of the driven body")


def _best_fit(points, readings, measured, start, driven, noise):
    """Fullest pose that the markers allow: what is known, which axes are read, and position, rotation, covariance."""
    whole = measured.all(axis=1)
    arms = points @ start.T
    size = spread(points[whole]) if whole.sum() > 2 else np.zeros(3)
    if size[1] > COLLINEAR * size[0]:
        position, rotation, covariance = fit_poses(points[whole], readings[:, whole], noise)
        fitted = np.isfinite(position[:, 0])
        mean = covariance[fitted].mean(axis=0) if fitted.any() else np.full((6, 6), np.nan)
        return POSE, True, (position, rotation, mean)
    for axes, turned in (((0, 2), _turn_in_plane), ((0,), _turn_of_upright)):
        enough = measured[:, axes].all(axis=1)
        planar = arms[enough][:, [0, 2]]
        planar = planar - planar.mean(axis=0) if enough.any() else planar
        if (planar[:, 2 - len(axes) :] ** 2).sum() > 1e-4:
            read = measured[enough].all(axis=0)
            return PLANAR, read, _planar_fit(arms[enough], planar, readings[:, enough], start, noise, turned)
    return TRANSLATION, measured.any(axis=0), _displacement(arms, readings, measured, start, driven, noise)


def _displacement(arms, readings, measured, start, driven, noise):
    """Displacement along each direction by the markers that read it; the rotation is that of a driven body alone."""
    position, covariance = np.zeros((len(readings), 3)), np.zeros((6, 6))
    for axis in range(3):
        reading = measured[:, axis]
        if reading.any():
            position[:, axis] = readings[:, reading, axis].mean(axis=1) - arms[reading, axis].mean()
            covariance[axis, axis] = noise**2 / reading.sum()
    turn = start if driven else np.full((3, 3), np.nan)
    return position, np.tile(turn, (len(readings), 1, 1)), covariance


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


def _planar_fit(arms, planar, readings, start, noise, turned):
    """Least squares over displacement and a turn about y from the start; ``arms`` at the start, world frame [m]."""
    middle = readings.mean(axis=1)
    angle, angle_variance = turned(planar, readings[..., [0, 2]] - middle[:, None, [0, 2]], noise)
    vectors = np.zeros((len(angle), 3))
    vectors[:, 1] = np.where(np.isfinite(angle), angle, 0.0)
    turn = Rotation.from_rotvec(vectors).as_matrix()
    turn[~np.isfinite(angle)] = np.nan
    position = middle - turn @ arms.mean(axis=0)
    lever = np.array([-arms[:, 2].mean(), 0.0, arms[:, 0].mean()])  # of the centre about the markers' middle
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = np.eye(3) * noise**2 / len(arms) + np.outer(lever, lever) * angle_variance
    covariance[:3, 4] = covariance[4, :3] = lever * angle_variance
    covariance[4, 4] = angle_variance
    return position, turn @ start, covariance


def _turn_in_plane(planar, away, noise):
    """Turn about y from readings along x and z, (n_times,) [rad], and its variance; both about the markers' middle."""
    x, z = planar.T
    # about y: x' = c x + s z, z' = c z - s x
    angle = np.arctan2(
        (away[..., 0] * z - away[..., 1] * x).sum(axis=1), (away[..., 0] * x + away[..., 1] * z).sum(axis=1)
    )
    return angle, noise**2 / (planar**2).sum()


def _turn_of_upright(planar, away, noise):
    """Turn about y and its variance, as by `_turn_in_plane`, from readings along x of markers at several heights."""
    x, z = planar.T
    sine = np.zeros(len(away))
    for _ in range(_ROUNDS):
        # x' - c x = s z, with the cosine of the last round
        cosine = np.sqrt(1.0 - sine**2)
        sine = np.clip(((away[..., 0] - cosine[:, None] * x) * z).sum(axis=1) / (z**2).sum(), -1.0, 1.0)
    return np.arcsin(sine), noise**2 / (z**2).sum()


def fit_poses(points, readings, marker_noise):
    """Fit a rigid body to its markers at every time.

    Parameters
    ----------
    points : float64 array, shape (n_markers, 3)
        Markers in the body frame, three or more that are not on a line [m].
    readings : float64 array, shape (n_times, n_markers, 3)
        Their positions, inertial frame [m]; a marker with a NaN is not used at that time.
    marker_noise : float
        Standard deviation of a position along an axis, the same for all [m].

    Returns
    -------
    position : float64 array, shape (n_times, 3)
        Place of the mass centre, inertial frame [m]; NaN, as all else, where fewer than three markers were read, or
        markers on a line alone.
    rotation : float64 array, shape (n_times, 3, 3)
        Body to world.
    covariance : float64 array, shape (n_times, 6, 6)
        Covariance of position [m] and small rotation, world frame [rad].

    Notes
    -----
    Rotation from the singular vectors of the cross-covariance (Arun, Huang and Blostein 1987; Umeyama 1991).
    To first order the covariance is ``noise^2 (J^T J)^-1`` with J the change of the markers' positions by a
    displacement and a small rotation.
    """
    n_times = len(readings)
    position, rotation = np.full((n_times, 3), np.nan), np.full((n_times, 3, 3), np.nan)
    covariance = np.full((n_times, 6, 6), np.nan)
    read = np.isfinite(readings).all(axis=2)
    # times that read the same markers are fitted at once
    for pattern in np.unique(read, axis=0):
        if pattern.sum() < _FEWEST_POINTS or spread(points[pattern])[1] < COLLINEAR * spread(points)[0]:
            continue
        times = np.flatnonzero((read == pattern).all(axis=1))
        known = points[pattern]
        seen = readings[np.ix_(times, np.flatnonzero(pattern))]
        middle, centre = known.mean(axis=0), seen.mean(axis=1)
        u, _, v = np.linalg.svd(np.einsum("tmi,mj->tij", seen - centre[:, None], known - middle))
        u[:, :, 2] *= np.sign(np.linalg.det(u @ v))[:, None]
        rotation[times] = u @ v
        position[times] = centre - rotation[times] @ middle
        jacobian = rigid_jacobian(np.einsum("tij,mj->tmi", rotation[times], known))
        normal = np.einsum("tmj,tmk->tjk", jacobian, jacobian)
        covariance[times] = marker_noise**2 * np.linalg.inv(normal)
    return position, rotation, covariance


def spread(points):
    """Singular values of the points about their middle, largest first [m]."""
    return np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
