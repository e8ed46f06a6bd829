import copy

import numpy as np
import pytest

from blockshake.geometry.structure import build_structure
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters

SHAPES = {
    "slab": {"box": [3.0, 3.0, 0.2]},
    "block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02},
    "sharp": {"box": [0.8, 2.4, 1.6]},
    "cube": {"box": [1.0, 1.0, 1.0]},
}
SLAB = {"name": "slab", "shape": "slab", "position": [0.0, 0.0, -0.1], "driven": True}


@pytest.fixture(scope="session")
def make_mapping():
    """Mapping of a structure file: bodies of one stone on a driven slab whose top is at z = 0."""

    def make(bodies, *, friction=0.5, slab=True, shapes=None, **keys):
        mapping = {
            "name": "test",
            "materials": {"stone": {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}},
            "shapes": {**SHAPES, **(shapes or {})},
            "bodies": [{"material": "stone", **body} for body in ([SLAB] if slab else []) + list(bodies)],
            "friction": [{"pair": ["stone", "stone"], "coefficient": friction}],
            **keys,
        }
        return copy.deepcopy(mapping)

    return make


@pytest.fixture(scope="session")
def make_structure(make_mapping):
    """Structure of `make_mapping`'s mapping."""

    def make(bodies, **keys):
        return build_structure(make_mapping(bodies, **keys), "test.yaml", ".")

    return make


@pytest.fixture(scope="session")
def run_ls_dem():
    """LS-DEM run recorded at a uniform rate; keys are ``ls_dem`` parameters."""

    def run(structure, duration, *, motion=None, time_step=5e-5, rate=200, **parameters):
        times = np.arange(round(duration * rate) + 1) / rate
        return simulate_ls_dem(structure, motion, LsDemParameters(**parameters), times, time_step)

    return run


@pytest.fixture(scope="session")
def three():
    """Three blocks with a marker off the line of the others on each body."""
    from synthetic_campaigns import structure_of_three

    return structure_of_three()


@pytest.fixture(scope="session")
def clean_tests(three):
    """Sound sensors: coloured noise, gaps, outliers, offsets, markers within 1 mm."""
    from synthetic_campaigns import make_tests

    return make_tests(
        three, 1, mounting=1e-3, marker_dropouts=0.01, accelerometer_offset=0.05, outliers=0.002
    )
