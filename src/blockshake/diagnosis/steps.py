"""The way of a diagnosis from readings to verdict, a function a step, in the order of the workflow.

Each function imports what it runs inside its own body. `blockshake.sources` watches this file function by function,
so that a step is rerun by an edit of what that step runs, and by no other: an edit of the gain simulates nothing anew.
"""

from typing import NamedTuple

import xarray as xr

from blockshake.errors import InputError
from blockshake.store import load_made


class DecidedCampaign(NamedTuple):
    """Sensors checked against each other, what the tests speak for, and their rows as forces."""

    parity: object
    decision: object
    evidence: xr.Dataset


def decide(folder, without):
    """Read the open tests of a campaign, take the faults of sensors out, and decide what acts.

    Parameters
    ----------
    folder : str
        Of the campaign.
    without : sequence of str
        Effects that are left out, as if nobody had thought of them.

    Returns
    -------
    DecidedCampaign
    """
    from blockshake.diagnosis.answer.decide import decide
    from blockshake.diagnosis.evidence.seen_campaign import see_campaign
    from blockshake.diagnosis.flight.decide import decide_flights
    from blockshake.measurement.campaigns.campaign import load_campaign
    from blockshake.measurement.poses.posed_test import load_posed
    from blockshake.parity.parity import UNCHECKED

    campaign = load_campaign(folder)
    if campaign.still:
        return DecidedCampaign(UNCHECKED, *decide_flights(load_posed(campaign, list(campaign.open)), without))
    seen = see_campaign(campaign, without)
    unseen = [f"{name} is not judged: {reason}" for name, reason in seen.unseen.items()]
    if not seen.tests:
        raise InputError(
            folder, "tests", f"expected an open test whose forces can be read; {'; '.join(unseen)}"
        )
    return DecidedCampaign(seen.parity, *decide(seen.tests, without, unseen))


def simulate_nominal(folder, effort, number, solver, store):
    """Simulate one open test by one solver: the ensemble of nominal models, and twins.

    Parameters
    ----------
    folder, effort : str
        Of the campaign; one at which something is simulated.
    number : int
        Of the test among those that are simulated.
    solver : str
    store : Store

    Returns
    -------
    xarray.Dataset
        From `simulate_members`.
    """
    from blockshake.diagnosis.nominal.ensemble import nominal_members, simulate_members
    from blockshake.diagnosis.nominal.plan import plan_diagnosis

    plan = plan_diagnosis(folder, effort)
    test = list(plan.tests)[number]
    members = nominal_members(test, plan.tests[test], solver, plan.effort.draws, plan.effort.twins)
    return simulate_members(members, store)


def describe_misfit(folder, effort, files):
    """Hold the nominal ensembles of both solvers beside the measured histories of the open tests.

    Parameters
    ----------
    folder, effort : str
        Of the campaign; one at which something is simulated.
    files : object
        Attributes ``parity`` and ``ensembles`` (by test and solver): files of the earlier steps.

    Returns
    -------
    xarray.Dataset
        From `misfit`.
    """
    from blockshake.diagnosis.misfit.judged_test import judged_test
    from blockshake.diagnosis.misfit.misfit import misfit
    from blockshake.diagnosis.nominal.measured import measured_histories
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.parity.parity import load_parity

    plan = plan_diagnosis(folder, effort)
    measured = measured_histories(plan.campaign, plan.tests, load_parity(files.parity).findings)
    nominal = _by_test(plan, files.ensembles)
    return misfit([judged_test(name, measured[name], nominal[name]) for name in plan.tests])


def _by_test(plan, files):
    """Ensembles of files that are listed by test and solver, or by test of one solver, a list for each test."""
    runs = [load_made(path) for path in files]
    count = len(runs) // len(plan.tests)
    return {name: runs[place * count : (place + 1) * count] for place, name in enumerate(plan.tests)}


def extend_model(folder, effort, solver, files, store):
    """Simulate sealed tests by one solver: the nominal, the recalibrated, the extended and the placebo model.

    Parameters
    ----------
    folder, effort, solver : str
    files : object
        Attributes ``frozen``, ``decision``, ``parity`` and ``ensembles`` (by test, of this solver): files of the
        earlier steps.
    store : Store

    Returns
    -------
    xarray.Dataset
        From `extended_runs`.
    """
    from blockshake.diagnosis.answer.decision import load_decision
    from blockshake.diagnosis.gain.extended_model import acting_causes, extended_runs
    from blockshake.diagnosis.nominal.measured import measured_histories
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.diagnosis.verdict.frozen import check_frozen
    from blockshake.parity.parity import load_parity

    check_frozen(files.frozen, files.decision)
    plan, causes = plan_diagnosis(folder, effort), acting_causes(load_decision(files.decision))
    measured = measured_histories(plan.campaign, plan.tests, load_parity(files.parity).findings)
    nominal = {name: runs for name, (runs,) in _by_test(plan, files.ensembles).items()}
    return extended_runs(plan, solver, causes, nominal, measured, store)


def measure_gain(folder, effort, files):
    """Measure on the sealed tests what naming the causes gains: the one step that reads them.

    Parameters
    ----------
    folder, effort : str
    files : object
        Attributes ``frozen``, ``decision``, ``parity``, and ``ensembles`` (by test and solver) and ``extended`` (by
        solver), both empty where nothing is simulated: files of the earlier steps.

    Returns
    -------
    CampaignGain
    """
    from blockshake.diagnosis.answer.decision import load_decision
    from blockshake.diagnosis.evidence.seen_campaign import see_campaign, see_sealed
    from blockshake.diagnosis.flight.gain import flight_gain
    from blockshake.diagnosis.gain.campaign_gain import campaign_gain, with_rows
    from blockshake.diagnosis.gain.row_gain import row_gain
    from blockshake.diagnosis.gain.sensor_gain import sensors_gain
    from blockshake.diagnosis.nominal.measured import measured_histories
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.diagnosis.verdict.frozen import check_frozen
    from blockshake.measurement.campaigns.campaign import load_campaign
    from blockshake.measurement.poses.posed_test import load_posed
    from blockshake.parity.parity import load_parity

    check_frozen(files.frozen, files.decision)
    campaign, decision = load_campaign(folder), load_decision(files.decision)
    if campaign.still:
        opened, sealed = (load_posed(campaign, list(tests)) for tests in (campaign.open, campaign.sealed))
        return flight_gain(opened, sealed, decision)
    findings = load_parity(files.parity).findings
    if not decision.parts:
        return sensors_gain(campaign, decision.tests, list(campaign.sealed), findings)
    sealed = see_sealed(campaign)
    rows = row_gain(decision, see_campaign(campaign).tests, sealed.tests)
    if not files.extended:
        return with_rows(None, *rows)
    plan = plan_diagnosis(folder, effort)
    responses = campaign_gain(
        plan,
        measured_histories(campaign, plan.tests, findings),
        measured_histories(campaign, list(campaign.sealed), sealed.parity.findings),
        _by_test(plan, files.ensembles),
        [load_made(path) for path in files.extended],
    )
    return with_rows(responses, *rows)


def conclude(folder, runs, files):
    """Put sensors, decision and gain together to the verdict.

    Parameters
    ----------
    folder : str
    runs : int
        Simulated tests in all nominal ensembles, as of `Plan`.
    files : object
        Attributes ``parity``, ``decision`` and ``gain`` (the summary, or empty): files of the earlier steps.

    Returns
    -------
    Verdict
    """
    from blockshake.diagnosis.answer.decision import load_decision
    from blockshake.diagnosis.verdict.conclusion import conclude, no_gain
    from blockshake.diagnosis.verdict.verdict import load_gain
    from blockshake.measurement.campaigns.campaign import load_campaign
    from blockshake.parity.parity import load_parity

    parity, decision = load_parity(files.parity), load_decision(files.decision)
    campaign = load_campaign(folder)
    measured = load_gain(files.gain[0]) if files.gain else None
    caveats = [
        f"{test} is judged until {one.body} falls, at {one.time:.2f} s" for test, one in parity.falls.items()
    ]
    caveats += [f"{test}: {line}" for test, lines in parity.gaps.items() for line in lines]
    if not files.gain:
        caveats += no_gain(campaign, [*decision.parts, *parity.findings])
    verdict = conclude(decision, parity.findings, parity.recorder_sensors, caveats, measured)
    return verdict.model_copy(update={"runs": runs + verdict.runs})
