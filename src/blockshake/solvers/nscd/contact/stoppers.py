"""Stoppers as compliant contacts without friction."""

import numpy as np

from blockshake.jit import kernel
from blockshake.solvers.stoppers import closure_into


@kernel
def place_stoppers_into(bodies, stoppers, base, step, dt, theta, contacts):
    """Write the stoppers, as contacts of the driven body ``base``, into the last rows.

    The law of an implicit spring that only pushes, ``u_n + shift + p / s >= 0`` with ``s = theta dt^2 k``, times ``s
    / (s + m)``, m the mass of the body: so a stop without stiffness has the law ``p / m >= 0``, and no impulse.
    """
    first = contacts.gap.size - stoppers.body.size
    toward = np.empty(3)
    for stopper in range(stoppers.body.size):
        row, body = first + stopper, stoppers.body[stopper]
        contacts.body_a[row], contacts.body_b[row] = base, body
        contacts.stopper[row] = stopper
        contacts.home[row] = stoppers.point[stopper]
        contacts.friction[row] = 0.0
        admittance = theta * dt * dt * stoppers.stiffness[stopper]
        contacts.share[row] = admittance / (admittance + bodies.mass[body])
        contacts.compliance[row] = 1.0 / (admittance + bodies.mass[body])
        closed = closure_into(
            bodies, stoppers, stopper, base, step.detection, contacts.arm_a[row], contacts.arm_b[row], toward
        )
        contacts.gap[row] = -closed
        contacts.basis[row, 0] = -toward
