"""Contact forces from readings against those that follow by hand from a motion in closed form."""

import numpy as np
import pytest
from known_blocks import DURATION, GRAVITY, HEIGHT, accelerations, readings, rocking, shaken, stack
from scipy.ndimage import gaussian_filter1d

from blockshake.forces.motion import WIDTH as WIDTH_OF_KERNEL
from blockshake.forces.seen.reconstructed_test import reconstruct_test

INNER = slice(10, -10)


def lever(seen):
    """Where the resultant crosses each face along its first tangent, and the standard deviation of that [m]."""
    normal = seen.forces.force[..., 2]
    return -seen.forces.moment[..., 1] / normal, seen.forces.moment_error / normal


def smoothed(history, time):
    """A history in closed form seen through the kernel of the forces."""
    step = 2e-3
    fine = np.arange(0.0, DURATION, step)
    values = gaussian_filter1d([history(t) for t in fine], WIDTH_OF_KERNEL / step)
    return np.interp(time, fine, values)


def carried(table, n_bodies):
    """All bodies go with the table."""

    def poses(t):
        found = np.zeros((n_bodies, 3))
        found[:, 0] = table(t)
        return found

    return poses


def tilted(t, size=0.02, start=2.0):
    """A turn that comes and goes smoothly, to one side and to the other."""
    if t < start or t > DURATION - 1.0:
        return 0.0
    return size * np.sin(np.pi * (t - start) / 1.0) ** 3


def test_blocks_that_go_with_the_table_need_shear_and_lever_of_their_inertia(sensors):
    structure, table = stack(2), shaken(0.5)
    seen = reconstruct_test("carried", readings(structure, carried(table, 3)), structure, sensors)
    time = seen.motion.time[INNER]
    acceleration = smoothed(lambda t: accelerations(carried(table, 3), t)[0, 0], time)
    for place, above in enumerate((2, 1)):
        mass = above * structure.mass[1]
        shear, _, normal = seen.forces.force[INNER, place].T
        np.testing.assert_allclose(normal, mass * GRAVITY, rtol=1e-4)
        np.testing.assert_allclose(shear / normal, acceleration / GRAVITY, atol=0.01 * 0.5 / GRAVITY)
        # statics: the resultant of weight and inertia passes through the centre of what is above
        expected = -0.5 * above * HEIGHT * acceleration / GRAVITY
        np.testing.assert_allclose(lever(seen)[0][INNER, place], expected, atol=0.01 * np.abs(expected).max())


def test_forces_of_a_rocking_block_are_those_of_newton_and_euler(sensors):
    structure = stack(1)
    poses = rocking(shaken(0.0), tilted)
    seen = reconstruct_test("rocking", readings(structure, poses), structure, sensors)
    mass, inertia = structure.mass[1], structure.inertia[1, 1, 1]

    def required(t):
        (ax, az, alpha), (_, _, angle) = accelerations(poses, t)[1], poses(t)[1]
        c, s = np.cos(angle), np.sin(angle)
        # moment about the middle of the lower face of the force at the mass centre, 0.8 m above it in the block
        moment = inertia * alpha + 0.5 * HEIGHT * mass * (c * ax - s * (az + GRAVITY))
        return mass * (c * (az + GRAVITY) + s * ax), moment

    rows = np.flatnonzero(seen.states.edge[:, 0, 0])
    assert len(rows) > 50
    time = seen.motion.time[rows]
    normal, moment = (smoothed(lambda t, place=place: required(t)[place], time) for place in (0, 1))
    np.testing.assert_allclose(seen.forces.force[rows, 0, 2], normal, rtol=5e-3)
    np.testing.assert_allclose(lever(seen)[0][rows, 0], -moment / normal, atol=5e-3)


def test_levers_of_a_block_whose_mass_is_off_its_centroid_lie_the_other_way_if_it_is_taken_there(sensors):
    """Statics: the resultant passes through the mass centre. On edges at -b and b it seems to at -b - e and b - e."""
    offset, structure = 0.05, stack(1)
    name = structure.body_names[1]
    eccentric = structure.with_parameters({f"bodies.{name}.mass_offset": [offset, 0.0, 0.0]})
    test = readings(structure, rocking(shaken(0.0), tilted))
    levers = [lever(reconstruct_test("tilted", test, one, sensors))[0] for one in (structure, eccentric)]
    assert np.nanmedian((levers[0] - levers[1])[INNER]) == pytest.approx(-offset, rel=0.01)


def test_errors_are_as_large_as_they_are_said_to_be(sensors):
    """Chi-square of the levers over many draws of the noise."""
    structure, table = stack(2), shaken(0.5)
    exact, _ = lever(reconstruct_test("exact", readings(structure, carried(table, 3)), structure, sensors))
    squares = []
    for seed in range(6):
        noisy = readings(
            structure, carried(table, 3), sensors.marker_noise, sensors.accelerometer_noise, seed
        )
        read, error = lever(reconstruct_test("noisy", noisy, structure, sensors))
        squares.append(((read - exact) / error)[INNER] ** 2)
    assert np.nanmean(squares) == pytest.approx(1.0, abs=0.25)


def test_a_joint_that_closes_and_opens_to_the_same_side_bears_on_neither_edge_meanwhile(sensors):
    """A kink at zero, rounded by the kernel to a millirad, is an impact; a smooth turn a millirad from zero is none."""
    structure, kinks = stack(1), [2.0, 3.0, 4.0]

    def bouncing(t):
        return 0.03 * abs(np.sin(np.pi * t)) if t > 1.0 else 0.0

    def swaying(t):
        return 1e-3 * (2.0 + np.cos(2.0 * np.pi * t)) * np.clip(t - 1.0, 0.0, 1.0) ** 2

    for turn, closes in ((bouncing, True), (swaying, False)):
        noisy = readings(
            structure, rocking(lambda t: 0.0, turn), sensors.marker_noise, sensors.accelerometer_noise
        )
        seen = reconstruct_test("kinks", noisy, structure, sensors)
        near = np.searchsorted(seen.motion.time, kinks if closes else [2.5, 3.5, 4.5])
        assert (np.abs(seen.joints.rotation[near, 0]) > 3e-4).all()
        assert ((seen.joints.side[near, 0] == 0) == closes).all()
