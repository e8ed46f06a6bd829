"""The motion that everything here is timed under: 1 Hz, 1.5 m/s2, from rest."""

import numpy as np

from blockshake.dynamics.motion import ground_motion

FREQUENCY, ACCELERATION = 1.0, 1.5  # Hz, m/s2
NUDGE = 1e-6  # share by which the motion of a nudged twin is larger
_ROWS = 1000  # a second; the cubic between them follows the sine to 1e-12 m


def harmonic(duration, acceleration=ACCELERATION):
    """Displacement ``A (cos(2 pi f t) - 1)`` along x: at rest at first, full ``acceleration`` [m/s2] at once."""
    omega = 2.0 * np.pi * FREQUENCY
    time = np.arange(int(np.ceil(duration * _ROWS)) + 2) / _ROWS
    displacement = acceleration / omega**2 * (np.cos(omega * time) - 1.0)
    return ground_motion("harmonic", time, {"x": displacement}, "displacement", {"source": "bench"})
