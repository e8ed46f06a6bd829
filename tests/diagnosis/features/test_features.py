"""Every feature on a motion for which its value is known."""

import numpy as np
import pytest
from known_motion import END, SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, ramp, seen

from blockshake.diagnosis.features.feature_table import (
    BANDS,
    BASE_FEATURES,
    BASE_MOTION_FEATURES,
    JOINT_FEATURES,
    TOP_FEATURES,
    kind,
)
from blockshake.diagnosis.features.features import features
from blockshake.diagnosis.features.joint_features import spike_features
from blockshake.measurement.motion.joint_histories import joint_histories

BASE = base_motion()
A, V, D = BASE.acceleration, BASE.velocity, BASE.displacement


def _features(run, base=BASE, **reading):
    return features(joint_histories(seen(run, **reading), STRUCTURE, SENSORS, base))


def _value(found, name):
    return float(found["value"].sel(feature=name))


def _censored(found, name):
    return bool(found["censored"].sel(feature=name))


@pytest.fixture(scope="module")
def rocking():
    """Joint 2 rocks by +10 and -6 mrad about edges at 0.38 and 0.33 m; joint 1 slips to 4 mm and back by 1."""
    angle = bump(TIME, 2.0, 0.5, 0.010) + bump(TIME, 2.5, 0.4, -0.006)
    slip = ramp(TIME, 2.2, 0.1, 0.004) + ramp(TIME, 3.0, 0.1, -0.003)
    return _features(moved_run(BASE, rocking=[0.0, angle], slips=[slip], edge=(0.38, 0.33)))


def test_quiet_slopes_are_the_prescribed_ones():
    """Slopes in acceleration, velocity and displacement are told apart."""
    run = moved_run(
        BASE, slips=[0.004 * D + 3e-5 * A, 1e-3 * V], rocking=[1e-4 * A], pitch=4e-4 * A + 1e-3 * V,
        vertical=0.2 * D + 1e-4 * A, lateral=0.03 * D,
    )  # fmt: skip
    found = _features(run)
    expected = {
        "joint1.slip.quiet.acceleration": 3e-5,
        "joint1.slip.quiet.displacement": 0.004,
        "joint1.rotation.quiet.acceleration": 1e-4,
        "joint2.slip.quiet.acceleration": 0.0,
        "joint2.slip.quiet.displacement": 0.0,
        "base.pitch.acceleration": 4e-4,
        "base.pitch.velocity": 1e-3,
        "base.vertical.acceleration": 1e-4,
        "base.vertical.displacement": 0.2,
        "base.lateral.displacement": 0.03,
    }
    sizes = {"acceleration": 1e-6, "velocity": 1e-5, "displacement": 2e-4}
    for name, value in expected.items():
        # the median of three clips tops by (w dt)^2 / 2 = 1e-3, and the slip of a turn about an edge is of second order
        assert _value(found, name) == pytest.approx(value, abs=sizes[name.rpartition(".")[2]]), name
        assert not _censored(found, name)


def test_yaw_of_the_table_is_in_its_own_feature():
    found = _features(moved_run(BASE, yaw=2e-4 * A))
    assert _value(found, "base.yaw.acceleration") == pytest.approx(2e-4, rel=0.01)
    assert abs(_value(found, "base.pitch.acceleration")) < 1e-6


def test_peaks_residuals_and_asymmetry(rocking):
    # half sines read every 5 ms: the top is missed by at most (pi 0.0025 / 0.4)^2 / 2
    assert _value(rocking, "joint2.rotation.peak+") == pytest.approx(0.010, rel=1e-3)
    assert _value(rocking, "joint2.rotation.peak-") == pytest.approx(-0.006, rel=1e-3)
    assert _value(rocking, "joint2.rotation.asymmetry") == pytest.approx(0.25, abs=1e-3)
    assert _value(rocking, "joint1.slip.peak+") == pytest.approx(0.004, rel=1e-9)
    assert _value(rocking, "joint1.slip.peak-") == pytest.approx(0.0, abs=1e-9)
    assert _value(rocking, "joint1.slip.asymmetry") == pytest.approx(1.0, abs=1e-6)
    assert _value(rocking, "joint1.slip.residual") == pytest.approx(0.001, abs=1e-9)
    assert _value(rocking, "joint2.rotation.residual") == pytest.approx(0.0, abs=1e-12)
    assert _value(rocking, "joint1.slip.path") == pytest.approx(0.007, rel=1e-6)
    assert _value(rocking, "top.displacement.peak+") > 0.01 * 1.6


def test_pivots_are_where_it_rocks(rocking):
    """Opening = b sin(rotation): exact but for the median of three at the top."""
    assert _value(rocking, "joint2.pivot+") == pytest.approx(0.38, rel=1e-3)
    assert _value(rocking, "joint2.pivot-") == pytest.approx(0.33, rel=1e-3)
    for side in "+-":
        assert _censored(rocking, f"joint3.pivot{side}")
        assert _value(rocking, f"joint3.pivot{side}") == 0.0


def test_onset_is_the_acceleration_until_then(rocking):
    """The block leans to +x while the base accelerates to -x; 5 sigma are passed within 15 ms."""
    for name, drive, begin in (
        ("joint2.rotation.onset+", -A, 2.0),
        ("joint2.rotation.onset-", A, 2.5),
        ("joint1.slip.onset", np.abs(A), 2.2),
    ):
        lowest, highest = drive[begin >= TIME].max(), drive[begin + 0.05 >= TIME].max()
        assert lowest - 1e-12 <= _value(rocking, name) <= highest + 1e-12
        assert not _censored(rocking, name)
    assert _value(rocking, "joint3.rotation.onset-") == pytest.approx(A.max())
    assert _censored(rocking, "joint3.rotation.onset-")
    assert 2.0 < _value(rocking, "onset.time") < 2.016


def test_a_free_swing_after_the_shaking():
    """Period T, decrement of a half-cycle d T / 2, once the base rests."""
    period, damping = 0.7, 0.6
    since = TIME - END + 1.0
    angle = np.where(since > 0.0, 0.01 * np.exp(-damping * since) * np.sin(2.0 * np.pi * since / period), 0.0)
    found = _features(moved_run(BASE, rocking=[angle]))
    assert _value(found, "top.period") == pytest.approx(period, abs=0.01)
    assert _value(found, "top.decrement") == pytest.approx(damping * period / 2.0, abs=1e-3)
    assert _value(found, "top.half_cycles") >= 4
    assert _value(found, "top.swing") == pytest.approx(
        0.5 * period * (1.0 - 2.0 * np.arcsin(0.25) / np.pi), abs=0.01
    )
    still = _features(moved_run(BASE))
    for name in ("top.period", "top.half_cycles", "top.decrement", "top.swing", "top.delay"):
        assert _censored(still, name)
        assert _value(still, name) == 0.0


def test_a_marker_that_sits_elsewhere_leaks_the_rotation_into_the_slip():
    """All markers of block 2 sit 50 mm higher than said: the slip of joint 2 errs by 0.05 sin(rotation)."""
    angle = bump(TIME, 2.0, 0.5, 0.010) + bump(TIME, 2.5, 0.5, -0.010)
    offsets = {f"block-2-{letter}": (0.0, 0.0, 0.05) for letter in "abcd"}
    found = _features(moved_run(BASE, rocking=[0.0, angle]), marker_offset=offsets)
    # the slip of rocking itself, opening tan(rotation / 2), is taken out
    assert _value(found, "joint2.slip.rotation") == pytest.approx(0.05, rel=1e-3)
    clean = _features(moved_run(BASE, rocking=[0.0, angle]))
    assert _value(clean, "joint2.slip.rotation") == pytest.approx(0.0, abs=1e-5)


def test_a_gain_of_one_blocks_markers_is_a_slope_on_displacement():
    """Markers of block 1 read 1 % too much: joint 1 slips by 0.01 d, joint 2 by as much the other way."""
    gains = {f"block-1-{letter}": 1.01 for letter in "abcd"}
    found = _features(moved_run(BASE), marker_gain=gains)
    assert _value(found, "joint1.slip.quiet.displacement") == pytest.approx(0.01, rel=0.01)
    assert _value(found, "joint2.slip.quiet.displacement") == pytest.approx(-0.01, rel=0.01)


def test_delay_and_band_of_the_top():
    """The top follows the lowest block 30 ms later, at 3 Hz."""
    early, late = (
        bump(TIME, 1.5 + lag, 2.5, 1.0) * 0.004 * np.sin(6 * np.pi * (TIME - lag)) for lag in (0.0, 0.03)
    )
    # a higher joint slips by what the body above does less what the one below does
    found = _features(moved_run(BASE, slips=[early, late - early]))
    assert _value(found, "top.delay") == pytest.approx(0.03, abs=2e-3)
    assert _value(found, "top.correlation") > 0.99
    levels = [_value(found, f"top.band{number}") for number in range(1, len(BANDS) + 1)]
    assert int(np.argmax(levels)) == 2


def test_spikes_at_a_gap_have_no_scatter():
    time, time_acc = np.arange(2001) / 200.0, np.arange(5121) / 512.0
    displacement = 0.02 * np.sin(2.0 * np.pi * 1.1 * time)
    tops = (np.arange(8) + 0.5) / 2.2
    stopped, anywhere = np.zeros(len(time_acc)), np.zeros(len(time_acc))
    stopped[np.round(tops * 512).astype(int)] = 30.0 - np.arange(8)
    anywhere[np.round(np.linspace(1.0, 3.0, 8) * 512).astype(int)] = 30.0 - np.arange(8)
    found = spike_features(time, displacement, 1e-4, time_acc, stopped)
    assert found["spike.largest"][0] == pytest.approx(30.0)
    assert found["spike.scatter"][0] < 0.01
    assert spike_features(time, displacement, 1e-4, time_acc, anywhere)["spike.scatter"][0] > 0.1
    assert spike_features(time, 0.0 * displacement, 1e-4, time_acc, stopped)["spike.scatter"][:2] == (
        1.0,
        True,
    )


def test_features_are_all_there_finite_and_described(rocking):
    names = set(rocking["feature"].values)
    expected = {f"joint{joint}.{name}" for joint in (1, 2, 3) for name in JOINT_FEATURES}
    assert names == expected | set(BASE_FEATURES) | set(BASE_MOTION_FEATURES) | set(TOP_FEATURES)
    for name in ("value", "error"):
        assert np.isfinite(rocking[name]).all()
    assert all(kind(name).formula and kind(name).source for name in names)


def test_a_run_cut_short_has_features_too():
    test = seen(moved_run(BASE, rocking=[bump(TIME, 2.0, 0.4, 0.02)]))
    test["marker_displacement"][450:] = np.nan
    found = features(joint_histories(test, STRUCTURE, SENSORS, BASE))
    assert np.isfinite(found["value"]).all()
    assert _censored(found, "joint1.rotation.residual")
    assert _value(found, "joint1.rotation.residual") > 0.01


def test_same_readings_same_features(rocking):
    run = moved_run(BASE, rocking=[bump(TIME, 2.0, 0.4, 0.02)])
    first, second = (_features(run, marker_noise=1e-4, seed=4) for _ in range(2))
    assert first.identical(second)
