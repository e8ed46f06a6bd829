"""The way of a diagnosis from readings to verdict, a function a step, in the order of the workflow.

Each function imports what it runs inside its own body. `blockshake.sources` watches this file function by function,
so that a step is rerun by an edit of what that step runs, and by no other: an edit of the gain reruns no library.
"""

from typing import NamedTuple

import xarray as xr

from blockshake.store import load_made


class Measured(NamedTuple):
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
    Measured
    """
    from blockshake.diagnosis.answer.decide import decide
    from blockshake.diagnosis.evidence.seen_campaign import see_campaign
    from blockshake.measurement.campaigns.campaign import load_campaign

    seen = see_campaign(load_campaign(folder), without)
    unseen = [f"{name} is not judged: {reason}" for name, reason in seen.unseen.items()]
    return Measured(seen.parity, *decide(seen.tests, without, unseen))


def simulate_library(name, solver, config, shared, store, source, progress):
    """Simulate one open test by one solver: nominal draws, and draws with every candidate effect.

    Parameters
    ----------
    name : str
        Of the library, as of `Plan.library`.
    solver : str
    config : dict
        Entries ``diagnosed``, folders of campaigns, and ``diagnosis_effort``.
    shared : str
        Digest of the sources that both solvers share, which is in the library's name.
    store, source, progress
        As of `library`; ``source`` is the solver's own.

    Returns
    -------
    features, histories : xarray.Dataset
        From `library`.
    """
    from blockshake.diagnosis.libraries.library import library
    from blockshake.diagnosis.libraries.plan import plan_of_library

    plan, test = plan_of_library(name, config["diagnosed"], config["diagnosis_effort"], shared)
    draws = plan.effort.nominal_draws, plan.own_draws
    return library(plan.tests[test], solver, plan.candidates, *draws, store, source, progress)


def calibrate_decision(libraries, effects, store, source, progress):
    """Judge every draw of the libraries by all others.

    Parameters
    ----------
    libraries : sequence of str
        Files of features, by test and solver.
    effects : sequence of str
        Names of the effects that are considered.
    store : str or path
        Folder of judged draws: one that is there is not judged again.
    source : str
        Digest of the sources that judge.
    progress : callable

    Returns
    -------
    list of ScoredReadings
    """
    from blockshake.diagnosis.inference.calibration import cases_of, library_cases, rows_of
    from blockshake.diagnosis.inference.library_scores import load_tables, score_library
    from blockshake.files import content_digest, file_digest
    from blockshake.store import kept_value

    given = source, [file_digest(path) for path in libraries], list(effects)

    def keep(model, draw, judge):
        key = content_digest(*given, model, draw)
        return cases_of(kept_value(store, key, lambda: rows_of(judge())))

    return library_cases(score_library(load_tables(libraries), effects)[0], progress, keep)


def simulate_cause(name, solver, key, further_draws, config, shared, store, source, progress):
    """Simulate more draws with one candidate than a library has.

    Parameters
    ----------
    key : str
        Of the candidate.
    further_draws : int
        Draws beyond the library's.
    name, solver, config, shared, store, source, progress
        As of `simulate_library`.

    Returns
    -------
    features : xarray.Dataset
        From `library`; nominal draws and the first with the candidate come from the store.
    """
    from blockshake.diagnosis.libraries.library import library
    from blockshake.diagnosis.libraries.plan import plan_of_library

    plan, test = plan_of_library(name, config["diagnosed"], config["diagnosis_effort"], shared)
    (candidate,) = (one for one in plan.candidates if one.key == key)
    draws = plan.own_draws + further_draws
    return library(plan.tests[test], solver, [candidate], draws, draws, store, source, progress)[0]


class Sized(NamedTuple):
    """The size of the first cause, and the tests that it rests on."""

    size: object
    tests: list


def size_cause(files, effects):
    """Measure the size of the first cause, from all draws with it.

    Parameters
    ----------
    files : object
        Attributes ``frozen``, ``decision``, ``readings``, ``libraries`` and ``further`` (by test and solver): files
        of the earlier steps.
    effects : sequence of str
        Names of the effects that are considered.

    Returns
    -------
    Sized
    """
    from blockshake.diagnosis.features.measured_readings import tamed_readings
    from blockshake.diagnosis.inference.decision import Decision, load_result
    from blockshake.diagnosis.inference.library_scores import load_tables, score_library
    from blockshake.diagnosis.inference.size_of_cause import library_of_cause, size_of_cause, without_second
    from blockshake.diagnosis.verdict.frozen import check_frozen

    check_frozen(files.frozen, files.decision)
    decision, tables = load_result(Decision, files.decision), load_tables(files.libraries)
    measured = load_made(files.readings)
    whole, scales = score_library(tables, effects)
    left = without_second(whole, tamed_readings(scales, measured), decision)
    library, _ = library_of_cause(tables, load_tables(files.further), decision.first_key)
    return Sized(size_of_cause(library, left), measured["test"].values.tolist())


def extend_model(folder, effort, solver, files, effects, store, source, progress):
    """Simulate sealed tests by one solver: the nominal, the recalibrated and the extended model.

    Parameters
    ----------
    folder, effort, solver : str
    files : object
        Attributes ``frozen``, ``decision``, ``readings``, ``libraries``, and ``posterior`` (the size and its hash) and
        ``further``, both empty where the cause is unknown and a force from outside extends the model: files of the
        earlier steps.
    effects : sequence of str
    store, source, progress
        As of `library`.

    Returns
    -------
    xarray.Dataset
        From `extended_runs`.
    """
    from blockshake.diagnosis.features.measured_readings import tamed_readings
    from blockshake.diagnosis.gain.described_force import members_with_force
    from blockshake.diagnosis.gain.extended_runs import extended_runs, members_with_cause, nominal_draws
    from blockshake.diagnosis.gain.extension import open_features
    from blockshake.diagnosis.inference.decision import CauseSize, Decision, load_result
    from blockshake.diagnosis.inference.library_scores import load_tables, score_library
    from blockshake.diagnosis.inference.size_of_cause import library_of_cause, without_second
    from blockshake.diagnosis.libraries.plan import plan_diagnosis
    from blockshake.diagnosis.verdict.frozen import check_frozen
    from blockshake.geometry.structure import load_structure

    check_frozen(files.frozen, files.decision)
    decision, tables = load_result(Decision, files.decision), load_tables(files.libraries)
    library, scales = score_library(tables, effects)
    features = tamed_readings(scales, load_made(files.readings))
    plan = plan_diagnosis(folder, effort)
    if files.posterior:
        posterior, frozen = files.posterior
        check_frozen(frozen, posterior)
        size, left = load_result(CauseSize, posterior), without_second(library, features, decision)
        library, _ = library_of_cause(tables, load_tables(files.further), size.key)
        members = members_with_cause(plan, solver, decision, size, library, left)
    else:
        draws = nominal_draws(plan, solver)[: plan.effort.members]
        members = members_with_force(decision.laws.outside, draws, load_structure(plan.campaign.structure))
    known = open_features(library, solver)
    return extended_runs(plan, solver, members, known, features, store, source, progress)


def measure_gain(folder, files):
    """Measure on the sealed tests what naming the cause gains: the one step that reads them.

    Parameters
    ----------
    folder : str
        Of the campaign.
    files : object
        Attributes ``frozen``, ``decision``, ``readings``, ``libraries``, ``parity``, and ``posterior`` (the size and
        its hash, or empty) and ``extended`` (by solver, or empty): files of the earlier steps.

    Returns
    -------
    CampaignGain
    """
    from blockshake.diagnosis.gain.campaign_gain import campaign_gain
    from blockshake.diagnosis.gain.sensor_gain import sensors_gain
    from blockshake.diagnosis.inference.decision import Decision, load_result
    from blockshake.diagnosis.inference.library_scores import load_tables
    from blockshake.diagnosis.verdict.frozen import check_frozen
    from blockshake.measurement.campaigns.campaign import load_campaign
    from blockshake.parity.parity import load_parity

    check_frozen(files.frozen, files.decision)
    if files.posterior:
        size, frozen_size = files.posterior
        check_frozen(frozen_size, size)
    campaign, readings = load_campaign(folder), load_made(files.readings)
    if not files.extended:
        return sensors_gain(campaign, readings, load_parity(files.parity).findings)
    runs = {one.attrs["model"]: one for one in map(load_made, files.extended)}
    laws = load_result(Decision, files.decision).laws
    broken = [one.name for one in laws.broken] if laws else []
    return campaign_gain(campaign, readings, load_tables(files.libraries), runs, broken)


def conclude(folder, files):
    """Put sensors, decision and gain together to the verdict.

    Parameters
    ----------
    folder : str
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
    measured = load_gain(files.gain) if files.gain else None
    caveats = [
        f"{test} is judged until {one.body} falls, at {one.time:.2f} s" for test, one in parity.falls.items()
    ]
    caveats += [f"{test}: {line}" for test, lines in parity.gaps.items() for line in lines]
    if not files.gain:
        caveats += no_gain(campaign, [*decision.parts, *parity.findings])
    return conclude(decision, parity.findings, parity.recorder_sensors, caveats, measured)


def predict_twins(name, histories, config, shared, progress):
    """Measure how long a test can be predicted, by all solvers.

    Parameters
    ----------
    histories : sequence of str
        Files from `simulate_library`, by solver.
    name, config, shared, progress
        As of `simulate_library`.

    Returns
    -------
    xarray.Dataset
        From `predictability_of`.
    """
    from blockshake.diagnosis.libraries.plan import plan_of_library
    from blockshake.diagnosis.misfit.predictability import predictability_of

    plan, test = plan_of_library(name, config["diagnosed"], config["diagnosis_effort"], shared)
    nominal = {one.attrs["model"]: one for one in map(load_made, histories)}
    return predictability_of(plan.tests[test], plan.effort.twins, nominal, progress)
