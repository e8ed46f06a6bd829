"""Bodies, their state, their energy and the record of a run, for both solvers."""

from dataclasses import dataclass, fields
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.motion import PITCH
from blockshake.geometry.rotations import rotate_into, rotation_matrices, rotation_rows, turned
from blockshake.geometry.structure_file import signed_axis
from blockshake.geometry.vectors import columns_product, dot
from blockshake.jit import kernel_without_allocation

ENERGY_TERMS = (
    "kinetic",
    "potential",
    "elastic",
    "dissipated_friction",
    "dissipated_contact",
    "dissipated_viscous",
    "input",
)
# Entries of an energy audit by name, in the order of `ENERGY_TERMS`
KINETIC, POTENTIAL, ELASTIC, FRICTION_LOSS, CONTACT_LOSS, VISCOUS_LOSS, INPUT = range(len(ENERGY_TERMS))


class Status(StrEnum):
    """How a run ended."""

    COMPLETED = "completed"
    COLLAPSED = "collapsed"
    FALLING = "falling"
    DIVERGED = "diverged"
    NOT_CONVERGED = "not-converged"


FALLEN = (Status.COLLAPSED, Status.FALLING)  # the window ended before a block that falls was down
FINISHED = (Status.COMPLETED, *FALLEN)  # a run that the solver could not finish is no prediction


class Bodies(NamedTuple):
    """Constants of the bodies, as kernels read them.

    ``mass`` (n_bodies,) [kg]; ``inertia`` and ``inverse_inertia`` (n_bodies, 3, 3), body axes [kg m2]; ``inverse_mass``
    (n_bodies,), zero with ``inverse_inertia`` for driven bodies; ``driven`` bool (n_bodies,); ``gravity`` (3,) [m/s2];
    ``home`` (n_bodies, 3) and ``home_orientation`` (n_bodies, 4): poses of the structure file.
    """

    mass: np.ndarray
    inertia: np.ndarray
    inverse_mass: np.ndarray
    inverse_inertia: np.ndarray
    driven: np.ndarray
    gravity: np.ndarray
    home: np.ndarray
    home_orientation: np.ndarray


class State(NamedTuple):
    """Motion of the bodies at one instant, world frame, changed in place by kernels.

    ``position`` (n_bodies, 3) [m], ``orientation`` (n_bodies, 4) unit quaternions,
    ``velocity`` (n_bodies, 3) [m/s], ``angular_velocity`` (n_bodies, 3) [rad/s].
    """

    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray


class Stoppers(NamedTuple):
    """Elastic stops fixed to the first driven body.

    ``body`` int64 (n,); ``point`` (n, 3) from the mass centre, body frame [m]; ``axis`` (n, 3) signed unit vectors,
    world frame at the start; ``gap`` (n,) [m]; ``stiffness`` (n,) [N/m].
    """

    body: np.ndarray
    point: np.ndarray
    axis: np.ndarray
    gap: np.ndarray
    stiffness: np.ndarray


@dataclass(frozen=True)
class Rows:
    """Record of a run at some of the times requested, in their order; NaN after an abort."""

    time: np.ndarray  # float64 (n_times,) [s]
    # position, velocity, angular_velocity: float64 (n_times, n_bodies, 3); inertial frame [m, m/s, rad/s]
    position: np.ndarray
    # float64 (n_times, n_bodies, 4); unit quaternions (w, x, y, z), body to world, continuous in sign
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    energy: np.ndarray  # float64 (n_times, 7); `ENERGY_TERMS`, of the bodies that are not driven [J]
    joints: np.ndarray  # int64 (n_joints, 2); pairs of bodies that touched so far, by index
    joint_force: np.ndarray  # float64 (n_times, n_joints, 3); resultant on the second body of each pair [N]

    def at(self, rows):
        """Some of these rows; a slice, numbers or a mask."""
        taken = {
            field.name: getattr(self, field.name)[rows] for field in fields(Rows) if field.name != "joints"
        }
        return Rows(joints=self.joints, **taken)


@dataclass(frozen=True)
class Trajectory(Rows):
    """Rows until the last time requested, and how the run ended."""

    status: Status
    reason: str  # why the run ended early or is not to be trusted; empty when completed
    end_time: float  # time reached [s]
    numerics: dict  # str to float; figures of the computation: steps, residuals, iterations and the like


def assemble_bodies(structure, motion=None):
    """Bodies, their state at the start and their stoppers, None without any, from a structure.

    Where the pitch of a ``motion`` does not begin at 0, the table starts turned about its mass centre, and all that the
    structure file has, velocities too, is turned with it.
    """
    free = ~structure.driven
    inverse_mass = np.where(free, 1.0 / structure.mass, 0.0)
    inverse_inertia = np.linalg.inv(structure.inertia) * free[:, None, None]
    bodies = Bodies(
        mass=structure.mass,
        inertia=structure.inertia,
        inverse_mass=inverse_mass,
        inverse_inertia=inverse_inertia,
        driven=structure.driven,
        gravity=np.array(structure.file.gravity),
        home=structure.position.copy(),
        home_orientation=structure.orientation.copy(),
    )
    state = State(
        structure.position.copy(),
        structure.orientation.copy(),
        structure.velocity.copy(),
        structure.angular_velocity.copy(),
    )
    if motion is not None and motion.first_pitch != 0.0 and structure.driven.any():
        _turn_with_table(motion.first_pitch, structure.position[np.argmax(structure.driven)], state)
    return bodies, state, _assemble_stoppers(structure)


def _turn_with_table(pitch, centre, state):
    """Turn a state by a pitch [rad] about a point (3,) [m], in place."""
    turn = np.array([0.0, pitch, 0.0])
    rotation = rotation_matrices(turned(1.0, 0.0, 0.0, 0.0, *turn))
    state.position[:] = centre + (state.position - centre) @ rotation.T
    for vectors in (state.velocity, state.angular_velocity):
        vectors[:] = vectors @ rotation.T
    for orientation in state.orientation:
        rotate_into(orientation, turn, orientation)


def _assemble_stoppers(structure):
    file = structure.file
    if not file.stoppers:
        return None
    return Stoppers(
        body=structure.carriers(file.stoppers),
        point=structure.arms(file.stoppers),
        axis=np.array([signed_axis(stop.axis) for stop in file.stoppers]).reshape(-1, 3),
        gap=np.array([stop.gap for stop in file.stoppers], dtype=float),
        stiffness=np.array([stop.stiffness for stop in file.stoppers], dtype=float),
    )


@kernel_without_allocation
def place_driven_into(bodies, displacement, velocity, state):
    """Put every driven body where the ground motion has it, with its velocity.

    Parameters
    ----------
    bodies : Bodies
    displacement, velocity : float64 arrays, shape (4,)
        Ground x, y, z relative to the start and pitch [m, rad], and their rates.
    state : State
        Position, orientation and velocities of the driven bodies are overwritten; pitch turns
        each about its moving mass centre, positive leaning the top to +x.
    """
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            for axis in range(3):
                state.position[body, axis] = bodies.home[body, axis] + displacement[axis]
                state.velocity[body, axis] = velocity[axis]
                state.angular_velocity[body, axis] = 0.0
            state.angular_velocity[body, 1] = velocity[PITCH]
            home, q = bodies.home_orientation[body], state.orientation[body]
            q[0], q[1], q[2], q[3] = turned(home[0], home[1], home[2], home[3], 0.0, displacement[PITCH], 0.0)


@kernel_without_allocation
def kinetic_energy(bodies, velocity, angular_velocity, orientation):
    """Kinetic energy of the bodies that are not driven [J]; arrays as in `State`."""
    energy = 0.0
    for body in range(bodies.mass.size):
        if bodies.driven[body]:
            continue
        spin = columns_product(rotation_rows(orientation[body]), angular_velocity[body])
        energy += 0.5 * bodies.mass[body] * dot(velocity[body], velocity[body])
        for i in range(3):
            for j in range(3):
                energy += 0.5 * spin[i] * bodies.inertia[body, i, j] * spin[j]
    return energy


@kernel_without_allocation
def potential_energy(bodies, position):
    """Potential energy in gravity of the bodies that are not driven, zero at the origin [J]."""
    energy = 0.0
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            for axis in range(3):
                energy -= bodies.mass[body] * bodies.gravity[axis] * position[body, axis]
    return energy
