"""Newmark's (1965) rigid sliding block under two horizontal components."""

import numpy as np

from blockshake.dynamics.motion import ground_motion

G = 9.81
MU = 0.5
# amplitude [g], frequency [Hz] and phase of the base's acceleration along x and y; whether the block rests at times
TWO_COMPONENTS = [
    # an ellipse outside Coulomb's circle: never at rest
    ((0.9, 3.0, 0.5 * np.pi), (0.7, 3.0, 0.0), False),
    ((0.9, 3.0, 0.0), (0.35, 3.0, 0.5 * np.pi), None),  # an ellipse that dips into it
    ((0.7, 2.0, 0.0), (0.6, 5.0, 0.0), True),  # two frequencies: rests and slides by turns
]


def slips(run):
    """Way of the first free body against the slab since the start, x and y [m]."""
    moved = run.position - run.position[0]
    return moved[:, 1, :2] - moved[:, 0, :2]


def slide(acceleration, duration):
    """Slip of a rigid block on a base with the given acceleration [m/s2], (n, 2): the reference.

    ``s'' = -a - mu g s'/|s'|``, and rest while ``|a| <= mu g``: a step of implicit Euler in the velocity
    has both in one formula, Moreau's (1988): what friction may take off the trial velocity, it takes.
    """
    dt = duration / len(acceleration)
    speed, slip = np.zeros(2), np.zeros(2)
    slips = [slip]
    for a in acceleration:
        trial = speed - dt * a
        size = np.hypot(*trial)
        speed = np.zeros(2) if size <= MU * G * dt else trial * (1.0 - MU * G * dt / size)
        slip = slip + dt * speed
        slips.append(slip)
    return np.array(slips)


def shaken(x, y, duration):
    """Motion of a base under two sines, and the slip of a block on it at 100,001 even instants.

    ``x`` and ``y``: amplitude [g], frequency [Hz], phase of the base's acceleration.
    """
    spacing, n = 1e-3, 100_000
    time = np.arange(0.0, duration + spacing / 2, spacing)
    a = np.column_stack([part * G * np.sin(2 * np.pi * f * time + phase) for part, f, phase in (x, y)])
    motion = ground_motion("base", time, {"x": a[:, 0], "y": a[:, 1]}, "acceleration")
    fine = (np.arange(n) + 0.5) * duration / n
    return motion, slide(np.column_stack([np.interp(fine, time, part) for part in a.T]), duration)
