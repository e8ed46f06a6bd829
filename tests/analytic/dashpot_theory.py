"""A mass on a spring and a dashpot: what Eq. (3) of Zhou et al. (2023) means for a rebound."""

import numpy as np
from scipy.integrate import solve_ivp


def critical_part(restitution):
    """Damping ratio by which a spring and a dashpot that may pull rebound with ``restitution``.

    Half a cycle of free vibration: C = exp(-pi zeta / sqrt(1 - zeta^2)), solved for zeta.
    """
    if restitution == 0.0:
        return 1.0
    log = np.log(restitution)
    return -log / np.hypot(np.pi, log)


def rebound(zeta, pulling=False):
    """Rebound speed over approach speed of ``x'' + 2 zeta x' + x = 0`` from x = 0.

    It parts where x = 0 (``pulling``) or where the force vanishes; overdamped and pulling, never: 0.
    """
    if pulling and zeta >= 1.0:
        return 0.0

    def parts(_, y):
        return y[0] if pulling else y[0] + 2.0 * zeta * y[1]

    parts.terminal, parts.direction = True, 1.0
    # x < 0 inside, and a start just inside, so that it is no event itself
    run = solve_ivp(
        lambda _, y: [y[1], -y[0] - 2.0 * zeta * y[1]],
        (0.0, 10.0 + 40.0 * zeta), [-1e-12, -1.0], events=parts, rtol=1e-11, atol=1e-13,
    )  # fmt: skip
    return run.y_events[0][0][1]


def rebound_of_nodes(k, gamma, pulling=False):
    """Rebound ratio of a unit mass on parallel springs ``k`` and dashpots ``gamma``, each cut by itself.

    Where each spring has another ratio to its dashpot, each lets go at another instant.
    """

    def leaves(_, y):
        return y[0]

    leaves.terminal, leaves.direction = True, 1.0

    def slope(_, y):
        force = -k * y[0] - gamma * y[1]
        return [y[1], (force if pulling else np.maximum(force, 0.0)).sum()]

    slow = gamma.sum() / k.sum() + 1.0 / np.sqrt(k.sum())
    run = solve_ivp(slope, (0.0, 40.0 * slow), [-1e-12, -1.0], events=leaves, rtol=1e-9, atol=1e-13)
    return run.y_events[0][0][1] if run.t_events[0].size > 0 else 0.0


def rebound_error(zeta, omega_dt):
    """Error of a rebound ratio that a step may make.

    The dashpot's force jumps in at contact, somewhere within a step: 2 zeta omega dt; the spring's part and
    the scheme are of second order.
    """
    return 2.0 * zeta * omega_dt + 2.0 * omega_dt**2
