"""The way of a diagnosis from readings to verdict, a function a step, in the order of the workflow.

Each function imports what it runs inside its own body. `blockshake.sources` watches this file function by function,
so that a step is rerun by an edit of what that step runs, and by no other: an edit of the gain simulates nothing anew.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.store import load_made


def simulate_nominal(name, solver, config, shared, store, source, progress):
    """Simulate one open test by one solver: the ensemble of nominal models, and twins.

    Parameters
    ----------
    name : str
        Of the ensemble, as of `Plan.ensemble`.
    solver : str
    config : dict
        Entries ``diagnosed``, folders of campaigns, and ``diagnosis_effort``.
    shared : str
        Digest of the sources that both solvers share, which is in the ensemble's name.
    store, source, progress
        As of `simulate_members`; ``source`` is the solver's own.

    Returns
    -------
    xarray.Dataset
        From `simulate_members`.
    """
    from blockshake.diagnosis.nominal.ensemble import nominal_members, simulate_members
    from blockshake.diagnosis.nominal.plan import plan_of_ensemble

    plan, test = plan_of_ensemble(name, config["diagnosed"], config["diagnosis_effort"], shared)
    members = nominal_members(test, plan.tests[test], solver, plan.effort.draws, plan.effort.twins)
    return simulate_members(members, store, source, progress)


class Decided(NamedTuple):
    """A decision, the misfit of the nominal model, the features that decided, and the tests judged by."""

    decision: object
    misfit: xr.Dataset
    evidence: xr.Dataset
    tests: list


def decide(folder, effects, files):
    """Decide which effects the open tests speak for.

    Parameters
    ----------
    folder : str
        Of the campaign.
    effects : sequence of str
        Names of the effects that are considered.
    files : object
        Attributes ``readings``, ``forces``, ``libraries`` and ``histories`` (by test and solver), ``calibration``:
        files of the earlier steps.

    Returns
    -------
    Decided
    """
    from blockshake.diagnosis.features.measured_readings import reading_of, tamed_readings
    from blockshake.diagnosis.inference.calibration import load_cases
    from blockshake.diagnosis.inference.decide import decide
    from blockshake.diagnosis.inference.deciding_features import deciding_features
    from blockshake.diagnosis.inference.lawful_decision import with_laws
    from blockshake.diagnosis.inference.library_scores import load_tables, score_library
    from blockshake.diagnosis.laws.judged_laws import judge_laws
    from blockshake.diagnosis.laws.measured_forces import outside_of
    from blockshake.diagnosis.libraries.candidates import candidates
    from blockshake.diagnosis.misfit.misfit import misfit
    from blockshake.geometry.structure import load_structure
    from blockshake.measurement.campaigns.campaign import load_campaign

    measured = load_made(files.readings)
    names = [str(name) for name in measured["test"].values]
    library, scales = score_library(load_tables(files.libraries), effects)
    structure = load_structure(load_campaign(folder).structure)
    places = {one.key: one.place for one in candidates(structure)}
    cases = load_cases(files.calibration)
    decision = decide(library, tamed_readings(scales, measured), cases, places)
    ensembles = [list(by_solver.values()) for by_solver in load_tables(files.histories)]
    if measured.sizes["law"]:
        draws = {
            name: np.concatenate([one["law_value"].to_numpy() for one in own])
            for name, own in zip(names, ensembles, strict=True)
        }
        own = {name: measured.sel(test=name) for name in names}
        outside = outside_of(load_made(files.forces))
        decision = with_laws(decision, judge_laws(own, draws, outside, structure.weight_shares()), places)
    return Decided(
        decision,
        misfit(measured, dict(zip(names, ensembles, strict=True))),
        deciding_features(
            library,
            scales,
            [reading_of(measured, name) for name in names],
            names,
            decision.candidate(decision.first_key),
        ),
        names,
    )


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


def extend_model(folder, effort, solver, files, store, source, progress):
    """Simulate sealed tests by one solver: the nominal, the recalibrated, the extended and the placebo model.

    Parameters
    ----------
    folder, effort, solver : str
    files : object
        Attributes ``frozen``, ``decision``, ``parity`` and ``ensembles`` (by test, of this solver): files of the
        earlier steps.
    store, source, progress
        As of `simulate_members`.

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
    return extended_runs(plan, solver, causes, nominal, measured, store, source, progress)


def measure_gain(folder, effort, files):
    """Measure on the sealed tests what naming the cause gains: the one step that reads them.

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
    from blockshake.diagnosis.gain.campaign_gain import campaign_gain
    from blockshake.diagnosis.gain.sensor_gain import sensors_gain
    from blockshake.diagnosis.nominal.measured import measured_histories
    from blockshake.diagnosis.nominal.plan import plan_diagnosis, sealed_tests
    from blockshake.diagnosis.verdict.frozen import check_frozen
    from blockshake.geometry.structure import load_structure
    from blockshake.measurement.campaigns.campaign import load_test
    from blockshake.parity.parity import check_parity, load_parity

    check_frozen(files.frozen, files.decision)
    plan, findings = plan_diagnosis(folder, effort), load_parity(files.parity).findings
    campaign, names = plan.campaign, sealed_tests(plan.campaign)
    if not files.extended:
        return sensors_gain(campaign, plan.open, names, findings)
    tests = {name: load_test(campaign, name) for name in names}
    faults = check_parity(tests, load_structure(campaign.structure), campaign.sensors).findings
    return campaign_gain(
        plan,
        measured_histories(campaign, plan.tests, findings),
        measured_histories(campaign, names, faults),
        _by_test(plan, files.ensembles),
        [load_made(path) for path in files.extended],
    )


def conclude(folder, effort, files):
    """Put sensors, decision and gain together to the verdict.

    Parameters
    ----------
    folder, effort : str
    files : object
        Attributes ``parity``, ``decision``, ``misfit``, and ``posterior`` (the size and its hash, or empty) and
        ``gain`` (summary and scores, or empty): files of the earlier steps.

    Returns
    -------
    Verdict
    """
    from blockshake.diagnosis.inference.decision import CauseSize, Decision, load_result
    from blockshake.diagnosis.libraries.plan import plan_diagnosis
    from blockshake.diagnosis.misfit.misfit import where
    from blockshake.diagnosis.verdict.conclusion import Judged, conclude, no_gain
    from blockshake.diagnosis.verdict.verdict import MeasuredGain
    from blockshake.parity.parity import load_parity

    parity, decision = load_parity(files.parity), load_result(Decision, files.decision)
    misfit, plan = load_made(files.misfit), plan_diagnosis(folder, effort)
    size = load_result(CauseSize, files.posterior[0]) if files.posterior else None
    if files.gain:
        measured, scores = load_result(MeasuredGain, files.gain[0]), load_made(files.gain[1])
    else:
        described = [decision.described] if decision.described else []
        caveats = no_gain(plan.campaign, [*decision.causes, *parity.findings, *described])
        measured, scores = MeasuredGain(gain=None, caveats=caveats, runs=0), None
    runs = plan.runs + (plan.further_runs if size else 0) + measured.runs
    judged = Judged(where(misfit), misfit.sizes["test"])
    fell = [
        f"{test} is judged until {one.body} falls, at {one.time:.2f} s" for test, one in parity.falls.items()
    ]
    gaps = [f"{test}: {line}" for test, lines in parity.gaps.items() for line in lines]
    caveats = [*measured.caveats, *fell, *gaps]
    return conclude(
        decision, parity.findings, parity.recorder_sensors, judged, runs, caveats, effort, size, measured, scores,
    )  # fmt: skip
