"""Noise as laboratories have it, scattered masses and rare impacts are no cause, and hide none."""

from dataclasses import replace

import numpy as np
import pytest
from simulated_tests import seen_tests

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.answer.explain import likelihoods
from blockshake.diagnosis.evidence.joint_rows import JointRows
from blockshake.forces.seen.wrench_histories import force_at
from blockshake.measurement.sensors.instruments import Instruments, SlowNoise

pytestmark = pytest.mark.usefixtures("without_limits")
MOTIONS = {"first": ("alkion", 2.5), "second": ("basso-tirreno", 2.0), "third": ("alkion", 3.0)}
STRUCK, AT = 2, 1.0  # number of a test, s
SLOW = SlowNoise(share=0.3, memory=0.1)


@pytest.fixture(scope="module")
def sound():
    return seen_tests("two-blocks", MOTIONS)


def _causes(seen):
    return [cause.name for part in decide(seen).decision.parts for cause in part.causes]


def test_noise_that_is_slow_and_uneven_by_axis_is_no_cause():
    noise = Instruments(marker_axes=(1.0, 1.5, 1.0), marker_slow=SLOW, accelerometer_slow=SLOW)
    assert _causes(seen_tests("two-blocks", MOTIONS, noise=noise)) == []


def test_blocks_of_scattered_density_are_no_cause():
    def scattered(experiment, _):
        densities = {"bodies.block-1.density": 2400.0 * 1.035, "bodies.block-2.density": 2400.0 * 0.975}
        return replace(experiment, structure=experiment.structure.with_parameters(densities))

    assert _causes(seen_tests("two-blocks", MOTIONS, change=scattered)) == []


def _with_rows(seen, values):
    """Seen tests in which other values are added to the rows of the struck one."""
    test = seen[STRUCK]
    struck = replace(test, rows=replace(test.rows, value=test.rows.value + values))
    return [*seen[:STRUCK], struck, *seen[STRUCK + 1 :]]


def _first_change(test):
    """Time of the first change of an edge after `AT` that leaves rows for a quarter of a second."""
    side = test.joints.side
    changed = test.motion.time[1:][(side[1:] != side[:-1]).any(axis=1)]
    return next(
        time
        for time in changed
        if time > AT and ((test.rows.time > time) & (test.rows.time < time + 0.25)).sum() > 6
    )


def test_an_event_of_one_impact_is_no_blow(sound):
    """Rows of a tenth of a second of one test are off by up to eleven standard deviations."""
    rows = sound[STRUCK].rows
    likelihood = likelihoods([JointRows(sound[STRUCK])], [])[3]  # the stated noise, the usual errors
    near = np.flatnonzero(rows.time > _first_change(sound[STRUCK]))[:6]
    errors = np.zeros(len(rows.value))
    errors[near] = [11.0, 1.5, 2.0, -5.0, -3.0, 4.0]
    assert _causes(_with_rows(sound, likelihood.roots[0] @ errors)) == []


def test_a_blow_in_the_same_rows_is_found(sound):
    test = sound[STRUCK]
    pulse = np.exp(-0.5 * ((test.motion.time - _first_change(test) - 0.1) / 0.04) ** 2)
    force = 8e3 * pulse[:, None] * np.array([1.0, 0.0, 0.0])
    assert "blow" in _causes(_with_rows(sound, test.rows.along(force_at(test, 2, force))))
