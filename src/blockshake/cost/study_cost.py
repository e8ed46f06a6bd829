"""How long a study takes, from a trial of each case by each model on this machine."""

import sys

from blockshake.cost.diagnosis_cost import diagnosis_cost
from blockshake.cost.jobs import CostPart, planned_jobs
from blockshake.cost.trial import run_seconds
from blockshake.dynamics.record_set import DrawnMotions
from blockshake.files import HOME
from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import solver_of
from blockshake.study.config import load_config
from blockshake.study.planned_runs import planned_runs


def study_cost(path):
    """CPU time of a study's parts, a list of `CostPart`, if nothing of it is made yet; `InputError` by its files.

    ``path``: of its configuration.

    Notes
    -----
    A replicate counts as two runs; the fragility with as many runs as it may need; a diagnosis
    without the runs of a cause, which it has only where it finds one.
    """
    config = load_config(path)
    parts = []
    for model, settings in config.models.items():
        for case in config.cases:
            structure = load_structure(case.structure)
            motion = next(DrawnMotions.of(case.model_dump()).strongest())
            trial = {"model": solver_of(model).name, **settings.model_dump()}
            planned = planned_runs(config, model, case)
            each = run_seconds(structure, motion, trial, case.duration, sum(one.count for one in planned))
            parts += [CostPart(one.name, one.count, one.motions * each) for one in planned]
    tried = {}
    for folder in config.diagnosis.campaigns:
        parts += diagnosis_cost(folder, config.diagnosis.effort, tried)
    command = [
        sys.executable, "-m", "snakemake", "--cores", "1", "--snakefile", str(HOME / "Snakefile"),
        "--configfile", str(path),
    ]  # fmt: skip
    return [*parts, planned_jobs(command)]
