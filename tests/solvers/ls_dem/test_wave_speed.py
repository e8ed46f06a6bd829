import numpy as np
import pytest
from scipy.linalg import expm

from blockshake.dynamics.motion import ground_motion
from blockshake.solvers.ls_dem.interfaces import damping_ratio

SPEED = 1e-3  # m/s; small enough that no joint opens (static penetration 2e-6 m, wave 4e-7 m)
K_N, AREA = 2.16e10, 0.76 * 2.36
STEP = 1e-5
RATE = 20_000


def _chain(n, mass, duration):
    """Displacements of n masses on springs and dashpots over a base that moves at SPEED from t = 0.

    Exact, by the matrix exponential of the base's frame: displacements against the base start at zero with
    the velocity -SPEED. k = k_n A, and the dashpot of a joint is 2 zeta sqrt(m_eff k), m_eff = m over the
    driven base and m/2 between blocks.
    """
    k = K_N * AREA
    zeta = damping_ratio(0.5)
    K, C = np.zeros((n, n)), np.zeros((n, n))
    for joint in range(n):
        gamma = 2.0 * zeta * np.sqrt((mass if joint == 0 else mass / 2.0) * k)
        for matrix, value in ((K, k), (C, gamma)):
            matrix[joint, joint] += value
            if joint > 0:
                matrix[joint - 1, joint - 1] += value
                matrix[joint, joint - 1] -= value
                matrix[joint - 1, joint] -= value
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K / mass, -C / mass]])
    y = np.concatenate([np.zeros(n), np.full(n, -SPEED)])
    step = expm(A / RATE)
    history = [y]
    for _ in range(round(duration * RATE)):
        history.append(step @ history[-1])
    time = np.arange(len(history)) / RATE
    return np.array(history)[:, :n] + SPEED * time[:, None], np.array(history)[:, n:] + SPEED


@pytest.mark.parametrize("n", [4, 8])
def test_a_velocity_step_climbs_a_tower_as_through_the_exact_chain(n, make_structure, run_ls_dem):
    """The calibration's experiment, Zhou et al. (2023), Eq. (7): block stiffness lumped into the joints."""
    duration = 0.02
    motion = ground_motion("step", np.array([0.0, 1.0]), {"z": np.array([SPEED, SPEED])}, "velocity")
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(n)]
    slab = {"slab": {"box": [0.8, 2.4, 0.2], "chamfer": 0.02}}  # the blocks' flat, so that A is the same
    structure = make_structure(bodies, shapes=slab)
    run = run_ls_dem(structure, duration, motion=motion, time_step=STEP, rate=RATE)
    displacement, velocity = _chain(n, structure.mass[1], duration)
    moved = (run.position - run.position[0])[:, 1:, 2]
    # velocity Verlet: phases off by (omega dt)^2 / 24 of omega t for the fastest mode, 2 sqrt(k/m) = 4,600 rad/s:
    # 9e-5 of 90 rad; those modes are damped within a few cycles, slower ones err less
    error = 1e-4
    np.testing.assert_allclose(moved, displacement, atol=error * displacement.max())
    np.testing.assert_allclose(run.velocity[:, 1:, 2], velocity, atol=5.0 * error * SPEED)
    # the top starts later than the bottom: n / kappa of it
    assert moved[np.searchsorted(run.time, 0.5e-3), -1] < 0.01 * moved[np.searchsorted(run.time, 0.5e-3), 0]
