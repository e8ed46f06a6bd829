"""Rows of a test: the share of the required wrenches that no face may carry as it is seen to move."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.forces.required import covariance_root, unread_directions
from blockshake.geometry.rotations import rotation_matrices

_EVERY = 0.02  # s, between instants: the kernel passes next to nothing beyond 25 Hz
# of the largest singular value: a wrench that faces carry. In a loop of bodies the measured edges are parallel to
# 1e-4 rad or so, which turns an exact zero into 1e-5; those that are carried have 1e-2 and more.
_CARRIED = 1e-3
_RESOLVED = 1.0 - 1e-6  # share of a contact force that the wrenches tell
_BEYOND, _SURELY = 0.01, 4.0  # m, standard deviations: of the resultant beyond the edge of a closed face
_BY_NOISE = 3.0  # standard deviations that noise may have in rows
_TURNS = 3.0  # standard deviations, by which such a face turns to that side: a force from outside moves a resultant too


@dataclass(frozen=True)
class EquilibriumRows:
    """Equations without a force of a joint: ``z . (M a - M g) = z . (wrenches of what is not modelled)``."""

    instant: np.ndarray  # int (n_rows,); index of each row's time among the motion's instants
    time: np.ndarray  # float64 (n_rows,) [s]
    # float64 (n_rows, n_bodies, 6); z: a unit vector of virtual displacements of all free bodies, force and
    # moment about the mass centre; zero for driven bodies
    direction: np.ndarray
    value: np.ndarray  # float64 (n_rows,); of the required wrenches along z [N, N m]
    # dict of Colour to float64 (n_rows, n_sources); errors of the rows by one standard deviation of every sensor's
    # noise of this colour
    noise: dict

    def along(self, wrench):
        """Component of a history of wrenches (n_times, n_bodies, 6) along every row, (n_rows,)."""
        return np.einsum("rbk,rbk->r", self.direction, wrench[self.instant])


@dataclass(frozen=True)
class ContactForces:
    """Resultants that would balance the required wrenches if every face could carry any wrench."""

    # force, moment: float64 (n_times, n_faces, 3); on the upper body, about the middle of the face, along its
    # axes [N, N m]: exact where the faces are a tree, of the least norm elsewhere. NaN where motions are
    # unknown that it follows from
    force: np.ndarray
    moment: np.ndarray
    # float64 (n_times, n_faces); standard deviation of the moment about the second tangent [N m]
    moment_error: np.ndarray


def contact_forces(frames, required, free, states=None):
    """`ContactForces` of the least norm between `FaceFrames`, of the free bodies, an int array (n_free,).

    Every face may carry any wrench alike or, by `FaceStates`, a thousandth of what it cannot carry as it moves. Alike,
    turned faces of a loop would pull and clamp: walls under a bridge would share its weight as no statics has it.
    """
    n_times, n_faces = len(required.wrench), len(frames.faces)
    columns = np.stack([frames.unit_wrenches(face) for face in range(n_faces)], axis=-2)
    if states is not None:
        carried = np.stack(_all_carried(frames, states), axis=-2)
        carries = carried.any(axis=(1, 2))
        columns = np.where(carries[:, None, None], carried, _CARRIED * columns)
    # (n_times, n_bodies, 6, n_faces, 6) to one matrix an instant
    matrix = columns[:, free].reshape(n_times, 6 * len(free), 6 * n_faces)
    wanted, information, read = _of_read_bodies(required, free)
    matrix = matrix * np.repeat(read, 6, axis=1)[..., None]
    inverse = np.linalg.pinv(matrix)
    resultants = np.einsum("tij,tj->ti", inverse, wanted.reshape(n_times, -1)).reshape(n_times, n_faces, 6)
    resolved = np.einsum("tij,tji->ti", inverse, matrix).reshape(n_times, n_faces, 6) > _RESOLVED
    resultants[~(resolved.all(axis=2) | read.all(axis=1, keepdims=True))] = np.nan
    if states is not None:
        resultants = np.where(carries, resultants, _CARRIED * resultants)
    about = inverse.reshape(n_times, n_faces, 6, len(free), 6)[:, :, 4]
    errors = np.einsum("tfbi,tbij->tfbj", about, covariance_root(information))
    return ContactForces(resultants[..., :3], resultants[..., 3:], np.sqrt((errors**2).sum(axis=(2, 3))))


def _of_read_bodies(required, free):
    """Wrenches and information of free bodies, none where a body's motion is unknown, and whether it is known."""
    read = np.isfinite(required.wrench[:, free]).all(axis=2)
    wrench = np.where(read[..., None], required.wrench[:, free], 0.0)
    return wrench, np.where(read[..., None, None], required.information[:, free], 0.0), read


@dataclass(frozen=True)
class FaceFrames:
    """Faces as their upper bodies carry them along."""

    faces: list  # of Face
    middle: np.ndarray  # float64 (n_times, n_faces, 3); world frame [m]
    axes: np.ndarray  # float64 (n_times, n_faces, 3, 3); two tangents and the normal, in columns, world frame
    position: np.ndarray  # float64 (n_times, n_bodies, 3); of the mass centres [m]

    def between(self, face, force, point, moment=0.0):
        """Wrenches of a face's force on its upper body, and of its opposite on the lower one, (n_times, n_bodies, 6).

        ``force``, ``point`` (n_times, 3): world frame [N, m]; ``moment`` (n_times, 3): on the upper body [N m].
        """
        wrench = np.zeros((*self.position.shape[:2], 6))
        for body, sign in ((self.faces[face].upper, 1.0), (self.faces[face].lower, -1.0)):
            wrench[:, body, :3] = sign * force
            wrench[:, body, 3:] = sign * (np.cross(point - self.position[:, body], force) + moment)
        return wrench

    def unit_wrenches(self, face, point=None):
        """Wrenches of unit forces at a point, the middle by default, and of unit moments along a face's axes.

        Returns
        -------
        float64 array, shape (n_times, n_bodies, 6, 6)
            In the last axis: three forces, three moments.
        """
        point = self.middle[:, face] if point is None else point
        none = np.zeros_like(point)
        forces = [self.between(face, self.axes[:, face, :, axis], point) for axis in range(3)]
        moments = [self.between(face, none, point, self.axes[:, face, :, axis]) for axis in range(3)]
        return np.stack(forces + moments, axis=-1)


def face_frames(structure, faces, motion):
    """`FaceFrames` of a motion; a body whose pose is unknown is where it started."""
    start = rotation_matrices(structure.orientation)
    rotation = np.where(np.isfinite(motion.rotation), motion.rotation, start)
    position = np.where(np.isfinite(motion.position), motion.position, structure.position)
    middle, axes = [], []
    for face in faces:
        turn = rotation[:, face.upper]
        middle.append(position[:, face.upper] + turn @ face.on_upper)
        axes.append(turn @ (start[face.upper].T @ face.axes))
    return FaceFrames(faces, np.stack(middle, axis=1), np.stack(axes, axis=1), position)


def with_resultants(states, frames, forces, joints):
    """States in which a closed face whose resultant lies surely beyond an edge bears on that edge.

    The face has to turn to that side as well. The faces are a tree, whose resultants are known.
    """
    edge = states.edge.copy()
    for index, face in enumerate(frames.faces):
        normal, moment = forces.force[:, index, 2], forces.moment[:, index, 1]
        over = np.abs(moment) - face.half_width * normal
        surely = over > _SURELY * forces.moment_error[:, index] + _BEYOND * normal
        turns = -np.sign(moment) * joints.rotation[:, index] > _TURNS * joints.rotation_error[index]
        beyond = surely & turns & (normal > 0.0) & (edge[:, index, 0] == 0) & ~states.lifted[:, index]
        edge[beyond, index, 0] = -np.sign(moment[beyond])
    return replace(states, edge=edge)


def bearing_points(frames, states):
    """Where every face bears: its middle, an edge or a corner, (n_times, n_faces, 3), world frame [m]."""
    half = np.array(
        [[0.5 * np.ptp(face.corners[:, tangent]) for tangent in range(2)] for face in frames.faces]
    )
    return frames.middle + np.einsum("tfk,tfik->tfi", states.edge * half, frames.axes[..., :2])


def equilibrium_rows(frames, states, motion, required, free, known=True):
    """`EquilibriumRows` of a test 20 ms apart, where normal forces are ``known`` (n_times,); ``free`` (n_free,) int.

    Notes
    -----
    The wrenches that the faces may carry span a space at each instant: any wrench where a face is closed; no moment
    about an edge on which it has turned; no shear with friction where it slips; nothing where it is lifted. The rows
    are an orthonormal basis of what is orthogonal to it: the equations of virtual work of the mechanism that the turned
    joints make, whatever the statical indeterminacy of the others. A direction of a body that no sensor reads is free
    like a joint's force, and so is all of a body whose motion is unknown.
    """
    n_bodies = frames.position.shape[1]
    step = float(np.median(np.diff(motion.time)))
    wrench, information, read = _of_read_bodies(required, free)
    chosen = np.flatnonzero(read.any(axis=1) & known)
    chosen = chosen[chosen % max(1, round(_EVERY / step)) == 0]
    carried = np.concatenate(
        [columns[chosen][:, free] for columns in _all_carried(frames, states)], axis=-1
    ).reshape(len(chosen), 6 * len(free), 6 * len(frames.faces))
    matrix = np.concatenate([carried, _unread(information[chosen])], axis=-1)
    vectors, sizes, _ = np.linalg.svd(matrix, full_matrices=False)
    row, column = np.nonzero(sizes <= _CARRIED * sizes[:, :1])
    vectors = vectors[row, :, column]
    direction = np.zeros((len(row), n_bodies, 6))
    direction[:, free] = vectors.reshape(-1, len(free), 6)
    instant = chosen[row]
    value = np.einsum("rbk,rbk->r", direction[:, free], wrench[instant])
    by_colour = {}
    for body in free:
        for colour, errors in required.errors[body].items():
            part = np.einsum("ri,rij->rj", direction[:, body], errors[instant])
            by_colour.setdefault(colour, []).append(part)
    noise = {colour: np.concatenate(parts, axis=1) for colour, parts in by_colour.items()}
    return EquilibriumRows(instant, motion.time[instant], direction, value, noise)


def balanced_wrenches(rows, required, free):
    """Required wrenches less the errors of the sensors that rows show, at the instants of rows, (n_times, n_bodies, 6).

    The least change, by the covariance of the sensors, with which the rows are zero, as far as noise can be: the rest
    of an event is none. Elsewhere NaN.
    """
    balanced = np.full_like(required.wrench, np.nan)
    for instant in np.unique(rows.instant):
        here = rows.instant == instant
        errors = [
            np.concatenate([part[instant] for part in required.errors[body].values()], axis=1)
            for body in free
        ]
        along = [rows.direction[here, body] @ error for body, error in zip(free, errors, strict=True)]
        value = rows.value[here]
        shares = np.linalg.solve(sum(one @ one.T for one in along), value)
        shares *= min(1.0, _BY_NOISE / np.sqrt(max(value @ shares / len(value), np.finfo(float).tiny)))
        for body, error, one in zip(free, errors, along, strict=True):
            balanced[instant, body] = required.wrench[instant, body] - error @ (one.T @ shares)
    return balanced


def _all_carried(frames, states):
    """Wrenches that each face may carry, a list of (n_times, n_bodies, 6, 6)."""
    bearing = bearing_points(frames, states)
    return [_carried(frames, states, bearing[:, face], face) for face in range(len(frames.faces))]


def _carried(frames, states, bearing, face):
    """Wrenches that a face may carry, (n_times, n_bodies, 6, 6); zero columns where it may carry less than six."""
    edge, slip = states.edge[:, face], states.slip[:, face]
    columns = frames.unit_wrenches(face, bearing)
    friction = frames.faces[face].friction * slip
    columns[..., 2] -= friction[:, None, None] * columns[..., 0]
    columns[slip != 0, ..., 0] = 0.0
    columns[edge[:, 0] != 0, ..., 4] = 0.0
    columns[edge[:, 1] != 0, ..., 3] = 0.0
    columns[states.lifted[:, face]] = 0.0
    return columns


def _unread(information):
    """Unit wrenches along the directions of bodies that no sensor reads, (n_chosen, 6 * n_free, 6 * n_free)."""
    n_chosen, n_free = information.shape[:2]
    vectors = unread_directions(information)
    columns = np.zeros((n_chosen, n_free, 6, n_free, 6))
    for body in range(n_free):
        columns[:, body, :, body] = vectors[:, body]
    return columns.reshape(n_chosen, 6 * n_free, 6 * n_free)
