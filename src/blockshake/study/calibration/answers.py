"""Which values of a parameter measured tests allow: scores by value, a permutation test, and a conformal interval.

The permutation test asks whether the scores differ beyond chance: with the parameters of the samples exchanged at
random among their runs, no score depends on a value. The conformal interval takes each sample for the measured test in
turn, since its parameters are known.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from blockshake.statistics.resampling import rank_chance
from blockshake.statistics.scores import ensemble_score

LEVEL = 0.95  # of all hypotheses together, and of each interval
SHARES = np.linspace(0.0, 1.0, 41)  # of a parameter's range, at which scores are taken
_PERMUTATIONS = 999
_HALF_WIDTH = 0.2  # of a parameter's range, within which samples count for a value


class Distances(NamedTuple):
    """How far the samples' readings of one test are from the measured ones and from each other."""

    to_test: np.ndarray  # float64 (n_samples,); NaN for a sample without an answer [1]
    between: np.ndarray  # float64 (n_samples, n_samples); symmetric; NaN likewise [1]


def distances(readings, measured):
    """`Distances` of readings of any kind at the same places: times and markers, or frequencies and channels.

    Parameters
    ----------
    readings : float64 array, shape (n_samples, ...)
        With the instrument's noise; NaN all over for a sample without an answer.
    measured : float64 array, shape (...)
        NaN is a gap.

    Notes
    -----
    Differences are taken over the mean difference, at the place, of two readings among those of the test and of all
    samples. Every time and every channel weighs alike: the first millimetres of a slip count as much as the late
    decimetres of rocking that nobody predicts. A place where all read the same is left out.
    """
    readings, measured = np.reshape(readings, (len(readings), -1)), np.reshape(measured, -1)
    answered = np.isfinite(readings).all(axis=1)
    known = np.isfinite(measured)
    every = np.sort(np.concatenate([readings[answered], measured[None]])[:, known], axis=0)
    rank = 2.0 * np.arange(1, len(every) + 1) - len(every) - 1
    scale = 2.0 * rank @ every / (len(every) * max(len(every) - 1, 1))
    known[known], scale = scale > 0.0, scale[scale > 0.0]
    count = len(readings)
    to_test, between = np.full(count, np.nan), np.full((count, count), np.nan)
    if known.any():
        scaled = readings[:, known] / scale
        to_test = np.abs(scaled - measured[known] / scale).mean(axis=1)
        for sample in np.flatnonzero(answered):
            between[sample] = np.abs(scaled - scaled[sample]).mean(axis=1)
    return Distances(to_test, between)


def weights_near(shares, values):
    """Weights of samples for values of a parameter, each row of sum 1, shape (n_values, n_samples).

    Parameters
    ----------
    shares : float64 array, shape (n_samples,)
        Where the samples lie in the parameter's range, 0 to 1.
    values : float64 array, shape (n_values,)
        Likewise.

    Notes
    -----
    Epanechnikov's kernel, a fifth of the range to each side.
    """
    weights = np.maximum(1.0 - ((values[:, None] - shares) / _HALF_WIDTH) ** 2, 0.0)
    return weights / weights.sum(axis=1, keepdims=True)


def weighted_scores(weights, found):
    """`ensemble_score` of weighted samples, mean over the places of `distances`, shape (...,) [1].

    ``weights`` (..., n_samples); ``found``: `Distances`. Samples without an answer have no weight. With equal weights
    the score is 0.5 in the mean where the test is exchangeable with the samples.
    """
    return ensemble_score(*map(np.nan_to_num, found), weights * np.isfinite(found.to_test))


def chance_of_test(found):
    """`rank_chance` of the test's mean distance from the samples among those of the samples from the others [1].

    A test that no sample resembles has the chance 1 / (n_samples + 1).
    """
    answered = np.isfinite(found.to_test)
    count = int(answered.sum())
    if count < 2:
        return np.nan
    own = np.nansum(found.between[np.ix_(answered, answered)], axis=1) / (count - 1)
    return float(rank_chance(found.to_test[answered].mean(), own))


@dataclass(frozen=True)
class Answer:
    """Scores, p-value and interval of one parameter by some tests."""

    score: np.ndarray  # float64 (n_shares,); mean over the tests, as they count, at `SHARES` of the range [1]
    limit: float  # by which the score of the true value exceeds the lowest one at most, at `LEVEL` [1]
    # p-value of scores that differ as much though no test depends on the parameter, for all hypotheses together [1]
    chance: float
    # lower, upper: ends of the conformal interval as shares of the range; 0 and 1 where nothing is known [1]
    lower: float
    upper: float

    @property
    def constrained(self):
        """Whether the scores differ beyond chance."""
        return self.chance <= 1.0 - LEVEL

    @property
    def best(self):
        """Share of the range with the lowest score [1]."""
        return float(SHARES[np.argmin(self.score)])


def answer_hypotheses(hypotheses, seed):
    """`Answer` by hypothesis: whether the score depends on the parameter, and the values that are kept.

    Parameters
    ----------
    hypotheses : dict of hashable to (float64 array, list of Distances)
        Shares of the parameter's range at which the samples lie, shape (n_samples,), and the tests that are used.
        The samples are the same in all.
    seed : int
        Seed of the permutations.

    Notes
    -----
    The statistic of a hypothesis is the range of its scores over the values, standardised by the permuted ones. Its
    p-value is the share of the permutations in which the largest statistic of all hypotheses is as large (max-T,
    Westfall and Young 1993), which keeps the family-wise error rate. Tests are weighted by one over the standard
    deviation of their permuted scores: a reading that follows other parameters, or none, scatters more.
    """
    if not hypotheses:
        return {}
    size = len(next(iter(hypotheses.values()))[0])
    generator = np.random.default_rng(seed)
    permutations = np.array([generator.permutation(size) for _ in range(_PERMUTATIONS)])
    scores, test_weights, statistics, permuted_statistics = {}, {}, {}, []
    for name, (shares, tests) in hypotheses.items():
        weights = weights_near(shares, SHARES)
        permuted = weights[:, permutations].transpose(1, 0, 2)
        by_test = np.array([weighted_scores(permuted, test) for test in tests])
        test_weights[name] = 1.0 / np.maximum(by_test.std(axis=1).mean(axis=1), np.finfo(float).tiny)
        scores[name] = np.average([weighted_scores(weights, test) for test in tests], 0, test_weights[name])
        spreads = np.ptp(np.average(by_test, 0, test_weights[name]), axis=-1)
        mean, deviation = spreads.mean(), max(spreads.std(), np.finfo(float).tiny)
        statistics[name] = (np.ptp(scores[name]) - mean) / deviation
        permuted_statistics.append((spreads - mean) / deviation)
    largest = np.max(permuted_statistics, axis=0)
    answers = {}
    for name, (shares, tests) in hypotheses.items():
        chance = float(rank_chance(statistics[name], largest))
        score, limit, lower, upper = scores[name], np.inf, 0.0, 1.0
        if chance <= 1.0 - LEVEL:
            limit = excess_of_truth(shares, tests, test_weights[name])
            kept = np.flatnonzero(score - score.min() <= limit)
            lower, upper = float(SHARES[kept[0]]), float(SHARES[kept[-1]])
        answers[name] = Answer(score, limit, chance, lower, upper)
    return answers


def excess_of_truth(shares, tests, test_weights):
    """Conformal limit: by how much the score of the true value exceeds the lowest score at most, at `LEVEL` [1].

    ``shares`` and ``tests`` as of a hypothesis of `answer_hypotheses`; ``test_weights``: one for each test.

    Notes
    -----
    Every sample takes the place of the tests once: the others predict its readings, and its own value is the truth. If
    the model is right, the measured readings are exchangeable with those of the samples, and the true value is kept
    with the probability `LEVEL` (conformal inference: Vovk, Gammerman and Shafer 2005). The limit is infinite with too
    few samples for that level.
    """
    weights = weights_near(shares, SHARES)
    excesses = []
    for sample, truth in enumerate(shares):
        answered = [place for place, test in enumerate(tests) if np.isfinite(test.to_test[sample])]
        if answered:
            scores = [weighted_scores(weights, _sample_as_test(sample, tests[place])) for place in answered]
            score = np.average(scores, 0, test_weights[answered])
            excesses.append(np.interp(truth, SHARES, score) - score.min())
    rank = int(np.ceil(LEVEL * (len(excesses) + 1)))
    return float(np.sort(excesses)[rank - 1]) if rank <= len(excesses) else np.inf


def _sample_as_test(sample, test):
    """`Distances` with a sample in place of the measured test, and left out of the ensemble."""
    to_sample = test.between[sample].copy()
    to_sample[sample] = np.nan
    return Distances(to_sample, test.between)
