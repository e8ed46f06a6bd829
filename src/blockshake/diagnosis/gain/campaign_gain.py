"""Gain of a campaign's extended model: the sealed tests are opened, and predicted by rival ensembles."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.special import ndtri

from blockshake.diagnosis.gain.response_gain import gain_of_verdict, response_gain, select_gain
from blockshake.diagnosis.misfit.judged_test import judged_test
from blockshake.diagnosis.nominal.ensemble import (
    DISCREPANCY,
    EXTENDED,
    NOMINAL,
    PLACEBO,
    RECALIBRATED,
    runs_of,
)
from blockshake.diagnosis.verdict.verdict import MeasuredGain
from blockshake.diagnosis.wording import percent_words
from blockshake.dynamics.system import FALLEN, FINISHED
from blockshake.pages.wording import listed
from blockshake.statistics.resampling import resampled_weights
from blockshake.study.extension.changes import quantities

_STILL = "no gain was measured on the responses: no joint moves in the sealed tests"
_IDLE = "the model with the cause is not proposed: of the error on the responses of {}, to select by, it removes {}"


class CampaignGain(NamedTuple):
    """Gain of a campaign: summary for the verdict, and all scores."""

    summary: MeasuredGain
    scores: xr.Dataset


def campaign_gain(plan, opened, sealed, nominal, runs):
    """Gain on the sealed tests against four rivals.

    Parameters
    ----------
    plan : Plan
    opened, sealed : dict of str to xarray.Dataset
        By test: measured, from `read_histories`.
    nominal : dict of str to list of xarray.Dataset
        By open test: its nominal ensembles, one a solver.
    runs : list of xarray.Dataset
        One a solver: from `extended_runs`.

    Returns
    -------
    CampaignGain
        ``scores`` from `response_gain`, and by test what the cause changes, from `_effect`.
    """
    planned = plan.tests | plan.sealed
    motions = {name: plan.campaign.tests[name].motion for name in planned}
    peaks = {name: test.peak_acceleration for name, test in planned.items()}
    known = [judged_test(name, opened[name], nominal[name]) for name in nominal]
    kinds = [kind for kind in (NOMINAL, RECALIBRATED, EXTENDED, PLACEBO) if (runs[0]["kind"] == kind).any()]
    tests = []
    for name, histories in sealed.items():
        test = judged_test(name, histories, [runs_of(solver_runs, test=name) for solver_runs in runs], kinds)
        drawn = test.members[NOMINAL].copy(data=members_with_discrepancy(test, known, motions, peaks))
        tests.append(replace(test, members=test.members | {DISCREPANCY: drawn}))
    select, unproposed = _selected(plan, opened, runs)
    count = plan.runs + sum(int(solver_runs.attrs["simulated"]) for solver_runs in runs)
    tests = [test for test in tests if test.judged.any()]
    if not tests:
        return CampaignGain(
            MeasuredGain(select=select, caveats=[*unproposed, _STILL], runs=count), xr.Dataset()
        )
    names = [test.name for test in tests]
    effects = xr.concat([_effect(name, runs, sealed[name]) for name in names], dim=xr.Variable("test", names))
    scores = response_gain(tests).merge(effects)
    measured = gain_of_verdict(scores, count)
    caveats = (*unproposed, *measured.caveats)
    return CampaignGain(measured.model_copy(update={"select": select, "caveats": caveats}), scores)


def _selected(plan, opened, runs):
    """Gain on the open tests to select by, None without any, and caveats: whether the model is not proposed."""
    judged = [
        judged_test(name, opened[name], [runs_of(one, test=name) for one in runs], (NOMINAL, EXTENDED))
        for name in plan.selecting
    ]
    gain = select_gain(judged)
    if MeasuredGain(select=gain).proposes:
        return gain, []
    return gain, [_IDLE.format(listed(plan.selecting), percent_words(gain))]


def _effect(name, runs, measured):
    """Changes that the cause makes in a sealed test, by the nominal and the extended members of all solvers.

    As of `quantities` along ``response``, of the drift of any block and the opening of any joint, with the number of
    members ``paired``, and measured ``largest(response)`` [m].
    """
    sides, finished = [], True
    for kind in (NOMINAL, EXTENDED):
        own = [runs_of(one, test=name, kind=kind) for one in runs]
        status = np.concatenate([one["status"].to_numpy() for one in own])
        peaks = [np.concatenate(parts) for parts in zip(*map(_peaks, own), strict=True)]
        sides.append([*peaks, np.isin(status, FALLEN)])
        finished = finished & np.isin(status, FINISHED)
    count = int(finished.sum())
    weights = resampled_weights(count, np.random.default_rng([count, *name.encode()])) if count else None
    end = max(float(one["time"][-1]) for one in own)
    drift, uplift = map(float, _peaks(measured.sel(time=slice(None, end))))
    found = quantities([[one[finished] for one in side] for side in sides], weights).rename(
        quantity="response"
    )
    return found.assign(paired=count, largest=("response", [drift, drift, uplift, np.nan, np.nan]))


def _peaks(histories):
    """Largest drift of any block and opening of any joint [m], of every run where there are several."""
    return np.abs(histories["drift"]).max(("time", "body")), histories["opening"].max(("time", "joint"))


def with_rows(responses, rows, caveats):
    """`CampaignGain` on rows, from `row_gain`, and on responses; None of these where nothing was simulated."""
    responses = responses or CampaignGain(MeasuredGain(), xr.Dataset())
    caveats = (*responses.summary.caveats, *caveats)
    return responses._replace(summary=responses.summary.model_copy(update={"rows": rows, "caveats": caveats}))


def members_with_discrepancy(test, opened, motions, peaks):
    """Nominal members of a sealed test with a draw of the discrepancy each, (n_members, n_times, n_cells).

    Parameters
    ----------
    test : JudgedTest
        Sealed.
    opened : list of JudgedTest
        Open ones.
    motions : dict of str to str
        By test, the name of its motion.
    peaks : dict of str to float
        By test, the peak acceleration that was commanded [m/s2].

    Notes
    -----
    Measured = model + discrepancy + noise (Kennedy and O'Hagan 2001, J. R. Stat. Soc. B 63), with a discrepancy that
    grows with the intensity and is known of the same motion alone: its mean is what the nominal mean missed under this
    motion, over the peak acceleration, mean over those open tests, instant by instant; under a motion that no open
    test had it is nothing. Its spread is what this rule misses in the open tests, each predicted from the others, root
    mean square over tests and times by cell. Members are the medians of as many strata of the normal law, in an order
    of their own by cell.
    """
    time, names = test.measured["time"].to_numpy(), list(test.measured["cell"].values)
    missed = {known.name: _missed(known, names, time) / peaks[known.name] for known in opened}

    def carried(name):
        same = [miss for other, miss in missed.items() if other != name and motions[other] == motions[name]]
        same = np.array(same).reshape(-1, len(time), len(names))
        return np.nansum(same, axis=0) / np.maximum(np.isfinite(same).sum(axis=0), 1)

    errors = np.array([miss - carried(name) for name, miss in missed.items()])
    known = np.isfinite(errors).sum(axis=(0, 1))
    spread = np.sqrt(np.nansum(errors**2, axis=(0, 1)) / np.maximum(known, 1))
    members = test.members[NOMINAL].to_numpy()
    strata = ndtri((np.arange(len(members)) + 0.5) / len(members))
    orders = [np.random.default_rng([len(members), *name.encode()]).permutation(strata) for name in names]
    drawn = np.array(orders).T[:, None] * spread
    return members + peaks[test.name] * (carried(test.name) + drawn)


def _missed(test, names, time):
    """Measured less nominal mean until the horizon, at other times and cells, NaN where it is not known."""
    missed = test.measured - test.members[NOMINAL].mean("run")
    missed = missed.copy(data=test.until_horizon(missed.to_numpy()))
    return missed.reindex(cell=names).interp(time=time).to_numpy()
