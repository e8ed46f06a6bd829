import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.simulation.energy_residual import energy_residual

SHAPES = {"plate": {"box": [0.3, 0.3, 0.1]}}


@pytest.mark.parametrize(
    "orientation", [[0.92388, 0.38268, 0, 0], [0.88, 0.325, -0.28, 0.2], [0.8805, 0.2798, 0.3647, 0.1159]]
)
def test_tumbling_plate_comes_to_rest_on_a_face(scene, simulate, orientation):
    orientation = (np.array(orientation) / np.linalg.norm(orientation)).tolist()
    body = {
        "name": "p", "shape": "plate", "position": [0, 0, 0.6], "orientation": orientation,
        "angular_velocity": [1.0, 2.0, 0.5], "velocity": [0.3, 0.0, 0.0],
    }  # fmt: skip
    run = simulate(scene(SHAPES, [body]), 2.5)
    assert run.status == "completed"
    # on its large face, or on a side
    assert min(abs(run.position[-1, 1, 2] - half) for half in (0.05, 0.15)) < 1e-4
    assert np.abs(run.velocity[-1, 1]).max() < 1e-5
    assert run.numerics["max_penetration"] < 1e-4


def test_crossed_bars_meet_edge_on_edge(scene, simulate):
    turned = np.sin(np.pi / 8)
    bodies = [
        {
            "name": "low",
            "shape": "bar",
            "position": [0, 0, 0],
            "orientation": [np.cos(np.pi / 8), turned, 0, 0],
        },
        {
            "name": "high",
            "shape": "post",
            "position": [0, 0, 0.5],
            "orientation": [np.cos(np.pi / 8), 0, turned, 0],
            "velocity": [0, 0, -1.0],
        },
    ]
    shapes = {"bar": {"box": [1.0, 0.2, 0.2]}, "post": {"box": [0.2, 1.0, 0.2]}}
    run = simulate(scene(shapes, bodies, floor=False, gravity=[0, 0, 0]), 0.5)
    # equal masses, central, no restitution: both go on at half the speed, edges in touch
    np.testing.assert_allclose(run.velocity[-1, :, 2], -0.5, rtol=1e-6)
    np.testing.assert_allclose(run.position[-1, 1, 2] - run.position[-1, 0, 2], 0.2 * np.sqrt(2), atol=1e-6)


@pytest.mark.parametrize("seed", [2, 9, 35])
def test_the_audit_closes_where_an_oblique_impact_gives_work_to_friction(seed, scene, simulate):
    # Newton's restitution with friction: an impact may turn the slip over and do work on it (Kane and Levinson 1985);
    # counted as no friction heat, up to 6 % of the energy in play went missing here
    turn = Rotation.random(rng=seed).as_quat(scalar_first=True).tolist()
    spin = (20.0 * np.random.default_rng(seed).normal(0.0, 1.0, 3)).tolist()
    structure = scene(
        {"cube": {"box": [0.1, 0.1, 0.1]}},
        [{"name": "b", "shape": "cube", "position": [0, 0, 0.15], "orientation": turn,
          "velocity": [1.5, 0.0, -1.0], "angular_velocity": spin}],
        nscd_restitution=0.3, friction=0.18,
    )  # fmt: skip
    run = simulate(structure, 0.8)
    # the scheme's own error in free flight and slip at this spin
    assert energy_residual(run.energy) < 1e-4
    assert (np.diff(run.energy[:, 3:6], axis=0) >= 0.0).all()
