"""The way of a diagnosis from readings to verdict, a function a step, in the order of the workflow.

In every step ``folder`` is that of the campaign, ``effort`` a key of `EFFORTS` (in `simulate_nominal`,
`describe_misfit` and `extend_model` one at which something is simulated), and ``files`` an object whose attributes are
the files of the earlier steps, as the rule of the step has them: ``ensembles`` by test and solver, ``extended`` by
solver, others one file each.

Each function imports what it runs inside its own body. `blockshake.sources` watches this file function by function,
so that a step is rerun by an edit of what that step runs, and by no other: an edit of the gain simulates nothing anew.
"""

from itertools import islice
from typing import NamedTuple

import xarray as xr

from blockshake.store import load_made


class DecidedCampaign(NamedTuple):
    """Sensors checked against each other, what the tests support, and their rows as forces."""

    parity: object
    decision: object
    evidence: xr.Dataset


def decide(folder, without, files=None):
    """`DecidedCampaign`: the open tests read, the faults of sensors taken out, and what acts decided.

    ``files.outcomes`` are the batches of `simulate_outcomes`; a campaign with readings has none. ``files.clean`` are
    the files of `simulate_clean`, none where no motion is known.
    """
    from blockshake.measurement.campaigns.campaign import load_campaign
    from blockshake.parity.parity import UNCHECKED

    campaign = load_campaign(folder)
    decision, evidence, *parity = campaign.kind.decide(campaign, files, without)
    return DecidedCampaign(*(parity or [UNCHECKED]), decision, evidence)


def decide_shaken(campaign, files, without):
    """Decision, evidence and parity of a campaign with base motion."""
    from blockshake.diagnosis.answer.decide import decide, undecided
    from blockshake.diagnosis.answer.thresholds import thresholds_of
    from blockshake.diagnosis.evidence.reconstructed_campaign import reconstruct_campaign
    from blockshake.files import load_json
    from blockshake.geometry.structure import load_structure

    seen = reconstruct_campaign(campaign, without)
    unseen = [f"{name} is not judged: {reason}" for name, reason in seen.unseen.items()]
    if not seen.tests:
        return *undecided(load_structure(campaign.structure), without, unseen), seen.parity
    runs = [run for path in files.clean for run in load_json(path)] if files else []
    select = [test.name for test in campaign.open.values() if test.role == "select"]
    return *decide(seen.tests, without, unseen, thresholds_of(runs), select), seen.parity


def simulate_nominal(folder, effort, number, solver, store):
    """One open test by one solver, from `simulate_members`: the ensemble of nominal models, and twins.

    ``number`` is that of the test among those that are simulated.
    """
    from blockshake.diagnosis.nominal.ensemble import nominal_members, simulate_members
    from blockshake.diagnosis.nominal.plan import plan_diagnosis

    plan = plan_diagnosis(folder, effort)
    test = list(plan.tests)[number]
    members = nominal_members(test, plan.tests[test], solver, plan.effort.draws, plan.effort.twins)
    return simulate_members(members, store)


def simulate_clean(folder, effort, solver, store):
    """Evidence of every cause in simulated open tests without any, by model: list of dict of str to float."""
    from dataclasses import replace

    from blockshake.diagnosis.evidence.reconstructed_campaign import found_sensors
    from blockshake.diagnosis.nominal.clean_runs import simulate_clean_runs
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.measurement.campaigns.open_readings import read_open_tests
    from blockshake.measurement.sensors.accelerometers import read_channels

    plan = plan_diagnosis(folder, effort)
    readings = read_open_tests(plan.campaign, plan.open)
    sensors = found_sensors(plan.campaign, readings)
    planned = {name: replace(test, sensors=sensors) for name, test in plan.opened.items()}
    channels = {name: read_channels(readings.tests[name]) for name in planned}
    return simulate_clean_runs(planned, channels, solver, plan.clean, store)


def simulate_outcomes(folder, effort, batch, solver, store):
    """A batch of tests of a campaign of outcomes by one solver; no outcome is read."""
    from blockshake.diagnosis.nominal.plan import EFFORTS
    from blockshake.diagnosis.outcomes.runs import simulate_outcomes
    from blockshake.measurement.campaigns.campaign import load_campaign

    return simulate_outcomes(load_campaign(folder), batch, solver, EFFORTS[effort].outcomes, store)


def describe_misfit(folder, effort, files):
    """`misfit` of the nominal ensembles of both solvers against the measured histories of the open tests."""
    from blockshake.diagnosis.misfit.judged_test import judged_test, measured_histories
    from blockshake.diagnosis.misfit.misfit import misfit
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.parity.parity import load_parity

    plan = plan_diagnosis(folder, effort)
    measured = measured_histories(plan.campaign, plan.tests, load_parity(files.parity).findings)
    nominal = _by_test(plan, files.ensembles)
    return misfit([judged_test(name, measured[name], nominal[name]) for name in plan.tests])


def _by_test(plan, files):
    """Ensembles of files that are listed by test and solver, or by test of one solver, a list for each test."""
    count = len(files) // len(plan.tests)
    runs = map(load_made, files)
    return {name: list(islice(runs, count)) for name in plan.tests}


def extend_model(folder, effort, solver, files, store):
    """Sealed tests by one solver, from `extended_runs`; ``files.ensembles`` are of this solver."""
    from blockshake.diagnosis.answer.decision import check_frozen, load_decision
    from blockshake.diagnosis.gain.extended_model import acting_causes, extended_runs
    from blockshake.diagnosis.misfit.judged_test import measured_histories
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.parity.parity import load_parity

    check_frozen(files.frozen, files.decision)
    plan, causes = plan_diagnosis(folder, effort), acting_causes(load_decision(files.decision))
    measured = measured_histories(plan.campaign, plan.tests, load_parity(files.parity).findings)
    nominal = {name: runs for name, (runs,) in _by_test(plan, files.ensembles).items()}
    return extended_runs(plan, solver, causes, nominal, measured, store)


def measure_gain(folder, effort, files):
    """`CampaignGain`, on the sealed tests, of naming the causes: the one step that reads these tests.

    ``files.ensembles`` and ``files.extended`` are empty where nothing is simulated, and ``files.outcomes`` where there
    are readings.
    """
    from blockshake.diagnosis.answer.decision import check_frozen, load_decision
    from blockshake.measurement.campaigns.campaign import load_campaign

    check_frozen(files.frozen, files.decision)
    campaign = load_campaign(folder)
    return campaign.kind.measure_gain(campaign, load_decision(files.decision), effort, files)


def measure_shaken_gain(campaign, decision, effort, files):
    """`CampaignGain` of a campaign with base motion, see `measure_gain`."""
    from blockshake.diagnosis.evidence.reconstructed_campaign import reconstruct_campaign, reconstruct_sealed
    from blockshake.diagnosis.gain.campaign_gain import campaign_gain, with_rows
    from blockshake.diagnosis.gain.row_gain import row_gain
    from blockshake.diagnosis.gain.sensor_gain import sensor_gain
    from blockshake.diagnosis.misfit.judged_test import measured_histories
    from blockshake.diagnosis.nominal.plan import plan_diagnosis
    from blockshake.parity.parity import load_parity

    findings = load_parity(files.parity).findings
    if not decision.parts:
        return sensor_gain(campaign, decision.tests, findings)
    sealed = reconstruct_sealed(campaign)
    rows = row_gain(decision, reconstruct_campaign(campaign).tests, sealed.tests)
    if not files.extended:
        return with_rows(None, *rows)
    plan = plan_diagnosis(campaign.folder, effort)
    responses = campaign_gain(
        plan,
        measured_histories(campaign, plan.tests, findings),
        measured_histories(campaign, list(campaign.sealed), sealed.parity.findings),
        _by_test(plan, files.ensembles),
        [load_made(path) for path in files.extended],
    )
    return with_rows(responses, *rows)


def conclude(folder, runs, files):
    """`Verdict` of sensors, decision and gain.

    ``runs`` is the number of simulated tests in all nominal ensembles, as of `Plan`, and ``files.gain`` the summary
    alone, or empty.
    """
    from blockshake.diagnosis.answer.decision import load_decision
    from blockshake.diagnosis.verdict.conclusion import conclude
    from blockshake.diagnosis.verdict.verdict import load_gain
    from blockshake.files import file_digest
    from blockshake.geometry.structure import load_structure
    from blockshake.measurement.campaigns.campaign import load_campaign
    from blockshake.parity.parity import load_parity

    parity, decision = load_parity(files.parity), load_decision(files.decision)
    measured = load_gain(files.gain[0]) if files.gain else None
    caveats = [
        f"{test} is judged until {fall.body} falls, at {fall.time:.2f} s"
        for test, fall in parity.falls.items()
    ]
    caveats += [f"{test}: {line}" for test, lines in parity.gaps.items() for line in lines]
    campaign = load_campaign(folder)
    judged = {
        "structure": load_structure(campaign.structure).content,
        "tests": {
            name: file_digest(campaign.folder / campaign.tests[name].file)
            for name in decision.tests
            if campaign.tests[name].file
        },
    }
    if (decision.parts or parity.findings) and not (files.gain or campaign.sealed):
        caveats.append("no gain was measured: there is no sealed test")
    verdict = conclude(decision, parity.findings, parity.recorder_sensors, caveats, measured, judged)
    return verdict.model_copy(update={"runs": runs + verdict.runs})
