"""Wrenches that causes outside the model would put on the bodies of a test, at every instant.

Each history is a float64 array (n_times, n_bodies, 6), force [N] and moment about the mass centre [N m] in the world
frame, per unit of its amplitude. It is zero where a motion is not known: no row is there.
"""

import numpy as np

_WIDEST = 2.0 / 3.0  # of the half width: an elastic face bears at most so far within its edge
_EARLY = 0.5  # of the coefficient of friction
_BEFORE, _AFTER = 0.25, 0.1  # s, about the instant at which a slip is seen


def edge_inward(seen, face, tangent=0, edge=0):
    """Moment of a bearing edge that lies 1 m further in: ``s N`` about the other tangent.

    Parameters
    ----------
    seen : ReconstructedTest
    face : int
    tangent : int
        Along which the edge lies off the middle.
    edge : int
        1 or -1 for one of the two edges, 0 for both.
    """
    side = seen.states.edge[:, face, tangent].astype(float)
    return _shifted(seen, face, tangent, -side * (np.equal(side, edge) if edge else 1.0))


def edges_along(seen, face, tangent=0):
    """Moment of both bearing edges moved by 1 m along the tangent, in the direction that counts as positive."""
    return _shifted(seen, face, tangent, np.abs(seen.states.edge[:, face, tangent]).astype(float))


def _shifted(seen, face, tangent, shift):
    """Moment of the normal force moved by ``shift`` (n_times,) along a tangent [m]."""
    axes = seen.frames.axes[:, face]
    arm = shift[:, None] * axes[..., tangent]
    moment = np.cross(arm, normal_force(seen, face)[:, None] * axes[..., 2])
    none = np.zeros_like(arm)
    return np.nan_to_num(seen.frames.between(face, none, none, moment))


def bed_inset(normal, compliance, turn, face, tangent=0):
    """How far within the edge an elastic bed without tension bears: ``sqrt(2 N c / (9 L phi))`` [m], Winkler's.

    Parameters
    ----------
    normal, turn : float64 arrays or numbers
        Normal force N [N], not negative, and rotation phi of the joint [rad], above zero.
    compliance : float
        Closure by pressure, c [m3/N].
    face : Face
        Its edges are L long; the inset is two thirds of its half width at most.
    tangent : int
        Along which the edge lies off the middle.
    """
    length, width = np.ptp(face.corners[:, 1 - tangent]), np.ptp(face.corners[:, tangent])
    return np.minimum(np.sqrt(2.0 * normal * compliance / (9.0 * length * turn)), _WIDEST * 0.5 * width)


def friction_against_slip(seen, face):
    """Shear of 1 times the normal force against the slip, where the face bears."""
    against = -seen.states.slip[:, face] * normal_force(seen, face)
    force = against[:, None] * seen.frames.axes[:, face, :, 0]
    return np.nan_to_num(seen.frames.between(face, force, seen.bearing[:, face]))


def slips_early(seen, face):
    """Whether the first slip of a face in the test begins at less than half of its friction; False in a loop.

    The shear over the normal force is at its largest about the instant at which the slip is seen. Friction that falls
    with the slip or its rate would be whole until then.
    """
    slipping = np.flatnonzero(seen.states.slip[:, face])
    if not (seen.tree and len(slipping)):
        return False
    start = seen.motion.time[slipping[0]]
    about = (seen.motion.time >= start - _BEFORE) & (seen.motion.time <= start + _AFTER)
    force = seen.forces.force[about, face]
    known = force[:, 2] > 0.0
    if not known.any():
        return False
    return bool((np.abs(force[known, 0]) / force[known, 2]).max() < _EARLY * seen.faces[face].friction)


def normal_force(seen, face):
    """Normal force of a face as if it were closed, (n_times,) [N]; zero where it is not known."""
    return np.nan_to_num(seen.forces.force[:, face, 2])


def mass_centre_off(seen, body, axis=0):
    """Effect on the balance of a body whose mass centre lies 1 m along one of its axes from where it is taken to be.

    The required wrench about the supposed centre then lacks ``m (alpha x e + omega x (omega x e))`` and ``e x m (a -
    g)``, to first order in e.
    """
    motion, structure = seen.motion, seen.structure
    arm = motion.rotation[:, body, :, axis]
    spin, turning = motion.angular_velocity[:, body], motion.angular_acceleration[:, body]
    further = np.cross(turning, arm) + np.cross(spin, np.cross(spin, arm))
    weight = motion.acceleration[:, body] - np.array(structure.file.gravity)
    wrench = _none(seen)
    wrench[:, body, :3] = -structure.mass[body] * further
    wrench[:, body, 3:] = -structure.mass[body] * np.cross(arm, weight)
    return np.nan_to_num(wrench)


def heavier(seen, body, height=0.0):
    """Effect on the balance of a body of twice the mass, what is added at a height above its mass centre [m].

    By `ReconstructedTest.balanced`: the noise of the rows is not in it, nor then the readings themselves where all
    bodies, or those that turn as one, are heavier alike.
    """
    motion, wrench, mass = seen.motion, seen.balanced[:, body], seen.structure.mass[body]
    arm, spin = height * motion.rotation[:, body, :, 2], motion.angular_velocity[:, body]
    turn = motion.rotation[:, body]
    inertia = turn @ seen.structure.inertia[body] @ np.swapaxes(turn, -1, -2)
    moment = wrench[:, 3:] - np.cross(spin, np.einsum("tij,tj->ti", inertia, spin))
    turning = np.einsum(
        "tij,tj->ti", np.linalg.inv(np.where(np.isfinite(inertia), inertia, np.eye(3))), moment
    )
    further = np.cross(turning, arm) + np.cross(spin, np.cross(spin, arm))
    return force_at(seen, body, -wrench[:, :3] - mass * further, arm=arm)


def force_at(seen, body, force, height=0.0, arm=None):
    """A force on a body.

    Parameters
    ----------
    seen : ReconstructedTest
    body : int
    force : float64 array, shape (n_times, 3) or (3,)
        World frame [N].
    height : float
        Its point above the mass centre along the body's z axis [m].
    arm : float64 array, shape (n_times, 3), optional
        Of its point from the mass centre in place of that, world frame [m].
    """
    arm = height * seen.motion.rotation[:, body, :, 2] if arm is None else arm
    force = np.broadcast_to(force, arm.shape)
    wrench = _none(seen)
    wrench[:, body, :3] = force
    wrench[:, body, 3:] = np.cross(arm, force)
    return np.nan_to_num(wrench)


def moves_at(seen, body, height=0.0):
    """Displacement from rest and velocity of a point of a body against the first driven body, (n_times, 3) [m, m/s].

    NaN where either motion is not known.
    """
    motion = seen.motion
    table = int(np.flatnonzero(seen.structure.driven)[0])
    point = motion.position[:, body] + height * motion.rotation[:, body, :, 2]
    away = point - motion.position[:, table]
    rest = away[seen.still & np.isfinite(away).all(axis=1)]
    start = np.median(rest, axis=0) if len(rest) else np.nan_to_num(away[np.isfinite(away).all(axis=1)][0])
    return away - start, motion.velocity_at(body, point) - motion.velocity[:, table]


def _none(seen):
    return np.zeros((len(seen.motion.time), len(seen.structure.mass), 6))
