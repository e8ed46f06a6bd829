"""Scores of an ensemble curve by curve: coverage, sharpness and CRPS, each with its leave-one-out reference."""

import numpy as np
import xarray as xr

from blockshake.study.ensembles.coverage import REFERENCE_QUANTILES, band, members_inside, share_inside
from blockshake.study.ensembles.scores import crps


def joint_curves(histories, test):
    """Slip along x, rotation about y and opening of every joint as curves (n_times,) or (n_draws, n_times), by name.

    ``histories`` from `read_off`, of an ensemble along ``draw``. ``TEST.jointJ.slip`` and so on, so that the curves of
    several tests can be joined; joints that nobody can know are left out. Where that is all of them, as with one
    marker a block, ``TEST.BODY.drift`` of every block stands for them.
    """
    found = {}
    for joint in range(histories.sizes["joint"]):
        for name in ("slip", "rotation", "opening"):
            one = histories[name].isel(joint=joint).transpose(..., "time").to_numpy().astype(float)
            if np.isfinite(one).any():
                found[f"{test}.joint{joint + 1}.{name}"] = one
    if found:
        return found
    for name in histories["body"].values:
        one = histories["drift"].sel(body=name).transpose(..., "time").to_numpy().astype(float)
        if (np.abs(one) > 0.0).any():  # the table does not drift against itself
            found[f"{test}.{name}.drift"] = one
    return found


def curve_scores(measured, members):
    """Scores of every curve by itself.

    Parameters
    ----------
    measured : dict of str to float64 array, shape (n_times,)
        NaN where nothing was measured.
    members : dict of str to float64 array, shape (n_members, n_times)
        With the noise of the measurement.

    Returns
    -------
    xarray.Dataset
        Along ``curve``: ``coverage`` in the members' band [1], ``sharpness``, mean width of the band over the largest
        measured magnitude [1], ``crps``, mean over time [curve's unit]; ``coverage_reference`` and
        ``crps_reference(quantile, curve)`` of each member against the others.
    """
    rows = [_scores(np.asarray(measured[name], float), np.asarray(members[name], float)) for name in measured]
    names = ("coverage", "sharpness", "crps", "coverage_reference", "crps_reference")
    columns = {name: np.array([row[name] for row in rows]) for name in names}
    return xr.Dataset(
        {
            name: (("quantile", "curve"), values.T) if values.ndim > 1 else ("curve", values)
            for name, values in columns.items()
        },
        {"curve": list(measured), "quantile": list(REFERENCE_QUANTILES)},
    )


def members_crps(members):
    """CRPS of every member against the others, shape (n_members, ...), as `crps` would give it.

    Parameters
    ----------
    members : float64 array, shape (n_members, ...)
        At least three; no NaN, which would make it NaN.
    """
    count = len(members)
    order = np.argsort(members, axis=0, kind="stable")
    ordered = np.take_along_axis(members, order, axis=0)
    rank = np.arange(1, count + 1).reshape(-1, *[1] * (members.ndim - 1))
    below = np.cumsum(ordered, axis=0)
    # sum of distances to all others, from the sums below and above
    distance = ordered * (2 * rank - count) - 2.0 * below + below[-1]
    pairs = 0.5 * distance.sum(axis=0)
    score = distance / (count - 1) - (pairs - distance) / ((count - 1) * (count - 2))
    result = np.empty_like(score)
    np.put_along_axis(result, order, score, axis=0)
    return result


def _scores(curve, curves):
    known = np.isfinite(curve)
    curve, curves = curve[known], curves[:, known]
    lower, upper = band(curves)
    of_members = members_inside(curves, curves), np.nanmean(members_crps(curves), axis=1)
    peak = np.abs(curve).max()
    return {
        "coverage": share_inside(curve, lower, upper),
        "sharpness": np.nanmean(upper - lower) / peak if peak > 0.0 else np.inf,
        "crps": np.nanmean(crps(curves, curve)),
        "coverage_reference": np.nanquantile(of_members[0], REFERENCE_QUANTILES),
        "crps_reference": np.nanquantile(of_members[1], REFERENCE_QUANTILES),
    }
