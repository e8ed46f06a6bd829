"""Forces from outside on single bodies, and elastic stops fixed to the driven body."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import State
from blockshake.geometry.rotations import rotation_rows
from blockshake.geometry.schema import AXES, CREEP
from blockshake.geometry.vectors import (
    add_impulse_into,
    columns_product,
    cross,
    difference,
    dot,
    put_into,
    rows_product,
)
from blockshake.jit import inner_kernel


class ExternalForces(NamedTuple):
    """Forces along fixed axes, one an entry.

    ``given`` (State): where the run starts; ``body`` int64 (n,); ``base``: first driven body, -1 without one;
    ``point`` (n, 3) from the mass centre, body frame [m]; ``axis`` (n, 3) unit vectors, world frame;
    ``amplitude`` (n,) [N]; ``start``, ``end`` (n,) [s]; ``stiffness`` (n,) [N/m]; ``damping`` (n,) [N s/m];
    ``drag`` (n,) [N].
    """

    given: State
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


def assemble_external_forces(structure, given):
    """External forces of a structure, bodies in the order of its file; None without any, and no kernel has them.

    ``given`` (State): where the run starts, from `assemble_bodies`.
    """
    forces = structure.file.external_forces
    if not forces:
        return None
    driven = np.flatnonzero(structure.driven)
    return ExternalForces(
        State(*(part.copy() for part in given)),
        structure.carriers(forces),
        int(driven[0]) if len(driven) else -1,
        structure.arms(forces),
        np.eye(3)[[AXES.index(force.axis) for force in forces]].reshape(-1, 3),
        *(
            np.array([getattr(force, name) for force in forces], dtype=float)
            for name in ("amplitude", "start", "end", "stiffness", "damping", "drag")
        ),
    )


@inner_kernel
def external_wrenches_into(forces, state, time, ahead, wrench):
    """External forces on all bodies, with their moments about the mass centres.

    ``time``: when the forces are requested, ``ahead`` of the state, over which every point keeps its velocity [s].
    ``wrench`` (n_bodies, 6) is overwritten with force and moment, world frame [N, N m].

    Notes
    -----
    ``amplitude`` from ``start`` until before ``end``, less ``stiffness`` times the point's displacement against the
    driven body since the start of the run, less ``damping`` times its velocity v against it, less ``drag`` times
    tanh(v / 0.01 m/s): dry friction, made smooth at rest.
    """
    wrench[:] = 0.0
    given = forces.given
    for force in range(forces.body.size):
        body, point, axis = forces.body[force], forces.point[force], forces.axis[force]
        home = rows_product(rotation_rows(given.orientation[body]), point)
        arm = rows_product(rotation_rows(state.orientation[body]), point)
        rate = cross(state.angular_velocity[body], arm)
        moved, speed = 0.0, 0.0
        for i in range(3):
            moved += axis[i] * (state.position[body, i] + arm[i] - given.position[body, i] - home[i])
            speed += axis[i] * (state.velocity[body, i] + rate[i])
            if forces.base >= 0:
                moved -= axis[i] * (state.position[forces.base, i] - given.position[forces.base, i])
                speed -= axis[i] * state.velocity[forces.base, i]
        size = -forces.stiffness[force] * (moved + ahead * speed) - forces.damping[force] * speed
        size -= forces.drag[force] * np.tanh(speed / CREEP)
        if forces.start[force] <= time < forces.end[force]:
            size += forces.amplitude[force]
        add_impulse_into(size, axis, arm, wrench[body])


@inner_kernel
def external_impulses_into(bodies, forces, state, time, dt, impulse):
    """Impulses of external forces, if any, in a step of length ``dt`` around a time [s], as the wrenches above.

    ``impulse`` (n_bodies, 6) is then overwritten [N s, N m s].
    """
    if forces is None:
        return
    external_wrenches_into(forces, state, time, 0.5 * dt, impulse)
    for body in range(bodies.mass.size):
        for axis in range(6):
            impulse[body, axis] *= dt


@inner_kernel
def number_of(stoppers):
    """How many stoppers there are, if any."""
    if stoppers is None:
        return np.int64(0)
    return stoppers.body.size


@inner_kernel
def closure_into(bodies, stoppers, stopper, base, state, reach, arm, toward):
    """Closure of a stopper beyond its gap [m], negative while open.

    A stopper is a plane across its signed axis, ``gap`` away from the body's point at the start, that travels and turns
    with the driven body ``base``. ``reach`` and ``arm`` (3,) are overwritten with the point seen from the mass centres
    of the driven body and of its own [m], ``toward`` (3,) with the signed axis as it has turned; world frame.
    """
    body = stoppers.body[stopper]
    point = stoppers.point[stopper]
    start = rotation_rows(bodies.home_orientation[base])
    axis = columns_product(start, stoppers.axis[stopper])
    put_into(rows_product(rotation_rows(state.orientation[body]), point), arm)
    now = rotation_rows(state.orientation[base])
    put_into(rows_product(now, axis), toward)
    home = rows_product(rotation_rows(bodies.home_orientation[body]), point)
    reach_start = np.empty(3)
    for i in range(3):
        reach_start[i] = bodies.home[body, i] + home[i] - bodies.home[base, i]
        reach[i] = state.position[body, i] + arm[i] - state.position[base, i]
    # in the driven body's axes, where the stopper stands still
    moved = difference(columns_product(now, reach), columns_product(start, reach_start))
    return dot(axis, moved) - stoppers.gap[stopper]
