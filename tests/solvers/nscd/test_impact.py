import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.simulation.energy_residual import energy_residual

G = 9.81
# a body lands as deep as the solver's tolerance leaves it: 1e-6 of the speed times the step
PENETRATION = 1e-8
SHAPES = {
    "cube": {"box": [0.2, 0.2, 0.2]},
    "plate": {"box": [0.3, 0.3, 0.1]},
    "heavy": {"box": [0.4, 0.4, 0.4]},
}


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_falling_block_rebounds_by_newton(scene, simulate, restitution):
    drop = 0.2
    structure = scene(
        SHAPES, [{"name": "b", "shape": "cube", "position": [0, 0, 0.1 + drop]}], nscd_restitution=restitution
    )
    run = simulate(structure, 0.5, output_step=1e-3)
    after = run.time > np.sqrt(2.0 * drop / G) + 0.002
    rebound = (run.position[after, 1, 2] - 0.1).max()
    # the impact falls somewhere within a step: v dt = 2 mm against a rebound of e^2 h = 50 mm
    assert rebound == pytest.approx(restitution**2 * drop, abs=2.5e-3)
    assert run.position[:, 1, 2].min() > 0.1 - PENETRATION
    kinetic = structure.mass[1] * G * drop
    if restitution == 0.0:
        assert rebound < 1e-6
        assert run.energy[-1, 4] == pytest.approx(kinetic, rel=1e-3)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_two_free_bodies_keep_their_momentum(scene, simulate, restitution):
    bodies = [
        {"name": "a", "shape": "cube", "position": [0, 0, 0], "velocity": [1.0, 0, 0]},
        {"name": "b", "shape": "heavy", "position": [0.5, 0.05, 0.02], "velocity": [-0.5, 0, 0]},
    ]
    structure = scene(
        SHAPES, bodies, floor=False, gravity=[0, 0, 0], nscd_restitution=restitution, friction=0.3
    )
    run = simulate(structure, 1.0)
    momentum = np.einsum("b,tba->ta", structure.mass, run.velocity)
    np.testing.assert_allclose(
        momentum, np.tile(momentum[0], (len(momentum), 1)), atol=1e-10 * structure.mass.sum()
    )
    # they met and lost energy, and nothing but the contact took it
    assert run.energy[-1, 0] < 0.95 * run.energy[0, 0]
    lost = run.energy[0, 0] - run.energy[-1, 0]
    # dissipated terms never fall, so net work that turned back for a moment is left over
    assert run.energy[-1, 3] + run.energy[-1, 4] == pytest.approx(lost, rel=1e-5)


def test_central_collision_follows_newton(scene, simulate):
    bodies = [
        {"name": "a", "shape": "cube", "position": [0, 0, 0], "velocity": [1.0, 0, 0]},
        {"name": "b", "shape": "cube", "position": [0.5, 0, 0]},
    ]
    run = simulate(scene(SHAPES, bodies, floor=False, gravity=[0, 0, 0], nscd_restitution=0.5), 1.0)
    np.testing.assert_allclose(run.velocity[-1, :, 0], [0.25, 0.75], rtol=1e-6)
    np.testing.assert_allclose(run.angular_velocity[-1], 0.0, atol=1e-9)


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
