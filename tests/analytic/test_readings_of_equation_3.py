"""The switches of Eqs. (2) and (3): a force that may pull, and damping node by node as printed."""

import numpy as np
import pytest
from dashpot_theory import critical_part, rebound, rebound_error, rebound_of_nodes

from blockshake.geometry.surface_nodes import line_nodes

SPEED = 0.01  # m/s; gravity off
STEP = 2e-6
K_N, K_S = 2.16e10, 9.0e9
FLAT = (0.76, 2.36)
INSET = 0.003 * min(FLAT)  # m, the default share of the narrower width
# a slab that is the block's flat, so that the two sides' nodes are the same
SEAT = {"slab": {"box": [0.8, 2.4, 0.2], "chamfer": 0.02}}
BLOCK = {"name": "b", "shape": "block", "position": [0.0, 0.0, 0.8 + 1e-6], "velocity": [0.0, 0.0, -SPEED]}


def _drop(make_structure, run_ls_dem, restitution, duration=0.01, **parameters):
    structure = make_structure([BLOCK], restitution=restitution, gravity=[0.0, 0.0, 0.0], shapes=SEAT)
    run = run_ls_dem(structure, duration, time_step=STEP, **parameters)
    assert np.abs(run.angular_velocity[-1]).max() < 1e-9
    omega_dt = STEP * np.sqrt(K_N * FLAT[0] * FLAT[1] / structure.mass[1])
    return run.velocity[-1, 1, 2] / SPEED, omega_dt


def test_the_theory_gives_c_res_where_it_pulls_and_0_5503_where_it_does_not():
    for restitution in (0.1, 0.5, 0.9):
        assert rebound(critical_part(restitution), pulling=True) == pytest.approx(restitution, rel=1e-8)
    assert rebound(critical_part(0.5)) == pytest.approx(0.5503, abs=5e-5)


@pytest.mark.parametrize("spacing", [0.8, 0.2])
@pytest.mark.parametrize("restitution", [0.1, 0.5, 0.9])
def test_a_face_that_may_pull_rebounds_with_c_res(restitution, spacing, make_structure, run_ls_dem):
    """Eq. (2) as printed, Eq. (3) for the interface: Tsuji et al. (1993)."""
    found, omega_dt = _drop(make_structure, run_ls_dem, restitution, node_spacing=spacing, pulling=True)
    zeta = critical_part(restitution)
    # where it lets go the dashpot's force jumps once more
    assert found == pytest.approx(restitution, abs=2.0 * rebound_error(zeta, omega_dt))
    # distinguished from the cut force, by the half of what lies between
    assert abs(found - restitution) < 0.5 * (rebound(zeta) - restitution)


@pytest.mark.parametrize("pulling", [False, True])
def test_two_free_bodies_that_may_pull(pulling, make_structure, run_ls_dem):
    structure = make_structure(
        [
            {
                "name": "a", "shape": "cube", "position": [0.0, 0.0, 2.0], "velocity": [0.0, 0.0, SPEED],
                "density": 1000.0,
            },
            {"name": "b", "shape": "cube", "position": [0.0, 0.0, 3.000001]},
        ],
        gravity=[0.0, 0.0, 0.0],
    )  # fmt: skip
    run = run_ls_dem(structure, 0.01, time_step=STEP, pulling=pulling)
    momentum = structure.mass[1:] @ run.velocity[:, 1:, 2].T
    # rounding: 1000 steps of 1e-16 of the momentum
    np.testing.assert_allclose(momentum, momentum[0], rtol=1e-13)
    zeta = critical_part(0.5)
    omega_dt = STEP * np.sqrt(K_N * (1.0 / structure.mass[1] + 1.0 / structure.mass[2]))
    parting = (run.velocity[-1, 2, 2] - run.velocity[-1, 1, 2]) / SPEED
    assert parting == pytest.approx(rebound(zeta, pulling), abs=2.0 * rebound_error(zeta, omega_dt))


@pytest.mark.parametrize("pulling", [False, True])
@pytest.mark.parametrize(("spacing", "at_least"), [(2.4, 3.0), (0.8, 3.0), (0.2, 8.0)])
def test_node_by_node_a_face_is_overdamped_by_the_root_of_its_nodes(
    spacing, at_least, pulling, make_structure, run_ls_dem
):
    """Each node has 2 zeta sqrt(m k_i) of its own stiffness k_i and the whole mass:

    zeta_face = zeta sum(sqrt(k_i)) / sqrt(sum(k_i)), zeta sqrt(N) for N alike. Two sides of 65 nodes make 11 of
    one; 9 and 15 nodes a side show that it is the number of nodes that decides.
    """
    weights = [line_nodes(length, spacing, INSET)[1] for length in FLAT]
    share = np.concatenate([np.outer(*weights).ravel()] * 2) / (2.0 * FLAT[0] * FLAT[1])
    excess = np.sqrt(share).sum()
    assert excess > at_least
    zeta = critical_part(0.5)
    # a unit mass and a unit spring; every node is cut by itself, and small ones are the most damped
    expected = rebound_of_nodes(share, 2.0 * zeta * np.sqrt(share), pulling)
    # slow to part where it is overdamped: the depth decays as exp(-omega t / (2 zeta))
    found, omega_dt = _drop(
        make_structure, run_ls_dem, 0.5, duration=0.02, node_spacing=spacing, damping="node", pulling=pulling
    )
    # what a step misses of the approach is damped with it; 1e-4 where it hardly comes back at all
    assert found == pytest.approx(expected, rel=2.0 * rebound_error(zeta * excess, omega_dt), abs=1e-4)
    # 0.55 for the interface's damping
    assert found < 0.35
    if not pulling:
        assert rebound_of_nodes(share, 2.0 * zeta * share) == pytest.approx(rebound(zeta), rel=1e-5)


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.3])
def test_a_shear_dashpot_damps_the_sway_of_a_plate(ratio, make_structure, run_ls_dem):
    """x'' + 2 zeta omega x' + omega^2 x = 0 with omega^2 = k_s A / m; a thin plate, so that it does not nod."""
    edges = (2.0, 1.0, 0.05)
    mass = 2400.0 * np.prod(edges)
    omega = np.sqrt(K_S * edges[0] * edges[1] / mass)
    speed = 1e-5  # swings by 1e-9 m; a node slips from mu g / omega^2 = 1e-7 m on
    structure = make_structure(
        [{"name": "b", "shape": "plate", "position": [0.0, 0.0, 0.025], "velocity": [speed, 0.0, 0.0]}],
        friction=0.9, restitution=1.0,
        shapes={"plate": {"box": list(edges)}, "slab": {"box": [2.0, 1.0, 0.2]}},
    )  # fmt: skip
    cycles = 4.0
    rate = round(omega / (2.0 * np.pi) * 40.0)
    run = run_ls_dem(structure, cycles * 40.0 / rate, time_step=1e-6, rate=rate, shear_damping_ratio=ratio)
    t = run.time
    swift = omega * np.sqrt(1.0 - ratio**2)
    expected = speed / swift * np.exp(-ratio * omega * t) * np.sin(swift * t)
    moved = run.position[:, 1, 0] - run.position[0, 1, 0]
    # the nod softens the sway by h^2 k_s A / k_theta = 8e-4, half of it in the frequency, over 25 rad; and a
    # step of 1e-6 s is omega dt = 9e-3 of the dashpot's time
    assert np.abs(moved - expected).max() < 0.02 * speed / omega
    assert run.energy[-1, 3] == 0.0
