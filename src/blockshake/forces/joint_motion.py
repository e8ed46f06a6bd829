"""Motion of the joints: rotation, slip and where each face still bears, from the smoothed motion."""

from dataclasses import dataclass

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import rotation_vectors

TURNED = 3e-4  # rad: a joint that bears on an edge; elastic joints turn by a tenth of it before they open
SURE = 5.0  # standard deviations


@dataclass(frozen=True)
class JointMotion:
    """Motion of the joints in the axes of the lower body's face."""

    # float64 (n_times, n_joints); of the upper body about the second tangent: positive leans its top along
    # the first one [rad]
    rotation: np.ndarray
    # float64 (n_times, n_joints); of the upper body about the first tangent: positive leans its top against
    # the second one [rad]
    roll: np.ndarray
    rotation_error: np.ndarray  # float64 (n_joints,) [rad]
    # float64 (n_times, n_joints); along the first tangent, of the point of the upper body that bears [m/s]
    slip_rate: np.ndarray
    slip_error: np.ndarray  # float64 (n_joints,); of the displacement along the first tangent [m]
    # side, across: int8 (n_times, n_joints); edge that bears: 1 or -1 along the first, and along the second
    # tangent, 0 for the whole face
    side: np.ndarray
    across: np.ndarray


def joint_motion(structure, faces, motion, still):
    """`JointMotion` of all ``faces``; rotations count from their mean in the quiet start, ``still`` (n_times,) bool."""
    by_joint = [_histories(structure, face, motion, still) for face in faces]
    joints = {name: np.stack([joint[name] for joint in by_joint], axis=-1) for name in by_joint[0]}
    bends = joints.pop("rotation_bend"), joints.pop("roll_bend")
    side = _bearing(joints["rotation"], bends[0], joints["rotation_error"], motion.width)
    across = -_bearing(joints["roll"], bends[1], joints.pop("roll_error"), motion.width)
    return JointMotion(**joints, side=side, across=across)


def _bearing(rotation, bend, error, width):
    """Edge that bears, by the sign of a rotation that is surely more than an elastic one and that no impact interrupts.

    A joint that closes and opens again to the same side has a kink at zero. The local parabola rounds a kink of slopes
    -s and s off by ``0.4 s width``, and the positive kernel gives it the second derivative ``0.8 s / width``: the
    rotation less half of ``width**2`` times that ``bend`` is what the kink itself comes to.
    """
    side = np.sign(rotation)
    least = np.fmin(np.abs(rotation), side * (rotation - 0.5 * width**2 * bend))
    return np.where(least > np.maximum(TURNED, SURE * error), side, 0.0).astype(np.int8)


def _histories(structure, face, motion, still):
    """Histories and errors of a joint by name, see `JointMotion`, and those that decide which edges bear."""
    lower, upper = face.lower, face.upper
    start = rotation_matrices(structure.orientation[[lower, upper]])
    axes = motion.rotation[:, lower] @ (start[0].T @ face.axes)
    turned = motion.rotation[:, upper] @ start[1].T
    relative = np.swapaxes(motion.rotation[:, lower] @ start[0].T, -1, -2) @ turned
    turns = rotation_vectors(relative)
    roll, turn = (from_rest(turns @ face.axes[:, axis], still) for axis in range(2))
    bearing = face.half_width * np.clip(turn / TURNED, -1.0, 1.0)
    middle = motion.position[:, upper] + motion.rotation[:, upper] @ face.on_upper
    point = middle + bearing[:, None] * (turned @ face.axes[:, 0])
    rate = motion.velocity_at(upper, point) - motion.velocity_at(lower, point)
    pose = motion.pose_covariance[upper] + motion.pose_covariance[lower]
    bend = motion.angular_acceleration[:, upper] - motion.angular_acceleration[:, lower]
    arm = rotation_matrices(structure.orientation[upper]) @ face.on_upper
    along = np.concatenate([face.axes[:, 0], np.cross(arm, face.axes[:, 0])])
    return {
        "rotation": turn,
        "rotation_error": np.sqrt(face.axes[:, 1] @ pose[3:, 3:] @ face.axes[:, 1]),
        "rotation_bend": np.einsum("ti,ti->t", axes[..., 1], bend),
        "roll": roll,
        "roll_bend": np.einsum("ti,ti->t", axes[..., 0], bend),
        "roll_error": np.sqrt(face.axes[:, 0] @ pose[3:, 3:] @ face.axes[:, 0]),
        "slip_rate": np.einsum("ti,ti->t", axes[..., 0], rate),
        "slip_error": np.sqrt(along @ pose @ along),
    }


def from_rest(values, still):
    """Values less their mean in the quiet start; as they are where none is known there, counted from rest already."""
    rest = still & np.isfinite(values)
    return values - (values[rest].mean() if rest.any() else 0.0)
