import numpy as np
import pytest

from blockshake.solvers.nscd.parameters import DeformableParameters
from blockshake.solvers.nscd_deformable.driver import simulate_deformable


@pytest.fixture(scope="session")
def stone(make_structure):
    """Structure of boxes of one material on a driven slab whose top is at z = 0."""

    def make(bodies, *, friction=0.75, **keys):
        stone = {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2, "viscous_modulus": 1.5e8}
        material = {name: keys.pop(name, value) for name, value in stone.items()}
        return make_structure(bodies, materials={"stone": material}, friction=friction, **keys)

    return make


@pytest.fixture(scope="session")
def tower():
    """Bodies of a tower of equal boxes."""

    def make(count, shape="sharp", height=1.6):
        return [
            {"name": f"block-{n + 1}", "shape": shape, "position": [0.0, 0.0, (n + 0.5) * height]}
            for n in range(count)
        ]

    return make


@pytest.fixture(scope="session")
def deform():
    """Run of the deformable solver recorded at a uniform rate; keys are ``nscd_deformable`` parameters."""

    def run(structure, duration, *, motion=None, time_step=1e-3, rate=200, viscous=False, **parameters):
        times = np.arange(round(duration * rate) + 1) / rate
        return simulate_deformable(
            structure, motion, DeformableParameters(**parameters), times, time_step, viscous=viscous
        )

    return run
