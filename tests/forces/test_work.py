"""Work of a joint against the energy that a motion in closed form loses."""

import numpy as np
import pytest
from known_blocks import GRAVITY, HEIGHT, WIDTH, readings, rocking, shaken, sliding, stack

from blockshake.forces.joint_forces import joint_forces
from blockshake.forces.laws.work import energy_taken, work_law

IMPACT = 3.0  # s
KEPT = 0.7  # of the angular velocity
SPIN = 0.3  # rad/s before the impact
AROUND = 0.06  # s, beyond the kernel's reach


def test_friction_takes_its_force_times_the_path(sensors):
    """E = mu m g times the length of the slip."""
    mu, table = 0.25, shaken(4.0, 1.5)
    structure, poses = stack(1, friction=mu), sliding(table, mu)
    forces = joint_forces(readings(structure, poses), structure, sensors)
    time = np.arange(forces.motion.time[0], forces.motion.time[-1], 1e-3)
    apart = np.array([np.diff(poses(t)[:, 0])[0] for t in time])
    path = np.abs(np.diff(apart)).sum()
    told = work_law(forces, 0)["work.taken"]
    assert path > 0.3
    assert told.value == pytest.approx(mu * structure.mass[1] * GRAVITY * path, rel=0.02)


def swing(t):
    """To one side, an impact that keeps `KEPT` of the angular velocity, and to rest on the other side."""
    own = t - IMPACT
    if own < -1.0 or own > 1.0:
        return 0.0
    return SPIN * own * (KEPT if own > 0.0 else 1.0) * (1.0 - own**2) ** 3


def energies(structure, poses, t, step=1e-4):
    """Of the block that rocks: kinetic and potential [J]."""
    before, now, after = (poses(t + shift)[1] for shift in (-step, 0.0, step))
    rate = (after - before) / (2.0 * step)
    mass, inertia = structure.mass[1], structure.inertia[1, 1, 1]
    kinetic = 0.5 * mass * (rate[0] ** 2 + rate[1] ** 2) + 0.5 * inertia * rate[2] ** 2
    return np.array([kinetic, mass * GRAVITY * now[1]])


def test_an_impact_takes_the_kinetic_energy_that_is_lost(sensors):
    """From shortly before to shortly after it; the potential energy of the moment is counted too."""
    structure, poses = stack(1), rocking(shaken(0.0), swing)
    markers_alone = readings(structure, poses).drop_dims("time_acc")  # channels would miss a sharp peak
    forces = joint_forces(markers_alone, structure, sensors)
    taken = energy_taken(forces, 0)
    first, last = (int(np.argmin(np.abs(forces.motion.time - IMPACT - away))) for away in (-AROUND, AROUND))
    before, after = (energies(structure, poses, forces.motion.time[at]) for at in (first, last))
    edge = structure.inertia[1, 1, 1] + 0.25 * structure.mass[1] * (HEIGHT**2 + WIDTH**2)
    assert (before - after)[0] == pytest.approx(0.5 * edge * (1.0 - KEPT**2) * SPIN**2, rel=0.1)
    assert taken[last] - taken[first] == pytest.approx((before - after).sum(), rel=0.03)


def test_its_error_is_as_large_as_it_is_said_to_be(sensors):
    """Over draws of the noise."""
    structure, poses = stack(1), rocking(shaken(0.0), swing)
    found = [
        work_law(
            joint_forces(
                readings(structure, poses, sensors.marker_noise, sensors.accelerometer_noise, seed),
                structure,
                sensors,
            ),
            0,
        )["work.taken"]
        for seed in range(8)
    ]
    scatter, said = np.std([one.value for one in found], ddof=1), np.mean([one.error for one in found])
    assert said / 3.0 < scatter < 2.0 * said


def test_a_test_with_a_long_gap_tells_no_work(sensors):
    structure, poses = stack(1), rocking(shaken(0.0), swing)
    test = readings(structure, poses)
    gap = (test["time"] > 2.0) & (test["time"] < 3.0)
    test["marker_displacement"] = test["marker_displacement"].where(~gap)
    assert np.isnan(work_law(joint_forces(test, structure, sensors), 0)["work.taken"].value)
