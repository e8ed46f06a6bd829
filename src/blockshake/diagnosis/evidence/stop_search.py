"""A stop on either side of a block, or one on each: all gaps of both sides together."""

import numpy as np
from scipy.special import log_ndtr

from blockshake.diagnosis.evidence.explanation import Explanation, mean_evidence
from blockshake.diagnosis.evidence.likelihood import gain_of_one


def explain_stops(likelihood, place, variants):
    """`Explanation` of springs beyond gaps at one point.

    Parameters
    ----------
    likelihood : Likelihood
    place : str
    variants : list of list of Columns
        By gap and test, all of the side of +x first.
    """
    half = len(variants) // 2
    rows = [np.concatenate([one[test].rows for one in variants], axis=1) for test in range(len(variants[0]))]
    scale = variants[0][0].scales[0]
    target, gram = likelihood.normal_equations(likelihood.whiten(rows))
    alone, means = gain_of_one(target, np.diag(gram), scale, True)
    both, pairs = _gains_of_pairs(target, gram, half, scale)
    sides = [mean_evidence(alone[:half]), mean_evidence(alone[half:]), mean_evidence(both)]
    kind = int(np.argmax(sides))
    if kind == 2:
        first, second = np.unravel_index(np.argmax(both), both.shape)
        chosen, mean = [first, half + second], pairs[:, first, second]
    else:
        chosen = [kind * half + int(np.argmax(alone[kind * half : (kind + 1) * half]))]
        mean = means[chosen]
    values = [variants[index][0].values for index in chosen]
    return Explanation(
        "stopper-contact",
        place,
        float(mean_evidence(sides)),
        [one[:, chosen] for one in rows],
        np.full(len(chosen), scale),
        mean,
        np.linalg.inv(gram[np.ix_(chosen, chosen)] + np.eye(len(chosen)) * scale**-2.0),
        {"gaps": {f"{one['side']:+d}": one["gap"] for one in values}},
    )


def _gains_of_pairs(target, gram, half, scale):
    """Gains of one column of each half together, (half, half), and their means, (2, half, half); both not negative."""
    first, second = slice(None, half), slice(half, None)
    a, d, b = (
        np.diag(gram)[first, None] + scale**-2.0,
        np.diag(gram)[None, second] + scale**-2.0,
        gram[first, second],
    )
    left, right = target[first, None], target[None, second]
    determinant = a * d - b * b
    means = np.stack([(d * left - b * right) / determinant, (a * right - b * left) / determinant])
    gain = 0.5 * (left * means[0] + right * means[1]) - 0.5 * np.log(determinant * scale**4)
    gain += (
        np.log(4.0)
        + log_ndtr(means[0] * np.sqrt(determinant / d))
        + log_ndtr(means[1] * np.sqrt(determinant / a))
    )
    return gain, means
