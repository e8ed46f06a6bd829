"""Gain on the responses of sealed tests: the share of a rival's error that the extended model removes."""

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from blockshake.diagnosis.nominal.ensemble import EXTENDED, NOMINAL, RECALIBRATED
from blockshake.diagnosis.verdict.verdict import NOTHING_TO_GAIN, OF_A_GAIN, Contrast, Gain, MeasuredGain
from blockshake.statistics.resampling import limits_of, resampled_weights
from blockshake.statistics.scores import ensemble_score, mean_differences, mean_width, member_scores

_FLOOR_QUANTILE = 0.95  # share of the extended members' own scores that a rival must exceed
_CONFIRMING_SHARE = 0.5  # share of the fall that each solver must show by itself


@dataclass(frozen=True)
class _Cells:
    """Cells of all tests that are judged, side by side; the first row of every weight is that of all, once each."""

    # str to float64 array, shape (n_members, n_cells); by kind: mean differences of the members from the
    # record, in units of the cell's spread
    away: dict
    # str to float64 array, shape (n_members, n_members, n_cells); the same of the members from each other
    pairs: dict
    weights: np.ndarray  # float64 (n_draws, n_cells); of a mean over tests of the mean over cells; sum 1
    members: np.ndarray  # float64 (n_draws, n_members); how often each is drawn

    def score(self, kind):
        """Score of an ensemble, (n_draws,)."""
        return self.whole(ensemble_score(self.away[kind], self.pairs[kind], self.members))

    def score_of(self, kind, chosen):
        """Score of some members of an ensemble, `chosen` (n_members,) bool."""
        pairs = self.pairs[kind][np.ix_(chosen, chosen)]
        by_cell = ensemble_score(self.away[kind][chosen], pairs, np.ones((1, chosen.sum())))
        return self.whole(by_cell)[0]

    def whole(self, by_cell):
        """Mean over tests of the mean over cells, (n_draws,)."""
        return (self.weights[: len(by_cell)] * by_cell).sum(axis=1)


def response_gain(tests):
    """Scores of all ensembles on sealed tests, and the gain of the extended ensemble over each of the others.

    Parameters
    ----------
    tests : list of JudgedTest
        At least one, with the kinds nominal, recalibrated and extended and perhaps others; the same members in all.

    Returns
    -------
    xarray.Dataset
        In units of a cell's spread ``score(kind)`` and ``floor``; ``gain``, ``gain_lower`` and ``gain_upper(rival)``
        [1], NaN where nothing is there to gain; ``confirmed``, whether each solver by itself shows half of the fall
        against the recalibrated model or more; and along ``test`` what `JudgedTest.bands` gives.

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
    cells = _cells(tests)
    score = {kind: cells.score(kind) for kind in kinds}
    floor = cells.whole(0.5 * mean_width(cells.pairs[EXTENDED], cells.members))
    highest = np.quantile(member_scores(cells.pairs[EXTENDED]) @ cells.weights[0], _FLOOR_QUANTILE)
    gain = np.array([_ratio(score[kind] - score[EXTENDED], score[kind] - floor) for kind in rivals])
    able = np.array([score[kind][0] > highest for kind in rivals])
    limits = np.where(able, limits_of(gain.T, OF_A_GAIN), np.nan)
    falls = [
        cells.score_of(RECALIBRATED, models == solver) - cells.score_of(EXTENDED, models == solver)
        for solver in dict.fromkeys(models.tolist())
    ]
    fall = score[RECALIBRATED][0] - score[EXTENDED][0]
    scores = xr.Dataset(
        {
            "score": ("kind", [score[kind][0] for kind in kinds]),
            "floor": floor[0],
            "gain": ("rival", np.where(able, gain[:, 0], np.nan)),
            "gain_lower": ("rival", limits[0]),
            "gain_upper": ("rival", limits[1]),
            "confirmed": bool(fall > 0.0 and min(falls) >= _CONFIRMING_SHARE * fall),
        },
        {"kind": kinds, "rival": rivals},
    )
    shown = xr.concat([test.bands() for test in tests], dim="test", join="outer")
    return scores.merge(shown.assign_coords(test=[test.name for test in tests]))


def gain_over_nominal(tests, kind=EXTENDED):
    """`Contrast` of the members of a kind over the nominal ones on tests; None where these score within noise.

    Parameters
    ----------
    tests : list of JudgedTest
        With both kinds.
    kind : str
    """
    held = [
        replace(test, members={
            NOMINAL: test.members[NOMINAL], RECALIBRATED: test.members[NOMINAL], EXTENDED: test.members[kind],
        })
        for test in tests
        if test.judged.any()
    ]  # fmt: skip
    if not held:
        return None
    gained = response_gain(held).sel(rival=NOMINAL)
    estimate, lower, upper = (float(gained[name]) for name in ("gain", "gain_lower", "gain_upper"))
    return None if np.isnan(estimate) else Contrast.cut_off(estimate, lower, upper)


def select_gain(tests):
    """Gain over the nominal model on the tests to select by; None without any, or where nothing moves in them."""
    if not any(test.judged.any() for test in tests):
        return None
    return gain_over_nominal(tests) or NOTHING_TO_GAIN


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
            contrasts[rival] = NOTHING_TO_GAIN
            caveats.append(
                f"nothing to gain on the sealed tests against the {rival} model: it scores within noise"
            )
        else:
            contrasts[rival] = Contrast.cut_off(estimate, lower, upper)
    if gained.sizes["test"] == 1:
        caveats.append("one sealed test: the gain's interval holds no scatter from test to test")
    if not gained["confirmed"] and contrasts[RECALIBRATED].estimate > 0.0:
        caveats.append("solver-dependent: one solver by itself shows less than half of the gain")
    return MeasuredGain(gain=Gain(**contrasts), caveats=caveats, runs=runs)


def _cells(tests):
    generator = np.random.default_rng([len(tests), len(tests[0].models)])
    models, kinds = tests[0].models, list(tests[0].members)
    scales = [_scale(test) for test in tests]
    known = [scale > 0.0 for scale in scales]
    away, pairs = {}, {}
    for kind in kinds:
        parts = []
        for test, scale, judged in zip(tests, scales, known, strict=True):
            members = test.until_horizon(test.members[kind].to_numpy())[..., judged] / scale[judged]
            measured = test.until_horizon(test.measured.to_numpy())[None, :, judged] / scale[judged]
            parts.append((mean_differences(members, measured)[:, 0], mean_differences(members, members)))
        away[kind], pairs[kind] = (np.concatenate(one, axis=-1) for one in zip(*parts, strict=True))
    of_tests = resampled_weights(len(tests), generator)
    of_tests /= of_tests.sum(axis=1, keepdims=True)
    of_cells = [resampled_weights(int(judged.sum()), generator) for judged in known]
    of_members = [resampled_weights(int((models == one).sum()), generator) for one in dict.fromkeys(models)]
    return _Cells(
        away=away,
        pairs=pairs,
        weights=np.concatenate(
            [
                of_tests[:, [number]] * one / one.sum(axis=1, keepdims=True)
                for number, one in enumerate(of_cells)
            ],
            axis=1,
        ),
        members=np.concatenate(of_members, axis=1),
    )


def _scale(test):
    """Spread of each cell over nominal and extended members together, (n_cells,); 0 where nothing is judged."""
    both = np.concatenate([test.members[kind].to_numpy() for kind in (NOMINAL, EXTENDED)])
    known = test.judged & (np.isfinite(both).sum(axis=0) > 1) & np.isfinite(test.measured.to_numpy())
    variance = np.nanvar(np.where(known, both, 0.0), axis=0, ddof=1)
    return np.sqrt(variance.sum(axis=0) / np.maximum(known.sum(axis=0), 1))


def _ratio(fall, to_gain):
    """Fall of the score over its largest possible fall; 1 or -1 by its sign where nothing is left to gain."""
    return np.where(to_gain > 0.0, fall / np.where(to_gain > 0.0, to_gain, 1.0), np.sign(fall))
