"""The explanation of the rows by a cause at a place: its evidence, and the forces that it would have made."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.special import log_ndtr, logsumexp

NEVER = -1e3  # nats, of what cannot be
_NEGLIGIBLE = 12.0  # nats below the best variant


@dataclass(frozen=True)
class Fit:
    """One variant of a cause at a place, its amplitudes fitted."""

    values: dict  # what the variant is: parameters that are not amplitudes
    gain: float  # logarithm of the evidence over that of no cause
    columns: list  # of float64 array, shape (n_rows, n_amplitudes); by test
    scales: np.ndarray  # float64 (n_amplitudes,); standard deviations of the amplitudes' priors
    mean: np.ndarray  # float64 (n_amplitudes,)
    covariance: np.ndarray  # float64 (n_amplitudes, n_amplitudes)
    positive: bool = False  # the first amplitude is not negative
    most: float = np.inf  # magnitude of the size, beyond which no structure has it
    apart: bool = False  # every amplitude is a size of its own

    @property
    def size(self):
        """Mean and standard deviation of the amplitudes as one of the first column, or of the first alone."""
        variance = float(self.contrast @ self.covariance @ self.contrast)
        return float(self.contrast @ self.mean), float(np.sqrt(max(variance, 0.0)))

    @cached_property
    def contrast(self):
        """Weights by which the amplitudes together are one of the first column, (n_amplitudes,)."""
        if len(self.mean) == 1 or self.apart:
            return np.eye(len(self.mean))[0]
        columns = np.concatenate(self.columns)
        square = float(columns[:, 0] @ columns[:, 0])
        return columns[:, 0] @ columns / square if square > 0.0 else np.eye(len(self.mean))[0]


@dataclass(frozen=True)
class Explanation:
    """A cause at a place under one noise model."""

    cause: str  # an effect of the registry, or a form from outside
    place: str  # where it acts
    gain: float  # logarithm of the evidence over that of no cause, averaged over what is searched
    fits: tuple  # of Fit; variants that matter
    # float64 (n_variants,); by variant, before the average; empty where a search has no fixed variants
    gains: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def best(self):
        """The most probable `Fit`."""
        return max(self.fits, key=lambda fit: fit.gain)

    @property
    def rows(self):
        """Rows of the forces at the best amplitudes, one array (n_rows,) a test."""
        return [column @ self.best.mean for column in self.best.columns]


def mean_evidence(gains):
    """Logarithm of the mean of evidences given by their logarithms."""
    return logsumexp(gains) - np.log(np.size(gains))


def best_of(likelihood, cause, place, variants):
    """`Explanation` by variants of the same prior, `DesignMatrix` by variant and test, whose evidences are averaged."""
    widths = [variant[0].rows.shape[1] for variant in variants]
    stacked = [
        np.concatenate([variant[test].rows for variant in variants], axis=1)
        for test in range(len(variants[0]))
    ]
    whitened = np.split(likelihood.whiten(stacked), np.cumsum(widths)[:-1], axis=1)
    fits = []
    for rows, (first, *others) in zip(whitened, variants, strict=True):
        amplitudes = likelihood.amplitudes(rows, first.scales, first.positive)
        columns, scales = [test.rows for test in (first, *others)], np.atleast_1d(first.scales or 1.0)
        posterior = amplitudes.mean, amplitudes.covariance
        fits.append(within(Fit(first.values, amplitudes.gain, columns, scales, *posterior, *first[3:])))
    gains = np.array([fit.gain for fit in fits])
    chosen = tuple(fit for fit in fits if fit.gain > gains.max() - _NEGLIGIBLE)
    return Explanation(cause, place, float(mean_evidence(gains)), chosen, gains)


def within(fit):
    """A `Fit` whose size no structure exceeds: its evidence by the share of posterior and prior within, rows cut off.

    With the prior cut off at ``most``, the evidence is multiplied by the ratio of both shares.
    """
    if not np.isfinite(fit.most):
        return fit
    size, deviation = fit.size
    prior = float(np.sqrt(fit.contrast**2 @ fit.scales**2))
    gain = fit.gain + _log_share(size, deviation, fit.most) - _log_share(0.0, prior, fit.most)
    return replace(fit, gain=float(gain), mean=fit.mean * min(1.0, fit.most / max(abs(size), 1e-300)))


def _log_share(mean, deviation, most):
    """Logarithm of the chance that a Gaussian size lies between ``-most`` and ``most``."""
    upper, lower = log_ndtr((most - abs(mean)) / deviation), log_ndtr((-most - abs(mean)) / deviation)
    return upper + np.log1p(-np.exp(lower - upper))


def single(cause, place, gain, columns, scale, fitted, values):
    """`Explanation` by one amplitude, its best value and standard deviation ``fitted``.

    ``columns`` are by test, (n_rows,) each, per unit of the amplitude, and ``gain`` is averaged over what was searched.
    """
    mean, deviation = fitted
    fit = Fit(
        values, float(gain), [column[:, None] for column in columns], np.array([scale]), np.array([mean]),
        np.array([[deviation**2]]),
    )  # fmt: skip
    return Explanation(cause, place, float(gain), (fit,))
