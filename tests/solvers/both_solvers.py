"""LS-DEM and rigid contact dynamics called alike, for the laws that both obey."""

import numpy as np
import pytest

from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

FIELDS = ("position", "orientation", "velocity", "angular_velocity", "energy", "joints", "joint_force")
TIME_STEP = {"ls-dem": 5e-5, "nscd": 1e-3}  # s
both = pytest.mark.parametrize("solver", TIME_STEP)


def solve(solver, structure, times, motion=None, time_step=None, checkpoint=None, **parameters):
    """Trajectory at ``times``, or at a uniform rate of 200 Hz until a duration; keys are the solver's parameters."""
    times = np.arange(round(200 * times) + 1) / 200 if np.ndim(times) == 0 else times
    given = (structure, motion), (times, time_step or TIME_STEP[solver])
    if solver == "ls-dem":
        return simulate_ls_dem(*given[0], LsDemParameters(**parameters), *given[1], checkpoint=checkpoint)
    return simulate_nscd(*given[0], NscdParameters(**parameters), *given[1], checkpoint=checkpoint)


def assert_same_bytes(run, other):
    """Every field of both runs has the same bits."""
    for field in FIELDS:
        assert getattr(run, field).tobytes() == getattr(other, field).tobytes(), field


def leans(run):
    """Lean of the first free body about y [rad]."""
    return 2.0 * np.arctan2(run.orientation[:, 1, 2], run.orientation[:, 1, 0])
