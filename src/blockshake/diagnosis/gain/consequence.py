"""Consequence of the extension for the user: largest drift of the top block, before and after."""

import numpy as np
import xarray as xr

from blockshake.measurement.motion.compared_curves import histories_at
from blockshake.study.ensembles.intervals import quantile_interval, sample_quantiles
from blockshake.study.ensembles.scores import crps

_MIDDLE = [0.5]
_PEAKS = ["top.displacement.peak+", "top.displacement.peak-"]


def largest_drift(reading):
    """Largest displacement of the top block against the base, to either side [m], shape (...) of the readings."""
    return np.abs(reading["value"].sel(feature=_PEAKS)).max("feature").to_numpy()


def consequence(measured, readings):
    """Median of the top block's largest drift in a test, and score of the drift's history, by ensemble.

    Parameters
    ----------
    measured : xarray.Dataset
        From `read_off`.
    readings : dict of str to dict of str to xarray.Dataset
        By kind and solver: ``value(run, feature)``, and where there are histories ``drift(run, time, body)`` [m], NaN
        after a run that ended early. As many runs of each solver.

    Returns
    -------
    xarray.Dataset
        ``measured``, the largest drift [m]; ``drift(kind)``, its median over the members of both solvers [m], with its
        limits of 95 % ``drift_lower`` and ``drift_upper``, NaN of too few members; ``crps(kind, body)``, score of the
        drift, mean over time [m], NaN without histories.
    """
    rows, scores = [], []
    own = measured["drift"].transpose("time", "body")
    for runs in readings.values():
        largest = np.concatenate([largest_drift(one) for one in runs.values()])
        rows.append([*sample_quantiles(largest, _MIDDLE), *quantile_interval(largest, _MIDDLE)[:, 0]])
        scores.append(_drift_score(own, list(runs.values())))
    table = np.array(rows)
    return xr.Dataset(
        {
            "measured": largest_drift(measured).item(),
            "drift": ("kind", table[:, 0]),
            "drift_lower": ("kind", table[:, 1]),
            "drift_upper": ("kind", table[:, 2]),
            "crps": (("kind", "body"), scores),
        },
        {"kind": list(readings), "body": own["body"].values},
    )


def _drift_score(measured, runs):
    if not all("drift" in one for one in runs):
        return np.full(measured.sizes["body"], np.nan)
    time = measured["time"].to_numpy()
    members = [histories_at(one[["drift"]], time)["drift"].transpose(..., "time", "body") for one in runs]
    score = crps(np.concatenate([one.to_numpy() for one in members]), measured.to_numpy())
    return measured.copy(data=score).mean("time").to_numpy()
