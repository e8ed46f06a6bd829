"""Mean of few runs of a costly model, helped by many of a cheap one: a control variate."""

import numpy as np
import pandas as pd
import scipy
import xarray as xr

from blockshake.dynamics.system import Status
from blockshake.statistics.intervals import CONFIDENCE, SURE_FROM

CHEAP = "nscd-rigid"
_ESTIMATES = ("value", "lower", "upper", "coefficient", "correlation", "gain")


def two_level_mean(costly, cheap, many):
    """Mean of a costly model's results, helped by a cheap one.

    Parameters
    ----------
    costly, cheap : float64 arrays, shape (n,)
        Responses of both models for the same samples, at least 6.
    many : float64 array, shape (N,)
        The cheap model for these samples and others.

    Returns
    -------
    dict of str to float
        ``value``, the mean, with the limits of 95 % ``lower`` and ``upper``, in the unit of the results; the
        ``coefficient`` by which a deviation of the cheap model's mean is taken over, ``correlation`` of the results of
        both models, and ``gain``, the variance of the mean of the costly results alone over that of the value [1]. NaN
        where the results of either model do not vary, or are too few.

    Notes
    -----
    Regression estimator of two-phase sampling (Cochran 1977, Sampling Techniques, section 12.6); with the best
    coefficient, that of least squares, its variance is ``s^2 / n (1 - r^2 (1 - n / N))`` (also Peherstorfer,
    Willcox and Gunzburger 2016, SIAM J. Sci. Comput. 38, for two models). The variance that is used is Cochran's
    conditional one, which knows that the coefficient is estimated; the limits are Student's with n - 2 degrees of
    freedom. The bias is of the order 1 / n.
    """
    size = len(costly)
    if size < SURE_FROM or np.ptp(costly) == 0.0 or np.ptp(cheap) == 0.0:
        return dict.fromkeys(_ESTIMATES, np.nan)
    centred, off = cheap - cheap.mean(), many.mean() - cheap.mean()
    squares = centred @ centred
    coefficient = centred @ costly / squares
    rest = costly - costly.mean() - coefficient * centred
    own, left = costly.var(ddof=1), rest @ rest / (size - 2)
    variance = left * (1.0 / size + off**2 / squares) + max(own - left, 0.0) / len(many)
    value = costly.mean() + coefficient * off
    half = scipy.stats.t.ppf(0.5 + 0.5 * CONFIDENCE, size - 2) * np.sqrt(variance)
    gain = own / size / variance if variance > 0.0 else np.inf
    correlation = np.corrcoef(costly, cheap)[0, 1]
    estimates = value, value - half, value + half, coefficient, correlation, gain
    return dict(zip(_ESTIMATES, map(float, estimates), strict=True))


def two_levels(ensembles):
    """`two_level_mean` of the largest displacement, of each model with fewer samples than rigid NSCD.

    Parameters
    ----------
    ensembles : dict of str to xarray.Dataset
        By model, from `join_batches`: all samples.

    Returns
    -------
    xarray.Dataset
        The largest displacement of any marker along x relative to the slab, by sample: ``mean_peak(model)`` of the
        model alone, ``two_level_peak(model)`` and its ``_interval(bound, model)`` [m], ``coefficient``,
        ``peak_correlation`` and ``variance_gain(model)`` [1]. NaN for other models, and where a sample did not
        complete: one that fell has no largest displacement.
    """
    peaks = {
        model: one["peak"].sel(frame="slab", drop=True).max("marker").where(one["status"] == Status.COMPLETED)
        for model, one in ensembles.items()
    }
    many, rows = peaks.get(CHEAP), []
    for own in peaks.values():
        helped = many is not None and 0 < own.sizes["sample"] < many.sizes["sample"]
        row = {}
        if helped and np.isfinite(own).all() and np.isfinite(many).all():
            both = [one.sel(sample=own["sample"]).to_numpy() for one in (own, many)]
            row = {"mean": both[0].mean(), **two_level_mean(*both, many.to_numpy())}
        rows.append(row)
    estimates = pd.DataFrame(rows, columns=["mean", *_ESTIMATES], dtype=float)
    return xr.Dataset(
        {
            "mean_peak": ("model", estimates["mean"]),
            "two_level_peak": ("model", estimates["value"]),
            "two_level_peak_interval": (("bound", "model"), estimates[["lower", "upper"]].T),
            "coefficient": ("model", estimates["coefficient"]),
            "peak_correlation": ("model", estimates["correlation"]),
            "variance_gain": ("model", estimates["gain"]),
        },
        {"bound": ["lower", "upper"]},
    )
