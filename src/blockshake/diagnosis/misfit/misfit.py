"""Misfit of the nominal model: its ensembles against the measured histories of the open tests."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.nominal.ensemble import NOMINAL
from blockshake.statistics.resampling import rank_chance
from blockshake.statistics.scores import ensemble_score, mean_differences, member_scores


def misfit(tests):
    """How far measured tests are from the nominal ensemble of all solvers, joint by joint.

    Parameters
    ----------
    tests : list of JudgedTest
        Tests of the nominal ensemble; the same members in all, in one order.

    Returns
    -------
    xarray.Dataset
        Along ``test`` and ``cell`` what `JudgedTest.bands` gives, the only kind left out; ``score``, the continuous
        ranked probability score of the ensemble, mean over the times until the horizon [unit of the cell];
        ``usual``, the median of the members' leave-one-out scores; ``chance``, the share of the members, the measured
        test counted with them, whose score is as large [1]; ``worst_time``, at which the measured curve
        is farthest from the median in units of the spread [s]; and ``p``, chance of the largest score over its usual
        one in all tests and cells. Attribute ``where``: the place of the largest in words.

    Notes
    -----
    Members hold the noise of the sensors, so that a nominal test is one more member and ``chance`` is a rank
    (1 / (n + 1) at least). The scale of ``p`` is the members' own, so that it needs no correction for many cells.
    """
    scores, of_members = zip(*(_scores(test) for test in tests), strict=True)
    usual = [np.median(values, axis=0) for values in of_members]
    largest = np.max(
        [_excess(values, by).max(axis=-1) for values, by in zip(of_members, usual, strict=True)], axis=0
    )
    excess = [_excess(values, by) for values, by in zip(scores, usual, strict=True)]
    parts = []
    for test, score, members, by in zip(tests, scores, of_members, usual, strict=True):
        parts.append(
            test.bands().sel(kind=NOMINAL, drop=True).assign(
                score=("cell", score),
                usual=("cell", by),
                chance=("cell", rank_chance(score, members)),
                worst_time=("cell", _worst_times(test), {"units": "s"}),
            )
        )  # fmt: skip
    worst = int(np.argmax([values.max() for values in excess]))
    index = int(excess[worst].argmax())
    whole = xr.concat(parts, dim="test", join="outer", coords="minimal", compat="override")
    where = _where(tests[worst], parts[worst].isel(cell=index), excess[worst][index])
    return (
        whole.assign_coords(test=[test.name for test in tests])
        .assign(p=rank_chance(excess[worst][index], largest))
        .assign_attrs(where=where)
    )


def _scores(test):
    """Score of the measured test by cell, and of every member by the others, (n_cells,) and (n_members, n_cells)."""
    members = test.until_horizon(test.members[NOMINAL].to_numpy())
    differences = mean_differences(members, members)
    away = mean_differences(members, test.until_horizon(test.measured.to_numpy())[None])[:, 0]
    return ensemble_score(away, differences, np.ones((1, len(members))))[0], member_scores(differences)


def _excess(score, usual):
    return np.nan_to_num(score / np.where(usual > 0.0, usual, np.inf))


def _worst_times(test):
    members = test.members[NOMINAL]
    spread = members.std("run", ddof=1).to_numpy()
    away = np.abs(test.measured - members.median("run")).to_numpy() / np.where(spread > 0.0, spread, np.inf)
    away = np.nan_to_num(test.until_horizon(away))
    return test.measured["time"].to_numpy()[away.argmax(axis=0)]


def _where(test, cell, excess):
    if not excess:
        return "no joint moves"
    return (
        f"{cell['quantity'].item()} of {cell['where'].item()} in {test.name}, most at "
        f"{float(cell['worst_time']):.1f} s: {excess:.1f} times the usual error until {float(cell['horizon']):.1f} s"
    )
