import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import build_structure
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

G = 9.81


@pytest.fixture(scope="session")
def scene():
    """Structure of bodies on a driven floor whose top is at z = 0, all of one stone; friction may be a law."""

    def make(shapes, bodies, *, friction=0.5, floor=True, folder=".", **keys):
        laws = (
            friction
            if isinstance(friction, list)
            else [{"pair": ["stone", "stone"], "coefficient": friction}]
        )
        ground = {"name": "floor", "shape": "floor", "position": [0.0, 0.0, -0.1], "driven": True}
        return build_structure(
            {
                "name": "test",
                "materials": {"stone": {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}},
                "shapes": {"floor": {"box": [12.0, 8.0, 0.2]}, **shapes},
                "bodies": [{"material": "stone", **body} for body in ([ground] if floor else []) + bodies],
                "friction": laws,
                **keys,
            },
            "test.yaml",
            folder,
        )

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
