"""Rank of a measured set of curves among those of an ensemble as a whole: extreme rank length."""

import numpy as np
from scipy.stats import rankdata

from blockshake.errors import InputError

_POINTS_AT_ONCE = 4096  # points that are ranked at once
_MEMBERS_NEEDED = 19  # below, no p value can reach 0.05


def whole_curve_probability(measured, members):
    """Chance of a rank as extreme as the measured set's among sets of simulated curves, all curves at once.

    Parameters
    ----------
    measured : dict of str to float64 array, shape (n_points,)
        Curves of any units and lengths: channels of one test or of several; NaN where nothing was measured.
    members : dict of str to float64 array, shape (n_members, n_points)
        By the same names: member i of every curve is one parameter set, as the truth is one for all. With the noise
        of the measurement. NaN at the end is a run cut short.

    Returns
    -------
    float
        Chance if the measured set were one more member [1]; at least 1 / (n_members + 1).

    Raises
    ------
    InputError
        Other names or shapes, fewer than 19 members, members with gaps, nothing measured.

    Notes
    -----
    Extreme rank length: ranks from the nearer end at every point, sorted within a set of curves, compared in the order
    of a dictionary (Narisetty and Nair 2016, J. Am. Stat. Assoc. 111; Myllymaki, Mrkvicka, Grabarnik, Seijo and Hahn
    2017, J. R. Stat. Soc. B 79). Ranks have no unit, so that curves of all kinds enter alike, each by its number of
    points. The chance is exact if measured and members are exchangeable, whatever the correlation in time and between
    curves; ties make it larger. Members of a Latin hypercube repel each other and are not exchangeable with a further
    draw. A run cut short counts as farthest out, to the side on which it ended.
    """
    values, members_of = _joined(measured, members)
    return float(_extreme_rank_length(np.concatenate([values[None], members_of]))[0])


def _joined(measured, members):
    """Measured values, and members (n_members, n_all), where something was measured."""
    names = sorted(measured)
    if names != sorted(members) or not names:
        raise InputError("whole-curve test", "members", "expected the same curves as measured")
    values = np.concatenate([np.asarray(measured[name], dtype=float) for name in names])
    lengths = {name: np.shape(members[name])[1:] == np.shape(measured[name]) for name in names}
    if not all(lengths.values()) or len({len(members[name]) for name in names}) > 1:
        raise InputError("whole-curve test", "members", "expected as many members and points in every curve")
    simulated = np.concatenate([_continued(np.asarray(members[name], dtype=float)) for name in names], axis=1)
    there = np.isfinite(values)
    if len(simulated) < _MEMBERS_NEEDED:
        raise InputError(
            "whole-curve test", "members", f"expected at least {_MEMBERS_NEEDED}, not {len(simulated)}"
        )
    if not there.any():
        raise InputError("whole-curve test", "measured", "expected at least one reading")
    if np.isnan(simulated[:, there]).any():
        raise InputError("whole-curve test", "members", "expected no gaps where something was measured")
    return values[there], simulated[:, there]


def _continued(curves):
    """Curves cut short, continued as infinite to the side of the median on which they ended."""
    if not np.isnan(curves[:, -1]).any():
        return curves
    curves, median = curves.copy(), np.nanmedian(curves, axis=0)
    for row in np.flatnonzero(np.isnan(curves[:, -1])):
        known = np.flatnonzero(np.isfinite(curves[row]))
        last = known[-1] if len(known) else 0
        out = np.inf if not len(known) or curves[row, last] >= median[last] else -np.inf
        curves[row, last + 1 :] = out
    return curves


def _extreme_rank_length(curves):
    """Share of the sets that are as extreme or more, shape (n_sets,); ``curves`` (n_sets, n_points)."""
    n_sets = len(curves)
    counts = np.zeros((n_sets, n_sets + 3), dtype=np.int64)  # of ranks 1, 1.5, 2, ... at 2, 3, 4, ...
    places = np.arange(n_sets)[:, None]
    for begin in range(0, curves.shape[1], _POINTS_AT_ONCE):
        rank = rankdata(curves[:, begin : begin + _POINTS_AT_ONCE], axis=0)
        twice = np.rint(2.0 * np.minimum(rank, n_sets + 1 - rank)).astype(np.int64)
        np.add.at(counts, (np.broadcast_to(places, twice.shape), twice), 1)
    # more of the smallest rank is more extreme: the order of the sorted ranks as words
    order = np.lexsort(-counts.T[::-1])
    ordered = counts[order]
    new = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)])
    group = np.cumsum(new) - 1
    upto = np.cumsum(np.bincount(group))
    measure = np.empty(n_sets)
    measure[order] = upto[group] / n_sets
    return measure
