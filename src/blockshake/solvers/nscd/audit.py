"""Where a run's energy goes, and how well its steps were solved."""

import numpy as np

from blockshake.dynamics.system import kinetic_energy, potential_energy
from blockshake.jit import kernel
from blockshake.solvers.nscd.gauss_seidel import relative_velocity
from blockshake.solvers.nscd.progress import (
    BAD_STEPS,
    CAPPED_STEPS,
    DEEPEST,
    FRICTION_WORK,
    IN_PLAY,
    ITERATIONS,
    LAST_STEP,
    MISFIT,
    MOST_ITERATIONS,
    NORMAL_WORK,
    PARTED_STEPS,
    WORST_RESIDUAL,
)
from blockshake.solvers.nscd.stoppers import closure_into
from blockshake.solvers.nscd.vectors import dot, turned_back, velocity_at

# Relative residual above which a step counts as badly solved; fixed by the project's contract.
_BAD_RESIDUAL = 1e-4


@kernel
def start_audit(bodies, contacts, dt, theta, progress):
    """Energy at the start; what lifts everything by a millimetre is the least that is ever "in play".

    ``contacts``: at the start. ``dt``: of the step that the first step takes for the one before it [s].
    """
    progress.audit[LAST_STEP] = dt
    state, energy = progress.state, progress.energy
    energy[0] = kinetic_energy(bodies, state.velocity, state.angular_velocity, state.orientation)
    energy[1] = potential_energy(bodies, state.position)
    for contact in range(contacts.gap.size):
        compliance, depth = contacts.compliance[contact], max(-contacts.gap[contact], 0.0)
        if compliance > 0.0:
            energy[2] += 0.5 * depth * depth / (theta * dt * dt * compliance)
    progress.energy_start[:] = energy
    weight = 0.0
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            weight += bodies.mass[body] * np.linalg.norm(bodies.gravity)
    progress.audit[IN_PLAY] = 1e-3 * weight


@kernel
def count_into(iterations, residual, tolerance, parts, clock, audit):
    """Add a step to the counts; ``residual`` is the worst and ``iterations`` the sum of its ``parts``."""
    clock[ITERATIONS] += iterations
    clock[MOST_ITERATIONS] = max(clock[MOST_ITERATIONS], iterations)
    clock[BAD_STEPS] += 1 if residual > _BAD_RESIDUAL else 0
    clock[CAPPED_STEPS] += 1 if residual > tolerance else 0
    clock[PARTED_STEPS] += 1 if parts > 1 else 0
    audit[WORST_RESIDUAL] = max(audit[WORST_RESIDUAL], residual)


@kernel
def audit_into(contacts, n_contacts, progress):
    """Bring the deepest penetration, the energy in play and its misfit up to the end of a step."""
    audit, energy, start = progress.audit, progress.energy, progress.energy_start
    for contact in range(n_contacts):
        audit[DEEPEST] = max(audit[DEEPEST], -contacts.gap[contact])
    in_play = energy[0] + abs(energy[1] - start[1]) + energy[2] + energy[3] + energy[4] + abs(energy[6])
    audit[IN_PLAY] = max(audit[IN_PLAY], in_play)
    balance = energy[0] + energy[1] + energy[2] + energy[3] + energy[4] - energy[6]
    audit[MISFIT] = max(audit[MISFIT], abs(balance - start[0] - start[1] - start[2]))


@kernel
def account_into(bodies, stoppers, base, state, contacts, step, theta, audit, energy):
    """Bring the energy terms up to the end of the step.

    Parameters
    ----------
    audit : float64 array, shape (7,)
        Of `Progress`: the net work taken out so far is brought up to date [J].
    energy : float64 array, shape (7,)
        `ENERGY_TERMS` at the start of the step [J]; overwritten with those at its end.

    Notes
    -----
    An impulse does the work ``p . u`` with the mean ``u`` of the velocities at the start and at the end
    (`turn_into` for rotations), so that the terms add up to rounding at theta 0.5. A layer that gave the impulse p over
    the step holds ``theta compliance p^2 / 2`` at its end. A dissipated
    term is the largest net work so far: net work can fall for a moment by the error of the scheme, and the fall
    then shows as the energy residual. In an oblique impact with Newton's restitution the work on friction, by mean
    velocities, can truly be negative (Kane and Levinson 1985): it is taken off what the contact took out.
    """
    elastic = 0.0
    for contact in range(contacts.gap.size):
        p = contacts.impulse[contact]
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        u_n, u_1, u_2 = relative_velocity(contacts, contact, step.v_mean)
        audit[FRICTION_WORK] -= p[1] * u_1 + p[2] * u_2
        audit[NORMAL_WORK] -= p[0] * u_n
        if contacts.stopper[contact] < 0:
            elastic += 0.5 * theta * contacts.compliance[contact] * p[0] * p[0]
        if bodies.driven[a]:
            world = turned_back(contacts.basis[contact], p)
            energy[6] += dot(world, velocity_at(step.v_mean[a], contacts.arm_a[contact]))
        if bodies.driven[b]:
            world = turned_back(contacts.basis[contact], p)
            energy[6] -= dot(world, velocity_at(step.v_mean[b], contacts.arm_b[contact]))
    reach, arm, toward = np.empty(3), np.empty(3), np.empty(3)
    for stopper in range(stoppers.body.size):
        squeezed = closure_into(bodies, stoppers, stopper, base, state, reach, arm, toward)
        elastic += 0.5 * stoppers.stiffness[stopper] * max(squeezed, 0.0) ** 2
    audit[NORMAL_WORK] -= elastic - energy[2]
    energy[0] = kinetic_energy(bodies, state.velocity, state.angular_velocity, state.orientation)
    energy[1] = potential_energy(bodies, state.position)
    energy[2] = elastic
    energy[3] = max(energy[3], audit[FRICTION_WORK])
    energy[4] = max(energy[4], audit[NORMAL_WORK] + (audit[FRICTION_WORK] - energy[3]))
