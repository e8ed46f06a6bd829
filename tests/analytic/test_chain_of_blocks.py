"""Waves in towers against the fixed-free chain of masses and springs, in closed form."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion

# m/s; small enough that no joint opens: the wave pulls by SPEED sqrt(m / k) = 4e-8 m at the most where the
# weight of the top block presses by 5e-7 m
SPEED = 1e-4
# A quarter of the Earth's: a tower of 16 then sinks by 0.07 mm, and starts in equilibrium (0.1 mm at most)
GRAVITY = [0.0, 0.0, -9.81 / 4.0]
K_N, AREA = 2.16e10, 0.76 * 2.36
RATE = 50_000
STEP = 1e-5
SEAT = {"slab": {"box": [0.8, 2.4, 0.2], "chamfer": 0.02}}


def _chain(n, mass, time):
    """Displacement and velocity of n equal masses on springs over a base that moves at SPEED from t = 0.

    In the base's frame all masses start at -SPEED. Modes ``sin(j q)``, ``q = (2 i - 1) pi / (2 n + 1)``, of
    the frequencies ``2 sqrt(k / m) sin(q / 2)``; ``sum_j sin(j q)`` and ``sum_j sin(j q)^2 = (2 n + 1) / 4``
    give each mode's share.
    """
    place = np.arange(1, n + 1)
    moved, speed = np.outer(time, np.full(n, SPEED)), np.full((time.size, n), SPEED)
    for mode in range(1, n + 1):
        q = (2 * mode - 1) * np.pi / (2 * n + 1)
        shape = np.sin(place * q)
        share = shape.sum() / ((2 * n + 1) / 4.0)
        omega = 2.0 * np.sqrt(K_N * AREA / mass) * np.sin(q / 2.0)
        moved -= SPEED * share * np.outer(np.sin(omega * time) / omega, shape)
        speed -= SPEED * share * np.outer(np.cos(omega * time), shape)
    return moved, speed


def _arrival(time, speed):
    """When each mass first has half of the base's speed [s]."""
    after = (speed > 0.5 * SPEED).argmax(axis=0)
    low, high = (
        np.take_along_axis(speed, (after - 1)[None], 0)[0],
        np.take_along_axis(speed, after[None], 0)[0],
    )
    return time[after - 1] + (0.5 * SPEED - low) / (high - low) / RATE


@pytest.mark.parametrize("n", [4, 8, 16])
def test_a_wave_climbs_as_through_the_undamped_chain(n, make_structure, run_ls_dem):
    """Zhou et al. (2023), Eq. (7): blocks as masses, joints as springs; c = h sqrt(k / m) below the cut-off.

    Undamped, so that all modes ring; until the wave is back at the base. Few nodes, for speed: stiffness is
    per area.
    """
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(n)]
    structure = make_structure(bodies, shapes=SEAT, restitution=1.0, gravity=GRAVITY)
    mass = structure.mass[1]
    period = np.sqrt(mass / (K_N * AREA))  # the wave's time from block to block, 0.44 ms
    duration = np.ceil(2.0 * n * period * RATE) / RATE
    motion = ground_motion("step", np.array([0.0, 1.0]), {"z": np.array([SPEED, SPEED])}, "velocity")
    run = run_ls_dem(structure, duration, motion=motion, time_step=STEP, rate=RATE, node_spacing=0.8)
    moved, speed = _chain(n, mass, run.time)
    found = (run.position - run.position[0])[:, 1:, 2]
    # velocity Verlet: phases ahead by (omega dt)^2 / 24 = 9e-5 for the fastest mode at 2 / period, which
    # turns by 4 n until the wave is back
    error = (2.0 * STEP / period) ** 2 / 24.0 * 4.0 * n
    np.testing.assert_allclose(found, moved, atol=error * SPEED * period)
    np.testing.assert_allclose(run.velocity[:, 1:, 2], speed, atol=error * SPEED)
    # the speed of the front from the second block to the top, as the calibration reads it
    exact, seen = _arrival(run.time, speed), _arrival(run.time, run.velocity[:, 1:, 2])
    wave = 1.6 * (n - 2) / (seen[-1] - seen[1])
    assert wave == pytest.approx(1.6 * (n - 2) / (exact[-1] - exact[1]), rel=1e-4)
