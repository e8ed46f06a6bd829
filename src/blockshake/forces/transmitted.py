"""Forces of the joints that alone hold a part of the structure: statically determinate, from the top down."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components

from blockshake.geometry.rotations import rotation_matrices

_SMALL = 1e-12  # of the largest eigenvalue


@dataclass(frozen=True)
class TransmittedForces:
    """Force and lever of the resultant in some joints, in the axes of the upper body's face.

    Attributes
    ----------
    faces : list of Face
        Joints whose opening would cut a part off the ground.
    carried : list of int array
        By joint: the bodies above it.
    force : float64 array, shape (n_times, n_joints, 3)
        On the upper body, along the face's axes: two shears and the normal force [N].
    moment : float64 array, shape (n_times, n_joints, 3)
        About the middle of the face, same axes [N m].
    covariance : float64 array, shape (n_times, n_joints, 6, 6)
        Of both; infinite on the diagonal where a direction is not read.
    """

    faces: list
    carried: list
    force: np.ndarray
    moment: np.ndarray
    covariance: np.ndarray

    @property
    def normal(self):
        """Normal force, shape (n_times, n_joints) [N]."""
        return self.force[..., 2]

    @property
    def lever(self):
        """Where the resultant crosses the face, along its first tangent, shape (n_times, n_joints) [m]."""
        return -self.moment[..., 1] / self.force[..., 2]

    @property
    def lever_error(self):
        """Standard deviation of the lever [m]."""
        by_force, by_moment = self.lever / self.normal, 1.0 / self.normal
        return np.sqrt(
            by_force**2 * self.covariance[..., 2, 2]
            + by_moment**2 * self.covariance[..., 4, 4]
            + 2.0 * by_force * by_moment * self.covariance[..., 2, 4]
        )

    @property
    def friction(self):
        """Shear along the first tangent over the normal force, shape (n_times, n_joints) [1]."""
        return self.force[..., 0] / self.force[..., 2]


def transmitted_forces(structure, faces, motion, required):
    """Forces in the joints that are statically determinate.

    Parameters
    ----------
    structure : Structure
    faces : list of Face
    motion : Motion
    required : RequiredWrenches

    Returns
    -------
    TransmittedForces

    Notes
    -----
    The joint carries the sum over the bodies above it of what they require, and that sum's moment about the middle of
    the face. Ratios of forces, and levers, do not depend on a density that all bodies share.
    """
    chosen, carried = [], []
    for face in faces:
        above = _cut_off(structure, faces, face)
        if above is not None:
            chosen.append(face)
            carried.append(above)
    n_times = len(motion.time)
    wrench, scatters = np.zeros((n_times, len(chosen), 6)), np.zeros((n_times, len(chosen), 6, 6))
    scatter = _covariance(required.information)
    for joint, (face, above) in enumerate(zip(chosen, carried, strict=True)):
        turn = motion.rotation[:, face.upper]
        middle = motion.position[:, face.upper] + turn @ face.on_upper
        total, covariance = np.zeros((n_times, 6)), np.zeros((n_times, 6, 6))
        for body in above:
            shift = _moved_by(motion.position[:, body] - middle)
            total += np.einsum("tij,tj->ti", shift, required.wrench[:, body])
            covariance += shift @ scatter[:, body] @ np.swapaxes(shift, -1, -2)
        axes = np.zeros((n_times, 6, 6))
        axes[:, :3, :3] = axes[:, 3:, 3:] = face_axes(structure, face, motion)
        wrench[:, joint] = np.einsum("tji,tj->ti", axes, total)
        scatters[:, joint] = np.swapaxes(axes, -1, -2) @ covariance @ axes
    return TransmittedForces(chosen, carried, wrench[..., :3], wrench[..., 3:], scatters)


def _cut_off(structure, faces, cut):
    """Bodies that stand on the ground no more if a joint opens, or None if none does or the upper body still stands."""
    links = np.zeros((len(structure.mass),) * 2, dtype=bool)
    for face in faces:
        if face is not cut:
            links[face.lower, face.upper] = True
    _, group = connected_components(links, directed=False)
    standing = set(group[structure.driven])
    if group[cut.upper] in standing or group[cut.lower] not in standing:
        return None
    return np.flatnonzero(group == group[cut.upper])


def face_axes(structure, face, motion):
    """Axes of a face as the upper body carries them along: (n_times, 3, 3), in columns, world frame."""
    on_body = rotation_matrices(structure.orientation[face.upper]).T @ face.axes
    return motion.rotation[:, face.upper] @ on_body


def _moved_by(arm):
    """Matrices that take a wrench to another point, ``arm`` from there to its own: (n_times, 6, 6)."""
    x, y, z = arm.T
    shift = np.zeros((len(arm), 6, 6))
    shift[:] = np.eye(6)
    shift[:, 3, 1], shift[:, 3, 2] = -z, y
    shift[:, 4, 0], shift[:, 4, 2] = z, -x
    shift[:, 5, 0], shift[:, 5, 1] = -y, x
    return shift


def _covariance(information):
    """Inverse of information, a direction without any being as good as infinite."""
    values, vectors = np.linalg.eigh(information)
    floor = _SMALL * values[..., -1:]
    inverse = 1.0 / np.maximum(values, np.maximum(floor, np.finfo(float).tiny))
    return np.einsum("...ij,...j,...kj->...ik", vectors, inverse, vectors)
