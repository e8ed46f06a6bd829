"""Physics at the limits of the schema: a run ends with a status and a reason, and what it tells is finite."""

import copy
import warnings

import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.system import FINISHED
from blockshake.geometry.structure import build_structure
from blockshake.simulation.simulate import simulate

STEPS = {"ls-dem": 5e-5, "nscd-rigid": 1e-3}
STONE = ("materials", "stone")
EXTREMES = [
    *(((*STONE, "density"), value) for value in (1e-3, 1e9)),
    *(((*STONE, "youngs_modulus"), value) for value in (1.0, 1e15)),
    *(((*STONE, "poisson_ratio"), value) for value in (-0.999, 0.4999999)),
    *(((*STONE, "viscous_modulus"), value) for value in (1e-300, 1e300)),
    *((("friction", 0, "coefficient"), value) for value in (0.0, 1e-300, 1e6)),
    *((("gravity",), value) for value in ([0.0, 0.0, 0.0], [0.0, 0.0, 9.81], [1e4, 0.0, -9.81], [0.0, 0.0, -1e4])),
    *((("restitution",), value) for value in (1e-300, 1.0)),
    *((("bodies", 1, "velocity"), value) for value in ([900.0, 0.0, 0.0], [0.0, 0.0, -1e4])),
    *((("bodies", 1, "angular_velocity"), value) for value in ([0.0, 1e4, 0.0], [1e4, 0.0, 0.0])),
]  # fmt: skip


@pytest.fixture(scope="module")
def mapping(make_mapping):
    blocks = [
        {"name": f"block-{k}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * k]} for k in range(2)
    ]
    return make_mapping(blocks)


@pytest.mark.parametrize("model", STEPS)
@pytest.mark.parametrize(("path", "value"), EXTREMES, ids=lambda one: str(one))
def test_a_run_ends_with_a_status_and_finite_results(mapping, model, path, value):
    own = copy.deepcopy(mapping)
    inner = own
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    structure = build_structure(own, "test.yaml", ".")
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of numpy: overflow and the like
        run = simulate(
            structure, load_motion("basso-tirreno", 2.0), model, duration=0.2, time_step=STEPS[model],
            accelerometers=False,
        )  # fmt: skip
    if run.attrs["status"] == "completed":
        assert np.isfinite(run["position"]).all()
    else:
        assert run.attrs["reason"]
        assert run.attrs["end_time"] <= 0.2
    if run.attrs["status"] in FINISHED:
        assert np.isfinite(run["position"].sel(time=slice(0.0, run.attrs["end_time"] - 0.01))).all()
