"""Sizes of faults by least squares, whose errors come from the scatter between segments of the records."""

from dataclasses import dataclass

import numpy as np

from blockshake.parity.finding import chance_within

_FEWEST_SEGMENTS = 4  # that carry the information


@dataclass(frozen=True)
class Size:
    """A linear estimate."""

    # estimate, covariance: float64 (n,), (n, n)
    estimate: np.ndarray
    covariance: np.ndarray
    freedom: float  # degrees of freedom behind the covariance

    def part(self, index):
        """One component alone."""
        return Size(self.estimate[[index]], self.covariance[[index]][:, [index]], self.freedom)

    def finding(self, kind, where, tests, tolerance, level, length=1.0):
        """List of the `Finding`, empty where a faultless sensor may have as much.

        Parameters
        ----------
        kind : Kind
        where, tests
            As in `Finding`.
        tolerance : float
            What a faultless sensor may have.
        level : Level
        length : float
            Of the record, of an estimate that is a change over it and a rate in the finding [s].
        """
        p = level.hypotheses * chance_within(self.estimate, self.covariance, tolerance, self.freedom)
        rate, square = self.estimate / length, self.covariance / length**2
        return [kind.finding(where, p, tests, rate, square)] if p < level.chance else []


def regression(parts, segment, ridge=0.0):
    """Regress the values of all parts on their columns: `Size`, or None where there are too few segments.

    Parameters
    ----------
    parts : sequence of (columns, values, since)
        Shapes (n, k), (n,), (n,), the times counted from the start of the record [s].
    segment : float
        Length within which residuals depend on each other [s].
    ridge : float or float64 array, shape (k,)
        Added to the squares of the columns.

    Notes
    -----
    The covariance is that of a sandwich, with as many degrees of freedom as segments carry weight.
    """
    normal = sum(columns.T @ columns for columns, _, _ in parts)
    normal = normal + ridge * np.eye(len(normal))
    if not np.diagonal(normal).all():
        return None
    inverse = np.linalg.inv(normal)
    estimate = inverse @ sum(columns.T @ values for columns, values, _ in parts)
    scores = []
    for columns, values, since in parts:
        score, numbers = columns * (values - columns @ estimate)[:, None], np.floor(since / segment)
        scores += [score[numbers == number].sum(axis=0) for number in np.unique(numbers)]
    scores, size = np.array(scores), len(estimate)
    power = (scores**2).sum(axis=1)
    if len(scores) < max(_FEWEST_SEGMENTS, size + 1) or not power.sum():
        return None
    effective = power.sum() ** 2 / (power**2).sum()
    freedom = max(0.5 * (len(scores) + effective) - size, 1.0)
    covariance = inverse @ (scores.T @ scores) @ inverse * len(scores) / (len(scores) - size)
    return Size(estimate, covariance, freedom)
