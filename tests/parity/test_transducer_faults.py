"""The statistic of transducer faults on equations made by hand, whose truth is known; tolerances are those of noise."""

from dataclasses import replace

import numpy as np
import pytest

from blockshake.parity.finding import Level
from blockshake.parity.transducer_faults import check_transducer, hypotheses
from blockshake.parity.transducer_readings import HeldReading

TESTS = ("t1", "t2", "t3")
NOISE = 4e-5  # m, of a mean over a tenth of a second
LEVEL = Level(0.01, hypotheses(len(TESTS)))


def held_readings(seed, gain=0.0, place=(0.0, 0.0, 0.0), slip=None):
    """Three records of 10 s: the bodies move apart by centimetres while they turn by tens of milliradians.

    The faultless transducer has half of each tolerance as standard deviation, and a clock that lags by 0.2 ms.
    """
    generator = np.random.default_rng(seed)
    time = 0.05 + 0.1 * np.arange(100)
    gain, place = gain + generator.normal(0.0, 5e-3), np.array(place) + generator.normal(0.0, 2.5e-3, 3)
    held = {}
    for name, size in zip(TESTS, (0.0, 0.5, 1.0), strict=True):
        turn, drift = size * np.stack([_waves(generator, time) for _ in range(2)])
        expected = 0.02 * turn + 0.01 * drift
        places = np.zeros((len(time), 6))
        places[:, 0], places[:, 2] = -5e-4 * turn**2, 0.02 * turn
        late = np.gradient(expected, time)
        misfit = (
            gain * expected + places[:, :3] @ place + 2e-4 * late + generator.normal(0.0, NOISE, len(time))
        )
        if slip and slip[0] == name:
            misfit += slip[1] * (time > slip[2])
        arrays = [one - one.mean(axis=0) for one in (misfit, expected, places, late)]
        held[name] = HeldReading(time, *arrays, noise=NOISE)
    return held


def _waves(generator, time):
    """Sines from 0.3 to 3 Hz with random phases and a permanent part, of unit size."""
    frequency, phase = np.geomspace(0.3, 3.0, 8), generator.uniform(0.0, 2.0 * np.pi, 8)
    return (np.sin(2.0 * np.pi * frequency * time[:, None] + phase)).sum(axis=1) / 2.0 + (time > 6.0)


def _only(held, effect, quantity):
    check = check_transducer("wire", held, LEVEL)
    assert [(one.effect, one.where, one.quantity) for one in check.findings] == [
        (effect, ("wire",), quantity)
    ]
    return check.findings[0]


def test_an_end_elsewhere_is_named_with_its_place_along_what_is_seen():
    finding = _only(held_readings(2, place=(0.0, 0.0, 0.06)), "marker-offset", "place")
    assert abs(finding.estimate[2] - 0.06) < 4.0 * np.hypot(2.5e-3, finding.standard_error[2])
    # along y nothing is seen at all
    assert (finding.estimate[1], finding.standard_error[1] > 1.0) == (0.0, True)


@pytest.mark.parametrize("test", ["t1", "t3"])
def test_an_end_that_slips_is_named_with_its_time(test):
    finding = _only(held_readings(3, slip=(test, 2e-3, 4.0)), "sensor-drift", "slip")
    assert abs(finding.estimate[0] - 2e-3) < 4.0 * finding.standard_error[0]
    assert finding.estimate[1] == pytest.approx(4.0, abs=0.05)
    assert finding.tests == (test,)


def test_a_reversed_transducer_is_named_and_its_other_faults_too():
    held = {name: one.reversed() for name, one in held_readings(4, slip=("t2", -3e-3, 7.0)).items()}
    check = check_transducer("wire", held, LEVEL)
    assert [(one.effect, one.quantity) for one in check.findings] == [
        ("channel-swap", "polarity"), ("sensor-drift", "slip"),
    ]  # fmt: skip
    assert check.findings[1].estimate[0] == pytest.approx(
        -3e-3, abs=4.0 * check.findings[1].standard_error[0]
    )


def test_a_gain_and_a_slip_are_told_apart_and_both_named():
    check = check_transducer("wire", held_readings(5, gain=0.06, slip=("t3", 4e-3, 6.5)), LEVEL)
    assert {one.quantity for one in check.findings} == {"gain", "slip"}
    assert check.gain == pytest.approx(0.06, abs=4.0 * np.hypot(5e-3, check.gain_error))


@pytest.mark.parametrize("quieter", [1.0, 0.01])
def test_bodies_that_do_not_move_apart_tell_no_gain_and_no_place(quieter):
    """Noise of the markers is all that the expectation holds: its coefficient would be -1, and means nothing."""
    generator = np.random.default_rng(6)
    held = {}
    for name, one in held_readings(6).items():
        noise = generator.normal(0.0, NOISE, len(one.time))
        misfit = quieter * generator.normal(0.0, NOISE, len(one.time)) - noise
        held[name] = replace(one, expected=noise, misfit=misfit, places=0.0 * one.places + noise[:, None])
    check = check_transducer("wire", held, LEVEL)
    assert np.isnan(check.gain)
    assert check.findings == ()


def test_the_stated_gain_error_is_that_of_the_estimates():
    """The root mean square of 100 standard scores is 1 within 4 standard errors of 0.07; the errors are bounds."""
    scores = []
    for seed in range(100):
        check = check_transducer("wire", held_readings(100 + seed), LEVEL)
        scores.append(check.gain / np.hypot(5e-3, check.gain_error))
    assert 0.5 < np.sqrt(np.mean(np.square(scores))) < 1.28


def test_false_alarms_of_sound_transducers():
    """Gain and places with half their tolerance as standard deviation: the level bounds the share with any finding.

    At a level of 20 % a share beyond 29 % of 300 has a chance of 1e-4 (binomial).
    """
    alarms = sum(
        bool(check_transducer("wire", held_readings(1000 + seed), LEVEL._replace(chance=0.2)).findings)
        for seed in range(300)
    )
    assert alarms <= 87
