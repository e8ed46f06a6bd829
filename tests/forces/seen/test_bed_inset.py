"""Inset of an elastic bed without tension against the equilibrium of its pressures."""

from types import SimpleNamespace

import numpy as np
import pytest

from blockshake.forces.seen.wrench_histories import bed_inset

NORMAL, COMPLIANCE = 2.5e5, 5e-11  # N, m3/N
WIDTH, LENGTH = 0.8, 2.4  # m


@pytest.fixture
def face():
    corners = 0.5 * np.array([[-WIDTH, -LENGTH, 0.0], [WIDTH, -LENGTH, 0.0], [WIDTH, LENGTH, 0.0]])
    return SimpleNamespace(corners=corners)


@pytest.mark.parametrize("turn", [5e-4, 2e-3, 2e-2])
def test_pressures_of_a_winkler_bed_balance_the_normal_force_where_it_says(face, turn):
    """The bed closes by the rotation times the distance from the line at which it parts."""
    pressed = 3.0 * bed_inset(NORMAL, COMPLIANCE, turn, face)
    assert pressed < WIDTH
    from_edge = (np.arange(20_000) + 0.5) * pressed / 20_000
    pressure = turn * (pressed - from_edge) / COMPLIANCE
    assert LENGTH * pressure.mean() * pressed == pytest.approx(NORMAL, rel=1e-6)
    resultant = (pressure * from_edge).sum() / pressure.sum()
    assert resultant == pytest.approx(pressed / 3.0, rel=1e-6)


def test_it_stays_within_two_thirds_of_the_half_width_along_its_tangent(face):
    assert bed_inset(NORMAL, 1.0, 1e-4, face) == pytest.approx(WIDTH / 3.0)
    assert bed_inset(NORMAL, 1.0, 1e-4, face, tangent=1) == pytest.approx(LENGTH / 3.0)
