"""Does a measured set of curves belong to an ensemble as a whole? Extreme rank length, envelope, violations."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import rankdata

from blockshake.errors import InputError

LEVEL = 0.05
_CHUNK = 4096  # points that are ranked at once
_FEWEST_MEMBERS = 19  # below, no p value can reach 0.05


@dataclass(frozen=True)
class WholeCurveTest:
    """Result of a whole-curve test.

    Attributes
    ----------
    p : float
        Chance of a rank as extreme if the measured set were one more member [1]; at least 1 / (n_members + 1).
    measure : float64 array, shape (n_members + 1,)
        Extreme rank length of the measured set (first) and of the members, share of the sets that are more extreme
        or equal: 1 is the most central [1].
    lower, upper : dict of str to float64 array, shape as the curve's
        Global envelope of 95 %, in the curve's unit; NaN where nothing was measured.
    stretches : pandas.DataFrame
        Where the measured curves leave the envelope: ``curve``, ``first`` and ``last`` (places along the curve),
        ``side`` (above or below), ``excess`` (largest distance from the envelope over its width there).
    """

    p: float
    measure: np.ndarray
    lower: dict
    upper: dict
    stretches: pd.DataFrame


def whole_curve_test(measured, members):
    """Rank a measured set of curves among sets of simulated ones, all curves at once.

    Parameters
    ----------
    measured : dict of str to float64 array, shape (n_points,)
        Curves of any units and lengths: channels of one test or of several; NaN where nothing was measured.
    members : dict of str to float64 array, shape (n_members, n_points)
        By the same names: member i of every curve is one parameter set, as the truth is one for all. With the noise
        of the measurement. NaN at the end is a run cut short.

    Returns
    -------
    WholeCurveTest

    Raises
    ------
    InputError
        Other names or shapes, fewer than 19 members, members with gaps, nothing measured.

    Notes
    -----
    Ranks from the nearer end at every point, sorted within a set of curves, compared in the order of a dictionary
    (Narisetty and Nair 2016, J. Am. Stat. Assoc. 111; Myllymaki, Mrkvicka, Grabarnik, Seijo and Hahn 2017, J. R. Stat.
    Soc. B 79). Ranks have no unit, so that curves of all kinds enter alike, each by its number of points. p is exact if
    measured and members are exchangeable, whatever the correlation in time and between curves; ties make it larger.
    Members of a Latin hypercube repel each other and are not exchangeable with a further draw: what the test's error
    rate is with them, `draw_probabilities` of independent draws tells. The envelope is spanned by the sets that are
    not among the most extreme 5 %; without ties the measured set leaves it somewhere if and only if p <= 0.05. A run
    cut short counts as farthest out, to the side on which it ended.
    """
    names, values, members_of, there = _joined(measured, members)
    curves = np.concatenate([values[None], members_of])
    measure = _extreme_rank_length(curves)
    kept = curves[measure > LEVEL]
    lower, upper = kept.min(axis=0), kept.max(axis=0)
    sizes = [len(measured[name]) for name in names]
    low, high = _parted(lower, there, sizes), _parted(upper, there, sizes)
    found = [
        row
        for name, below, above in zip(names, low, high, strict=True)
        for row in _stretches(name, np.asarray(measured[name], dtype=float), below, above)
    ]
    return WholeCurveTest(
        float(measure[0]), measure, dict(zip(names, low, strict=True)), dict(zip(names, high, strict=True)),
        pd.DataFrame(found, columns=["curve", "first", "last", "side", "excess"]),
    )  # fmt: skip


def draw_probabilities(draws, members):
    """p of every independent draw among the members: what the test says where nothing is missing.

    Parameters
    ----------
    draws : dict of str to float64 array, shape (n_draws, n_points)
        Sets drawn independently of each other and of the members, from the distribution that the members stand for.
    members : dict of str to float64 array, shape (n_members, n_points)

    Returns
    -------
    float64 array, shape (n_draws,)
        Uniform for exchangeable members; its share at or below 0.05 is the error rate.
    """
    count = len(next(iter(draws.values())))
    found = []
    for draw in range(count):
        _, values, others, _ = _joined({name: curve[draw] for name, curve in draws.items()}, members)
        found.append(_extreme_rank_length(np.concatenate([values[None], others]))[0])
    return np.array(found)


def calibrated_probability(p, of_draws):
    """p against those of independent draws, (1 + number at or below) / (1 + n_draws): exact for any members."""
    return float((1 + (np.asarray(of_draws) <= p).sum()) / (1 + len(of_draws)))


def _joined(measured, members):
    """Names, measured values and members (n_members, n_all) where something was measured, and where that is."""
    names = sorted(measured)
    if names != sorted(members) or not names:
        raise InputError("whole-curve test", "members", "expected the same curves as measured")
    values = np.concatenate([np.asarray(measured[name], dtype=float) for name in names])
    lengths = {name: np.shape(members[name])[1:] == np.shape(measured[name]) for name in names}
    if not all(lengths.values()) or len({len(members[name]) for name in names}) > 1:
        raise InputError("whole-curve test", "members", "expected as many members and points in every curve")
    simulated = np.concatenate([_continued(np.asarray(members[name], dtype=float)) for name in names], axis=1)
    there = np.isfinite(values)
    if len(simulated) < _FEWEST_MEMBERS:
        raise InputError(
            "whole-curve test", "members", f"expected at least {_FEWEST_MEMBERS}, not {len(simulated)}"
        )
    if not there.any():
        raise InputError("whole-curve test", "measured", "expected at least one reading")
    if np.isnan(simulated[:, there]).any():
        raise InputError("whole-curve test", "members", "expected no gaps where something was measured")
    return names, values[there], simulated[:, there], there


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
    for begin in range(0, curves.shape[1], _CHUNK):
        rank = rankdata(curves[:, begin : begin + _CHUNK], axis=0)
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


def _parted(values, there, sizes):
    """Values at the points that were measured, by curve, NaN elsewhere."""
    whole = np.full(len(there), np.nan)
    whole[there] = values
    return np.split(whole, np.cumsum(sizes)[:-1])


def _stretches(name, curve, lower, upper):
    """Runs of points beyond the envelope; a gap does not end a run."""
    there = np.flatnonzero(np.isfinite(curve))
    curve, lower, upper = curve[there], lower[there], upper[there]
    side = np.where(curve > upper, 1, np.where(curve < lower, -1, 0))
    edges = np.flatnonzero(np.diff(side)) + 1
    for begin, end in zip([0, *edges], [*edges, len(side)], strict=True):
        if len(side) and side[begin] != 0:
            own = slice(begin, end)
            beyond = np.maximum(curve[own] - upper[own], lower[own] - curve[own])
            with np.errstate(divide="ignore"):
                excess = float((beyond / (upper[own] - lower[own])).max())
            yield {
                "curve": name,
                "first": int(there[begin]),
                "last": int(there[end - 1]),
                "side": "above" if side[begin] > 0 else "below",
                "excess": excess,
            }
