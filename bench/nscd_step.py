"""CPU time of a step of nonsmooth contact dynamics on the paper's four configurations."""

import numpy as np
from measuring import seconds_between, spread
from motions import harmonic

from blockshake.geometry.structure import load_structure
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

CONFIGURATIONS = ("configuration-1", "configuration-2", "configuration-3", "configuration-4")
TIME_STEP = 1e-3  # s, the paper's
DURATION = 2.0  # s, simulated


def nscd_run(structure, motion, **parameters):
    """Function of a number of steps: runs so many and returns the trajectory."""

    def run(steps):
        times = np.array([0.0, steps * TIME_STEP])
        trajectory = simulate_nscd(structure, motion, NscdParameters(**parameters), times, TIME_STEP)
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


def measure_nscd_step(repeats, duration=DURATION, configurations=CONFIGURATIONS):
    """`step_cost` of each configuration under the bench's motion, set-up and compiling left out."""
    motion = harmonic(duration)
    return {
        name: step_cost(nscd_run(load_structure(name), motion), 1, round(duration / TIME_STEP), repeats)
        for name in configurations
    }
