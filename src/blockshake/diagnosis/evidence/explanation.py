"""The explanation of the rows by a cause at a place: its evidence, and the forces that it would have made."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.special import logsumexp

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

    @property
    def contrast(self):
        """Weights by which the amplitudes together are one of the first column, (n_amplitudes,)."""
        if len(self.mean) == 1:
            return np.ones(1)
        columns = np.concatenate(self.columns)
        square = float(columns[:, 0] @ columns[:, 0])
        return columns[:, 0] @ columns / square if square > 0.0 else np.eye(len(self.mean))[0]


@dataclass(frozen=True)
class Explanation:
    """A cause at a place beside one likelihood."""

    cause: str  # an effect of the registry, or a form from outside
    place: str  # where it acts
    gain: float  # logarithm of the evidence over that of no cause, averaged over what is searched
    fits: tuple  # of Fit; variants that matter
    # float64 (n_variants,); by variant, before the average; empty where a search has no fixed variants
    gains: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def best(self):
        """The likeliest `Fit`."""
        return max(self.fits, key=lambda fit: fit.gain)

    @property
    def rows(self):
        """Rows of the forces at the best amplitudes, one array (n_rows,) a test."""
        return [column @ self.best.mean for column in self.best.columns]


def mean_evidence(gains):
    """Logarithm of the mean of evidences given by their logarithms."""
    return logsumexp(gains) - np.log(np.size(gains))


def best_of(likelihood, cause, place, variants):
    """`Explanation` by variants of the same prior, `Columns` by variant and test, whose evidences are averaged."""
    widths = [variant[0].rows.shape[1] for variant in variants]
    stacked = [
        np.concatenate([variant[test].rows for variant in variants], axis=1)
        for test in range(len(variants[0]))
    ]
    whitened = np.split(likelihood.whiten(stacked), np.cumsum(widths)[:-1], axis=1)
    fitted = [
        likelihood.amplitudes(rows, variant[0].scales, variant[0].positive)
        for rows, variant in zip(whitened, variants, strict=True)
    ]
    gains = np.array([amplitudes.gain for amplitudes in fitted])
    fits = []
    for variant, amplitudes in zip(variants, fitted, strict=True):
        if amplitudes.gain > gains.max() - _NEGLIGIBLE:
            first, columns = variant[0], [test.rows for test in variant]
            scales = np.atleast_1d(first.scales or 1.0)
            posterior = amplitudes.mean, amplitudes.covariance
            fits.append(Fit(first.values, amplitudes.gain, columns, scales, *posterior, first.positive))
    return Explanation(cause, place, float(mean_evidence(gains)), tuple(fits), gains)


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
