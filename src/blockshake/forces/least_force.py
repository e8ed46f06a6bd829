"""The least unexplained force: the smallest wrenches on the blocks that leave forces which dry joints can carry."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from blockshake.forces.required import information_root
from blockshake.geometry.rotations import rotation_matrices

# edges of the pyramid about the friction cone: shears along both tangents do not take from each other, so that noise
# across the shaking does not pass for a lack of friction along it
_EDGES = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))
_RIDGE = 0.1  # standard deviations that a push of the structure's weight costs


@dataclass(frozen=True)
class LeastForce:
    """Unexplained wrenches of all free bodies, about their mass centres, world frame.

    Attributes
    ----------
    wrench : float64 array, shape (n_times, n_bodies, 6)
        Force [N] and moment [N m]; zero for driven bodies, NaN where the motion is unknown.
    distance : float64 array, shape (n_times,)
        Root of the residual's square in units of its standard deviations [1].
    push : float64 array, shape (n_times,)
        Of a body that is pushed [N].
    """

    wrench: np.ndarray
    distance: np.ndarray
    push: np.ndarray


def least_force(structure, faces, motion, joints, required, pushed=None, height=0.0):
    """Smallest external wrenches, in units of their standard deviations.

    Parameters
    ----------
    structure : Structure
    faces : list of Face
    motion : Motion
    joints : JointMotion
    required : RequiredWrenches
    pushed : int, optional
        Body on which a horizontal force along x costs nothing.
    height : float, optional
        Of that force's line above the body's mass centre [m].

    Returns
    -------
    LeastForce
        ``push`` is the force that costs nothing, zero without one.

    Notes
    -----
    Minimises ``|W (f - G r)|`` over ``r >= 0`` by non-negative least squares (Lawson and Hanson 1974). The bodies
    require f; G holds the wrenches of the generators of the friction cones at the corners of each face that may bear;
    W is a root of the information. No tree is needed: structures may be statically indeterminate. Dry joints carry no
    tension (Heyman 1966; Livesley 1978). A positive kernel keeps forces that a joint can carry within its cone, so
    that a corner counts as bearing if it bears at any time within the kernel's reach: impacts leave no residual.
    """
    free = np.flatnonzero(~structure.driven)
    weight = structure.mass[free].sum() * np.linalg.norm(structure.file.gravity)
    n_times = len(motion.time)
    wrench = np.zeros((n_times, len(structure.mass), 6))
    distance, pushes = np.full(n_times, np.nan), np.zeros(n_times)
    generators = _generators(structure, faces, motion, joints)
    if pushed is not None:
        push = np.zeros((n_times, len(structure.mass), 6, 2))
        push[:, pushed, 0] = 1.0, -1.0
        push[:, pushed, 4] = height, -height
        generators = np.concatenate([generators, push], axis=-1)
    # of all forces that explain as much the smallest one
    small = np.zeros(generators.shape[-1])
    small[generators.shape[-1] - (0 if pushed is None else 2) :] = _RIDGE
    roots = information_root(required.information[:, free])
    for place in range(n_times):
        wanted = required.wrench[place, free]
        if not np.isfinite(wanted).all():
            wrench[place] = np.nan
            continue
        columns = generators[place]
        whitened = np.einsum("bij,bjg->big", roots[place], columns[free]).reshape(6 * len(free), -1)
        target = np.einsum("bij,bj->bi", roots[place], wanted).ravel()
        used = np.abs(whitened).max(axis=0) > 0.0
        found = np.zeros(whitened.shape[1])
        if used.any():
            found[used], _ = nnls(np.vstack([whitened * weight, small])[:, used], np.append(target, 0.0))
        distance[place] = np.linalg.norm(target - weight * whitened @ found)
        if pushed is not None:
            pushes[place] = weight * (found[-2] - found[-1])
        wrench[place, free] = wanted - weight * columns[free] @ found
    return LeastForce(wrench, distance, pushes)


def _generators(structure, faces, motion, joints):
    """Wrenches of unit normal force along the edges of each corner's friction pyramid, (n_times, n_bodies, 6, n)."""
    n_bodies = len(structure.mass)
    parts = []
    for place, face in enumerate(faces):
        lower, upper = face.lower, face.upper
        start = rotation_matrices(structure.orientation[upper])
        axes = motion.rotation[:, upper] @ (start.T @ face.axes)
        middle = motion.position[:, upper] + motion.rotation[:, upper] @ face.on_upper
        for corner in face.corners:
            along, across = (corner[:2] > 0.0).astype(int)
            own = joints.bears[:, place, 0, along] & joints.bears[:, place, 1, across]
            point = middle + np.einsum("tij,j->ti", axes, corner)
            for first, second in _EDGES:
                tangent = first * axes[..., 0] + second * axes[..., 1]
                force = (axes[..., 2] + face.friction * tangent) * own[:, None]
                columns = np.zeros((len(motion.time), n_bodies, 6))
                for body, sign in ((upper, 1.0), (lower, -1.0)):
                    arm = point - motion.position[:, body]
                    columns[:, body] = sign * np.concatenate([force, np.cross(arm, force)], axis=-1)
                parts.append(columns)
    return np.stack(parts, axis=-1)
