"""The mean coefficient of friction whose ensemble fits a measured test best, and whether the test tells at all."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import t as student

from blockshake.study.ensembles.measured import compared_curves
from blockshake.study.ensembles.scores import crps
from blockshake.study.friction.replicates import replicate_error

LEVEL = 0.95  # of the one-sided test by which a mean is refused
_NO_DIFFERENCE = 0.01  # of the best score: a difference below it is none


@dataclass(frozen=True)
class FrictionCalibration:
    """Answer of a measured test on the mean coefficient.

    Attributes
    ----------
    table : pandas.DataFrame
        By candidate mean, rising: ``score`` [m], mean over the replicates; ``excess`` [m], score less that of
        the best mean; ``error`` [m], standard error of the excess from the replicates; ``accepted``.
    best : float
        Mean with the lowest score [1].
    lower, upper : float
        Refused means next to the accepted ones, NaN where none is refused on that side [1].
    answer : str
        In words: ``between``, ``not informed above``, ``not informed below`` or ``not informed``.
    """

    table: pd.DataFrame
    best: float
    lower: float
    upper: float
    answer: str


def mean_score(ensemble, measured, marker_noise, seed):
    """Score of an ensemble against a measured test: CRPS, mean over times and markers [m].

    Parameters
    ----------
    ensemble : xarray.Dataset
        From `gather_ensemble`.
    measured : xarray.Dataset
        As for `coverage`.
    marker_noise : float
        Standard deviation of a measured marker's position, given to the members too [m].
    seed : int
        Of that noise.

    Raises
    ------
    InputError
        Fewer than two samples finished, no marker or no time in common.
    """
    compared = compared_curves(measured, ensemble, marker_noise, seed, fewest=2)
    return float(np.nanmean(crps(compared.readings, compared.measured.to_numpy())))


def with_mean(design, distributions, variables, mean):
    """Design whose ``variables``, by dotted name, have another mean [1], their variation and pairing kept."""
    scaled = design.copy()
    for name in variables:
        scaled[name] *= mean / distributions[name].mean
    return scaled


def search_mean(evaluate, lowest, highest, step, finest):
    """Candidate means on an even grid, then ever finer where accepted ones end and refused ones begin.

    Parameters
    ----------
    evaluate : callable
        Mean to scores of the replicated designs, float64 array, shape (n_replicates,) [m]; the
        replicates of all means are paired.
    lowest, highest, step, finest : float
        Range of the means, distance of the first candidates, and how near the ends of the accepted range are
        located [1].

    Returns
    -------
    FrictionCalibration
    """
    count = round((highest - lowest) / step)
    scores = {round(mean, 6): evaluate(round(mean, 6)) for mean in np.linspace(lowest, highest, count + 1)}
    while True:
        found = weigh_means(scores)
        means = found.table.index.to_numpy()
        accepted = found.table["accepted"].to_numpy()
        edges = np.flatnonzero(accepted[1:] != accepted[:-1])
        new = [
            round(0.5 * (means[edge] + means[edge + 1]), 6)
            for edge in edges
            if means[edge + 1] - means[edge] > 1.001 * finest
        ]
        if not new:
            return found
        scores |= {mean: evaluate(mean) for mean in new}


def weigh_means(scores):
    """Answer of replicated scores on the candidates.

    Parameters
    ----------
    scores : dict of float to float64 array, shape (n_replicates,)
        By mean, at least two replicates [m].

    Notes
    -----
    A mean is refused when its score exceeds that of the best by more than chance: a one-sided t test of the
    paired differences over the replicated designs, at 95 %, and by more than a hundredth of the best score: replicates
    that happen to agree prove nothing of micrometres in a misfit of centimetres. The best is itself chosen from the
    scores, which makes the test a little too ready to refuse.
    """
    means = np.array(sorted(scores))
    values = np.array([scores[mean] for mean in means])
    best = int(values.mean(axis=1).argmin())
    excess, _, error = replicate_error((values - values[best]).T)
    limit = student.ppf(LEVEL, values.shape[1] - 1) * error + _NO_DIFFERENCE * values[best].mean()
    accepted = excess <= limit
    # what lies between two accepted means is not told from them
    first, last = np.flatnonzero(accepted)[[0, -1]]
    accepted[first : last + 1] = True
    lower = float(means[first - 1]) if first > 0 else np.nan
    upper = float(means[last + 1]) if last + 1 < len(means) else np.nan
    table = pd.DataFrame(
        {"score": values.mean(axis=1), "excess": excess, "error": error, "accepted": accepted},
        index=pd.Index(means, name="mean"),
    )
    return FrictionCalibration(
        table, float(means[best]), lower, upper, _answer(means, first, last, lower, upper)
    )


def _answer(means, first, last, lower, upper):
    if np.isnan(lower) and np.isnan(upper):
        return f"not informed between {means[0]:g} and {means[-1]:g}"
    if np.isnan(upper):
        return f"not informed above {means[first]:g}"
    if np.isnan(lower):
        return f"not informed below {means[last]:g}"
    return f"between {lower:g} and {upper:g}"
