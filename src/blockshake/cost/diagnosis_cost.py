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
    """CPU time of a diagnosis's simulations, clean campaigns and outcomes with them, if none of them is made yet.

    Parameters
    ----------
    folder : str or path
        The campaign.
    effort : str
        One of `EFFORTS`.
    tried : dict
        Ensembles of earlier campaigns, which cost nothing again; this campaign's are added.

    Returns
    -------
    list of CostPart
        The last one of a diagnosis that simulates ensembles only takes place where a cause is found.
    """
    plan = plan_diagnosis(folder, effort)
    first = _outcomes(plan) if plan.campaign.kind.batches else _clean(plan)
    if not plan.tests:
        return first
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
        *first,
        *parts,
        CostPart("tests with a cause, where one is found", more, more * float(np.mean(means))),
    ]


def _clean(plan):
    """Nominal models of all open tests, judged as if measured; tried by one test."""
    if not plan.clean:
        return []
    names = list(plan.opened)
    tried = names[len(names) // 2]
    share = sum(test.duration for test in plan.opened.values()) / plan.opened[tried].duration
    read = read_open_tests(plan.campaign, [tried])
    test = {tried: plan.opened[tried]}, {tried: read_channels(read.tests[tried])}
    seconds = {model: _second_time(simulate_clean_runs, *test, model, 1) for model in MODELS}
    words = f"clean campaigns of {count_words(len(names), 'test')}"
    return [
        CostPart(f"{words}, {model}", plan.clean, plan.clean * share * one) for model, one in seconds.items()
    ]


def _outcomes(plan):
    """Tests of which the outcome alone is known; tried by some of them."""
    campaign, draws = plan.campaign, plan.effort.outcomes
    few, count = replace(campaign, tests=dict(list(campaign.tests.items())[:_TRIED])), len(campaign.tests)
    seconds = {model: _second_time(simulate_outcomes, few, 0, model, draws) for model in solvers_of(draws)}
    words = f"outcomes of {count_words(count, 'test')}"
    return [
        CostPart(f"{words}, {model}", count * draws, count / len(few.tests) * one)
        for model, one in seconds.items()
    ]


def _second_time(simulate, *arguments):
    """CPU seconds of simulations into a new store, once they have loaded the kernels into another."""
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
