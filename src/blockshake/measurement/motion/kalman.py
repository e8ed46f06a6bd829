"""Kalman filter and Rauch-Tung-Striebel smoother of one axis of the base's motion, compiled."""

import numpy as np

from blockshake.jit import inner_kernel, kernel

# States
DISPLACEMENT, VELOCITY, ACCELERATION, OFFSET, N_STATES = 0, 1, 2, 3, 4


# Cholesky factor of the covariance of integrated white jerk over a unit step, density one
_UNIT_STEP = np.linalg.cholesky(
    np.array([[1 / 20, 1 / 8, 1 / 6], [1 / 8, 1 / 3, 1 / 2], [1 / 6, 1 / 2, 1.0]])
)


@kernel
def walk_into(time, jerk_density, normals, states):
    """A motion that white jerk makes, drawn with the numbers given.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        Increasing [s].
    jerk_density : float
        [m2/s5]
    normals : float64 array, shape (n_times, 3)
        Independent standard normal numbers; the first row is not used.
    states : float64 array, shape (n_times, N_STATES)
        First row: the first state. The others are overwritten.
    """
    F = np.eye(N_STATES)
    for k in range(1, time.size):
        step = time[k] - time[k - 1]
        _transition_into(step, F)
        states[k] = F @ states[k - 1]
        for i in range(3):
            scale = np.sqrt(jerk_density) * step ** (2.5 - i)
            for j in range(i + 1):
                states[k, i] += scale * _UNIT_STEP[i, j] * normals[k, j]


@kernel
def smooth(time, marker, marker_variance, reading, reading_variance, jerk_density, mean, covariance):
    """Smooth one axis over all its readings.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        Increasing [s].
    marker, reading : float64 arrays, shape (n_times,)
        Displacement [m] and acceleration with a constant offset [m/s2]; NaN where there is none.
    marker_variance, reading_variance : float
        Variances of independent errors [m2, m2/s4].
    jerk_density : float
        Spectral density of the white jerk that drives the acceleration [m2/s5].
    mean : float64 array, shape (n_times, N_STATES)
        First row: the state expected at the first time, before its readings. Overwritten with the smoothed states:
        displacement, velocity, acceleration [m, m/s, m/s2] and offset of the accelerometer [m/s2].
    covariance : float64 array, shape (n_times, N_STATES, N_STATES)
        First entry: that of the state expected. Overwritten with the smoothed covariances.

    Returns
    -------
    float
        Logarithm of the likelihood of the readings, without its constant.

    Notes
    -----
    Filter and smoother as in Särkkä (2013), Bayesian Filtering and Smoothing, chapters 4 and 8. The covariance of
    integrated white jerk over a step h has the entries h^5/20, h^4/8, h^3/6, h^3/3, h^2/2, h times the density.
    Scalar readings are taken in one after the other, so that no matrix is inverted in the filter.
    """
    n_times = time.size
    expected = np.empty((n_times, N_STATES))
    expected_covariance = np.empty((n_times, N_STATES, N_STATES))
    F = np.eye(N_STATES)
    likelihood = 0.0
    m, P = mean[0].copy(), covariance[0].copy()
    for k in range(n_times):
        if k > 0:
            _transition_into(time[k] - time[k - 1], F)
            m = F @ m
            P = F @ P @ F.T
            _add_process_noise_into(time[k] - time[k - 1], jerk_density, P)
        expected[k], expected_covariance[k] = m, P
        if not np.isnan(marker[k]):
            likelihood += _take_in(marker[k], marker_variance, False, m, P)
        if not np.isnan(reading[k]):
            likelihood += _take_in(reading[k], reading_variance, True, m, P)
        mean[k], covariance[k] = m, P
    for k in range(n_times - 2, -1, -1):
        _transition_into(time[k + 1] - time[k], F)
        # gain G = P F' (F P F' + Q)^-1, by solving with the symmetric matrix
        gain = np.linalg.solve(expected_covariance[k + 1], F @ covariance[k]).T
        mean[k] += gain @ (mean[k + 1] - expected[k + 1])
        covariance[k] += gain @ (covariance[k + 1] - expected_covariance[k + 1]) @ gain.T
    return likelihood


@inner_kernel
def _transition_into(step, F):
    F[DISPLACEMENT, VELOCITY] = F[VELOCITY, ACCELERATION] = step
    F[DISPLACEMENT, ACCELERATION] = 0.5 * step * step


@inner_kernel
def _add_process_noise_into(step, density, P):
    h2 = step * step
    Q = (density * step * h2 * h2 / 20.0, density * h2 * h2 / 8.0, density * step * h2 / 6.0)
    P[0, 0] += Q[0]
    P[0, 1] += Q[1]
    P[1, 0] += Q[1]
    P[0, 2] += Q[2]
    P[2, 0] += Q[2]
    P[1, 1] += density * step * h2 / 3.0
    P[1, 2] += density * h2 / 2.0
    P[2, 1] += density * h2 / 2.0
    P[2, 2] += density * step


@inner_kernel
def _take_in(value, variance, is_acceleration, m, P):
    """Update mean and covariance with one reading in place; its log-likelihood is returned."""
    if is_acceleration:
        column = P[:, ACCELERATION] + P[:, OFFSET]
        innovation = value - m[ACCELERATION] - m[OFFSET]
        spread = column[ACCELERATION] + column[OFFSET] + variance
    else:
        column = P[:, DISPLACEMENT].copy()
        innovation = value - m[DISPLACEMENT]
        spread = column[DISPLACEMENT] + variance
    m += column * (innovation / spread)
    for i in range(N_STATES):
        for j in range(N_STATES):
            P[i, j] -= column[i] * column[j] / spread
    return -0.5 * (innovation * innovation / spread + np.log(spread))
