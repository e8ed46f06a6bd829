"""States of the contact faces, from the measured motion of the joints: closed, on an edge, slipping, lifted."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import minimum_filter1d, uniform_filter1d

from blockshake.forces.joint_motion import SURE, from_rest
from blockshake.geometry.rotations import rotation_matrices

# m, between the edges that should bear; within the first a bounce may have touched
_LIFTED, _FLIES = 1e-3, 4e-3
_SLIPS = 0.01  # m/s, mean over `_OVER`
_OVER = 0.1  # s; a creep drowns in the rate's own noise and shows in the displacement over this time
_STILL = 0.5  # of the mean, that a slip that goes on has at least
_CALM = 3.0  # widths of the kernel: a change farther away moves a lever by less than a millimetre
_EITHER = 99  # number of no state


@dataclass(frozen=True)
class FaceStates:
    """States of all faces at every instant, their own changes within three widths of the kernel left out."""

    # int8 (n_times, n_faces, 2); edge that bears along the first and the second tangent: 1 or -1, 0 for the
    # whole face or where it changes
    edge: np.ndarray
    # int8 (n_times, n_faces); direction of the upper body's slip along the first tangent, 0 without, or where
    # it changes
    slip: np.ndarray
    # lifted, closed: bool (n_times, n_faces); the face bears nowhere; the whole face is seen to bear
    lifted: np.ndarray
    closed: np.ndarray


def face_states(structure, faces, motion, joints, still):
    """States of the faces.

    Parameters
    ----------
    structure : Structure
    faces : list of Face
    motion : Motion
    joints : JointMotion
    still : bool array, shape (n_times,)
        The quiet start, from which openings count.

    Returns
    -------
    FaceStates
        A face whose motion is not read counts as closed: it may carry any wrench.
    """
    step = float(np.median(np.diff(motion.time)))
    near = int(np.ceil(_CALM * motion.width / step))
    away = openings(structure, faces, motion, joints, still)
    lifted = np.nan_to_num(away) > _LIFTED
    edge = np.stack([joints.side, joints.across], axis=-1)
    closed = ~lifted & (edge == 0).all(axis=-1) & np.isfinite(joints.rotation)
    for tangent in range(2):
        steady = _unchanged(np.where(lifted, _EITHER, edge[..., tangent]), near)
        closed &= steady
        edge[..., tangent] *= steady & ~lifted
    mean = uniform_filter1d(np.nan_to_num(joints.slip_rate), max(1, round(_OVER / step)), axis=0)
    least = np.maximum(_SLIPS, np.sqrt(2.0) * SURE * joints.slip_error / _OVER)
    slip = np.where(np.abs(mean) > least, np.sign(mean), 0.0).astype(np.int8)
    # the mean still remembers a slip that has ended
    ends = np.sign(mean) * joints.slip_rate < _STILL * np.abs(mean)
    slip *= ~ends & ~lifted
    slip *= _unchanged(slip, near)
    flies = minimum_filter1d(np.nan_to_num(away), 2 * near, axis=0, mode="nearest", origin=-1) > _FLIES
    return FaceStates(edge, slip, flies, closed)


def openings(structure, faces, motion, joints, still):
    """Distance between the edges that should bear, less its mean in the quiet start, (n_times, n_faces) [m]."""
    start = rotation_matrices(structure.orientation)
    distance = np.empty((len(motion.time), len(faces)))
    for index, face in enumerate(faces):
        lower, upper = face.lower, face.upper
        apart = structure.position[upper] + start[upper] @ face.on_upper - structure.position[lower]
        middle = motion.position[:, upper] + motion.rotation[:, upper] @ face.on_upper
        beneath = motion.position[:, lower] + motion.rotation[:, lower] @ (start[lower].T @ apart)
        normal = motion.rotation[:, lower] @ (start[lower].T @ face.axes[:, 2])
        opening = np.einsum("ti,ti->t", normal, middle - beneath)
        lowered = face.half_width * np.abs(np.sin(joints.rotation[:, index]))
        distance[:, index] = from_rest(opening - lowered, still)
    return distance


def _unchanged(states, near):
    """Whether a state is the same ``near`` instants to either side."""
    changed = np.zeros(states.shape, dtype=bool)
    changed[1:] = states[1:] != states[:-1]
    calm = minimum_filter1d((~changed).astype(np.int8), 2 * near, axis=0, mode="constant", cval=0, origin=-1)
    return calm.astype(bool)
