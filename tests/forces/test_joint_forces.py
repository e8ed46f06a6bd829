"""Forces from readings against those that follow by hand from a motion in closed form."""

import numpy as np
import pytest
from known_blocks import (
    DURATION,
    GRAVITY,
    HEIGHT,
    WIDTH,
    accelerations,
    readings,
    rocking,
    shaken,
    sliding,
    stack,
)
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from blockshake.diagnosis.laws.law_table import law_of
from blockshake.diagnosis.laws.outside_force import law_of_tests
from blockshake.forces.joint_forces import joint_forces
from blockshake.forces.laws.friction import friction_law
from blockshake.forces.laws.lever import lever_law
from blockshake.forces.laws.table import table_law
from blockshake.forces.laws.unexplained import unexplained_law
from blockshake.forces.motion import WIDTH as WIDTH_OF_KERNEL
from blockshake.forces.outside.force_laws import fit_laws
from blockshake.forces.outside.push_history import push_history

INNER = slice(10, -10)


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
    forces = joint_forces(readings(structure, carried(table, 3)), structure, sensors)
    time = forces.motion.time[INNER]
    acceleration = smoothed(lambda t: accelerations(carried(table, 3), t)[0, 0], time)
    for place, above in enumerate((2, 1)):
        mass = above * structure.mass[1]
        np.testing.assert_allclose(forces.transmitted.normal[INNER, place], mass * GRAVITY, rtol=1e-4)
        np.testing.assert_allclose(
            forces.transmitted.friction[INNER, place], acceleration / GRAVITY, atol=0.01 * 0.5 / GRAVITY
        )
        # statics: the resultant of weight and inertia passes through the centre of what is above
        lever = -0.5 * above * HEIGHT * acceleration / GRAVITY
        np.testing.assert_allclose(
            forces.transmitted.lever[INNER, place], lever, atol=0.01 * np.abs(lever).max()
        )
    assert np.nanmax(np.abs(forces.least.wrench[INNER])) < 1e-6 * structure.mass[1] * GRAVITY


def test_forces_of_a_rocking_block_are_those_of_newton_and_euler(sensors):
    structure = stack(1)
    poses = rocking(shaken(0.0), tilted)
    forces = joint_forces(readings(structure, poses), structure, sensors)
    mass, inertia = structure.mass[1], structure.inertia[1, 1, 1]

    def required(t):
        (ax, az, alpha), (_, _, angle) = accelerations(poses, t)[1], poses(t)[1]
        c, s = np.cos(angle), np.sin(angle)
        # moment about the middle of the lower face of the force at the mass centre, 0.8 m above it in the block
        moment = inertia * alpha + 0.5 * HEIGHT * mass * (c * ax - s * (az + GRAVITY))
        return mass * (c * (az + GRAVITY) + s * ax), moment

    rows = np.flatnonzero(forces.joints.steady & (forces.joints.side[:, 0] != 0))
    time = forces.motion.time[rows]
    normal, moment = (smoothed(lambda t, place=place: required(t)[place], time) for place in (0, 1))
    np.testing.assert_allclose(forces.transmitted.normal[rows, 0], normal, rtol=5e-3)
    np.testing.assert_allclose(forces.transmitted.lever[rows, 0], -moment / normal, atol=5e-3)


def test_levers_of_a_block_whose_mass_is_off_its_centroid_lie_the_other_way_if_it_is_taken_there(sensors):
    """Statics: the resultant passes through the mass centre. On edges at -b and b it seems to at -b - e and b - e."""
    offset, structure = 0.05, stack(1)
    name = structure.body_names[1]
    eccentric = structure.with_parameters({f"bodies.{name}.mass_offset": [offset, 0.0, 0.0]})
    test = readings(structure, rocking(shaken(0.0), tilted))
    forces = [joint_forces(test, one, sensors).transmitted.lever for one in (structure, eccentric)]
    away = (forces[0] - forces[1])[INNER]
    assert np.nanmedian(away) == pytest.approx(-offset, rel=0.01)


def test_errors_are_as_large_as_they_are_said_to_be(sensors):
    """Chi-square of the levers over many draws of the noise."""
    structure, table = stack(2), shaken(0.5)
    exact = joint_forces(readings(structure, carried(table, 3)), structure, sensors).transmitted.lever
    squares = []
    for seed in range(6):
        noisy = readings(
            structure, carried(table, 3), sensors.marker_noise, sensors.accelerometer_noise, seed
        )
        forces = joint_forces(noisy, structure, sensors)
        squares.append(((forces.transmitted.lever - exact) / forces.transmitted.lever_error)[INNER] ** 2)
    assert np.nanmean(squares) == pytest.approx(1.0, abs=0.25)


def test_a_force_that_friction_cannot_carry_is_unexplained(sensors):
    """A block slides as mu = 0.3 has it, and is pushed with another tenth of its weight."""
    mu, extra = 0.3, 0.1
    structure = stack(1, friction=mu)
    rate = (mu + extra) * GRAVITY

    def poses(t):
        own = np.clip(t - 2.0, 0.0, None)
        return np.array([[0.0, 0.0, 0.0], [0.5 * rate * own**2 * (own < 1.0), 0.0, 0.0]])

    forces = joint_forces(readings(structure, poses), structure, sensors)
    inner = (forces.motion.time > 2.1) & (forces.motion.time < 2.9)
    weight = structure.mass[1] * GRAVITY
    # the smallest wrench takes a part of it as a load that presses the joint, for more friction
    found = forces.least.wrench[inner, 1, 0] / (extra * weight)
    assert found.min() > 0.8
    assert found.max() < 1.0
    assert unexplained_law(forces)["unexplained.largest"].value > 0.09


def test_what_slips_shows_its_friction(sensors):
    """Sine shaking of 4 m/s2 slides a block with mu = 0.25 to and fro: known by integration."""
    mu = 0.25
    structure, poses = stack(1, friction=mu), sliding(shaken(4.0, 1.5), mu)
    told = friction_law(joint_forces(readings(structure, poses), structure, sensors), 0)
    assert abs(told["friction.loss"].value) < 0.02
    rate = law_of("joint1.friction.rate")
    assert told["friction.rate"].value == pytest.approx(rate.usual, abs=rate.spread)


def test_lever_of_a_worn_edge_is_short(sensors):
    """The structure is told to be wider than the block that rocks."""
    structure = stack(1)
    inset = 0.03
    half, high = 0.5 * WIDTH - inset, 0.5 * HEIGHT
    inertia = structure.mass[1] * (half**2 + high**2) + structure.inertia[1, 1, 1]

    def swing(t):
        """Rocking about the edge further in: ``I theta'' = -m g R sin(alpha - |theta|)`` over half a cycle."""
        return float(smooth(t))

    step = 1e-3
    turns = np.zeros(int((DURATION + 0.1) / step))
    angle, rate, weight = 0.0, 0.0, structure.mass[1] * GRAVITY
    for row in range(int(2.0 / step), len(turns)):
        if row == int(2.0 / step):
            rate = 0.6
        side = np.sign(angle) if angle else np.sign(rate)
        arm = half * np.cos(angle) - side * high * np.sin(angle)
        rate += step * -side * weight * arm / inertia
        angle += step * rate
        turns[row] = angle

    smooth = CubicSpline(np.arange(len(turns)) * step, turns)

    def poses(t):
        angle = swing(t)
        side = np.sign(angle) if angle else 1.0
        c, s = np.cos(angle), np.sin(angle)
        x = side * half + (-side * half * c + high * s)
        z = (side * half * s + high * c) - high
        return np.array([[0.0, 0.0, 0.0], [x, z, angle]])

    told = lever_law(joint_forces(readings(structure, poses), structure, sensors), 0)
    assert told["lever.short"].value == pytest.approx(inset, abs=4e-3)
    assert abs(told["lever.bias"].value) < 3e-3


def test_a_table_that_pitches_with_its_acceleration(sensors):
    structure, table, coefficient = stack(1), shaken(1.0), 4e-4

    def poses(t):
        pitch = coefficient * accelerations(lambda at: np.array([[table(at)]]), t)[0, 0]
        # the block goes with the slab about the slab's centre
        return np.array([[table(t), 0.0, pitch], [table(t) + 0.9 * pitch, 0.0, pitch]])

    noisy = readings(structure, poses, sensors.marker_noise, sensors.accelerometer_noise)
    gap = noisy.copy(deep=True)  # no marker of the slab is seen in the quiet start
    gap["marker_displacement"].loc[{"marker": ["slab-a", "slab-b", "slab-c"], "time": slice(0.0, 0.8)}] = (
        np.nan
    )
    for test in (noisy, gap):
        told = table_law(joint_forces(test, structure, sensors))
        assert told["table.pitch"].value == pytest.approx(
            coefficient, abs=5.0 * told["table.pitch"].error + 1e-5
        )


def test_a_constant_push_is_found_with_its_start_and_size(sensors):
    """A sliding block is pushed from a time on: the excess over Coulomb's force is a step."""
    mu, push, start = 0.2, 3000.0, 3.0
    structure = stack(1, friction=mu)
    mass = structure.mass[1]

    def poses(t):
        own = np.clip(t - 1.5, 0.0, None)
        after = np.clip(t - start, 0.0, None)
        x = 0.5 * mu * GRAVITY * own**2 + 0.5 * push / mass * after**2
        return np.array([[0.0, 0.0, 0.0], [x, 0.0, 0.0]])

    noisy = readings(structure, poses, sensors.marker_noise, sensors.accelerometer_noise)
    forces = joint_forces(noisy, structure, sensors)
    history = push_history(forces, 1)
    pushed = (forces.motion.time > start + 0.1) & np.isfinite(history.force)
    # the smallest force: friction may take up to its own share of what presses the block down, and nothing more
    assert np.median(history.force[pushed]) == pytest.approx(push, rel=0.02)
    best = fit_laws(forces.motion.time, history)[0]
    assert best.name == "constant"
    assert best.amplitude == pytest.approx(push, rel=0.1)
    assert best.parameters["start"] == pytest.approx(start, abs=0.1)


@pytest.mark.parametrize("more", [0.9, 1.0, 1.1])
def test_friction_that_is_known_to_a_tenth_asks_for_no_force(more, sensors):
    """A block slides to and fro with another coefficient than its structure states."""
    mu = 0.25
    structure, poses = stack(1, friction=mu), sliding(shaken(4.0, 1.5), more * mu)
    noisy = readings(structure, poses, sensors.marker_noise, sensors.accelerometer_noise)
    forces = joint_forces(noisy, structure, sensors)
    assert law_of_tests({"only": fit_laws(forces.motion.time, push_history(forces, 1))}) is None


def test_a_joint_that_closes_and_opens_to_the_same_side_bears_on_both_edges(sensors):
    """A kink at zero, rounded by the kernel to a millirad, is an impact; a smooth turn a millirad from zero is none."""
    structure, kinks = stack(1), [2.0, 3.0, 4.0]

    def bouncing(t):
        return 0.03 * abs(np.sin(np.pi * t)) if t > 1.0 else 0.0

    def swaying(t):
        return 1e-3 * (2.0 + np.cos(2.0 * np.pi * t)) * np.clip(t - 1.0, 0.0, 1.0) ** 2

    for turn, bears in ((bouncing, True), (swaying, False)):
        noisy = readings(
            structure, rocking(lambda t: 0.0, turn), sensors.marker_noise, sensors.accelerometer_noise
        )
        forces = joint_forces(noisy, structure, sensors)
        near = np.searchsorted(forces.motion.time, kinks if bears else [2.5, 3.5, 4.5])
        assert (np.abs(forces.joints.rotation[near, 0]) > 3e-4).all()
        assert (forces.joints.bears[near, 0, 0].all(axis=-1) == bears).all()


def test_an_impact_just_beyond_the_end_of_a_record_leaves_no_unexplained_force(sensors):
    """The other edge bears within the kernel's reach of the last instant, though no reading shows it."""
    structure = stack(1)

    def swinging(t):
        return 0.02 * np.sin(np.pi * (t - 2.0)) if t > 2.0 else 0.0

    test = readings(structure, rocking(shaken(0.0), swinging))
    cut = test.isel(time=test["time"] < 3.005, time_acc=test["time_acc"] < 3.005)
    forces = joint_forces(cut, structure, sensors)
    late = forces.motion.time > 2.9
    assert (forces.joints.side[late, 0] == 1).all()
    weight = structure.mass[1] * GRAVITY
    assert np.nanmax(np.abs(forces.least.wrench[late, 1, 0])) < 0.01 * weight
