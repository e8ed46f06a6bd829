"""How long a diagnosis takes, from a trial of each of its tests by each solver on this machine."""

import numpy as np

from blockshake.cost.jobs import CostPart, planned_jobs
from blockshake.cost.trial import cpu_seconds
from blockshake.diagnosis.nominal.histories import read_histories
from blockshake.diagnosis.nominal.nominal_model import MODELS, draw_nominal
from blockshake.diagnosis.nominal.plan import plan_diagnosis
from blockshake.diagnosis.nominal.simulated_test import simulated_test
from blockshake.run_diagnosis import diagnosis_command

_TRIED = 2  # draws of a test by a solver


def campaign_cost(folder, effort):
    """CPU time of a diagnosis by itself, see `diagnosis_cost`, with its jobs in addition to their runs."""
    return [*diagnosis_cost(folder, effort, {}), planned_jobs(diagnosis_command(folder, effort, cores=1))]


def diagnosis_cost(folder, effort, tried):
    """CPU time of a diagnosis's simulations, if no ensemble of them is made yet.

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
        The last one only takes place where a cause is found. Empty at an effort that simulates nothing.
    """
    plan = plan_diagnosis(folder, effort)
    if not plan.tests:
        return []
    count, parts, means = plan.effort.draws + plan.effort.twins, [], []
    for name, planned in plan.tests.items():
        for model in MODELS:
            key = planned.digest, model
            if key not in tried:
                tried[key] = _seconds_of_draws(planned, model)
                parts.append(CostPart(f"ensemble of {name}, {model}", count, count * tried[key]))
            means.append(tried[key])
    more = plan.runs_of_cause
    return [*parts, CostPart("tests with a cause, where one is found", more, more * float(np.mean(means)))]


def _seconds_of_draws(planned, model):
    """CPU seconds of one simulated test, with its reading."""
    draws = [draw_nominal(planned.structure, model, number) for number in range(_TRIED)]

    def read(draw):
        read_histories(simulated_test(planned, draw), planned.structure, planned.sensors)

    read(draws[0])  # loads the kernels
    return cpu_seconds(lambda: [read(draw) for draw in draws]) / _TRIED
