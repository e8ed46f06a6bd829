"""A stop on either side of a block, or one on each: all gaps of both sides together."""

import numpy as np
from scipy.special import log_ndtr

from blockshake.diagnosis.evidence.explanation import NEVER, Explanation, Fit, mean_evidence
from blockshake.diagnosis.evidence.likelihood import gain_of_one

_NEGLIGIBLE = 8.0  # nats below the best gaps


def explain_stops(likelihood, place, variants):
    """`Explanation` of springs beyond gaps at one point.

    ``variants`` are `DesignMatrix` by gap and test, all of the side of +x first, from the smallest gap on. Where the
    smallest on both sides are best it is no stop but a spring to either side: its evidence is none.
    """
    half = len(variants) // 2
    rows = [np.concatenate([one[test].rows for one in variants], axis=1) for test in range(len(variants[0]))]
    scale = variants[0][0].scales[0]
    target, gram = likelihood.normal_equations(likelihood.whiten(rows))
    alone = gain_of_one(target, np.diag(gram), scale, True)[0]
    both, _ = _gains_of_pairs(target, gram, half, scale)
    sides = [mean_evidence(alone[:half]), mean_evidence(alone[half:]), mean_evidence(both)]
    best = max(alone.max(), both.max())
    spring = best > _NEGLIGIBLE and both[0, 0] == best
    chosen = [([index], gain) for index, gain in enumerate(alone) if gain > best - _NEGLIGIBLE]
    chosen += [
        ([first, half + second], both[first, second])
        for first, second in np.argwhere(both > best - _NEGLIGIBLE)
    ]
    fits = tuple(_fit(index, gain, target, gram, scale, rows, variants) for index, gain in chosen)
    return Explanation("stopper-contact", place, NEVER if spring else float(mean_evidence(sides)), fits)


def _fit(index, gain, target, gram, scale, rows, variants):
    """`Fit` of a stop on one side, or of two on both."""
    covariance = np.linalg.inv(gram[np.ix_(index, index)] + np.eye(len(index)) * scale**-2.0)
    sides = [variants[one][0].values for one in index]
    return Fit(
        {"gaps": {f"{one['side']:+d}": one["gap"] for one in sides}}, float(gain), [one[:, index] for one in rows],
        np.full(len(index), scale), covariance @ target[index], covariance, positive=True,
    )  # fmt: skip


def _gains_of_pairs(target, gram, half, scale):
    """Gains of one column of each half together, (half, half), and their means, (2, half, half); both not negative."""
    first, second = slice(None, half), slice(half, None)
    a, d, b = (
        np.diag(gram)[first, None] + scale**-2.0,
        np.diag(gram)[None, second] + scale**-2.0,
        gram[first, second],
    )
    of_first, of_second = target[first, None], target[None, second]
    determinant = a * d - b * b
    means = np.stack(
        [(d * of_first - b * of_second) / determinant, (a * of_second - b * of_first) / determinant]
    )
    gain = 0.5 * (of_first * means[0] + of_second * means[1]) - 0.5 * np.log(determinant * scale**4)
    gain += (
        np.log(4.0)
        + log_ndtr(means[0] * np.sqrt(determinant / d))
        + log_ndtr(means[1] * np.sqrt(determinant / a))
    )
    return gain, means
