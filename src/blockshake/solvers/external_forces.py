"""Forces from outside on single bodies, and elastic stops fixed to the driven body."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.rotations import rotation_matrix_into, rotation_rows
from blockshake.geometry.schema import AXES, CREEP
from blockshake.geometry.vectors import add_impulse_into, cross, rows_product
from blockshake.jit import kernel


class ExternalForces(NamedTuple):
    """Forces along fixed axes, one an entry.

    ``body`` int64 (n,); ``base``: first driven body, -1 without one; ``point`` (n, 3) from the mass centre, body frame
    [m]; ``axis`` (n, 3) unit vectors, world frame; ``amplitude`` (n,) [N]; ``start``, ``end`` (n,) [s];
    ``stiffness`` (n,) [N/m]; ``damping`` (n,) [N s/m]; ``drag`` (n,) [N].
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
    drag: np.ndarray


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
            for name in ("amplitude", "start", "end", "stiffness", "damping", "drag")
        ),
    )


@kernel
def external_wrenches_into(bodies, forces, state, time, ahead, wrench):
    """External forces on all bodies, with their moments about the mass centres.

    ``time``: when the forces are asked for, ``ahead`` of the state, over which every point keeps its velocity [s].
    ``wrench`` (n_bodies, 6) is overwritten with force and moment, world frame [N, N m].

    Notes
    -----
    ``amplitude`` from ``start`` until before ``end``, less ``stiffness`` times the point's displacement against the
    driven body since the start of the run, less ``damping`` times its velocity v against it, less ``drag`` times
    tanh(v / 0.01 m/s): dry friction, made smooth at rest.
    """
    wrench[:] = 0.0
    for force in range(forces.body.size):
        body, point, axis = forces.body[force], forces.point[force], forces.axis[force]
        home = rows_product(rotation_rows(bodies.home_orientation[body]), point)
        arm = rows_product(rotation_rows(state.orientation[body]), point)
        rate = cross(state.angular_velocity[body], arm)
        moved, speed = 0.0, 0.0
        for i in range(3):
            moved += axis[i] * (state.position[body, i] + arm[i] - bodies.home[body, i] - home[i])
            speed += axis[i] * (state.velocity[body, i] + rate[i])
            if forces.base >= 0:
                moved -= axis[i] * (state.position[forces.base, i] - bodies.home[forces.base, i])
                speed -= axis[i] * state.velocity[forces.base, i]
        size = -forces.stiffness[force] * (moved + ahead * speed) - forces.damping[force] * speed
        size -= forces.drag[force] * np.tanh(speed / CREEP)
        if forces.start[force] <= time < forces.end[force]:
            size += forces.amplitude[force]
        add_impulse_into(size, axis, arm, wrench[body])


@kernel
def closure_into(bodies, stoppers, stopper, base, state, reach, arm, toward):
    """Closure of a stopper beyond its gap [m], negative while open.

    A stopper is a plane across its signed axis, ``gap`` away from the body's point at the start, that travels and turns
    with the driven body ``base``. ``reach`` and ``arm`` (3,) are overwritten with the point seen from the mass centres
    of the driven body and of its own [m], ``toward`` (3,) with the signed axis as it has turned; world frame.
    """
    body = stoppers.body[stopper]
    R, R_base, R_start = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    rotation_matrix_into(bodies.home_orientation[body], R)
    rotation_matrix_into(bodies.home_orientation[base], R_start)
    reach_start = bodies.home[body] + R @ stoppers.point[stopper] - bodies.home[base]
    axis = R_start.T @ stoppers.axis[stopper]
    rotation_matrix_into(state.orientation[body], R)
    rotation_matrix_into(state.orientation[base], R_base)
    arm[:] = R @ stoppers.point[stopper]
    reach[:] = state.position[body] + arm - state.position[base]
    toward[:] = R_base @ axis
    # in the driven body's axes, where the stopper stands still
    return np.dot(axis, R_base.T @ reach - R_start.T @ reach_start) - stoppers.gap[stopper]
