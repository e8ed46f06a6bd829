"""Figures that say how strong a ground motion is and how long it lasts."""

import numpy as np

from blockshake.dynamics.motion import CHANNELS
from blockshake.dynamics.response_spectrum import acceleration_segments

_GRAVITY = 9.80665  # m/s2, in Arias's definition


def motion_figures(motion, axis="x"):
    """Peaks, Arias intensity and duration of a motion along one axis.

    Parameters
    ----------
    motion : GroundMotion
    axis : str
        ``x``, ``y`` or ``z``.

    Returns
    -------
    dict of str to float
        ``peak_acceleration`` [m/s2], ``peak_velocity`` [m/s] and ``peak_displacement`` [m], largest
        absolute value at the rows, displacement from the first row; ``arias_intensity`` [m/s];
        ``significant_duration`` from 5 to 95 % of it, with its ``significant_start`` and
        ``significant_end`` [s]; ``duration`` of the record [s]; ``end_displacement`` [m].
    """
    _, start, end = acceleration_segments(motion, axis)
    channel = CHANNELS.index(axis)
    displacement = motion.evaluate(motion.table.breaks)[:, channel]
    displacement = displacement - displacement[0]
    velocity = motion.evaluate(motion.table.breaks, derivative=1)[:, channel]
    arias = arias_intensity(motion, axis)
    begins, ends = (_crossing(motion.table.breaks, arias, share) for share in (0.05, 0.95))
    return {
        "peak_acceleration": float(max(np.abs(start).max(), np.abs(end).max())),
        "peak_velocity": float(np.abs(velocity).max()),
        "peak_displacement": float(np.abs(displacement).max()),
        "arias_intensity": float(arias[-1]),
        "significant_duration": ends - begins,
        "significant_start": begins,
        "significant_end": ends,
        "duration": motion.duration,
        "end_displacement": float(displacement[-1]),
    }


def arias_intensity(motion, axis="x"):
    """Arias intensity gathered up to each row.

    Returns
    -------
    float64 array, shape (n_rows,)
        ``pi / (2 g)`` times the integral of the squared acceleration, exact for acceleration that
        is linear in each segment [m/s].

    Notes
    -----
    Arias (1970), A measure of earthquake intensity; g is 9.80665 m/s2.
    """
    step, start, end = acceleration_segments(motion, axis)
    gathered = np.cumsum(step * (start * start + start * end + end * end) / 3.0)
    return np.pi / (2.0 * _GRAVITY) * np.concatenate([[0.0], gathered])


def strong_until(motion):
    """Time at which 95 % of the Arias intensity of all axes is gathered [s]; 0 for a motion that never moves."""
    return _crossing(motion.table.breaks, sum(arias_intensity(motion, axis) for axis in "xyz"), 0.95)


def _crossing(time, gathered, share):
    """First time at which a share of the end value is reached; 0 for a motion that never moves."""
    if gathered[-1] == 0.0:
        return 0.0
    return float(np.interp(share * gathered[-1], gathered, time))
