"""How long a diagnosis takes, from a trial of each of its tests by each solver on this machine."""

import tempfile
from dataclasses import replace
from functools import partial

import numpy as np

from blockshake.cost.jobs import CostPart, planned_jobs
from blockshake.cost.trial import cpu_seconds
from blockshake.diagnosis.nominal.clean_runs import simulate_clean_runs
from blockshake.diagnosis.nominal.histories import read_histories
from blockshake.diagnosis.nominal.nominal_model import MODELS, draw_nominal
from blockshake.diagnosis.nominal.plan import plan_diagnosis
from blockshake.diagnosis.nominal.simulated_test import simulated_test
from blockshake.diagnosis.outcomes.runs import simulate_outcomes, solvers_of
from blockshake.measurement.campaigns.open_readings import read_open_tests
from blockshake.measurement.sensors.accelerometers import read_channels
from blockshake.pages.wording import count_words
from blockshake.run_diagnosis import diagnosis_command
from blockshake.store import Store

_TRIED = 2  # draws of a test by a solver


def campaign_cost(folder, effort):
    """CPU time of a diagnosis by itself, see `diagnosis_cost`, with its jobs in addition to their runs."""
    return [*diagnosis_cost(folder, effort, {}), planned_jobs(diagnosis_command(folder, effort, cores=1))]


def diagnosis_cost(folder, effort, tried):
    """CPU time of all simulations of a diagnosis if none is made yet, from short trials on this machine.

    Parameters
    ----------
    folder : str or path
        The campaign.
    effort : str
        One of `EFFORTS`.
    tried : dict
        CPU seconds of one draw by digest of the test and model: a test that an earlier campaign had is simulated once
        and costs nothing again. This campaign's are added.

    Returns
    -------
    list of CostPart
        Clean campaigns or outcomes first, then ensembles by test and model, then tests with the cause, which are
        simulated only if a cause is found.
    """
    plan = plan_diagnosis(folder, effort)
    before = _outcome_parts(plan) if plan.campaign.kind.batches else _clean_parts(plan)
    if not plan.tests:
        return before
    count, parts, means = plan.effort.draws + plan.effort.twins, [], []
    for name, planned in plan.tests.items():
        for model in MODELS:
            key = planned.digest, model
            if key not in tried:
                tried[key] = _seconds_of_draws(planned, model)
                parts.append(CostPart(f"ensemble of {name}, {model}", count, count * tried[key]))
            means.append(tried[key])
    more = plan.runs_of_cause
    return [
        *before,
        *parts,
        CostPart("tests with a cause, where one is found", more, more * float(np.mean(means))),
    ]


def _clean_parts(plan):
    """`CostPart` of clean campaigns by model, scaled from a trial of one test by the duration of all."""
    if not plan.clean:
        return []
    names = list(plan.opened)
    tried = names[len(names) // 2]
    share = sum(test.duration for test in plan.opened.values()) / plan.opened[tried].duration
    read = read_open_tests(plan.campaign, [tried])
    test = {tried: plan.opened[tried]}, {tried: read_channels(read.tests[tried])}
    seconds = {model: _warm_seconds(simulate_clean_runs, *test, model, 1) for model in MODELS}
    words = f"clean campaigns of {count_words(len(names), 'test')}"
    return [
        CostPart(f"{words}, {model}", plan.clean, plan.clean * share * one) for model, one in seconds.items()
    ]


def _outcome_parts(plan):
    """`CostPart` of tests with a binary outcome by model, scaled from a trial of the first ones by their number."""
    campaign, draws = plan.campaign, plan.effort.outcomes
    few, count = replace(campaign, tests=dict(list(campaign.tests.items())[:_TRIED])), len(campaign.tests)
    seconds = {model: _warm_seconds(simulate_outcomes, few, 0, model, draws) for model in solvers_of(draws)}
    words = f"outcomes of {count_words(count, 'test')}"
    return [
        CostPart(f"{words}, {model}", count * draws, count / len(few.tests) * one)
        for model, one in seconds.items()
    ]


def _warm_seconds(simulate, *arguments):
    """CPU seconds of simulations into an empty store, measured the second time: the first one loads the kernels."""
    for _ in range(2):
        with tempfile.TemporaryDirectory() as folder:
            spent = cpu_seconds(partial(simulate, *arguments, Store(folder, "", str)))
    return spent


def _seconds_of_draws(planned, model):
    """CPU seconds of one simulated test, with its reading."""
    draws = [draw_nominal(planned.structure, model, number) for number in range(_TRIED)]

    def read(draw):
        read_histories(simulated_test(planned, draw), planned.structure, planned.sensors)

    read(draws[0])  # loads the kernels
    return cpu_seconds(lambda: [read(draw) for draw in draws]) / _TRIED
