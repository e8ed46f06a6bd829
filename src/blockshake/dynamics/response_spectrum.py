"""Response spectra of a ground motion: peaks of damped oscillators on a base that shakes."""

import numpy as np

from blockshake.dynamics.motion import CHANNELS
from blockshake.jit import kernel

DAMPING = 0.05  # of critical; the engineering convention
_POINTS_PER_CYCLE = 32.0  # a peak between two of these is missed by less than 0.5 %


def response_spectrum(motion, periods, axis="x", damping=DAMPING):
    """Pseudo-acceleration spectrum of one component.

    Parameters
    ----------
    motion : GroundMotion
    periods : float64 array, shape (n_periods,)
        Undamped natural periods, above zero [s].
    axis : str
        ``x``, ``y`` or ``z``.
    damping : float
        Share of critical damping, in [0, 1) [1].

    Returns
    -------
    float64 array, shape (n_periods,)
        ``(2 pi / period)^2`` times the peak relative displacement during the motion [m/s2].
    """
    step, start, end = acceleration_segments(motion, axis)
    return pseudo_acceleration(step, start, end, np.asarray(periods, dtype=float), damping)


def acceleration_segments(motion, axis="x"):
    """Acceleration of one component, linear in each segment of the motion.

    Returns
    -------
    step, start, end : float64 arrays, shape (n_segments,)
        Length of each segment [s] and acceleration at its two ends [m/s2]; ``end`` and the next
        ``start`` differ where the motion was given as velocity.
    """
    c = motion.table.coefficients[:, CHANNELS.index(axis)]
    step = np.diff(motion.table.breaks)
    return step, 2.0 * c[:, 2], 2.0 * c[:, 2] + 6.0 * step * c[:, 3]


@kernel
def pseudo_acceleration(step, start, end, periods, damping):
    """Peak pseudo-acceleration of oscillators at rest under a piecewise linear base acceleration.

    Parameters
    ----------
    step, start, end : float64 arrays, shape (n_segments,)
        From `acceleration_segments` [s, m/s2, m/s2].
    periods : float64 array, shape (n_periods,)
        [s]
    damping : float
        Below critical [1].

    Returns
    -------
    float64 array, shape (n_periods,)
        [m/s2]

    Notes
    -----
    Nigam and Jennings (1969), Calculation of response spectra from strong-motion earthquake records, Bull. Seismol.
    Soc. Am. 59: the exact solution of ``u'' + 2 zeta w u' + w^2 u = -(a0 + a1 t)`` over each piece. Pieces are cut so
    that a cycle has at least 32 points, which bounds the peak missed between points, not the solution.
    """
    peaks = np.zeros(periods.size)
    for index in range(periods.size):
        w = 2.0 * np.pi / periods[index]
        w_damped = w * np.sqrt(1.0 - damping * damping)
        u = v = peak = h = e_cos = e_sin = 0.0
        for segment in range(step.size):
            pieces = int(np.ceil(_POINTS_PER_CYCLE * step[segment] / periods[index]))
            length = step[segment] / pieces
            if abs(length - h) > 1e-12 * length:
                h = length
                decay = np.exp(-damping * w * h)
                e_cos, e_sin = decay * np.cos(w_damped * h), decay * np.sin(w_damped * h)
            slope = (end[segment] - start[segment]) / step[segment]
            for piece in range(pieces):
                # the particular solution is p0 + p1 t, the rest decays freely
                a = start[segment] + slope * h * piece
                p1 = -slope / (w * w)
                p0 = -(a + 2.0 * damping * w * p1) / (w * w)
                free, free_rate = u - p0, v - p1
                mixed = (free_rate + damping * w * free) / w_damped
                u = e_cos * free + e_sin * mixed + p0 + p1 * h
                v = (
                    e_cos * (w_damped * mixed - damping * w * free)
                    - e_sin * (damping * w * mixed + w_damped * free)
                    + p1
                )
                peak = max(peak, abs(u))
        peaks[index] = w * w * peak
    return peaks
