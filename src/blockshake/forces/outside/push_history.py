"""History of a horizontal force on one block that would explain what dry joints cannot."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_erosion

from blockshake.forces.joint_motion import from_rest
from blockshake.forces.laws.friction import SLIPS
from blockshake.forces.least_force import least_force


@dataclass(frozen=True)
class PushHistory:
    """A force along x on a body.

    Attributes
    ----------
    body : int
    height : float
        Of the force's line above the body's mass centre [m].
    force, error : float64 arrays, shape (n_times,)
        And its standard deviation [N].
    told : bool array, shape (n_times,)
        Whether the joints tell it: a joint below is turned and stays on its edge or slips on, or the force is needed
        for sure.
    distance : float64 array, shape (n_times,)
        What it leaves unexplained, in standard deviations [1].
    edge : float64 array, shape (n_times,)
        Force that an edge a metre further out takes up [N/m]: edges are known to millimetres.
    friction : float64 array, shape (n_times,)
        Force of Coulomb's friction on what slips, zero where nothing does [N]: its coefficient is known to a share.
    lower, upper : float64 arrays, shape (n_times,)
        Ends between which the force leaves the resultant of the lowest joint beneath on its face [N]; without ends
        where the joint's forces are not known.
    by_lever : float64 array, shape (n_times,)
        Force that moves that resultant by a metre [N/m].
    displacement, velocity : float64 arrays, shape (n_times,)
        Of the body against the table along x [m, m/s].
    """

    body: int
    height: float
    force: np.ndarray
    error: np.ndarray
    told: np.ndarray
    distance: np.ndarray
    edge: np.ndarray
    friction: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    by_lever: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


FRICTION = 0.10  # share that a coefficient of friction is known to (Zhou et al. 2023, Table 2)
_SURE = 4.0  # standard deviations
_LIKELY = 2.0  # standard deviations of friction
_NEAR = 3.0  # widths of the kernel, within which it mixes instants


def push_history(forces, body, height=0.0):
    """Smallest force on a body that explains as much as any.

    Parameters
    ----------
    forces : JointForces
    body : int
        Free.
    height : float, optional
        Of the force's line above the body's mass centre [m].

    Returns
    -------
    PushHistory

    Notes
    -----
    A force that the contacts can take up without moving leaves no trace: the history is told only where a joint below
    the body bears on an edge, or slips for longer than the kernel mixes slip and rest, or where the force is more than
    errors and a somewhat larger friction take up. At all other times the force has ends: a resultant beyond an edge
    would turn the joint.
    """
    motion = forces.motion
    least = least_force(forces.structure, forces.faces, motion, forces.joints, forces.required, body, height)
    n_times = len(motion.time)
    near = int(_NEAR * motion.width / np.median(np.diff(motion.time)))
    error, turned = np.full(n_times, np.inf), np.zeros(n_times, dtype=bool)
    edge, friction, more = np.zeros(n_times), np.zeros(n_times), np.zeros(n_times)
    slides = np.zeros(n_times, dtype=bool)
    lowest = None
    carried = forces.transmitted.carried
    beneath = [place for place in range(len(carried)) if body in carried[place]]
    for place in sorted(beneath, key=lambda place: -len(carried[place])):
        face = forces.transmitted.faces[place]
        joint = forces.faces.index(face)
        middle = motion.position[:, face.upper] + motion.rotation[:, face.upper] @ face.on_upper
        arm = motion.position[:, body, 2] + height - middle[:, 2]
        side = forces.joints.side[:, joint]
        on_one_edge = ~forces.joints.bears[:, joint, 0].all(axis=-1)
        here = (side != 0) & forces.joints.steady & on_one_edge & ~turned
        by_lever = forces.transmitted.normal[:, place] / arm
        lowest = (by_lever, forces.transmitted.lever[:, place], face.half_width) if lowest is None else lowest
        # the lowest joint that is turned tells the force best; before any is, the lowest joint's error stands
        first = here | ~np.isfinite(error)
        error = np.where(first, forces.transmitted.lever_error[:, place] * by_lever, error)
        edge = np.where(here, side * by_lever, edge)
        turned |= here
        limit = face.friction * forces.transmitted.normal[:, place]
        rate = forces.joints.slip_rate[:, joint]
        least_rate = max(SLIPS, _SURE * forces.joints.slip_rate_error[joint])
        runs = [side * rate > least_rate for side in (1.0, -1.0)]
        slides |= np.any([binary_erosion(run, iterations=near) for run in runs], axis=0)
        # the lowest joint that slips: it carries the most
        here = (runs[0] | runs[1]) & (friction == 0.0)
        friction[here] = (-np.sign(rate) * limit)[here]
        held = np.abs(forces.transmitted.friction[:, place]) > face.friction
        more = np.where(held, np.maximum(more, _LIKELY * FRICTION * limit), more)
    known = np.isfinite(least.distance) & np.isfinite(error)
    told = known & (turned | slides | (np.abs(least.push) > _SURE * error + more))
    by_lever, lever, half_width = lowest or (np.zeros(n_times), np.zeros(n_times), np.inf)
    ends = [
        np.where(known & (by_lever > 0.0), by_lever * (end - lever), np.copysign(np.inf, end))
        for end in (-half_width, half_width)
    ]
    driven = int(np.flatnonzero(forces.structure.driven)[0])
    moved = motion.position[:, body, 0] - motion.position[:, driven, 0]
    return PushHistory(
        body=body,
        height=height,
        force=least.push,
        error=error,
        told=told,
        distance=least.distance,
        edge=edge,
        friction=friction,
        lower=ends[0],
        upper=ends[1],
        by_lever=by_lever,
        displacement=from_rest(moved, forces.still),
        velocity=motion.velocity[:, body, 0] - motion.velocity[:, driven, 0],
    )
