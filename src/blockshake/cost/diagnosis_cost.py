"""How long a diagnosis takes, from a trial of each of its tests by each solver on this machine."""

import time

import numpy as np

from blockshake.cost.jobs import planned_jobs
from blockshake.cost.part import Part
from blockshake.diagnosis.features.reading import read_off
from blockshake.diagnosis.libraries.designed_test import simulated_test
from blockshake.diagnosis.libraries.efforts import ENSEMBLES_OF_SEALED_TEST
from blockshake.diagnosis.libraries.null_model import MODELS, draw_nominal
from blockshake.diagnosis.libraries.plan import plan_diagnosis, sealed_tests
from blockshake.run_diagnosis import diagnosis_command

_TRIED = 2  # draws of a test by a solver


def campaign_cost(folder, effort):
    """CPU time of a diagnosis by itself, see `diagnosis_cost`, with its jobs beside their runs."""
    parts = diagnosis_cost(folder, effort, {})
    jobs = planned_jobs(diagnosis_command(folder, effort, cores=1))
    return [*parts, jobs.as_part()]


def diagnosis_cost(folder, effort, tried):
    """CPU time of a diagnosis's simulations, if no library of them is made yet.

    Parameters
    ----------
    folder : str or path
        Of the campaign.
    effort : str
        One of `EFFORTS`.
    tried : dict
        Libraries of earlier campaigns, which cost nothing again; this campaign's are added.

    Returns
    -------
    list of Part
        The last two only take place where a cause is found.

    Raises
    ------
    InputError
    """
    plan = plan_diagnosis(folder, effort)
    amounts, parts, means = plan.effort, [], []
    own = plan.own_draws * len(plan.candidates)
    for name, planned in plan.tests.items():
        for model in MODELS:
            key = planned.digest(), model
            if key in tried:
                means.append(tried[key])
                continue
            simulated, lawful, plain = _seconds_of_draws(planned, model)
            parts += [
                Part(
                    f"library of {name}, {model}",
                    amounts.nominal_draws + own,
                    amounts.nominal_draws * (simulated + lawful) + own * (simulated + plain),
                ),
                Part(f"twins of {name}, {model}", 1 + amounts.twins, (1 + amounts.twins) * simulated),
            ]
            tried[key] = simulated + lawful
            means.append(tried[key])
    further = len(plan.tests) * len(MODELS) * amounts.further_draws
    sealed = len(sealed_tests(plan.campaign)) * ENSEMBLES_OF_SEALED_TEST * len(MODELS) * amounts.members
    mean = float(np.mean(means))
    return [
        *parts,
        Part("more draws of a cause, where one is found", further, further * mean),
        Part("sealed tests, where a cause is found", sealed, sealed * mean),
    ]


def _seconds_of_draws(planned, model):
    """CPU seconds of one simulated test: to simulate, to read off with laws, and without."""
    draws = [draw_nominal(planned.structure, model, number) for number in range(_TRIED)]
    _seconds_of_draw(planned, draws[0])  # loads the kernels
    return np.mean([_seconds_of_draw(planned, draw) for draw in draws], axis=0)


def _seconds_of_draw(planned, draw):
    clock = [time.process_time()]
    test = simulated_test(planned, draw).test
    clock.append(time.process_time())
    for laws in (True, False):
        read_off(test, planned.structure, planned.sensors, laws=laws)
        clock.append(time.process_time())
    return np.diff(clock)
