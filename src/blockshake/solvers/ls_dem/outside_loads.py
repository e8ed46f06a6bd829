"""Loads from outside of the stack: stoppers as penalty springs, external forces and the work that they do."""

import numpy as np

from blockshake.jit import kernel
from blockshake.solvers.external_forces import external_wrenches_into
from blockshake.solvers.stoppers import closure_into


@kernel
def stopper_forces_into(bodies, stoppers, state, loads):
    """Add the forces of closed stoppers to ``loads``; the elastic energy they hold is returned [J].

    With the closure ``c`` of its body's point beyond the gap, see `closure_into`, a stopper pushes the point back with
    ``stiffness * c`` and the first driven body with the opposite.
    """
    energy = 0.0
    driven = np.argmax(bodies.driven)
    reach, arm, toward = np.empty(3), np.empty(3), np.empty(3)
    for stopper in range(stoppers.body.size):
        closure = closure_into(bodies, stoppers, stopper, driven, state, reach, arm, toward)
        if closure > 0.0:
            body, stiffness = stoppers.body[stopper], stoppers.stiffness[stopper]
            force = -stiffness * closure * toward
            loads.force[body] += force
            loads.moment[body] += np.cross(arm, force)
            loads.force[driven] -= force
            loads.moment[driven] -= np.cross(reach, force)
            energy += 0.5 * stiffness * closure * closure
    return energy


@kernel
def external_loads_into(bodies, forces, state, time, external, loads):
    """Add external forces to ``loads``; ``external`` (n_bodies, 6) is overwritten."""
    external_wrenches_into(bodies, forces, state, time, 0.0, external)
    for body in range(external.shape[0]):
        for axis in range(3):
            loads.force[body, axis] += external[body, axis]
            loads.moment[body, axis] += external[body, 3 + axis]


@kernel
def external_power(external, state):
    """Power of external forces on bodies that move as ``state`` has it [W]."""
    power = 0.0
    for body in range(external.shape[0]):
        for axis in range(3):
            power += external[body, axis] * state.velocity[body, axis]
            power += external[body, 3 + axis] * state.angular_velocity[body, axis]
    return power
