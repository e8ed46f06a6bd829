"""Evidence of restitution: impacts of a known share against what undamaged models keep."""

import numpy as np
import pytest
from known_blocks import kicked, readings, rocking, stack

from blockshake.diagnosis.evidence import angular_momentum_ratio
from blockshake.diagnosis.evidence.angular_momentum_ratio import restitution_gain
from blockshake.forces.seen.impacts import Impact
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.measurement.campaigns.campaign import Sensors

NEEDED = 8.0  # nats


@pytest.fixture
def judged(monkeypatch):
    """Judge impacts that are given in place of tests."""
    monkeypatch.setattr(angular_momentum_ratio, "find_impacts", lambda impacts: impacts)
    return lambda impacts: restitution_gain([impacts])


def impacts(share, plastic, blocks=1, n_impacts=12, error=0.01, scatter=0.01, seed=1):
    shares = np.random.default_rng(seed).normal(share, np.hypot(error, scatter), n_impacts)
    return [Impact(float(t), False, blocks, 0.3, float(own), error, plastic) for t, own in enumerate(shares)]


@pytest.mark.parametrize("plastic", [0.5, 0.7, 0.87])
def test_shares_of_rigid_edges_and_of_flat_faces_are_nominal(judged, plastic):
    # losses over Housner's of contact dynamics and of LS-DEM at a restitution of 0.1 and 0.5 (docs/theory/rocking.md)
    for loss in (1.03, 0.63, 0.52):
        assert judged(impacts(1.0 - loss * (1.0 - plastic), plastic)).gain < 0.0


@pytest.mark.parametrize("plastic", [0.5, 0.7])
def test_a_squat_block_that_loses_next_to_nothing_is_evidence(judged, plastic):
    found = judged(impacts(1.0 - 0.1 * (1.0 - plastic), plastic))
    assert found.gain > NEEDED
    assert "no verdict" not in found.statement


@pytest.mark.parametrize("share", [0.9, 0.963, 0.98, 1.0, 1.05])
def test_a_slender_stack_is_never_judged(judged, share):
    found = judged(impacts(share, 0.963, blocks=3, n_impacts=60))
    assert abs(found.gain) < 2.0
    assert "no verdict" in found.statement


def test_the_interval_holds_the_truth_as_often_as_it_says(judged):
    held = [
        lower <= 0.8 <= upper
        for lower, upper in (
            judged(impacts(0.8, 0.7, scatter=0.02, seed=seed)).interval for seed in range(60)
        )
    ]
    assert 0.8 < np.mean(held) < 0.98


def test_a_few_impacts_that_something_else_strikes_hardly_count(judged):
    sound = impacts(0.85, 0.7)
    struck = [*sound, Impact(20.0, False, 1, 0.3, 1.6, 0.01, 0.7)]
    assert judged(struck).estimate == pytest.approx(judged(sound).estimate, abs=0.005)
    assert judged(struck).gain < 0.0


def test_returns_are_counted_and_tests_without_impacts_say_so(judged):
    back = Impact(20.0, True, 1, 0.3, -0.3, 0.01, 0.7)
    assert "1 more returned" in judged([*impacts(0.85, 0.7), back]).statement
    nothing = judged([])
    assert nothing.gain == 0.0
    assert nothing.statement.startswith("no impact")


@pytest.mark.parametrize(("share", "named"), [(0.7, False), (0.97, True)])
def test_from_readings_to_evidence(share, named):
    structure, sensors = stack(1), Sensors(marker_noise=1e-4, accelerometer_noise=0.02)
    read = readings(structure, rocking(lambda t: 0.0, kicked([share], kick=1.0)), 1e-4, 0.02)
    found = restitution_gain([reconstruct_test("kicked", read, structure, sensors)])
    assert (found.gain > NEEDED) == named
    assert found.interval[0] <= share <= found.interval[1]
