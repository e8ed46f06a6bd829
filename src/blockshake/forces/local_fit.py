"""Local quadratic fits of readings: smoothed values and derivatives by a positive kernel, with their noise."""

import numpy as np

REACH = 4.0  # of the kernel's standard deviation: what lies beyond has no weight
_FEWEST = 6  # readings of a fit


def fit_locally(times, readings, at, width, degree=2):
    """Fit a polynomial with Gaussian weights about each time, channel by channel.

    Parameters
    ----------
    times : float64 array, shape (n_readings,)
        Uniform, increasing [s].
    readings : float64 array, shape (n_readings, n_channels)
        NaN is a gap.
    at : float64 array, shape (n_times,)
        Where it is requested [s].
    width : float
        Standard deviation of the kernel [s].
    degree : int
        Of the polynomial: 2, or 0 for a mean with positive weights.

    Returns
    -------
    values, variances : float64 arrays, shape (degree + 1, n_times, n_channels)
        Value and derivatives, NaN where the readings do not show them; their variances for white noise of variance
        1.

    Notes
    -----
    The second derivative is a mean of the true second derivative with weights that are nowhere negative, whatever the
    gaps: the leading coefficient of a least-squares polynomial is a positively weighted mean of divided
    differences (Jacobi 1841; de Boor and Pinkus 2003), and a divided difference is a mean of the derivative over a
    B-spline. So a smoothed history of forces that a joint can carry is one that it can carry. Without
    gaps the weights are the Gaussian itself.

    A fit needs readings on both sides of its time, and no gap near it longer than twice the width.
    """
    rate = (len(times) - 1) / (times[-1] - times[0])
    half = int(np.ceil(REACH * width * rate))
    offsets = np.arange(-half, half + 1)
    nearest = np.rint((at - times[0]) * rate).astype(int)
    indices = nearest[:, None] + offsets
    inside = (indices >= 0) & (indices < len(times))
    indices = np.clip(indices, 0, len(times) - 1)
    u = (times[indices] - at[:, None]) / width
    weight = np.where(inside & (np.abs(u) <= REACH), np.exp(-0.5 * u**2), 0.0)
    powers = u[..., None] ** np.arange(degree + 1)
    read = np.isfinite(readings)
    filled = np.where(read, readings, 0.0)
    n_times, n_channels = len(at), readings.shape[1]
    values = np.full((degree + 1, n_times, n_channels), np.nan)
    variances = np.full((degree + 1, n_times, n_channels), np.inf)
    scale = np.array([1.0, 1.0 / width, 2.0 / width**2])[: degree + 1]
    shared = {}
    for channel in range(n_channels):
        pattern = read[:, channel].tobytes()
        if pattern not in shared:
            shared[pattern] = _operators(weight * read[indices, channel], powers, u, scale)
        rows, known, variance = shared[pattern]
        fitted = np.einsum("dtw,tw->dt", rows, filled[indices, channel])
        values[:, known, channel] = fitted[:, known]
        variances[:, known, channel] = variance[:, known]
    return values, variances


def _operators(weight, powers, u, scale):
    """Weights of the readings in value and derivatives, whether a fit is known, and the variances for unit noise."""
    moments = np.einsum("tw,twi,twj->tij", weight, powers, powers, optimize=True)
    known = ((weight > 0.0).sum(axis=1) >= _FEWEST) & _surrounded(weight, u)
    moments[~known] = np.eye(powers.shape[-1])
    rows = np.einsum("tij,twj,tw->itw", np.linalg.inv(moments), powers, weight, optimize=True)
    rows *= scale[:, None, None]
    return rows, known, (rows**2).sum(axis=-1)


def _surrounded(weight, u):
    """Whether there are readings within one width of the time on both sides, and beyond."""
    used = weight > 0.0
    before, after = (used & (u <= 0.0) & (u > -1.0)).any(axis=1), (used & (u >= 0.0) & (u < 1.0)).any(axis=1)
    far = (used & (u < -1.5)).any(axis=1) & (used & (u > 1.5)).any(axis=1)
    return before & after & far
