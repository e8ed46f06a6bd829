"""Modes found in runs of LS-DEM at low amplitude against blocks on elastic beds, in closed form."""

import numpy as np
import pytest
import xarray as xr
from shear_chain import exact, white

from blockshake.dynamics.motion import ground_motion
from blockshake.measurement.modes.dynamic_properties import modes_from_noise
from blockshake.measurement.sensors.markers import marker_displacement

K_N, K_S = 2e9, 8e8  # N/m3; soft, so that the modes lie below 100 Hz
LENGTH, WIDTH, HEIGHT = 0.76, 2.36, 1.6  # m, of the flats of a chamfered block; of the block
RATE = 200


def _planar(structure, n, restitution=0.5):
    """State matrix of n blocks on beds of springs k_n and k_s an area: x and theta of each, about its mass centre.

    A bed is Winkler's (I. N. Psycharis and P. C. Jennings 1983, Rocking of slender rigid bodies allowed to uplift,
    Earthq. Eng. Struct. Dyn. 11, 57-76): k_theta = k_n I, k_x = k_s A, I and A of the flat. Gravity takes the
    weight on a joint times h from either block's stiffness. Dashpots gamma = 2 zeta sqrt(m_eff k_n / A) an area
    beside the normal springs alone (docs/method.md).
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
    M = np.tile([mass, inertia], n)
    inverse = np.diag(1.0 / M)
    return np.block([[np.zeros((2 * n, 2 * n)), np.eye(2 * n)], [-inverse @ K, -inverse @ C]])


@pytest.mark.parametrize("n", [1, 2])
def test_blocks_on_elastic_beds(n, make_structure, run_ls_dem):
    """Frequency within 0.2 % and damping within 1 % of theory, on every mode below 80 Hz.

    Time steps take (w dt)^2 / 24, 3e-5, of the frequency; the rest is for the nodes of 5 mm inset and 200 Hz of
    the record. No joint opens: 0.1 m/s2 rms, amplified, against 0.17 g.
    """
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(n)]
    markers = [{"name": "slab-face", "body": "slab", "position": [0.4, 0.0, 0.0]}]
    for i in range(n):
        markers += [
            {"name": f"b{i}-{name}", "body": f"b{i}", "position": [0.4, 0.0, z]}
            for name, z in (("low", -0.7), ("top", 0.7))
        ]
    structure = make_structure(
        bodies, shapes={"slab": {"box": [0.8, 2.4, 0.2], "chamfer": 0.02}}, markers=markers, restitution=0.5
    )
    acceleration, _ = white(1, 10.0, 0.1)
    acceleration *= np.clip(np.arange(len(acceleration)) / 2000.0, 0.0, 1.0)
    motion = ground_motion(
        "noise", np.arange(len(acceleration)) / 2000.0, {"x": acceleration}, "acceleration"
    )
    run = run_ls_dem(structure, 10.0, motion=motion, normal_stiffness=K_N, shear_stiffness=K_S)
    test = xr.Dataset(
        {
            "marker_displacement": (
                ("time", "marker", "axis"), marker_displacement(structure, run.position, run.orientation),
            )
        },
        {"time": run.time, "marker": [marker["name"] for marker in markers], "axis": ["x", "y", "z"]},
    )  # fmt: skip
    found = modes_from_noise(test, structure, 0.0, 0.0)
    frequency, damping, _ = exact(_planar(structure, n))
    below = frequency < 80.0
    assert below.sum() == (1 if n == 1 else 2)
    assert found.sizes["mode"] == below.sum(), (found.attrs, frequency, found["frequency"].to_numpy())
    np.testing.assert_allclose(found["frequency"], frequency[below], rtol=2e-3)
    np.testing.assert_allclose(found["damping_ratio"], damping[below], rtol=1e-2)
