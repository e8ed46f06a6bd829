"""One nominal model of all open tests of a campaign, seen and judged as the measured tests are."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.diagnosis.answer.answer import rank
from blockshake.diagnosis.answer.explain import gather_evidence
from blockshake.diagnosis.answer.places import joined_bodies
from blockshake.diagnosis.evidence.angular_momentum_ratio import restitution_gain
from blockshake.diagnosis.evidence.closed_joints import closed_joints
from blockshake.diagnosis.evidence.slab_motion import explain_slab, slab_motion
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.nominal.simulated_test import simulated_test
from blockshake.effects.impact_restitution import EFFECT as RESTITUTION
from blockshake.forces.seen.reconstructed_test import reconstruct_test, why_not_reconstructed
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.store import Unit


def simulate_clean_runs(planned, channels, solver, count, store):
    """Evidence of every cause in simulated tests in which none acts, of some nominal models by one solver.

    Parameters
    ----------
    planned : dict of str to PlannedTest
        All open tests, by name; their sensors with the noise that was found.
    channels : dict of str to list of str
        Channels of accelerometers that were read, by test.
    solver : str
    count : int
        Nominal models, the first ones of `draw_nominal`.
    store : Store

    Returns
    -------
    list of dict of str to float
        As of `gains_by_cause`, by model; empty of a model of which no test shows any forces.
    """
    runs = []
    for number in range(count):
        tests = tuple((name, one, tuple(channels[name])) for name, one in planned.items())
        runs.append(store.value(_CleanRun(tests, solver, number)))
        store.say(f"clean runs by {solver} {number + 1}/{count}: {_words(runs[-1])}")
    return runs


def gains_by_cause(seen):
    """Logarithm of the evidence of every cause over none, by name, at the places of `rank`, of `ReconstructedTest`
    together."""
    closed = {name: joint.gains for name, joint in closed_joints(seen).items()}
    gains = {one.cause: one.gain for one in rank(gather_evidence(seen), closed, joined_bodies(seen))}
    gains |= {name: one.gain for name, one in explain_slab([slab_motion(test) for test in seen]).items()}
    return gains | {RESTITUTION.name: restitution_gain(seen).gain}


@dataclass(frozen=True)
class _CleanRun(Unit):
    """Evidence of every cause in the tests of one nominal model."""

    tests: tuple  # of name, `PlannedTest` and names of the channels, in the order of the noise's seeds
    solver: str
    number: int

    def made(self, checkpoint):
        return _gains(self.tests, self.solver, self.number)


def _gains(tests, solver, number):
    seen = [
        reconstruct_test(name, readings, test.structure, test.sensors)
        for index, (name, test, channels) in enumerate(tests)
        if (readings := _readings(test, channels, solver, number, index)) is not None
    ]
    return gains_by_cause(seen) if seen else {}


def _readings(test, channels, solver, number, index):
    """Readings of a simulated test until a block falls, with noise of its own; None of one that cannot be seen."""
    draw = draw_nominal(test.structure, solver, number)
    seed = int(np.random.default_rng([draw.seed, index]).integers(2**31))
    noise = draw.noise | {
        "louder": 1.0,
        "noise_memory": 0.0,
    }  # the sensors' noise is found, slow part and all
    read = simulated_test(test, replace(draw, noise=noise, seed=seed), accelerometers=bool(channels))
    if channels:
        read = read.sel(channel=[name for name in channels if name in read["channel"].values])
    read = without_outliers(until_fall(read, find_fall(read, test.structure, test.sensors)), test.structure)
    return None if why_not_reconstructed(read, test.structure) else read


def _words(gains):
    if not gains:
        return "no test shows any forces"
    name = max(gains, key=gains.get)
    return f"the largest evidence is {gains[name]:.1f} nats, of {name}"
