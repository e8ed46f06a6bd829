"""How strong a ground motion is and how long it lasts: peaks, Arias intensity, response spectra."""

import numpy as np
import numpy.typing as npt

from blockshake.dynamics.motion import CHANNELS, GroundMotion
from blockshake.errors import Argument, InputError
from blockshake.jit import kernel

_GRAVITY = 9.80665  # m/s2, in Arias's definition
DAMPING = 0.05  # of critical; the engineering convention
_POINTS_PER_CYCLE = 32.0  # a peak between two of these is missed by less than 0.5 %


def motion_figures(motion: GroundMotion, axis: str = "x") -> dict[str, float]:
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

    Raises
    ------
    InputError
        Another axis.

    Examples
    --------
    >>> import blockshake
    >>> figures = blockshake.motion_figures(blockshake.load_motion("alkion"))
    >>> for name in ("peak_acceleration", "peak_velocity", "peak_displacement"):
    ...     print(f"{name}: {figures[name]:.3g}")
    peak_acceleration: 1.18
    peak_velocity: 0.0984
    peak_displacement: 0.0273
    """
    channel = _channel(axis)
    _, start, end = acceleration_segments(motion, axis)
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


def response_spectrum(
    motion: GroundMotion, periods: npt.ArrayLike, axis: str = "x", damping: float = DAMPING
) -> np.ndarray:
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

    Raises
    ------
    InputError
        Another axis, a period that is not above zero, a damping that is none below critical.

    Examples
    --------
    >>> import blockshake
    >>> blockshake.response_spectrum(blockshake.load_motion("alkion"), [0.1, 0.5, 2.0]).round(2)
    array([2.  , 2.89, 0.57])
    """
    step, start, end = acceleration_segments(motion, axis)
    periods = np.asarray(periods, dtype=float)
    if not ((periods > 0.0) & np.isfinite(periods)).all():
        raise InputError(Argument("periods"), "", "expected periods above 0 s")
    if not 0.0 <= damping < 1.0:
        raise InputError(Argument("damping"), "", f"expected a share of critical damping, not {damping}")
    return pseudo_acceleration(step, start, end, periods, damping)


def _channel(axis):
    if axis not in CHANNELS[:3]:
        raise InputError(Argument("axis"), "", f"expected x, y or z, not {axis!r}")
    return CHANNELS.index(axis)


def acceleration_segments(motion, axis="x"):
    """Acceleration of one component, linear in each segment of the motion.

    Returns
    -------
    step, start, end : float64 arrays, shape (n_segments,)
        Length of each segment [s] and acceleration at its two ends [m/s2]; ``end`` and the next
        ``start`` differ where the motion was given as velocity.
    """
    c = motion.table.coefficients[:, _channel(axis)]
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
