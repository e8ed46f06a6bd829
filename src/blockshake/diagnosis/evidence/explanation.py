"""The explanation of the rows by a cause at a place: its evidence, and the forces that it would have made."""

from dataclasses import dataclass, field

import numpy as np
from scipy.special import logsumexp


@dataclass(frozen=True)
class Explanation:
    """A cause at a place beside one likelihood.

    Attributes
    ----------
    cause : str
        An effect of the registry, or a form from outside.
    place : str
        Where it acts.
    gain : float
        Logarithm of the evidence over that of no cause, averaged over what is searched.
    columns : list of float64 array, shape (n_rows, n_amplitudes)
        By test, of the best variant.
    scales : float64 array, shape (n_amplitudes,)
        Standard deviations of the amplitudes' priors.
    mean : float64 array, shape (n_amplitudes,)
        Best amplitudes.
    covariance : float64 array, shape (n_amplitudes, n_amplitudes)
    values : dict
        What the best variant is.
    gains : float64 array, shape (n_variants,)
        By variant, before the average.
    """

    cause: str
    place: str
    gain: float
    columns: list
    scales: np.ndarray
    mean: np.ndarray
    covariance: np.ndarray
    values: dict = field(default_factory=dict)
    gains: np.ndarray = field(default_factory=lambda: np.zeros(0))

    @property
    def rows(self):
        """Rows of the forces at the best amplitudes, one array (n_rows,) a test."""
        return [column @ self.mean for column in self.columns]


def mean_evidence(gains, axis=None):
    """Logarithm of the mean of evidences given by their logarithms."""
    gains = np.asarray(gains)
    count = gains.size if axis is None else gains.shape[axis]
    return logsumexp(gains, axis=axis) - np.log(count)


def best_of(likelihood, cause, place, variants):
    """`Explanation` by variants of the same prior, whose evidences are averaged.

    Parameters
    ----------
    likelihood : Likelihood
    cause, place : str
    variants : list of list of Columns
        By variant and test.
    """
    widths = [variant[0].rows.shape[1] for variant in variants]
    stacked = [
        np.concatenate([variant[test].rows for variant in variants], axis=1)
        for test in range(len(variants[0]))
    ]
    whitened = np.split(likelihood.whiten(stacked), np.cumsum(widths)[:-1], axis=1)
    found = [
        likelihood.amplitudes(rows, variant[0].scales, variant[0].positive)
        for rows, variant in zip(whitened, variants, strict=True)
    ]
    gains = np.array([one.gain for one in found])
    best = int(np.argmax(gains))
    return Explanation(
        cause,
        place,
        float(mean_evidence(gains)),
        [one.rows for one in variants[best]],
        np.atleast_1d(variants[best][0].scales or 1.0),
        found[best].mean,
        found[best].covariance,
        variants[best][0].values,
        gains,
    )


def single(cause, place, gain, columns, scale, mean, values):
    """`Explanation` by one amplitude.

    Parameters
    ----------
    gain : float
        Averaged over what was searched.
    columns : list of float64 array, shape (n_rows,)
        By test, per unit of the amplitude.
    scale, mean : float
    values : dict
    """
    return Explanation(
        cause, place, float(gain), [column[:, None] for column in columns], np.array([scale]), np.array([mean]),
        np.zeros((1, 1)), values,
    )  # fmt: skip
