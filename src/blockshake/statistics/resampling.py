"""How sure a statistic is, from its samples drawn or dealt again: intervals, and what chance alone reaches."""

from math import comb

import numpy as np

from blockshake.statistics.intervals import CONFIDENCE, sample_quantiles
from blockshake.statistics.scores import ensemble_distance

DRAWS = 400  # a tail of 2.5 % then rests on ten draws


def resampled_weights(size, generator, draws=DRAWS):
    """How often each member is drawn in a bootstrap, float64 (1 + draws, size); once each in the first row."""
    drawn = generator.multinomial(size, np.full(size, 1.0 / size), size=draws).astype(float)
    return np.concatenate([np.ones((1, size)), drawn])


def limits_of(drawn, confidence=CONFIDENCE):
    """Bootstrap interval of values along the first axis: float64 array, shape (2, ...)."""
    tail = 0.5 - 0.5 * confidence
    return sample_quantiles(drawn, (tail, 1.0 - tail))


def bootstrap_interval(statistic, samples, generator, draws=DRAWS):
    """Interval of 95 % of a statistic from samples drawn again with replacement.

    Parameters
    ----------
    statistic : callable
        ``statistic(*samples)`` -> float64 array.
    samples : sequence of float64 arrays, shapes (n_samples, ...)
        Drawn together.
    generator : numpy.random.Generator
    draws : int

    Returns
    -------
    float64 array, shape (2, ...)
        Quantiles of the drawn statistics, shifted so that their mean is the statistic of the samples themselves.

    Notes
    -----
    Samples drawn twice agree with themselves and raise what a class mean explains; the shift takes that out (as the
    bias-reducing estimate of Plischke, Borgonovo and Smith 2013 does). The pairing in a Latin hypercube makes
    estimates a little steadier than independent draws: the interval errs on the wide side.
    """
    size = len(samples[0])
    drawn = []
    for _ in range(draws):
        rows = generator.integers(0, size, size)
        drawn.append(statistic(*(values[rows] for values in samples)))
    tails = (0.5 - 0.5 * CONFIDENCE, 0.5 + 0.5 * CONFIDENCE)
    return np.quantile(drawn, tails, axis=0) - np.mean(drawn, axis=0) + statistic(*samples)


def chance_level(statistic, inputs, outputs, generator, draws=DRAWS):
    """Level that the largest of all measures stays below in 95 of 100 cases where no input has any effect.

    Parameters
    ----------
    statistic : callable
        ``statistic(inputs, outputs)`` -> float64 array.
    inputs, outputs : float64 arrays, shapes (n_samples, ...)
    generator : numpy.random.Generator
    draws : int

    Returns
    -------
    float
        Quantile of the largest absolute measure over all outputs and inputs, the outputs' rows permuted together; NaN
        where nothing is defined.

    Notes
    -----
    One level for all pairs (Westfall and Young 1993): if nothing matters, one picture in twenty has any point beyond
    the level of 95 %. Markers of one run move together, and the permutation keeps that.
    """
    largest = np.full(draws, np.nan)
    for index in range(draws):
        measures = np.abs(statistic(inputs, outputs[generator.permutation(len(outputs))]))
        if np.isfinite(measures).any():
            largest[index] = np.nanmax(measures)
    return float(np.quantile(largest, CONFIDENCE))


def chance_distance(differences, first, second, generator):
    """Distance that 95 of 100 random divisions of all members into ensembles of these sizes stay below.

    The arguments are those of `ensemble_distance`. NaN where the members are so few that a twentieth of their divisions
    or more are as far apart as the farthest. A sample that both models ran makes the ensembles more alike than the
    division takes them to be, so that a distance beyond this level is rarer by chance than stated.
    """
    # the same two groups come twice where they are of one size
    alike = (1 + (len(first) == len(second))) / comb(len(first) + len(second), len(first))
    if alike >= 1.0 - CONFIDENCE:
        return np.nan
    pooled, size = np.concatenate([first, second]), len(first)
    drawn = []
    for _ in range(DRAWS):
        mixed = generator.permutation(pooled)
        drawn.append(ensemble_distance(differences, mixed[:size], mixed[size:]))
    return float(np.quantile(drawn, CONFIDENCE))


def rank_chance(value, others):
    """Chance of a value as large if it were one more of the others: float64 (...), from 1 / (n + 1) to 1; NaN of NaN.

    ``value`` (...), ``others`` (n, ...).
    """
    return np.where(np.isnan(value), np.nan, (1.0 + (others >= value).sum(axis=0)) / (1.0 + len(others)))
