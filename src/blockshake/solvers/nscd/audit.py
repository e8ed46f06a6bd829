"""Energy balance of a run, and the quality of the solution of its steps."""

import numpy as np

from blockshake.dynamics.system import (
    CONTACT_LOSS,
    ELASTIC,
    FRICTION_LOSS,
    INPUT,
    KINETIC,
    POTENTIAL,
    VISCOUS_LOSS,
    kinetic_energy,
    potential_energy,
)
from blockshake.geometry.vectors import copy_into, dot, transposed_product, velocity_at
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.external_forces import closure_into
from blockshake.solvers.nscd.progress import (
    BAD_STEPS,
    CAPPED_STEPS,
    DEEPEST,
    FRICTION_WORK,
    HELD,
    IN_PLAY,
    ITERATIONS,
    LAST_STEP,
    MISFIT,
    MOST_ITERATIONS,
    NORMAL_WORK,
    PARTED_STEPS,
    WORST_RESIDUAL,
)

# Relative residual above which a step counts as badly solved; fixed by the project's contract.
_BAD_RESIDUAL = 1e-4


@inner_kernel
def start_audit(bodies, contacts, dt, theta, strain, progress):
    """Energy at the start; what lifts everything by a millimetre is the least that is ever "in play".

    ``contacts``: at the start. ``strain``: elastic energy of the bodies then [J]. ``dt``: of the step that the first
    step takes for the one before it [s].
    """
    progress.audit[LAST_STEP] = dt
    state, energy = progress.state, progress.energy
    energy[KINETIC] = kinetic_energy(bodies, state.velocity, state.angular_velocity, state.orientation)
    energy[POTENTIAL] = potential_energy(bodies, state.position)
    for contact in range(contacts.gap.size):
        compliance, depth = contacts.compliance[contact], max(-contacts.gap[contact], 0.0)
        if compliance > 0.0:
            energy[ELASTIC] += 0.5 * depth * depth / (theta * dt * dt * compliance)
    progress.audit[HELD] = energy[ELASTIC]
    energy[ELASTIC] += strain
    copy_into(energy, progress.energy_start)
    weight = 0.0
    for body in range(bodies.mass.size):
        if not bodies.driven[body]:
            weight += bodies.mass[body] * np.sqrt(dot(bodies.gravity, bodies.gravity))
    progress.audit[IN_PLAY] = 1e-3 * weight


@kernel_without_allocation
def count_into(iterations, residual, tolerance, parts, clock, audit):
    """Add a step to the counts; ``residual`` is the worst and ``iterations`` the sum of its ``parts``."""
    clock[ITERATIONS] += iterations
    clock[MOST_ITERATIONS] = max(clock[MOST_ITERATIONS], iterations)
    clock[BAD_STEPS] += 1 if residual > _BAD_RESIDUAL else 0
    clock[CAPPED_STEPS] += 1 if residual > tolerance else 0
    clock[PARTED_STEPS] += 1 if parts > 1 else 0
    audit[WORST_RESIDUAL] = max(audit[WORST_RESIDUAL], residual)


@kernel_without_allocation
def audit_into(contacts, n_contacts, progress):
    """Bring the deepest penetration, the energy in play and its misfit up to the end of a step."""
    audit, energy, start = progress.audit, progress.energy, progress.energy_start
    for contact in range(n_contacts):
        audit[DEEPEST] = max(audit[DEEPEST], -contacts.gap[contact])
    in_play = (
        energy[KINETIC] + abs(energy[POTENTIAL] - start[POTENTIAL]) + energy[ELASTIC] + energy[FRICTION_LOSS]
        + energy[CONTACT_LOSS] + energy[VISCOUS_LOSS] + abs(energy[INPUT])
    )  # fmt: skip
    audit[IN_PLAY] = max(audit[IN_PLAY], in_play)
    balance = (
        energy[KINETIC] + energy[POTENTIAL] + energy[ELASTIC] + energy[FRICTION_LOSS] + energy[CONTACT_LOSS]
        + energy[VISCOUS_LOSS] - energy[INPUT]
    )  # fmt: skip
    audit[MISFIT] = max(audit[MISFIT], abs(balance - start[KINETIC] - start[POTENTIAL] - start[ELASTIC]))


@inner_kernel
def stopper_energy(bodies, stoppers, base, state):
    """Energy in the stoppers, if any, of the driven body ``base`` [J]."""
    if stoppers is None:
        return 0.0
    held, reach, arm, toward = 0.0, np.empty(3), np.empty(3), np.empty(3)
    for stopper in range(stoppers.body.size):
        squeezed = closure_into(bodies, stoppers, stopper, base, state, reach, arm, toward)
        held += 0.5 * stoppers.stiffness[stopper] * max(squeezed, 0.0) ** 2
    return held


@kernel_without_allocation
def account_into(bodies, contacts, u_mean, step, theta, squeezed, deformation, progress):
    """Bring the energy terms up to the end of the step.

    Parameters
    ----------
    bodies, contacts, step, progress : Bodies, Contacts, Step, Progress
        The contacts have the impulses of the step, and ``progress.state`` is that at its end; its energy and the net
        work taken out so far are brought up to it.
    u_mean : float64 array, shape (n_contacts, 3)
        Velocities of the contacts that their impulses do work on, along their bases [m/s].
    theta : float
        Weight of the end of the step [1].
    squeezed : float
        Energy in the stoppers at the end of the step, of `stopper_energy` [J].
    deformation : tuple of 3 float
        Kinetic and elastic energy of the bodies' deformation at the end of the step, and what it lost in it [J].

    Notes
    -----
    An impulse does the work ``p . u`` with the mean ``u`` of the velocities at the start and at the end (`turn_into`
    for rotations), so that the terms add up to rounding at theta 0.5. A layer that gave the impulse p over the step
    holds ``theta compliance p^2 / 2`` at its end. A dissipated term is the largest net work so far: net work can fall
    for a moment by the error of the scheme, and the fall then shows as the energy residual. In an oblique impact with
    Newton's restitution the work on friction, by mean velocities, can truly be negative (Kane and Levinson 1985): it is
    taken off what the contact took out.
    """
    state, audit, energy = progress.state, progress.audit, progress.energy
    held = 0.0
    for contact in range(contacts.gap.size):
        p = contacts.impulse[contact]
        a, b = contacts.body_a[contact], contacts.body_b[contact]
        audit[FRICTION_WORK] -= p[1] * u_mean[contact, 1] + p[2] * u_mean[contact, 2]
        audit[NORMAL_WORK] -= p[0] * u_mean[contact, 0]
        if contacts.stopper[contact] < 0:
            held += 0.5 * theta * contacts.compliance[contact] * p[0] * p[0]
        if bodies.driven[a]:
            world = transposed_product(contacts.basis[contact], p)
            energy[INPUT] += dot(world, velocity_at(step.v_mean[a], contacts.arm_a[contact]))
        if bodies.driven[b]:
            world = transposed_product(contacts.basis[contact], p)
            energy[INPUT] -= dot(world, velocity_at(step.v_mean[b], contacts.arm_b[contact]))
    for body in range(bodies.mass.size):
        for i in range(6):
            energy[INPUT] += step.external[body, i] * step.v_mean[body, i]
    held += squeezed
    audit[NORMAL_WORK] -= held - audit[HELD]
    audit[HELD] = held
    kinetic, strain, lost = deformation
    energy[KINETIC] = kinetic + kinetic_energy(
        bodies, state.velocity, state.angular_velocity, state.orientation
    )
    energy[POTENTIAL] = potential_energy(bodies, state.position)
    energy[ELASTIC] = held + strain
    energy[VISCOUS_LOSS] += lost
    energy[FRICTION_LOSS] = max(energy[FRICTION_LOSS], audit[FRICTION_WORK])
    energy[CONTACT_LOSS] = max(
        energy[CONTACT_LOSS], audit[NORMAL_WORK] + (audit[FRICTION_WORK] - energy[FRICTION_LOSS])
    )
