"""Stoppers as penalty springs."""

import numpy as np

from blockshake.jit import kernel
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
