"""Pose and velocity of every block against its base while a test goes on: what a simulation is restarted from."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.diagnosis.body_poses import NOTHING, TRANSLATION
from blockshake.geometry.overlap import penetration_depth
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.base_motion import smoothed_base

_FEWEST = 4  # readings
_CONTACT = 1e-7  # m, to which a block is set down
_MOST_SHIFTS = 20
_AT_CONTACT = 2e-5  # m, corners of a block this near to its lowest one touch too


@dataclass(frozen=True)
class SmoothedStates:
    """Motion of all bodies against the driven one, in its frame, smoothed over the whole test.

    Attributes
    ----------
    time : float64 array, shape (n_times,)
        [s]
    moved : float64 array, shape (n_times, n_bodies, 6)
        Displacement of the mass centre since rest [m] and rotation [rad].
    rate : float64 array, shape (n_times, n_bodies, 6)
        Of the same [m/s, rad/s].
    moved_error, rate_error : float64 arrays, shape (n_times, n_bodies, 6)
        Standard deviations.
    driven : int
        The body that the others are held against, itself at rest here.
    """

    time: np.ndarray
    moved: np.ndarray
    rate: np.ndarray
    moved_error: np.ndarray
    rate_error: np.ndarray
    driven: int

    def drawn(self, place, generator):
        """Displacements and rates at a reading, ``(n_bodies, 6)``, errors drawn; without a generator the means."""
        moved, rate = self.moved[place].copy(), self.rate[place].copy()
        if generator is not None:
            moved += self.moved_error[place] * generator.normal(0.0, 1.0, moved.shape)
            rate += self.rate_error[place] * generator.normal(0.0, 1.0, rate.shape)
        return moved, rate


def smoothed_states(histories, structure):
    """States of all bodies, or None where a body's rotation is not known.

    Parameters
    ----------
    histories : xarray.Dataset
        From `joint_histories`.
    structure : Structure
        The campaign's.

    Returns
    -------
    SmoothedStates or None

    Notes
    -----
    Each coordinate is smoothed by itself as `smoothed_base` does it: constant acceleration but for white jerk of the
    likeliest density, so a block at rest against its base is known far better than one that rocks. The
    noise of a coordinate is what its own readings show. First the noise of the base's pose, which all blocks seen from
    it share, is taken out by smoothing that pose. Roll and yaw that nobody can know are none.
    """
    known = [str(word) for word in histories["known"].values]
    if any(
        word in (NOTHING, TRANSLATION) for word, fast in zip(known, structure.driven, strict=True) if not fast
    ):
        return None
    time = histories["time"].to_numpy()
    moved = np.concatenate(
        [
            histories["body_displacement"].transpose("time", "body", "axis").to_numpy(),
            histories["body_rotation"].transpose("time", "body", "axis").to_numpy(),
        ],
        axis=2,
    )
    driven = int(np.flatnonzero(structure.driven & np.array([word != NOTHING for word in known]))[0])
    moved = moved + _base_noise(histories, structure, driven)
    smooth = np.zeros((4, *moved.shape))
    for body in np.flatnonzero(~structure.driven):
        for axis in range(6):
            if np.isfinite(moved[:, body, axis]).sum() >= _FEWEST:
                smooth[:, :, body, axis] = _smoothed(time, moved[:, body, axis])
    return SmoothedStates(time, *smooth, driven)


def set_down(structure, position, orientation, velocity, angular_velocity):
    """Blocks set down on what carries them: neither in it nor above it, nor about to leave it.

    Parameters
    ----------
    structure : Structure
        Its joints at the start say what carries what.
    position, velocity, angular_velocity : float64 arrays, shape (n_bodies, 3)
        Mass centres, world frame [m, m/s, rad/s]; position and velocity are overwritten along z.
    orientation : float64 array, shape (n_bodies, 4)

    Returns
    -------
    float64 array, shape (n_bodies,)
        By how much each was shifted up [m].

    Notes
    -----
    From the lowest body upwards each is shifted along z until the deepest of its joints just touches, which needs no
    more than a pose that is right within some tenths of a millimetre and a stack in which nothing flies;
    bodies above come along. Then its vertical velocity is made such that its lowest point neither dips into nor leaves
    the body below: an error there would be an impact that never happened.
    """
    shift = np.zeros(len(position))
    height = structure.centroid[:, 2]
    for body in np.argsort(height, kind="stable"):
        below = [
            int(other)
            for other in np.flatnonzero(structure.touching[body])
            if height[other] < height[body] - 1e-6
        ]
        if structure.driven[body] or not below:
            continue
        position[body, 2] += max(shift[other] for other in below)
        shift[body] = max(shift[other] for other in below)
        for _ in range(_MOST_SHIFTS):
            depth = [
                penetration_depth(
                    structure.solid(other), position[other], orientation[other],
                    structure.solid(body), position[body], orientation[body],
                )
                for other in below
            ]  # fmt: skip
            deepest = int(np.argmax(depth))
            position[body, 2] += depth[deepest]
            shift[body] += depth[deepest]
            if abs(depth[deepest]) < _CONTACT:
                break
        under = below[deepest]
        point = _lowest_point(structure, under, body, position, orientation)
        normal = rotation_matrices(orientation[under])[:, 2]
        speeds = [
            velocity[one] + np.cross(angular_velocity[one], point - position[one]) for one in (body, under)
        ]
        velocity[body, 2] -= (speeds[0] - speeds[1]) @ normal / normal[2]
    return shift


def _lowest_point(structure, under, body, position, orientation):
    """Mean of the corners with which a body is lowest, seen along the up axis of the one below, world frame [m]."""
    corners = position[body] + structure.solid(body).vertices @ rotation_matrices(orientation[body]).T
    along = (corners - position[under]) @ rotation_matrices(orientation[under])[:, 2]
    return corners[along < along.min() + _AT_CONTACT].mean(axis=0)


def _base_noise(histories, structure, driven):
    """What the noise of the base's pose did to every body seen from it, to be added, (n_times, n_bodies, 6)."""
    time = histories["time"].to_numpy()
    shift = histories["base_displacement"].transpose("time", "axis").to_numpy()
    turn = histories["base_rotation"].transpose("time", "axis").to_numpy()
    off = np.zeros((len(time), 6))
    for axis, values in enumerate([*shift.T, *turn.T]):
        if np.isfinite(values).sum() >= _FEWEST:
            off[:, axis] = values - _smoothed(time, values)[0]
    arms = structure.position - structure.position[driven]
    seen = off[:, None, :3] + np.cross(off[:, None, 3:], arms[None])
    return np.concatenate([seen, np.broadcast_to(off[:, None, 3:], seen.shape)], axis=2)


def _smoothed(time, values):
    """Smoothed coordinate, rate and their standard deviations, (4, n_times); errors of gaps as large as they are."""
    rest = np.nanmean(values[: _FEWEST * 5]) if np.isfinite(values[: _FEWEST * 5]).any() else 0.0
    noise = _noise(values)
    if noise == 0.0:
        return np.array([np.zeros(len(time))] * 4)
    found = smoothed_base(time, values - rest, noise)
    return np.array(
        [found.displacement + rest, found.velocity, found.displacement_error, found.velocity_error]
    )


def _noise(values):
    """Standard deviation of white noise on a smooth history, from its third differences."""
    third = np.diff(values, 3)
    third = third[np.isfinite(third)]
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20.0)) if len(third) else 0.0


def turned(orientation, rotation):
    """Quaternions (w, x, y, z), shape (n_bodies, 4), turned further by rotation vectors, shape (n_bodies, 3)."""
    return (Rotation.from_rotvec(rotation) * Rotation.from_quat(orientation, scalar_first=True)).as_quat(
        scalar_first=True
    )
