"""How the samples of an ensemble ended, and how many of them carry its statistics."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import FINISHED


class Outcomes(NamedTuple):
    """Numbers of samples by the way they ended.

    >>> count_outcomes(["completed", "collapsed", "completed", "falling", "not-converged"])
    Outcomes(completed=2, collapsed=1, falling=1, failed=1)
    >>> count_outcomes(["completed", "falling"]).counted
    2
    """

    completed: int
    collapsed: int
    falling: int
    failed: int

    @property
    def counted(self):
        """Samples that enter statistics."""
        return self.completed + self.collapsed + self.falling


def count_outcomes(status):
    """`Outcomes` of samples from their statuses, as in the variable ``status`` of an ensemble."""
    status = np.asarray(status, dtype=str)
    counts = [int((status == one).sum()) for one in FINISHED]
    return Outcomes(*counts, len(status) - sum(counts))


def unfinished(samples):
    """Samples of `sample_figures` that did not complete, or that have a remark, a dataset each."""
    remarked = (samples["status"].values != "completed") | (samples["reason"].values.astype(str) != "")
    return [samples.sel(sample=one) for one in samples["sample"].values[remarked]]


def numerical_figure(samples, name, statistic):
    """Statistic of a figure of the computation, such as ``numerics_steps``, over the samples that have it, or NaN.

    ``samples`` from `sample_figures`; ``statistic``: of a float64 array of at least one value.
    """
    values = np.asarray(samples.get(name, []), dtype=float)
    values = values[np.isfinite(values)]
    return float(statistic(values)) if len(values) else np.nan
