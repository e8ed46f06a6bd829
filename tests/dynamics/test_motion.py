import numpy as np
import pytest

from blockshake.dynamics.motion import find_segment, ground_motion, ground_state_into, rest_table

ROUNDING = 1e-12  # a few hundred operations on numbers of order one


def random_motion(kind):
    rng = np.random.default_rng(3)
    time = np.concatenate([[0.0], np.cumsum(rng.uniform(0.01, 0.2, 40))])
    columns = {"x": rng.normal(size=41), "z": rng.normal(size=41), "pitch_y": 0.01 * rng.normal(size=41)}
    return ground_motion("random", time, columns, kind), time, columns


@pytest.mark.parametrize(("kind", "derivative"), [("displacement", 0), ("velocity", 1), ("acceleration", 2)])
def test_rows_are_met_and_unnamed_channels_rest(kind, derivative):
    motion, time, columns = random_motion(kind)
    values = motion.evaluate(time, derivative)
    # segments are half open: a kind that is linear between rows is read at all rows but the last
    np.testing.assert_allclose(values[:-1, 0], columns["x"][:-1], atol=ROUNDING)
    np.testing.assert_allclose(values[:-1, 2], columns["z"][:-1], atol=ROUNDING)
    assert not values[:, 1].any()
    np.testing.assert_allclose(motion.evaluate(time)[:, 3], columns["pitch_y"], atol=ROUNDING)


def test_constant_acceleration_gives_half_a_t_squared():
    time = np.array([0.0, 0.3, 0.35, 1.0])
    motion = ground_motion("constant", time, {"x": np.full(4, 2.0)}, "acceleration")
    np.testing.assert_allclose(motion.evaluate(time)[:, 0], time**2, atol=ROUNDING)
    np.testing.assert_allclose(motion.evaluate(time, 1)[:, 0], 2.0 * time, atol=ROUNDING)


def test_linear_velocity_gives_a_parabola_from_zero():
    time = np.linspace(0.0, 2.0, 5)
    motion = ground_motion("ramp", time, {"y": 0.5 + time}, "velocity")
    between = np.linspace(0.0, 2.0, 33)
    np.testing.assert_allclose(
        motion.evaluate(between)[:, 1], 0.5 * between + between**2 / 2.0, atol=ROUNDING
    )


def test_displacement_is_a_cubic_spline():
    # a not-a-knot spline of a cubic is that cubic
    time = np.array([0.0, 0.4, 0.5, 1.1, 2.0])
    motion = ground_motion("cubic", time, {"x": time**3 - time}, "displacement")
    between = np.linspace(0.0, 1.99, 50)
    np.testing.assert_allclose(motion.evaluate(between, 1)[:, 0], 3.0 * between**2 - 1.0, atol=1e-11)


def test_two_rows_of_displacement_make_a_line():
    motion = ground_motion("line", [0.0, 2.0], {"x": [1.0, 5.0]}, "displacement")
    np.testing.assert_allclose(motion.evaluate(np.array([0.5]))[0, 0], 2.0, atol=ROUNDING)


@pytest.mark.parametrize("kind", ["displacement", "velocity", "acceleration"])
def test_kernel_agrees_with_evaluate_inside_and_rests_after(kind):
    motion, time, _ = random_motion(kind)
    displacement, velocity = np.empty(4), np.empty(4)
    segment = 0
    # forwards and backwards: the search starts from the last segment found
    for t in [*np.linspace(0.0, time[-1] - 1e-9, 90), 0.05, time[-1] + 3.0]:
        segment = find_segment(motion.table.breaks, t, segment)
        ground_state_into(motion.table, segment, t, displacement, velocity)
        np.testing.assert_allclose(displacement, motion.evaluate(np.array([t]))[0], atol=ROUNDING)
        np.testing.assert_allclose(velocity, motion.evaluate(np.array([t]), 1)[0], atol=1e-10)
    assert not velocity.any()
    np.testing.assert_array_equal(find_segment(motion.table.breaks, time[7], 20), 7)


def test_scaling_multiplies_every_column_and_gathers():
    motion, time, _ = random_motion("acceleration")
    twice = motion.scaled(0.5).scaled(3.0)
    np.testing.assert_allclose(twice.evaluate(time), 1.5 * motion.evaluate(time), atol=ROUNDING)
    assert twice.attributes["scale"] == 1.5
    assert "scale" not in motion.attributes


def test_rest_stays_at_rest():
    displacement, velocity = np.ones(4), np.ones(4)
    ground_state_into(rest_table(), 0, 0.5, displacement, velocity)
    assert not displacement.any()
    assert not velocity.any()
