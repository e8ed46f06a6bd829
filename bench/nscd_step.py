"""CPU time of a step of nonsmooth contact dynamics on the paper's four configurations."""

import numpy as np
from measuring import seconds_between, spread
from motions import harmonic

from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import model_of

CONFIGURATIONS = ("configuration-1", "configuration-2", "configuration-3", "configuration-4")
TIME_STEP = 1e-3  # s, the paper's
DURATION = 2.0  # s, simulated
DEFORMABLE = ("nscd-elastic", "nscd-viscoelastic")
TARGETS_US = {"configuration-1 nscd-rigid": 15.0}


def nscd_run(structure, motion, model="nscd-rigid", **parameters):
    """Function of a number of steps: runs so many and returns the trajectory."""
    row = model_of(model)

    def run(steps):
        times = np.array([0.0, steps * TIME_STEP])
        trajectory = row.solve(structure, motion, row.schema(**parameters), times, TIME_STEP)
        if trajectory.status == "diverged":
            raise RuntimeError(f"{structure.source} {trajectory.status}: {trajectory.reason}")
        return trajectory

    return run


def step_cost(run, first, last, repeats):
    """Cost of the steps between two numbers of steps, and how well they were solved.

    Returns
    -------
    dict
        ``us_per_step``: median and quartiles [us]; ``iterations``: mean of these steps [1]; ``capped``: share of
        them that ended above the tolerance [1]; ``max_residual``: of the whole run [1].
    """
    before, after = run(first).numerics, run(last).numerics
    steps = last - first
    done = after["mean_iterations"] * after["steps"] - before["mean_iterations"] * before["steps"]
    return {
        "us_per_step": spread(1e6 * seconds_between(run, first, last, repeats) / steps),
        "iterations": done / steps,
        "capped": (after["capped_steps"] - before["capped_steps"]) / steps,
        "max_residual": after["max_residual"],
    }


def measure_nscd_step(repeats, duration=DURATION, configurations=CONFIGURATIONS, deformable=DEFORMABLE):
    """`step_cost` of each configuration under the bench's motion, set-up and compiling left out.

    The two stacks are measured with the ``deformable`` models too: a wall's step takes tens of milliseconds there.
    """
    motion, last = harmonic(duration), round(duration / TIME_STEP)
    cases = [(name, "nscd-rigid") for name in configurations]
    cases += [(name, model) for model in deformable for name in configurations[:2]]
    return {
        f"{name} {model}": step_cost(nscd_run(load_structure(name), motion, model), 1, last, repeats)
        for name, model in cases
    }
