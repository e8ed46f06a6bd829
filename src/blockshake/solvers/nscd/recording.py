"""A run's record between two steps: linear, rotations along the step's own, driven bodies as the motion has them."""

import numpy as np

from blockshake.dynamics.system import State, place_driven_into
from blockshake.geometry.rotations import rotate_into
from blockshake.geometry.vectors import transposed_product
from blockshake.jit import kernel_without_allocation


@kernel_without_allocation
def record_into(bodies, before, after, energy_before, energy, share, row, record):
    """Keep the state at a share of the step: linear, rotations along the step's own."""
    for body in range(bodies.mass.size):
        _put_between_into(before.position[body], after.position[body], share, record.position[row, body])
        _put_between_into(before.velocity[body], after.velocity[body], share, record.velocity[row, body])
        _put_between_into(
            before.angular_velocity[body],
            after.angular_velocity[body],
            share,
            record.angular_velocity[row, body],
        )
        turn = _rotation_between(before.orientation[body], after.orientation[body], share)
        rotate_into(before.orientation[body], turn, record.orientation[row, body])
    for term in range(energy.size):
        record.energy[row, term] = (1.0 - share) * energy_before[term] + share * energy[term]


@kernel_without_allocation
def _put_between_into(old, new, share, out):
    for axis in range(3):
        out[axis] = (1.0 - share) * old[axis] + share * new[axis]


@kernel_without_allocation
def _rotation_between(start, end, share):
    """``share`` of the world rotation vector [rad] that turns quaternion ``start`` into ``end``."""
    w, x, y, z = start[0], -start[1], -start[2], -start[3]
    a, b, c, d = end[0], end[1], end[2], end[3]
    scalar = a * w - b * x - c * y - d * z
    x, y, z = (
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )
    sine = np.sqrt(x * x + y * y + z * z)
    factor = 2.0 * np.arctan2(sine, scalar) / sine if sine > 0.0 else 1.0
    return share * (x * factor), share * (y * factor), share * (z * factor)


@kernel_without_allocation
def record_driven_into(bodies, ground, row, record):
    """Overwrite the driven bodies with the ground motion itself, which is ``ground`` (Ground) at the record time."""
    kept = State(
        record.position[row], record.orientation[row], record.velocity[row], record.angular_velocity[row]
    )
    place_driven_into(bodies, ground.displacement, ground.velocity, kept)


@kernel_without_allocation
def record_forces_into(contacts, n_contacts, joints, dt, row, record):
    """Keep the joints' mean forces over the step, on the second body of each [N]."""
    record.joint_force[row] = 0.0
    for contact in range(n_contacts):
        joint = joints.row[contacts.body_a[contact], contacts.body_b[contact]]
        if joint >= 0:
            world = transposed_product(contacts.basis[contact], contacts.impulse[contact])
            for axis in range(3):
                record.joint_force[row, joint, axis] += world[axis] / dt
