"""Evidence that a cause needs: more than its prior odds, and more than tests without any cause give by chance."""

from dataclasses import dataclass, field

import numpy as np

from blockshake.diagnosis.outside.registry import FORMS

FREE_FORCE = "unknown-force"
FREE_SHARE = 0.85  # of what any force at its place would explain, that a named form must
PRIOR, _PRIOR_OUTSIDE, _PRIOR_FREE = -3.0, -3.5, -6.0
ODDS = float(np.log(20.0))  # within which causes are not distinguished
RATE = 0.02  # chance that clean tests exceed the threshold of any cause
_SCALE = 1.0  # nats, of the evidence without a cause where the model is right: its chance falls as exp(-x)


@dataclass(frozen=True)
class Thresholds:
    """Logarithm of the evidence over none from which a cause is asserted, by its name."""

    runs: int = 0  # simulated campaigns without a cause
    by_chance: dict = field(default_factory=dict)  # str to float; exceeded by such runs at the `RATE`
    usual: float = 0.0  # the same of a cause that no run tells of

    def of(self, cause):
        """Threshold of a cause [nats]."""
        return max(by_odds(cause), self.by_chance.get(cause, self.usual))


def score_of(cause, gain):
    """Logarithm of the posterior odds over none; of a force without form, less the share that a form must explain."""
    if cause == FREE_FORCE:
        return FREE_SHARE * gain + _PRIOR_FREE
    return gain + (_PRIOR_OUTSIDE if cause in FORMS else PRIOR)


def by_odds(cause):
    """Evidence from which the posterior odds of a cause over none are 20."""
    return (ODDS - score_of(cause, 0.0)) / (FREE_SHARE if cause == FREE_FORCE else 1.0)


def thresholds_of(runs):
    """`Thresholds` from the evidence of every cause in simulated tests without any.

    Parameters
    ----------
    runs : list of dict of str to float
        By simulated campaign: logarithm of the evidence by cause. Empty ones do not count.

    Notes
    -----
    The evidence x of a cause is measured by its scale, 1 nat and the mean of its positive part over the runs. Of every
    run the largest ratio over all causes counts, so that the rate is that of the campaign and not of a cause (Westfall
    and Young 1993, max-T); the scales are those of the other runs. If k of n such maxima are positive, a new one
    exceeds t with the chance ``(k + 1/2) / (n + 1) (b / (b + t))^(k + 1)``, ``b = 1 + their sum``: the predictive
    distribution of exponential excesses, with one of the mean 1 as prior (Coles 2001, chapter 4).
    """
    runs = [run for run in runs if run]
    names = sorted({name for run in runs for name in run})
    if not runs:
        return Thresholds()
    positive = np.array([[max(run.get(name, 0.0), 0.0) for name in names] for run in runs])
    scales = _SCALE + positive.mean(axis=0)
    others = _SCALE + (positive.sum(axis=0) - positive) / max(len(runs) - 1, 1)
    largest = (positive / others).max(axis=1)
    found = int((largest > 0.0).sum())
    rate = 1.0 + float(largest.sum())
    exceeded = (found + 0.5) / (len(runs) + 1.0)
    ratio = rate * max((exceeded / RATE) ** (1.0 / (found + 1.0)) - 1.0, 0.0)
    by_chance = dict(zip(names, (ratio * scales).tolist(), strict=True))
    return Thresholds(len(runs), by_chance, ratio * _SCALE)
