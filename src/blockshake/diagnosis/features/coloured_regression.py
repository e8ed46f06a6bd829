"""Least squares in time with errors that hold where the residuals are coloured."""

from typing import NamedTuple

import numpy as np

_TIMES_PER_COEFFICIENT = 10  # times per coefficient
_LARGEST_MEMORY = 0.97  # of the prewhitening's singular values: Andrews and Monahan (1992)


class Regression(NamedTuple):
    """Coefficients and their standard deviations, each of shape (n_regressors,)."""

    coefficients: np.ndarray
    errors: np.ndarray


def coloured_regression(response, regressors):
    """Coefficients of regressors beside a constant, and their standard deviations.

    Parameters
    ----------
    response : float64 array, shape (n_times,)
        NaN is left out.
    regressors : float64 array, shape (n_times, n_regressors)
        Finite.

    Returns
    -------
    Regression
        In the response's unit over the regressor's; errors infinite and coefficients zero where there are fewer
        than ten times a coefficient or the regressors depend on each other.

    Notes
    -----
    Errors from the long-run covariance of regressors times residuals: prewhitened by a first-order vector
    autoregression (Andrews and Monahan 1992, Econometrica 60), Bartlett's kernel (Newey and West 1987) at Andrews'
    bandwidth (1991, Econometrica 59, eqs. 6.2 and 6.4), coloured again.
    """
    there = np.isfinite(response)
    size = np.sqrt((regressors[there] ** 2).mean(axis=0)) if there.any() else np.zeros(regressors.shape[1])
    n_times, n_terms = int(there.sum()), regressors.shape[1] + 1
    nothing = Regression(np.zeros(n_terms - 1), np.full(n_terms - 1, np.inf))
    if n_times < _TIMES_PER_COEFFICIENT * n_terms or not (size > 0.0).all():
        return nothing
    terms = np.column_stack([regressors[there] / size, np.ones(n_times)])
    normal = terms.T @ terms
    if np.linalg.cond(normal) > 1e10:
        return nothing
    inverse = np.linalg.inv(normal)
    coefficients = inverse @ (terms.T @ response[there])
    scores = terms * (response[there] - terms @ coefficients)[:, None]
    covariance = inverse @ _long_run(scores) @ inverse * (n_times**2 / (n_times - n_terms))
    errors = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return Regression(coefficients[:-1] / size, errors[:-1] / size)


def _long_run(scores):
    """Covariance of the scores summed over all lags, (n_terms, n_terms)."""
    if not scores.any():
        return np.zeros((scores.shape[1],) * 2)
    memory = np.linalg.lstsq(scores[:-1], scores[1:], rcond=None)[0]
    left, values, right = np.linalg.svd(memory)
    memory = left @ np.diag(np.minimum(values, _LARGEST_MEMORY)) @ right
    white = scores[1:] - scores[:-1] @ memory
    n_times = len(white)
    total = white.T @ white / n_times
    bandwidth = _bandwidth(white)
    for lag in range(1, min(int(bandwidth), n_times // 3) + 1):
        shifted = white[lag:].T @ white[:-lag] / n_times
        total += (1.0 - lag / (bandwidth + 1.0)) * (shifted + shifted.T)
    colour = np.linalg.inv(np.eye(len(memory)) - memory)
    return colour.T @ total @ colour


def _bandwidth(series):
    """Bartlett bandwidth from first-order autoregressions of each series."""
    before, after = series[:-1], series[1:]
    power = (before**2).sum(axis=0)
    rho = np.clip((before * after).sum(axis=0) / np.where(power > 0.0, power, 1.0), -0.97, 0.97)
    variance = ((after - rho * before) ** 2).mean(axis=0)
    numerator = (4.0 * rho**2 * variance**2 / ((1.0 - rho) ** 6 * (1.0 + rho) ** 2)).sum()
    denominator = (variance**2 / (1.0 - rho) ** 4).sum()
    return 1.1447 * (numerator / denominator * len(series)) ** (1.0 / 3.0) if denominator > 0.0 else 0.0
