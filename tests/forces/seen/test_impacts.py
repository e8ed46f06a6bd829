"""Impacts of blocks whose spin is known in closed form, against the share of it that they keep."""

import numpy as np
import pytest
from known_blocks import HEIGHT, WIDTH, kicked, readings, rocking, shaken, stack

from blockshake.forces.seen.impacts import find_impacts
from blockshake.forces.seen.reconstructed_test import reconstruct_test

NOISE, NOISE_ACC = 1e-4, 0.02


def still(t):
    return 0.0


def housner(height):
    """Housner (1963), 1 - 2 m b^2 / I."""
    half = 0.5 * WIDTH
    return 1.0 - 2.0 * half**2 / ((WIDTH**2 + height**2) / 12.0 + half**2 + 0.25 * height**2)


def impacts_of(sensors, shares, table=still, acceleration=still, seed=0, **kick):
    structure = stack(1)
    read = readings(
        structure,
        rocking(table, kicked(shares, table_acceleration=acceleration, **kick)),
        NOISE,
        NOISE_ACC,
        seed,
    )
    return find_impacts(reconstruct_test("kicked", read, structure, sensors))


@pytest.mark.parametrize("share", [0.6, 0.7, 0.85, 0.95])
def test_the_share_of_the_spin_kept_is_found_within_its_error(sensors, share):
    found = impacts_of(sensors, [share], kick=1.0)
    assert len(found) >= 3
    for impact in found:
        assert not impact.returned
        assert abs(impact.kept - share) < 3.0 * impact.error
        assert impact.plastic == pytest.approx(housner(HEIGHT), abs=0.01)
    # the first impact comes with the spin of the kick: nothing is lost in a swing
    assert found[0].spin == pytest.approx(1.0, rel=0.01)
    assert found[0].error < 0.015


def test_a_table_that_moves_changes_no_share(sensors):
    table = shaken(1.5, 1.5)
    step = 1e-3
    found = impacts_of(
        sensors, [0.8], table, lambda t: (table(t - step) - 2.0 * table(t) + table(t + step)) / step**2
    )
    assert len(found) >= 3
    for impact in found:
        assert abs(impact.kept - 0.8) < 3.0 * impact.error


def test_returns_to_the_same_edge_are_counted_with_a_negative_share(sensors):
    found = impacts_of(sensors, [-0.6, 0.8])
    assert found[0].returned
    assert found[0].kept == pytest.approx(-0.6, abs=3.0 * found[0].error)
    assert not any(impact.returned for impact in found[1:])


def test_blocks_that_turn_as_one_are_one_body(sensors):
    structure = stack(2)
    turn = kicked([0.9], height=2.0 * HEIGHT, kick=0.25)

    def poses(t):
        lower, angle = rocking(still, turn)(t), turn(t)
        up = HEIGHT * np.array([np.sin(angle), np.cos(angle) - 1.0])
        return np.array([*lower, [lower[1, 0] + up[0], lower[1, 1] + up[1], angle]])

    found = find_impacts(
        reconstruct_test("two", readings(structure, poses, NOISE, NOISE_ACC), structure, sensors)
    )
    assert len(found) >= 4
    assert {impact.blocks for impact in found} == {2}
    for impact in found:
        assert abs(impact.kept - 0.9) < 3.0 * impact.error
        assert impact.plastic == pytest.approx(housner(2.0 * HEIGHT), abs=0.005)
