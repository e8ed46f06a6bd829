"""How long a study takes, from a moment of each case on this machine."""

import time

from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure
from blockshake.simulation.simulate import simulate

_TRIAL_START = 2.0  # s; by then the strong motion of the shipped records has begun
_TRIAL = 0.3  # s of motion after it


def estimate_hours(config):
    """CPU hours that the simulations of a study take.

    Parameters
    ----------
    config : StudyConfig

    Returns
    -------
    float

    Notes
    -----
    Each case is tried with each model until 0.3 s after the first 2 s, with nominal parameters, and again until
    2 s; the difference is what a second of strong motion costs. Stronger rocking than the trial's costs more. Twins
    count as one run and one of twice the steps; the search of the mean friction with as many runs as it may need.
    """
    seconds = 0.0
    for model, settings in config.models.items():
        for case in config.cases:
            structure, motion = load_structure(case.structure), load_motion(case.motion, case.scale)
            spent = []
            for duration in (0.01, _TRIAL_START, _TRIAL_START + _TRIAL):
                started = time.process_time()
                simulate(
                    structure, motion, model, settings.parameters,
                    time_step=settings.time_step, duration=duration, accelerometers=False,
                )  # fmt: skip
                spent.append(time.process_time() - started)
            per_second = max((spent[2] - spent[1]) / _TRIAL, (spent[2] - spent[0]) / (_TRIAL_START + _TRIAL))
            count = config.samples(model, case.name) + 3 * config.has_twins(model, case.name)
            search = config.friction_calibration
            if search is not None and search.model == model and case.name in search.cases:
                count += search.runs
            seconds += per_second * case.duration * count
    return seconds / 3600.0
