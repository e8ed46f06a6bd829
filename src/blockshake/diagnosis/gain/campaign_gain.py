"""Gain of a campaign's extended model: the sealed tests are opened, and predicted by rival ensembles."""

from dataclasses import replace
from typing import NamedTuple

import xarray as xr

from blockshake.diagnosis.gain.discrepancy import members_with_discrepancy
from blockshake.diagnosis.gain.response_gain import gain_of_verdict, response_gain
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

_STILL = "no gain was measured on the responses: no joint moves in the sealed tests"
_OF_PARAMETERS = ("prior", "posterior", "narrowing", "skill", "chance", "informed", "held")


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
        ``scores`` from `response_gain`; and along ``model`` and ``parameter`` what the open tests tell of the nominal
        parameters, as of `Recalibration.informed`, NaN and false of a parameter that a solver has not.
    """
    planned = plan.tests | plan.sealed
    motions = {name: plan.campaign.tests[name].motion for name in planned}
    peaks = {name: one.peak_acceleration for name, one in planned.items()}
    known = [judged_test(name, opened[name], nominal[name]) for name in nominal]
    kinds = [kind for kind in (NOMINAL, RECALIBRATED, EXTENDED, PLACEBO) if (runs[0]["kind"] == kind).any()]
    tests = []
    for name, histories in sealed.items():
        test = judged_test(name, histories, [runs_of(one, test=name) for one in runs], kinds)
        drawn = test.members[NOMINAL].copy(data=members_with_discrepancy(test, known, motions, peaks))
        tests.append(replace(test, members=test.members | {DISCREPANCY: drawn}))
    count = plan.runs + sum(int(one.attrs["simulated"]) for one in runs)
    tests = [test for test in tests if test.judged.any()]
    if not tests:
        return CampaignGain(MeasuredGain(gain=None, caveats=[_STILL], runs=count), xr.Dataset())
    scores = response_gain(tests)
    return CampaignGain(gain_of_verdict(scores, count), scores.merge(_parameters(runs), compat="override"))


def with_rows(responses, rows, table, caveats):
    """`CampaignGain` on rows and, where they were simulated, on responses.

    Parameters
    ----------
    responses : CampaignGain or None
    rows, table, caveats
        From `row_gain`.
    """
    table = table.rename({name: f"row_{name}" for name in [*table.data_vars, *table.dims]})
    if responses is None:
        return CampaignGain(MeasuredGain(rows=rows, caveats=tuple(caveats)), table)
    own = responses.summary
    summary = own.model_copy(update={"rows": rows, "caveats": (*own.caveats, *caveats)})
    return CampaignGain(summary, responses.scores.merge(table))


def _parameters(runs):
    """Information of the open tests on the nominal parameters, by solver."""
    parts = [one[list(_OF_PARAMETERS)] for one in runs]
    whole = xr.concat(
        parts, dim="model", join="outer", coords="minimal", compat="override", fill_value={"informed": False}
    )
    return whole.assign_coords(model=[one.attrs["model"] for one in runs]).rename(quantile="bound")
