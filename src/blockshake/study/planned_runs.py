"""Runs of a study by their part, before they are made: what an estimate tries, and what progress is counted by."""

import re
from typing import NamedTuple

from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.motion.measured_base import record_start
from blockshake.simulation.models import solver_of
from blockshake.study.ensembles.batch import CALIBRATION, FRAGILITY, REPLICATE, SAMPLES, part_name

_OF_REPLICATE = 2  # runs that a replicate costs, of half the step
LINE = re.compile(
    rf"^((?:{SAMPLES}|{REPLICATE}|{CALIBRATION}|{FRAGILITY}) of .*): (sample \d+.*?), (.*?)(?:; took (\S+) s)?$"
)
"""Line on a run that is done: its part, which one it is, how it ended, and seconds where it was simulated."""


class PlannedRuns(NamedTuple):
    """Runs of a case by a model in one part of a study."""

    part: str  # first word of its name
    case: str
    model: str
    count: int  # simulations at most; a replicate counts as two
    motions: float  # whole motions in them, for the time that they take
    lines: tuple[str, ...]  # what their lines call them: some runs share one

    @property
    def name(self):
        """As in the lines on its runs."""
        return part_name(self.part, self.case, self.model)


def planned_runs(config, model, case):
    """`PlannedRuns` of a case, an entry of a `StudyConfig`, by a model of it."""

    def of(part, count, motions, lines):
        return PlannedRuns(part, case.name, model, count, motions, tuple(lines))

    samples = config.samples(model, case.name)
    parts = [of(SAMPLES, samples, samples, _samples(samples))]
    if config.has_replicate(model, case.name):
        parts.append(of(REPLICATE, _OF_REPLICATE, _OF_REPLICATE, _samples(1)))
    planned = config.calibration
    if planned is not None and case.name in planned.cases.get(model, ()):
        # a test is simulated for its record where that is shorter than the case
        records = _records(planned, case)
        shares = sum(min(record / case.duration, 1.0) for record in records.values())
        steps = planned.size * planned.steps(config.ensemble.distributions, solver_of(model))
        lines = [f"{sample} in {test}" for test in records for sample in _samples(planned.size)]
        parts.append(of(CALIBRATION, len(lines), steps * shares, lines))
    climbs = config.fragility
    if climbs is not None and climbs.model == model and case.name in climbs.cases:
        count = climbs.size * len(config.ladder.scales)
        parts.append(of(FRAGILITY, count, count, _samples(climbs.size)))
    return parts


def _samples(count):
    return [f"sample {number}" for number in range(count)]


def _records(calibration, case):
    """Lengths of the open tests of a case's campaign that the calibration simulates, by name [s]."""
    campaign = load_campaign(case.measured.campaign)
    times = {name: load_test(campaign, name)["time"].to_numpy() for name in calibration.chosen(campaign)}
    return {name: float(time[-1] - record_start(time)) for name, time in times.items()}
