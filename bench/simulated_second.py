"""CPU time of a simulated second of the paper's four configurations."""

import numpy as np
from measuring import seconds_between, spread
from motions import harmonic

from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters

TARGETS = {  # CPU seconds per simulated second at the first of the time steps
    "configuration-1": 0.22, "configuration-2": 0.31, "configuration-3": 0.75, "configuration-4": 1.3,
}  # fmt: skip
TIME_STEPS = (1e-5, 5e-5)  # s
DURATION = 0.5  # s, simulated


def measure_simulated_second(repeats, duration=DURATION, configurations=tuple(TARGETS)):
    """CPU seconds per simulated second, compiling and settling left out.

    Returns
    -------
    dict of str to dict
        For each configuration and time step, median and quartiles of repeats [s/s].
    """
    motion = harmonic(duration)
    return {
        name: {
            f"dt {time_step:g} s": spread(_costs(load_structure(name), motion, time_step, duration, repeats))
            for time_step in TIME_STEPS
        }
        for name in configurations
    }


def _costs(structure, motion, time_step, duration, repeats):
    """CPU time of runs of this duration less that of runs of one step, per simulated second."""

    def run(until):
        trajectory = simulate_ls_dem(structure, motion, LsDemParameters(), np.array([0.0, until]), time_step)
        if trajectory.status != "completed":
            raise RuntimeError(f"{structure.source} {trajectory.status}: {trajectory.reason}")

    run(time_step)
    return seconds_between(run, time_step, duration, repeats) / (duration - time_step)
