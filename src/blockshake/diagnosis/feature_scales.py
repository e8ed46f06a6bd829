"""Transforms that tame the heavy tails of features before anything Gaussian is done with them."""

import numpy as np
from scipy.stats import norm

from blockshake.diagnosis.feature_table import kind


def signed_log(values):
    """Features on a scale that is linear near zero and logarithmic far from it.

    Parameters
    ----------
    values : xarray.DataArray
        With coordinate ``feature``, as of `features`.

    Returns
    -------
    xarray.DataArray
        sign(x) ln(1 + |x| / scale) with the scale of the feature table [1]; as they are where it has none.
    """
    scale = np.array([kind(str(name)).scale for name in values["feature"].values])
    scale = values["feature"].copy(data=scale).reset_coords(drop=True)
    logarithm = np.sign(values) * np.log1p(abs(values) / scale.where(scale > 0.0, 1.0))
    return logarithm.where(scale > 0.0, values)


def rank_gaussian(values, pool):
    """Values as normal scores of their ranks in a pool of simulated ones.

    Parameters
    ----------
    values : float64 array, shape (..., n_features)
    pool : float64 array, shape (n_pool, n_features)

    Returns
    -------
    float64 array, shape (..., n_features)
        Standard normal for values that are distributed as the pool; ties get the middle of their ranks, values
        outside the pool at most the normal quantile of (n_pool + 1/2) / (n_pool + 1) [1].
    """
    ordered = np.sort(pool, axis=0)
    scores = np.empty(np.shape(values))
    for feature in range(pool.shape[1]):
        below = np.searchsorted(ordered[:, feature], values[..., feature], side="left")
        upto = np.searchsorted(ordered[:, feature], values[..., feature], side="right")
        scores[..., feature] = norm.ppf((0.5 * (below + upto) + 0.5) / (len(pool) + 1.0))
    return scores
