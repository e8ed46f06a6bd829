"""A run's record between two steps: linear, rotations along the step's own, driven bodies as the motion has them."""

import numpy as np

from blockshake.dynamics.system import State, place_driven_into
from blockshake.geometry.rotations import rotate_into
from blockshake.jit import kernel


@kernel
def record_into(bodies, before, after, energy_before, energy, share, row, record):
    """Keep the state at a share of the step: linear, rotations along the step's own."""
    turn = np.empty(3)
    for body in range(bodies.mass.size):
        for axis in range(3):
            for kept, old, new in (
                (record.position, before.position, after.position),
                (record.velocity, before.velocity, after.velocity),
                (record.angular_velocity, before.angular_velocity, after.angular_velocity),
            ):
                kept[row, body, axis] = (1.0 - share) * old[body, axis] + share * new[body, axis]
        _rotation_between_into(before.orientation[body], after.orientation[body], turn)
        rotate_into(before.orientation[body], share * turn, record.orientation[row, body])
    for term in range(energy.size):
        record.energy[row, term] = (1.0 - share) * energy_before[term] + share * energy[term]


@kernel
def _rotation_between_into(start, end, rotation):
    """World rotation vector [rad] that turns quaternion ``start`` into ``end``."""
    w, x, y, z = start[0], -start[1], -start[2], -start[3]
    a, b, c, d = end[0], end[1], end[2], end[3]
    scalar = a * w - b * x - c * y - d * z
    rotation[0] = a * x + b * w + c * z - d * y
    rotation[1] = a * y - b * z + c * w + d * x
    rotation[2] = a * z + b * y - c * x + d * w
    sine = np.sqrt(rotation[0] ** 2 + rotation[1] ** 2 + rotation[2] ** 2)
    if sine > 0.0:
        factor = 2.0 * np.arctan2(sine, scalar) / sine
        for axis in range(3):
            rotation[axis] *= factor


@kernel
def record_driven_into(bodies, ground, row, record):
    """Overwrite the driven bodies with the ground motion itself, which is ``ground`` (Ground) at the record time."""
    kept = State(
        record.position[row], record.orientation[row], record.velocity[row], record.angular_velocity[row]
    )
    place_driven_into(bodies, ground.displacement, ground.velocity, kept)


@kernel
def record_forces_into(contacts, n_contacts, joints, dt, row, record):
    """Keep the joints' mean forces over the step, on the second body of each [N]."""
    record.joint_force[row] = 0.0
    for contact in range(n_contacts):
        joint = joints.row[contacts.body_a[contact], contacts.body_b[contact]]
        if joint >= 0:
            record.joint_force[row, joint] += contacts.impulse[contact] @ contacts.basis[contact] / dt
