"""Restitution on a small anvil, and of a face when many unlike nodes share the dashpot."""

import numpy as np
import pytest
from dashpot_theory import critical_part, rebound, rebound_error

SPEED = 0.01  # m/s; gravity off
STEP = 2e-6
K_N = 2.16e10


@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9, 1.0])
def test_a_small_anvil_has_the_law_of_its_own_face(restitution, make_structure, run_ls_dem):
    """A wide face falls with one of its nodes on an anvil of 30 mm: not the node's area counts, but the overlap's."""
    shapes = {"anvil": {"box": [0.03, 0.03, 0.2]}}
    anvil = {"name": "anvil", "shape": "anvil", "position": [0.0, 0.0, -0.1], "driven": True}
    block = {
        "name": "b",
        "shape": "block",
        "position": [0.0, 0.0, 0.8 + 1e-6],
        "velocity": [0.0, 0.0, -SPEED],
    }
    structure = make_structure(
        [anvil, block], slab=False, restitution=restitution, gravity=[0.0, 0.0, 0.0], shapes=shapes
    )
    # nodes within 0.1 mm of the anvil's own edge split the overlap less well: the rebound is then 4 % off
    run = run_ls_dem(structure, 0.13, time_step=10.0 * STEP, node_spacing=2.4, perimeter_inset=0.02)
    assert np.abs(run.angular_velocity[-1]).max() < 1e-9
    zeta = critical_part(restitution)
    omega_dt = 10.0 * STEP * np.sqrt(K_N * 0.03**2 / structure.mass[1])
    assert run.velocity[-1, 1, 2] / SPEED == pytest.approx(rebound(zeta), abs=rebound_error(zeta, omega_dt))


@pytest.mark.parametrize("spacing", [0.8, 0.2, 0.05])
@pytest.mark.parametrize("restitution", [0.5, 1.0])
def test_two_free_bodies_face_to_face(restitution, spacing, make_structure, run_ls_dem):
    """Unlike masses: the relative speed rebounds by the law of the reduced mass, the common one stays."""
    shapes = {"light": {"box": [0.8, 0.6, 0.5]}, "heavy": {"box": [0.8, 0.6, 1.0]}}
    structure = make_structure(
        [
            {"name": "a", "shape": "light", "position": [0.0, 0.0, 2.0], "velocity": [0.0, 0.0, SPEED]},
            {"name": "b", "shape": "heavy", "position": [0.0, 0.0, 2.75 + 1e-6]},
        ],
        restitution=restitution, gravity=[0.0, 0.0, 0.0], shapes=shapes,
    )  # fmt: skip
    run = run_ls_dem(structure, 0.008, time_step=STEP, node_spacing=spacing)
    light, heavy = structure.mass[1:]
    speed = run.velocity[-1, 1:, 2]
    assert light * speed[0] + heavy * speed[1] == pytest.approx(light * SPEED, rel=1e-12)
    zeta = critical_part(restitution)
    omega_dt = STEP * np.sqrt(K_N * 0.8 * 0.6 * (1.0 / light + 1.0 / heavy))
    assert (speed[1] - speed[0]) / SPEED == pytest.approx(rebound(zeta), abs=rebound_error(zeta, omega_dt))
