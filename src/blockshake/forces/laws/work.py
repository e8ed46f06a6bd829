"""Work of a joint: the energy that friction, impacts and damping take out of the motion there."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, Statistic
from blockshake.forces.transmitted import face_axes

_LEAST_KNOWN = 0.95  # of the instants


def energy_taken(forces, place):
    """Energy that a joint has taken out of the motion since the first instant.

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.

    Returns
    -------
    float64 array, shape (n_times,)
        It falls while an elastic joint gives energy back; instants of unknown power count as none [J].

    Notes
    -----
    The power is ``-(F . v + M . w)``: the wrench on the upper body times the velocity of the upper body relative to the
    lower one, both at the middle of the face. Smoothing keeps the loss of an impact: an impulse J that changes a
    velocity from v1 to v2 does the work ``J (v1 + v2) / 2``, the change of kinetic energy, under any symmetric kernel
    that force and velocity share. Impulses of two joints closer together than the kernel is wide keep the sum of their
    losses, and not the share of each.
    """
    wrench, rate = _wrench_and_rate(forces, place)
    power = np.nan_to_num(-np.einsum("ti,ti->t", wrench, rate))
    return np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(forces.motion.time))])


def work_law(forces, place):
    """Statistic of one joint's work, by name.

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.

    Returns
    -------
    dict of str to Statistic
        ``work.taken``: energy that the joint takes out of the motion over the test [J]; untold where forces or rates
        of more than a twentieth of the instants are unknown.

    Notes
    -----
    Standard error: the noise of forces is one for ``2 sqrt(pi)`` widths of the kernel; the noise of velocities, under
    forces that vary slowly, adds up to that of the positions at both ends.
    """
    motion, face = forces.motion, forces.transmitted.faces[place]
    wrench, rate = _wrench_and_rate(forces, place)
    known = np.isfinite(wrench).all(axis=1) & np.isfinite(rate).all(axis=1)
    if known.mean() < _LEAST_KNOWN:
        return {"work.taken": UNTOLD}
    wrench, rate = wrench[known], rate[known]
    of_forces = np.einsum("ti,tij,tj->t", rate, forces.transmitted.covariance[known, place], rate)
    poses = motion.pose_covariance[face.lower] + motion.pose_covariance[face.upper]
    of_poses = np.einsum("ti,ij,tj->t", wrench, poses, wrench)
    step = float(np.median(np.diff(motion.time)))
    variance = of_forces.sum() * step * 2.0 * np.sqrt(np.pi) * motion.width + 2.0 * of_poses.mean()
    return {"work.taken": Statistic(float(energy_taken(forces, place)[-1]), float(np.sqrt(variance)))}


def _wrench_and_rate(forces, place):
    """Wrench on the upper body and its velocity relative to the lower one, in the axes of the face: (n_times, 6)."""
    face, motion = forces.transmitted.faces[place], forces.motion
    lower, upper = face.lower, face.upper
    middle = motion.position[:, upper] + motion.rotation[:, upper] @ face.on_upper
    along = motion.velocity_at(upper, middle) - motion.velocity_at(lower, middle)
    turning = motion.angular_velocity[:, upper] - motion.angular_velocity[:, lower]
    axes = face_axes(forces.structure, face, motion)
    rate = np.concatenate([np.einsum("tji,tj->ti", axes, own) for own in (along, turning)], axis=1)
    carried = forces.transmitted
    return np.concatenate([carried.force[:, place], carried.moment[:, place]], axis=1), rate
