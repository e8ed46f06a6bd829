import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters


@pytest.fixture(scope="session")
def scene(make_structure):
    """Structure of bodies on a driven floor whose top is at z = 0, all of one stone; friction may be a law."""

    def make(shapes, bodies, *, floor=True, **keys):
        ground = {"name": "floor", "shape": "floor", "position": [0.0, 0.0, -0.1], "driven": True}
        shapes = {"floor": {"box": [12.0, 8.0, 0.2]}, **shapes}
        return make_structure([ground] * floor + list(bodies), slab=False, shapes=shapes, **keys)

    return make


@pytest.fixture(scope="session")
def simulate():
    """Trajectory of a structure, recorded every ``output_step``."""

    def run(structure, duration, *, motion=None, time_step=1e-3, output_step=0.01, **parameters):
        times = np.linspace(0.0, duration, round(duration / output_step) + 1)
        return simulate_nscd(structure, motion, NscdParameters(**parameters), times, time_step)

    return run


@pytest.fixture(scope="session")
def push():
    """Ground motion with a constant acceleration along x for ``duration``, then at constant velocity."""

    def make(acceleration, duration, until):
        time = np.array([0.0, duration, duration + 1e-9, until])
        return ground_motion(
            "push", time, {"x": np.array([acceleration, acceleration, 0.0, 0.0])}, "acceleration"
        )

    return make
