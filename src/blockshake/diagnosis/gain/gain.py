"""Gain on sealed tests: the share of a rival's error that the extended model removes."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.cell_scores import cells_of, distances
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain

EXTENDED, RECALIBRATED = "extended", "recalibrated"
_REPLICATES = 1000
_INTERVAL = (0.05, 0.95)
_FLOOR_QUANTILE = 0.95  # share of the extended members' own scores that a rival must exceed
_CONFIRMING_SHARE = 0.5  # share of the fall that each solver must show by itself


class CampaignGain(NamedTuple):
    """Gain of a campaign: summary for the verdict, all scores, and consequences for the user."""

    summary: MeasuredGain
    scores: xr.Dataset
    consequences: xr.Dataset


def gain_on(tests):
    """Scores of all ensembles on sealed tests, and the gain of the extended ensemble against each of the others.

    Parameters
    ----------
    tests : list of SealedTest
        At least one; in all of them the same members in the same order.

    Returns
    -------
    xarray.Dataset
        In units of a feature's spread ``score(kind)``, ``score_of_test(kind, test)``, ``score_of_family(kind,
        family)``, ``score_of_solver(kind, model)``; ``floor``, and ``highest``, which 95 % of the extended members
        score less than; ``fall(rival)``, by how much the extended score is below the rival's, with ``fall_lower`` and
        ``fall_upper``; ``gain``, ``gain_lower`` and ``gain_upper(rival)`` [1], NaN where nothing is there to gain;
        ``fall_of_family``, ``fall_of_family_lower`` and ``fall_of_family_upper(family)`` against the recalibrated
        model; ``worse(family)``, whether that is below zero at its upper end too; ``confirmed``, whether each solver by
        itself shows half of the fall against the recalibrated model or more.

    Notes
    -----
    The score is the continuous ranked probability score, mean over tests of the mean over features, each in units of
    its standard deviation over nominal and extended members together. In units of the nominal spread alone the mean
    would be that of one feature: a weak joint moves the correlation of the top with the lowest block by 16 000 of them.
    Gain is ``(S_rival - S_extended) / (S_rival - S_floor)``: 1 leaves nothing to gain, below 0 the extension is worse.
    The floor is what the extended members score in the mean when each is taken for the record and judged by the others.

    One record scores by chance above or below the floor. Where the rival does not score more than 95 % of the extended
    members as the record would, its distance from the floor is noise and the ratio would be wild: nothing is there to
    gain.

    Intervals of 90 % by bootstrap (Efron and Tibshirani 1993, chapter 13) in two stages, since tests are few: tests, in
    each the families of features (joints, base, top), and members solver by solver, the same draws in ensembles of
    one size, which go back to the same nominal draws. With one sealed test there is no scatter from test to test in
    them. Those of a family are without the second stage.
    """
    tests = [_rescaled(test) for test in tests]
    cells, kinds = cells_of(tests), list(tests[0].members)
    rivals = [kind for kind in kinds if kind != EXTENDED]
    models = list(tests[0].members[EXTENDED])
    families = list(dict.fromkeys(cells.families))
    known = {kind: distances(tests, cells, kind) for kind in kinds}
    weights = cells.weights(np.ones(len(tests)), np.ones(len(cells.tests)))
    in_family = np.array([[own == name for own in cells.families] for name in families])
    in_test = np.arange(len(tests))[:, None] == cells.tests

    by_cell = {kind: one.scores(one.even_weights(models))[0] for kind, one in known.items()}
    score = {kind: weights @ values for kind, values in by_cell.items()}
    by_solver = {
        kind: [weights @ one.scores(one.even_weights([model]))[0] for model in models]
        for kind, one in known.items()
    }
    extended = known[EXTENDED]
    floor = weights @ extended.scores(extended.even_weights(models))[1]
    highest = np.quantile(weights @ extended.own_scores(), _FLOOR_QUANTILE)
    above = np.array([score[kind] > highest for kind in rivals])

    scores, floors, family_falls = _replicates(known, cells, models, len(tests), in_family)
    falls = np.array([score[kind] - score[EXTENDED] for kind in rivals])
    drawn_falls = np.array([scores[kind] - scores[EXTENDED] for kind in rivals])
    to_gain = np.array([score[kind] - floor for kind in rivals])
    drawn_to_gain = np.array([scores[kind] for kind in rivals]) - floors
    gains = _ratio(falls, to_gain)
    interval = np.quantile(_ratio(drawn_falls, drawn_to_gain), _INTERVAL, axis=1)
    of_family = _grouped(by_cell[RECALIBRATED] - by_cell[EXTENDED], weights, in_family)
    family_interval = np.nanquantile(family_falls, _INTERVAL, axis=1)  # a family may be in some tests alone
    solver_falls = np.subtract(by_solver[RECALIBRATED], by_solver[EXTENDED])
    fall = score[RECALIBRATED] - score[EXTENDED]
    cell_table = np.array([by_cell[kind] for kind in kinds])
    return xr.Dataset(
        {
            "score": ("kind", [score[kind] for kind in kinds]),
            "score_of_test": (("kind", "test"), _grouped(cell_table, weights, in_test)),
            "score_of_family": (("kind", "family"), _grouped(cell_table, weights, in_family)),
            "score_of_solver": (("kind", "model"), [by_solver[kind] for kind in kinds]),
            "floor": floor,
            "highest": highest,
            "fall": ("rival", falls),
            **_ends("fall", "rival", np.quantile(drawn_falls, _INTERVAL, axis=1)),
            "gain": ("rival", np.where(above, gains, np.nan)),
            **_ends("gain", "rival", np.where(above, interval, np.nan)),
            "fall_of_family": ("family", of_family),
            **_ends("fall_of_family", "family", family_interval),
            "worse": ("family", family_interval[1] < 0.0),
            "confirmed": bool(fall > 0.0 and (solver_falls >= _CONFIRMING_SHARE * fall).all()),
        },
        {
            "kind": kinds,
            "rival": rivals,
            "family": families,
            "model": models,
            "test": [test.name for test in tests],
        },
    )


def gain_of_verdict(gained, runs):
    """`MeasuredGain`, the gain of `gain_on` in the form of the verdict, with caveats and the number of simulated tests.

    It is cut off at -1 and 1. Where there is nothing to gain, it is 0, from -1 to 1.
    """
    contrasts, caveats = {}, []
    for rival in ("recalibrated", "nominal", "discrepancy"):
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
    if not gained["confirmed"] and float(gained["fall"].sel(rival=RECALIBRATED)) > 0.0:
        caveats.append("solver-dependent: one solver by itself shows less than half of the gain")
    return MeasuredGain(gain=Gain(**contrasts), caveats=caveats, runs=runs)


def contrast(estimate, lower, upper):
    """Gain with its interval, cut off at -1 and 1; an interval of few draws may miss its estimate."""
    values = {"estimate": estimate, "lower": min(lower, estimate), "upper": max(upper, estimate)}
    return Contrast(**{name: float(np.clip(value, -1.0, 1.0)) for name, value in values.items()})


def _replicates(known, cells, models, n_tests, in_family):
    """Bootstrap of scores by kind and of the floor, (n_replicates,), and of falls by family, (n_families, ...)."""
    scores = {kind: np.empty(_REPLICATES) for kind in known}
    floors, family_falls = np.empty(_REPLICATES), np.empty((len(in_family), _REPLICATES))
    for number in range(_REPLICATES):
        generator = np.random.default_rng([number, n_tests])
        weights, plain = np.zeros(len(cells.tests)), np.zeros(len(cells.tests))
        for test in generator.integers(n_tests, size=n_tests):
            once = np.arange(n_tests) == test
            own = np.flatnonzero(cells.tests == test)
            drawn = np.ones(len(cells.tests))  # the other tests do not count
            drawn[own] = np.bincount(generator.integers(len(own), size=len(own)), minlength=len(own))
            weights += cells.weights(once, drawn) / n_tests
            plain += cells.weights(once, np.ones(len(cells.tests))) / n_tests
        by_cell = {kind: one.scores(one.drawn_weights(models, number)) for kind, one in known.items()}
        for kind, (own, _) in by_cell.items():
            scores[kind][number] = weights @ own
        floors[number] = weights @ by_cell[EXTENDED][1]
        falls = by_cell[RECALIBRATED][0] - by_cell[EXTENDED][0]
        family_falls[:, number] = _grouped(falls, plain, in_family)
    return scores, floors, family_falls


def _rescaled(test):
    """The test in units of each feature's spread over nominal and extended members together."""
    both = [*test.members["nominal"].values(), *test.members[EXTENDED].values()]
    spread = np.concatenate(both).std(axis=0, ddof=1)
    members = {
        kind: {model: runs / spread for model, runs in own.items()} for kind, own in test.members.items()
    }
    return replace(test, measured=test.measured / spread, members=members)


def _ratio(fall, to_gain):
    """Fall of the score over its largest possible fall; 1 or -1 by its sign where nothing is left to gain."""
    return np.where(to_gain > 0.0, fall / np.where(to_gain > 0.0, to_gain, 1.0), np.sign(fall))


def _grouped(values, weights, inside):
    """Weighted means of cells (..., n_cells) in groups, inside (n_groups, n_cells); NaN of an empty one."""
    total = inside @ weights
    return np.where(total > 0.0, (values * weights) @ inside.T / np.where(total > 0.0, total, 1.0), np.nan)


def _ends(name, dim, interval):
    return {f"{name}_lower": (dim, interval[0]), f"{name}_upper": (dim, interval[1])}
