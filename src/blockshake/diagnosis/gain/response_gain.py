"""Gain on the responses of sealed tests: the share of a rival's error that the extended model removes."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.extended_model import EXTENDED, RECALIBRATED
from blockshake.diagnosis.nominal.ensemble import NOMINAL
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain
from blockshake.study.comparison.differences import (
    ensemble_score,
    limits_of,
    mean_differences,
    mean_width,
    member_scores,
    resampled_weights,
)

_CONFIDENCE = 0.9
_FLOOR_QUANTILE = 0.95  # share of the extended members' own scores that a rival must exceed
_CONFIRMING_SHARE = 0.5  # share of the fall that each solver must show by itself


class _Apart(NamedTuple):
    """Mean differences of an ensemble's members from the record and from each other, by test, in units of spread."""

    away: list
    pairs: list


def response_gain(tests):
    """Scores of all ensembles on sealed tests, and the gain of the extended ensemble over each of the others.

    Parameters
    ----------
    tests : list of JudgedTest
        At least one, with the kinds nominal, recalibrated and extended and perhaps others; the same members in all.

    Returns
    -------
    xarray.Dataset
        In units of a cell's spread ``score(kind)``, ``score_of_cell(kind, test, cell)``, ``score_of_solver(kind,
        model)``; ``floor``, and ``highest``, which 95 % of the extended members score less than; ``gain``,
        ``gain_lower`` and ``gain_upper(rival)`` [1], NaN where nothing is there to gain; ``confirmed``, whether each
        solver by itself shows half of the fall against the recalibrated model or more; and along ``test`` what
        `JudgedTest.bands` gives, with ``largest(kind, test)``, ``largest_lower`` and ``largest_upper``, median of the
        top's largest drift and the band of the members, and ``largest_measured(test)`` [m].

    Notes
    -----
    A cell is one history of one test, as of `as_cells`. Its score is the continuous ranked probability score, mean over
    the times until the horizon, in units of its spread over nominal and extended members together (root mean square
    over the time); the whole is the mean over tests of the mean over cells. Gain is ``(S_rival - S_extended) / (S_rival
    - S_floor)``: 1 leaves nothing to gain, below 0 the extension is worse. The floor is what the extended members score
    in the mean when each is taken for the record and judged by the others.

    One record scores by chance above or below the floor. Where the rival does not score more than 95 % of the extended
    members as the record would, its distance from the floor is noise and the ratio would be wild: nothing is there to
    gain.

    Intervals of 90 % by bootstrap (Efron and Tibshirani 1993, chapter 13): tests, in each the cells, and members solver
    by solver, the same draws in all ensembles, which go back to the same nominal draws. With one sealed test there is
    no scatter from test to test in them.
    """
    kinds, models = list(tests[0].members), tests[0].models
    rivals = [kind for kind in kinds if kind != EXTENDED]
    scales = [_scale(test) for test in tests]
    apart = {kind: _apart(tests, scales, kind) for kind in kinds}
    generator = np.random.default_rng(len(models))
    solvers = list(dict.fromkeys(models.tolist()))
    drawn = np.zeros((len(resampled_weights(1, generator)), len(models)))
    for solver in solvers:
        drawn[:, models == solver] = resampled_weights((models == solver).sum(), generator)
    of_tests = resampled_weights(len(tests), generator)
    of_cells = [resampled_weights(len(scale), generator) * (scale > 0.0) for scale in scales]

    def whole(by_test):
        """Mean over tests of the mean over cells, drawn anew: (n_draws,)."""
        means = [
            (of * one).sum(axis=1) / np.maximum(of.sum(axis=1), 1e-12)
            for of, one in zip(of_cells, by_test, strict=True)
        ]
        return (of_tests.T * means).sum(axis=0) / of_tests.sum(axis=1)

    by_cell = {
        kind: [ensemble_score(*both, drawn) for both in zip(one.away, one.pairs, strict=True)]
        for kind, one in apart.items()
    }
    scores = {kind: whole(one) for kind, one in by_cell.items()}
    floors = whole([0.5 * mean_width(pairs, drawn) for pairs in apart[EXTENDED].pairs])
    own = np.mean([member_scores(pairs)[:, scale > 0.0].mean(axis=1) for pairs, scale in zip(apart[EXTENDED].pairs, scales, strict=True)], axis=0)
    highest = np.quantile(own, _FLOOR_QUANTILE)
    gains = {kind: _ratio(scores[kind] - scores[EXTENDED], scores[kind] - floors) for kind in rivals}
    able = {kind: scores[kind][0] > highest for kind in rivals}
    limits = np.array([np.where(able[kind], limits_of(gains[kind], _CONFIDENCE), np.nan) for kind in rivals])
    of_solver = {kind: [_score_by(one, models == solver, scales) for solver in solvers] for kind, one in apart.items()}
    falls = np.subtract(of_solver[RECALIBRATED], of_solver[EXTENDED])
    fall = scores[RECALIBRATED][0] - scores[EXTENDED][0]
    table = [
        xr.DataArray(np.array([by_cell[kind][place][0] for kind in kinds]), dims=("kind", "cell"), coords={"cell": test.measured["cell"].values})
        for place, test in enumerate(tests)
    ]  # fmt: skip
    found = xr.Dataset(
        {
            "score": ("kind", [scores[kind][0] for kind in kinds]),
            "score_of_cell": xr.concat(table, dim="test", join="outer").transpose("kind", "test", "cell"),
            "score_of_solver": (("kind", "model"), [of_solver[kind] for kind in kinds]),
            "floor": floors[0],
            "highest": highest,
            "gain": ("rival", [gains[kind][0] if able[kind] else np.nan for kind in rivals]),
            "gain_lower": ("rival", limits[:, 0]),
            "gain_upper": ("rival", limits[:, 1]),
            "confirmed": bool(fall > 0.0 and (falls >= _CONFIRMING_SHARE * fall).all()),
        },
        {"kind": kinds, "rival": rivals, "model": solvers},
    )
    shown = xr.concat(
        [test.bands().merge(_largest(test)) for test in tests], dim="test", join="outer", coords="minimal", compat="override"
    )  # fmt: skip
    return found.merge(shown, compat="override").assign_coords(test=[test.name for test in tests])


def gain_of_verdict(gained, runs):
    """`MeasuredGain`, the gain of `response_gain` in the form of the verdict, with caveats and the number of runs.

    It is cut off at -1 and 1. Where there is nothing to gain, it is 0, from -1 to 1.
    """
    contrasts, caveats = {}, []
    for rival in gained["rival"].values.tolist():
        lower, estimate, upper = (
            float(gained[name].sel(rival=rival)) for name in ("gain_lower", "gain", "gain_upper")
        )
        if np.isnan(estimate):
            contrasts[rival] = Contrast(estimate=0.0, lower=-1.0, upper=1.0)
            caveats.append(
                f"nothing to gain on the sealed tests against the {rival} model: it scores within noise"
            )
        else:
            contrasts[rival] = contrast(estimate, lower, upper)
    if gained.sizes["test"] == 1:
        caveats.append("one sealed test: the gain's interval holds no scatter from test to test")
    if not gained["confirmed"] and contrasts[RECALIBRATED].estimate > 0.0:
        caveats.append("solver-dependent: one solver by itself shows less than half of the gain")
    return MeasuredGain(gain=Gain(**contrasts), caveats=caveats, runs=runs)


def contrast(estimate, lower, upper):
    """Gain with its interval, cut off at -1 and 1; an interval of few draws may miss its estimate."""
    values = {"estimate": estimate, "lower": min(lower, estimate), "upper": max(upper, estimate)}
    return Contrast(**{name: float(np.clip(value, -1.0, 1.0)) for name, value in values.items()})


def _scale(test):
    """Spread of each cell over nominal and extended members together, (n_cells,); 0 where nothing is judged."""
    both = np.concatenate([test.members[kind].to_numpy() for kind in (NOMINAL, EXTENDED)])
    known = test.judged & (np.isfinite(both).sum(axis=0) > 1) & np.isfinite(test.measured.to_numpy())
    variance = np.where(known, np.nanvar(np.where(known, both, 0.0), axis=0, ddof=1), 0.0)
    return np.sqrt(variance.sum(axis=0) / np.maximum(known.sum(axis=0), 1))


def _apart(tests, scales, kind):
    away, pairs = [], []
    for test, scale in zip(tests, scales, strict=True):
        unit = np.where(scale > 0.0, scale, 1.0)
        members = test.until_horizon(test.members[kind].to_numpy()) / unit
        measured = np.where(np.isfinite(test.measured.to_numpy()), test.until_horizon(test.measured.to_numpy()), np.nan)
        away.append(np.nan_to_num(mean_differences(members, measured[None] / unit)[:, 0]))
        pairs.append(np.nan_to_num(mean_differences(members, members)))
    return _Apart(away, pairs)


def _score_by(apart, chosen, scales):
    """Score of the members of one solver by themselves."""
    weights = np.ones((1, chosen.sum()))
    means = [
        ensemble_score(away[chosen], pairs[np.ix_(chosen, chosen)], weights)[0][scale > 0.0].mean()
        for away, pairs, scale in zip(apart.away, apart.pairs, scales, strict=True)
    ]
    return float(np.mean(means))


def _ratio(fall, to_gain):
    """Fall of the score over its largest possible fall; 1 or -1 by its sign where nothing is left to gain."""
    return np.where(to_gain > 0.0, fall / np.where(to_gain > 0.0, to_gain, 1.0), np.sign(fall))


def _largest(test):
    """Largest drift of the top to either side in the measured time: median and band by kind, and measured [m]."""
    of_top = test.measured["quantity"].to_numpy() == "drift"

    def largest(cells):
        return np.abs(cells.isel(cell=np.flatnonzero(of_top)[-1:])).max(("time", "cell"))

    bands = [largest(one).quantile((0.05, 0.5, 0.95), dim="run") for one in test.members.values()]
    lower, middle, upper = np.array([one.to_numpy() for one in bands]).T
    return xr.Dataset(
        {
            "largest": ("kind", middle),
            "largest_lower": ("kind", lower),
            "largest_upper": ("kind", upper),
            "largest_measured": float(largest(test.measured)),
        }
    )
