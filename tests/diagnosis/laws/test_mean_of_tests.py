"""Sizes of several tests make one with an honest interval."""

import numpy as np
import pytest

from blockshake.diagnosis.laws.mean_of_tests import mean_of_tests


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_nine_of_ten_intervals_hold_the_size(count):
    """Sizes of tests that differ by 15 %, the share that the form of a law leaves out, and by their errors."""
    generator, size, errors = np.random.default_rng(count), 2.0, np.full(count, 0.1)
    held = 0
    for _ in range(1000):
        values = size * (1.0 + 0.15 * generator.normal(size=count)) + errors * generator.normal(size=count)
        mean, half = mean_of_tests(values, errors)
        held += abs(mean - size) <= half
    # 900 is expected; four standard deviations of the count of a thousand
    assert held == pytest.approx(900, abs=38)


def test_a_test_that_tells_little_counts_little():
    mean, _ = mean_of_tests([2.0, 2.1, 9.0], [0.01, 0.01, 5.0])
    assert mean == pytest.approx(2.05, abs=0.06)
