"""How long a study takes, from a trial of each case by each model on this machine."""

import sys

from blockshake.cost.diagnosis_cost import diagnosis_cost
from blockshake.cost.jobs import CostPart, planned_jobs
from blockshake.cost.trial import run_seconds
from blockshake.dynamics.record_set import DrawnMotions
from blockshake.files import HOME
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.motion.measured_base import record_start
from blockshake.simulation.models import solver_of
from blockshake.study.config import load_config

_TWIN = 2  # runs that a twin costs, of half the step


def study_cost(path):
    """CPU time of a study's parts, a list of `CostPart`, if nothing of it is made yet; `InputError` by its files.

    ``path``: of its configuration.

    Notes
    -----
    A twin counts as two runs; the fragility with as many runs as it may need; a diagnosis
    without the runs of a cause, which it has only where it finds one.
    """
    config = load_config(path)
    parts = []
    for model, settings in config.models.items():
        for case in config.cases:
            structure = load_structure(case.structure)
            motion = next(DrawnMotions.of(case.model_dump()).strongest())
            trial = {"model": solver_of(model).name, **settings.model_dump()}
            planned = _runs(config, model, case)
            runs = sum(count for count, _ in planned.values())
            each = run_seconds(structure, motion, trial, case.duration, runs)
            parts += [CostPart(name, count, whole * each) for name, (count, whole) in planned.items()]
    tried = {}
    for folder in config.diagnosis.campaigns:
        parts += diagnosis_cost(folder, config.diagnosis.effort, tried)
    command = [
        sys.executable, "-m", "snakemake", "--cores", "1", "--snakefile", str(HOME / "Snakefile"),
        "--configfile", str(path),
    ]  # fmt: skip
    return [*parts, planned_jobs(command)]


def _runs(config, model, case):
    """Runs of a case by a model, by the part of the study: their number, and the whole motions in them."""
    samples = config.samples(model, case.name)
    runs = {f"samples of {case.name}, {model}": (samples, samples)}
    if config.has_twin(model, case.name):
        runs[f"twin of {case.name}, {model}"] = _TWIN, _TWIN
    planned = config.calibration
    if planned is not None and case.name in planned.cases.get(model, ()):
        # a test is simulated for its record where that is shorter than the case
        shares = [min(record / case.duration, 1.0) for record in _records(planned, case)]
        steps = planned.size * planned.steps(config.ensemble.distributions, solver_of(model))
        runs[f"calibration of {case.name}, {model}"] = planned.size * len(shares), steps * sum(shares)
    climbs = config.fragility
    if climbs is not None and climbs.model == model and case.name in climbs.cases:
        count = climbs.size * len(config.ladder.scales)
        runs[f"fragility of {case.name}"] = count, count
    return runs


def _records(calibration, case):
    """Lengths of the open tests of a case's campaign that the calibration simulates [s]."""
    campaign = load_campaign(case.measured.campaign)
    times = [load_test(campaign, name)["time"].to_numpy() for name in calibration.chosen(campaign)]
    return [float(time[-1] - record_start(time)) for time in times]
