"""Stacks of LS-DEM shaken by noise of low amplitude against blocks on elastic beds, whose equations are linear."""

import numpy as np
import pytest
from scipy.signal import cont2discrete, dlsim

from blockshake.dynamics.motion import ground_motion

K_N, K_S = 2e9, 8e8  # N/m3; soft, so that the modes lie below 100 Hz
LENGTH, WIDTH, HEIGHT = 0.76, 2.36, 1.6  # m, of the flats of a chamfered block; of the block
FINE, RATE, DURATION = 2000.0, 200.0, 4.0  # Hz of the noise, Hz of the record, s


def _noise(rms, lowest=0.3, highest=80.0):
    """Acceleration with a flat spectrum in a band, periodic but for a rise from rest over a second."""
    n = round(DURATION * FINE)
    frequency = np.fft.rfftfreq(n, 1.0 / FINE)
    generator = np.random.default_rng(1)
    lines = generator.normal(size=len(frequency)) + 1j * generator.normal(size=len(frequency))
    values = np.fft.irfft(lines * ((frequency > lowest) & (frequency < highest)), n)
    return rms / values.std() * values * np.clip(np.arange(n) / FINE, 0.0, 1.0)


def _planar(structure, n, restitution):
    """State matrix of n blocks on beds of springs k_n and k_s an area: x and theta of each, about its mass centre.

    A bed is Winkler's (I. N. Psycharis and P. C. Jennings 1983, Rocking of slender rigid bodies allowed to uplift,
    Earthq. Eng. Struct. Dyn. 11, 57-76): k_theta = k_n I, k_x = k_s A, I and A of the flat. Gravity takes the
    weight on a joint times h from either block's stiffness. Dashpots gamma = 2 zeta sqrt(m_eff k_n / A) an area
    next to the normal springs alone (docs/method.md).
    """
    area, second = LENGTH * WIDTH, WIDTH * LENGTH**3 / 12.0
    mass, inertia, h = structure.mass[1], structure.inertia[1][1, 1], HEIGHT / 2.0
    zeta = -np.log(restitution) / np.hypot(np.pi, np.log(restitution))
    K, C = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    for joint in range(n):
        lower, upper = slice(2 * joint - 2, 2 * joint), slice(2 * joint, 2 * joint + 2)
        slip, turn = np.zeros(2 * n), np.zeros(2 * n)
        slip[upper], turn[upper] = [1.0, -h], [0.0, 1.0]
        if joint:
            slip[lower], turn[lower] = [-1.0, -h], [0.0, -1.0]
        reduced = mass if joint == 0 else mass / 2.0
        gamma = 2.0 * zeta * np.sqrt(reduced * K_N / area)
        K += K_S * area * np.outer(slip, slip) + K_N * second * np.outer(turn, turn)
        C += gamma * second * np.outer(turn, turn)
        # weight N above the joint, standing on it: -N h theta^2 / 2 of the upper, -N h theta^2 / 2 of the lower block
        weight = (n - joint) * mass * 9.81
        for block in (joint, joint - 1):
            if block >= 0:
                K[2 * block + 1, 2 * block + 1] -= weight * h
    inverse = np.diag(1.0 / np.tile([mass, inertia], n))
    return np.block([[np.zeros((2 * n, 2 * n)), np.eye(2 * n)], [-inverse @ K, -inverse @ C]])


def _answer(A, acceleration):
    """Displacements relative to the base at the record's times, from rest, (n_times, 2 n_blocks)."""
    n = len(A)
    push = np.concatenate([np.zeros(n // 2), np.tile([-1.0, 0.0], n // 4)])[:, None]
    discrete = cont2discrete((A, push, np.eye(n)[: n // 2], np.zeros((n // 2, 1))), 1.0 / FINE, "foh")
    return dlsim(discrete, acceleration)[1][:: round(FINE / RATE)]


@pytest.mark.parametrize("n", [1, 2])
def test_a_stack_answers_noise_as_blocks_on_elastic_beds_do(n, make_structure, run_ls_dem):
    """Frequency, damping and shape of every mode enter the answer to noise.

    An error e of the frequency of a mode of damping zeta changes its steady answer by e / (2 zeta), and e is 1e-4 at
    the most: time steps take (w dt)^2 / 24 = 1e-5 of it. No joint opens: 0.1 m/s2 rms, amplified, against 0.17 g.
    """
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(n)]
    slab = {"slab": {"box": [0.8, 2.4, 0.2], "chamfer": 0.02}}
    structure = make_structure(bodies, shapes=slab, restitution=0.5)
    acceleration = _noise(0.1)
    time = np.arange(len(acceleration)) / FINE
    motion = ground_motion("noise", time, {"x": acceleration}, "acceleration")
    run = run_ls_dem(
        structure, DURATION - 1.0 / RATE, motion=motion, normal_stiffness=K_N, shear_stiffness=K_S, rate=RATE
    )
    A = _planar(structure, n, 0.5)
    poles = np.linalg.eigvals(A)
    least = (-poles.real / np.abs(poles)).min()
    exact = _answer(A, acceleration)
    moved = (run.position - run.position[0])[:, :, 0]
    for block in range(n):
        x = moved[:, 1 + block] - moved[:, 0]
        theta = 2.0 * run.orientation[:, 1 + block, 2]
        for found, right in ((x, exact[:, 2 * block]), (theta, exact[:, 2 * block + 1])):
            np.testing.assert_allclose(
                found, right, rtol=0.0, atol=1e-4 / (2.0 * least) * np.abs(right).max()
            )
