"""External forces as loads of a step, and the work that they do."""

from blockshake.jit import kernel
from blockshake.solvers.external_forces import external_wrenches_into


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
