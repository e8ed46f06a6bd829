"""A spring, a damper, and both together: each is called by its own name, and the rows of the others stay theirs."""

import numpy as np
import pytest
from moved_point import moved_point

from blockshake.diagnosis.evidence.explanation import NEVER
from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.diagnosis.outside.following import explain_following

TIME = np.arange(0.0, 20.0, 0.02)  # s
RATE = 2.0  # rad/s
MOVED, SPEED = 0.1 * np.sin(RATE * TIME), 0.1 * RATE * np.cos(RATE * TIME)  # m, m/s
STIFFNESS, DAMPING, NOISE = 2e5, 3e4, 1e3  # N/m, N s/m, N


def _explained(stiffness, damping):
    """`Explanation` by name of rows that a spring and a damper make."""
    rows = -stiffness * MOVED - damping * SPEED
    rows += np.random.default_rng(5).normal(0.0, NOISE, len(TIME))
    likelihood = from_rows([NOISE**2 * np.eye(len(TIME))], [rows], [])
    points = moved_point(MOVED, SPEED)
    return {one.cause: one for one in explain_following(likelihood, points, 30e3)}


@pytest.mark.parametrize(("stiffness", "damping", "name"), [(STIFFNESS, 0.0, "rope"), (0.0, DAMPING, "drag")])
def test_one_alone_is_called_so(stiffness, damping, name):
    found = _explained(stiffness, damping)
    assert found["spring-and-damper"].gain == NEVER
    assert max(found.values(), key=lambda one: one.gain).cause == name


def test_both_together_have_both_sizes():
    found = _explained(STIFFNESS, DAMPING)
    best = max(found.values(), key=lambda one: one.gain)
    assert best.cause == "spring-and-damper"
    # least squares: the error of an amplitude is that of the noise over the root of its rows' sum of squares
    for (size, true), deviation, rows in zip(
        zip(best.best.mean, (STIFFNESS, DAMPING), strict=True),
        np.sqrt(np.diag(best.best.covariance)),
        (MOVED, SPEED),
        strict=True,
    ):
        expected = NOISE / np.linalg.norm(rows)
        assert deviation == pytest.approx(expected, rel=0.01)
        assert abs(size - true) < 4.0 * expected
    assert best.best.size == (best.best.mean[0], pytest.approx(best.best.covariance[0, 0] ** 0.5))


def test_a_damper_within_the_error_of_the_springs_form_is_none():
    # it explains (c w / k)^2 = 1 % of what the spring does
    found = _explained(STIFFNESS, 0.1 * STIFFNESS / RATE)
    assert found["spring-and-damper"].gain == NEVER
    assert max(found.values(), key=lambda one: one.gain).cause == "rope"


def test_a_force_that_drives_is_no_damper():
    found = _explained(STIFFNESS, -DAMPING)
    assert found["spring-and-damper"].gain == NEVER
