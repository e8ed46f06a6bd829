import sys
from pathlib import Path

import numpy as np
import pytest

from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

sys.path.insert(0, str(Path(__file__).parents[2] / "bench"))  # programs that write figures of docs


@pytest.fixture(scope="session")
def run_nscd():
    """NSCD run recorded at a uniform rate; keys are ``nscd`` parameters."""

    def run(structure, duration, *, motion=None, time_step=1e-3, rate=200, **parameters):
        times = np.arange(round(duration * rate) + 1) / rate
        return simulate_nscd(structure, motion, NscdParameters(**parameters), times, time_step)

    return run
