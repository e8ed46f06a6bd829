"""Forces from outside on single bodies: between two instants, or against a body's motion relative to the table."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.rotations import rotation_matrix_into
from blockshake.geometry.schema import AXES
from blockshake.jit import kernel


class ExternalForces(NamedTuple):
    """Forces along fixed axes, one an entry.

    ``body`` int64 (n,); ``base``: first driven body, -1 without one; ``point`` (n, 3) from the mass centre, body frame
    [m]; ``axis`` (n, 3) unit vectors, world frame; ``amplitude`` (n,) [N]; ``start``, ``end`` (n,) [s];
    ``stiffness`` (n,) [N/m]; ``damping`` (n,) [N s/m].
    """

    body: np.ndarray
    base: int
    point: np.ndarray
    axis: np.ndarray
    amplitude: np.ndarray
    start: np.ndarray
    end: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


def assemble_external_forces(structure):
    """External forces of a structure, bodies in the order of its file."""
    forces = structure.file.external_forces
    driven = np.flatnonzero(structure.driven)
    return ExternalForces(
        structure.carriers(forces),
        int(driven[0]) if len(driven) else -1,
        structure.arms(forces),
        np.eye(3)[[AXES.index(force.axis) for force in forces]].reshape(-1, 3),
        *(
            np.array([getattr(force, name) for force in forces], dtype=float)
            for name in ("amplitude", "start", "end", "stiffness", "damping")
        ),
    )


@kernel
def external_wrenches_into(bodies, forces, state, time, ahead, wrench):
    """External forces on all bodies, with their moments about the mass centres.

    Parameters
    ----------
    bodies : Bodies
    forces : ExternalForces
    state : State
    time : float
        At which the forces are asked for [s].
    ahead : float
        Time from the state until then, over which every point keeps its velocity [s].
    wrench : float64 array, shape (n_bodies, 6)
        Overwritten: force and moment, world frame [N, N m].
    """
    wrench[:] = 0.0
    arm = np.empty(3)
    for force in range(forces.body.size):
        push = _size(bodies, forces, force, state, time, ahead, arm) * forces.axis[force]
        wrench[forces.body[force], :3] += push
        wrench[forces.body[force], 3:] += np.cross(arm, push)


@kernel
def _size(bodies, forces, force, state, time, ahead, arm):
    """Size of one force along its axis [N]; ``arm`` (3,) is overwritten with its point from the mass centre [m].

    ``amplitude`` from ``start`` until before ``end``, less ``stiffness`` times the point's displacement against the
    driven body since the start of the run, less ``damping`` times its velocity against it.
    """
    body, base, axis, point = forces.body[force], forces.base, forces.axis[force], forces.point[force]
    R = np.empty((3, 3))
    rotation_matrix_into(bodies.home_orientation[body], R)
    home = bodies.home[body] + R @ point
    rotation_matrix_into(state.orientation[body], R)
    arm[:] = R @ point
    moved = state.position[body] + arm - home
    rate = state.velocity[body] + np.cross(state.angular_velocity[body], arm)
    if base >= 0:
        moved -= state.position[base] - bodies.home[base]
        rate -= state.velocity[base]
    speed = np.dot(axis, rate)
    size = -forces.stiffness[force] * (np.dot(axis, moved) + ahead * speed) - forces.damping[force] * speed
    if forces.start[force] <= time < forces.end[force]:
        size += forces.amplitude[force]
    return size
