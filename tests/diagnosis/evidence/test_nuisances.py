"""A tolerance of undamaged blocks takes up what blocks may have, and no force that would need another block."""

from types import SimpleNamespace

import numpy as np
import pytest
from moved_point import moved_point

from blockshake.diagnosis.answer.explain import given, likelihoods
from blockshake.diagnosis.evidence.nuisances import nuisances_of, possible
from blockshake.diagnosis.outside.following import explain_following
from blockshake.forces.kernel_noise import Colour

TIME = np.arange(0.0, 20.0, 0.02)  # s
MASS, STIFFNESS, SOFTENS_AT, FARTHEST = 4.8e5, 2.6e6, 0.5, 0.15  # kg, N/m, m, m
MOVED, SPEED = FARTHEST * np.sin(2.3 * TIME), FARTHEST * 2.3 * np.cos(2.3 * TIME)  # m, m/s
ERROR = 0.01 * MASS  # N, of the required force


def _tested(force, weighs):
    """Test of a body on ice: forces that its motion needs, and those that twice its mass would need more."""
    noise = {Colour(False, 0.0): ERROR * np.eye(len(TIME))}
    return SimpleNamespace(
        rows=SimpleNamespace(value=force, time=TIME, noise=noise),
        seen=SimpleNamespace(free=[1], faces=[], motion=SimpleNamespace(width=0.001)),
        hinges={},
        slides={},
        eccentric={1: np.zeros(len(TIME))},
        heavier={1: -weighs},
    )


def _spring(likelihood):
    points = moved_point(MOVED, SPEED)
    return next(one for one in explain_following(likelihood, points, 9.81 * MASS) if one.cause == "rope")


def test_a_body_keeps_its_mass_on_a_spring_that_softens():
    """Else a body of less mass would need less force: the spring's stiffness would go with the mass that is left."""
    force = -STIFFNESS * MOVED / (1.0 + np.abs(MOVED) / SOFTENS_AT)
    force += np.random.default_rng(3).normal(0.0, ERROR, len(TIME))
    test = _tested(force, force)
    (mass,) = nuisances = nuisances_of([test])
    likelihood = likelihoods([test], nuisances)[0]
    beside = given(likelihood, [test], _spring(likelihood))
    weakest = STIFFNESS / (1.0 + FARTHEST / SOFTENS_AT)
    assert _spring(likelihood).best.size[0] < weakest
    assert beside.nuisance_amplitudes[0] < -mass.most
    assert possible(nuisances, beside.nuisance_amplitudes[:1]) == []
    assert weakest < _spring(likelihoods([test], [])[0]).best.size[0] < STIFFNESS


@pytest.mark.parametrize("excess", [0.03, -0.08])
def test_a_mass_that_blocks_may_have_stays_a_tolerance(excess):
    force = 0.3 * MASS * np.cos(1.7 * TIME)
    noise = np.random.default_rng(3).normal(0.0, ERROR, len(TIME))
    test = _tested(-excess * force + noise, force)
    nuisances = nuisances_of([test])
    amplitudes = likelihoods([test], nuisances)[0].nuisance_amplitudes
    assert 0.025 * amplitudes[0] == pytest.approx(excess, rel=0.05)
    assert possible(nuisances, amplitudes) == nuisances
