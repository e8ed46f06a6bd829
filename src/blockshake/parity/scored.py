"""Sizes of faults whose errors come from the scatter between segments of the records."""

from dataclasses import dataclass

import numpy as np

from blockshake.parity.finding import chance_within

FEWEST_SEGMENTS = 4  # segments that carry the information


@dataclass(frozen=True)
class Scored:
    """A linear estimate whose error comes from the scatter between segments.

    Attributes
    ----------
    estimate, covariance : float64 arrays, shapes (n,), (n, n)
    freedom : float
        Degrees of freedom behind the covariance.
    """

    estimate: np.ndarray
    covariance: np.ndarray
    freedom: float

    def part(self, index):
        """One component alone."""
        return Scored(self.estimate[[index]], self.covariance[[index]][:, [index]], self.freedom)

    def finding(self, kind, where, tests, tolerance, level, length=1.0):
        """List of the `Finding`, empty where a sound sensor may have as much.

        Parameters
        ----------
        kind : Kind
        where, tests
            As in `Finding`.
        tolerance : float
            What a sound sensor may have.
        level : Level
        length : float
            Of the record, of an estimate that is a change over it and a rate in the finding [s].
        """
        p = level.hypotheses * chance_within(self.estimate, self.covariance, tolerance, self.freedom)
        rate, square = self.estimate / length, self.covariance / length**2
        return [kind.finding(where, p, tests, rate, square)] if p < level.chance else []


def scored(estimate, normal, scores):
    """`Scored` with a sandwich covariance, and as many degrees of freedom as segments carry weight; None of too few.

    Parameters
    ----------
    estimate, normal : float64 arrays, shapes (n,), (n, n)
    scores : sequence of float64 array, shape (n,)
        By segment.
    """
    scores = np.array(scores)
    power = (scores**2).sum(axis=1)
    if len(scores) < FEWEST_SEGMENTS or not power.sum():
        return None
    effective = power.sum() ** 2 / (power**2).sum()
    freedom = max(0.5 * (len(scores) + effective) - len(estimate), 1.0)
    inverse = np.linalg.inv(normal)
    covariance = inverse @ (scores.T @ scores) @ inverse * len(scores) / max(len(scores) - len(estimate), 1)
    return Scored(estimate, covariance, freedom)


def by_segment(scores, since, length):
    """Sums of scores (n_times, ...) over segments of a length of the times since the record's start, list."""
    segment = np.floor(since / length)
    return [scores[segment == one].sum(axis=0) for one in np.unique(segment)]
