"""Sizes of several tests make one with an honest interval."""

import numpy as np
import pytest

from blockshake.diagnosis.laws.mean_of_tests import mean_of_tests


def held(count, common, own, form):
    """Share of a thousand intervals that hold a size of which tests differ by shares, all alike and each its own."""
    generator, size, errors = np.random.default_rng(count), 2.0, np.full(count, 0.1)
    found = 0
    for _ in range(1000):
        share = 1.0 + common * generator.normal() + own * generator.normal(size=count)
        mean, half = mean_of_tests(size * share + errors * generator.normal(size=count), errors, form)
        found += abs(mean - size) <= half
    return found / 1000


@pytest.mark.parametrize("count", [2, 3, 6])
def test_nine_of_ten_intervals_hold_a_size_by_which_tests_differ(count):
    # four standard deviations of the count of a thousand
    assert held(count, 0.0, 0.15, 0.0) == pytest.approx(0.9, abs=0.038)


@pytest.mark.parametrize("count", [1, 6, 30])
def test_nine_of_ten_intervals_hold_a_size_that_the_form_has_wrong_in_all_tests_alike(count):
    assert held(count, 0.15, 0.0, 0.15) == pytest.approx(0.9, abs=0.045)


def test_a_test_that_tells_little_counts_little():
    mean, _ = mean_of_tests([2.0, 2.1, 9.0], [0.01, 0.01, 5.0])
    assert mean == pytest.approx(2.05, abs=0.06)
