"""A ground motion of tests of several solvers."""

import numpy as np

from blockshake.dynamics.motion import ground_motion


def cycle(acceleration, frequency, until):
    """One cycle of a sine along x."""
    time = np.linspace(0.0, 1.0 / frequency, 201)
    a = acceleration * np.sin(2.0 * np.pi * frequency * time)
    return ground_motion(
        "cycle", np.append(time, [time[-1] + 1e-6, until]), {"x": np.append(a, [0.0, 0.0])}, "acceleration"
    )
