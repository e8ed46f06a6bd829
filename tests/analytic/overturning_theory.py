"""Overturning by one cycle of a sine: the rigid block's least amplitudes, by event-driven integration.

After Zhang & Makris (2001), Rocking response of free-standing blocks under cycloidal pulses: a block overturns
without an impact (a limit that no law of impact enters) or after one (which the kept part r decides).
"""

import functools

import numpy as np
from rocking_theory import G, rock

AFTER = 2.5  # s of rest after the cycle


def pulse(frequency, amplitude):
    """Times and accelerations of one cycle of a sine and rest after it."""
    n = 400
    time = np.concatenate([np.arange(n + 1) / n, [1.0 + 1e-6, 1.0 + 4.0 * frequency]]) / frequency
    a = np.concatenate([amplitude * np.sin(2.0 * np.pi * np.arange(n) / n), [0.0, 0.0, 0.0]])
    return time, a


@functools.cache
def limit(rocker, frequency, low, high, ratio, impacts):
    """Least amplitude [m/s2] of the reference between ``low`` and ``high`` g that overturns so, by bisection."""
    low, high = low * G, high * G
    for _ in range(12):
        middle = 0.5 * (low + high)
        time, a = pulse(frequency, middle)
        fell, hits = rock(rocker, lambda t: np.interp(t, time, a), 1.0 / frequency + AFTER, ratio)  # noqa: B023
        if fell and hits <= impacts:
            high = middle
        else:
            low = middle
    return high
