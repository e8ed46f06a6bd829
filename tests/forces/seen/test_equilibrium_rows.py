"""Rows of a seen test against the equations of motion of a rocking and of a sliding block, in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from known_blocks import (
    BRIDGE,
    GRAVITY,
    HEIGHT,
    SPAN,
    WIDTH,
    portal,
    readings,
    rocking,
    shaken,
    sliding,
    stack,
    swaying,
)

from blockshake.forces.seen.equilibrium_rows import equilibrium_rows
from blockshake.forces.seen.point_rows import point_rows
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.forces.seen.wrench_histories import (
    edge_inward,
    force_at,
    friction_against_slip,
    mass_centre_off,
)

STILL = 1e-6  # m, m/s2: noise of readings that have next to none


@pytest.fixture(scope="module")
def quiet(sensors):
    return sensors.model_copy(update={"marker_noise": STILL, "accelerometer_noise": 1e-4})


def turn(t, size=0.02, start=2.0, end=5.0):
    """A turn to one side and to the other that starts and ends smoothly."""
    return size * np.sin(np.pi * (t - start)) ** 3 if start < t < end else 0.0


@pytest.fixture(scope="module")
def rocked(quiet):
    """A block that turns about its edges on a table at rest, whatever makes it do so."""
    structure = stack(1)
    return reconstruct_test("rocked", readings(structure, rocking(lambda t: 0.0, turn)), structure, quiet)


def test_rows_are_there_only_where_the_block_has_turned_and_calmly(rocked):
    side = rocked.states.edge[rocked.rows.instant, 0, 0]
    assert (side != 0).all()
    assert set(side) == {-1, 1}
    # one degree of freedom is left: the rotation about the edge
    assert len(np.unique(rocked.rows.instant)) == len(rocked.rows.instant)


def test_a_row_is_the_moment_about_the_edge_that_the_joint_cannot_give(rocked):
    mass = rocked.structure.mass[1]
    half, high = 0.5 * WIDTH, 0.5 * HEIGHT
    inertia = mass * (WIDTH**2 + HEIGHT**2) / 12.0 + mass * (half**2 + high**2)
    found, expected = [], []
    pull = rocked.rows.along(force_at(rocked, 1, np.array([1.0, 0.0, 0.0]), high))
    step = 1e-3
    for index, time in enumerate(rocked.rows.time):
        angle = turn(time)
        side = np.sign(angle)
        # moment of gravity about the edge, against the turn while the block leans within its balance
        arm = side * half * np.cos(angle) - high * np.sin(angle)
        second = (turn(time - step) - 2.0 * angle + turn(time + step)) / step**2
        moment = inertia * second + mass * GRAVITY * arm
        # of a force of 1 N along x at the top of the block
        lever = 2.0 * high * np.cos(angle) + side * 2.0 * half * 0.5 * np.sin(angle)
        found.append(rocked.rows.value[index] / pull[index])
        expected.append(moment / lever)
    found, expected = np.array(found), np.array(expected)
    # the kernel of 15 ms takes 0.1 % of a turn with a period of 2 s
    np.testing.assert_allclose(found, expected, atol=0.01 * np.abs(expected).max())


def test_normal_force_of_a_single_joint_is_weight_and_vertical_inertia(rocked):
    mass = rocked.structure.mass[1]
    rest = rocked.still
    np.testing.assert_allclose(rocked.forces.force[rest, 0, 2], mass * GRAVITY, rtol=1e-3)


def test_normal_forces_in_a_loop_are_those_that_turned_joints_can_carry(quiet):
    """A bridge on the corners of two blocks that sway: its weight and its inertia alone share out its support."""
    structure, poses = portal(), swaying(turn)
    seen = reconstruct_test("swayed", readings(structure, poses), structure, quiet)
    supports = [index for index, face in enumerate(seen.faces) if face.upper == 3]
    edge = seen.states.edge[..., 0]
    calm = np.flatnonzero((edge != 0).all(axis=1))
    assert not seen.tree
    assert len(calm) > 100
    assert set(edge[calm, supports[0]]) == {-1, 1}
    found, expected = seen.forces.force[calm][:, supports, 2], []
    step = 1e-3
    for index in calm:
        before, now, after = (poses(seen.motion.time[index] + shift)[3, :2] for shift in (-step, 0.0, step))
        along, up = structure.mass[3] * (before - 2.0 * now + after) / step**2
        corners = 0.5 * WIDTH * edge[index, supports] + [-SPAN, SPAN]
        # vertical forces at the two corners: their sum, and their moment about the bridge's mass centre
        wanted = [up + structure.mass[3] * GRAVITY, -0.5 * BRIDGE * along]
        expected.append(np.linalg.solve([[1.0, 1.0], corners], wanted))
    np.testing.assert_allclose(found, expected, atol=0.01 * structure.mass[3] * GRAVITY)


def test_a_loop_of_which_a_body_is_not_read_has_no_rows(quiet):
    """A block that slips below and above has rows of its own: but by how much friction errs there is not known."""
    structure, sways = portal(), swaying(turn)

    def poses(t):
        moved = sways(t)
        moved[2, 0] += 0.05 * max(t - 1.5, 0.0)
        return moved

    read = readings(structure, poses)
    lost = (read["time"] > 1.0) & (read["time"] < 3.0)
    of_block = read["marker"].str.startswith("block-1")
    read["marker_displacement"] = read["marker_displacement"].where(~(lost & of_block))
    seen = reconstruct_test("lost", read, structure, quiet)
    assert np.isnan(seen.forces.force[seen.motion.time < 2.9, :, 2]).any()
    assert seen.rows.time.min() > 2.9
    slipping = equilibrium_rows(seen.frames, seen.states, seen.motion, seen.required, seen.free)
    assert slipping.time.min() < 2.9


def test_an_edge_further_in_shifts_the_moment_of_the_normal_force(rocked):
    column = rocked.rows.along(edge_inward(rocked, 0))
    edge = rocked.rows.along(_about_edge(rocked))
    side = rocked.states.edge[rocked.rows.instant, 0, 0]
    normal = rocked.forces.force[rocked.rows.instant, 0, 2]
    np.testing.assert_allclose(column, side * normal * edge, rtol=1e-9)
    assert not rocked.rows.along(edge_inward(rocked, 0, edge=1))[side < 0].any()


def _about_edge(seen):
    """Wrench of a moment of 1 N m about y on the block."""
    wrench = np.zeros((len(seen.motion.time), 2, 6))
    wrench[:, 1, 4] = 1.0
    return wrench


def test_rows_of_a_mass_centre_that_is_off_are_the_column_times_its_distance(quiet):
    """The same block seen with its true mass centre and with one that is supposed in the middle."""
    off = 1e-3
    structure = stack(1)
    true = structure.with_parameters({"bodies.block-1.mass_offset": [off, 0.0, 0.0]})
    read = readings(structure, rocking(lambda t: 0.0, turn))
    supposed, shifted = (
        reconstruct_test("a", read, structure, quiet),
        reconstruct_test("b", read, true, quiet),
    )
    assert (supposed.rows.instant == shifted.rows.instant).all()
    moment = [one.rows.along(_about_edge(one)) for one in (supposed, shifted)]
    difference = supposed.rows.value / moment[0] - shifted.rows.value / moment[1]
    column = supposed.rows.along(mass_centre_off(supposed, 1)) / moment[0]
    np.testing.assert_allclose(difference, off * column, atol=0.01 * off * np.abs(column).max())


def test_a_block_that_slides_by_its_friction_leaves_rows_of_nothing(quiet):
    structure = stack(1, friction=0.2)
    table = shaken(4.0, 1.0)
    seen = reconstruct_test("slid", readings(structure, sliding(table, 0.2)), structure, quiet)
    assert len(seen.rows.value) > 20
    weight = structure.mass[1] * GRAVITY
    assert np.abs(seen.rows.value).max() < 0.02 * 0.2 * weight
    # a tenth less friction than the structure states: the column of friction times the difference
    less = reconstruct_test("less", readings(structure, sliding(table, 0.18)), structure, quiet)
    column = less.rows.along(friction_against_slip(less, 0))
    found = (column @ less.rows.value) / (column @ column)
    assert found == pytest.approx(-0.02, rel=0.1)


def test_a_point_of_a_stack_that_turns_as_one_moves_with_its_height(quiet):
    structure = stack(2)

    def poses(t):
        lower = rocking(lambda t: 0.0, turn)(t)
        angle = lower[1, 2]
        up = HEIGHT * np.array([np.sin(angle), np.cos(angle) - 1.0])
        return np.array([*lower, [lower[1, 0] + up[0], lower[1, 1] + up[1], angle]])

    read = readings(structure, poses)
    whole = reconstruct_test("whole", read, structure, quiet)
    assert len(whole.rows.value) > 50
    point = point_rows(whole, "block-2", 0.5)
    assert point.unit.any()
    assert np.abs(point.displacement).max() == pytest.approx(2.0 * HEIGHT * 0.02, rel=0.1)


def test_states_of_a_seen_test_can_be_replaced(rocked):
    """The rows follow from the states alone: a face that may carry all leaves none."""
    closed = replace(rocked.states, edge=np.zeros_like(rocked.states.edge))
    rows = equilibrium_rows(rocked.frames, closed, rocked.motion, rocked.required, rocked.free)
    assert not len(rows.value)
