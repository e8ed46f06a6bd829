import numpy as np
from known_motion import END, SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, seen

from blockshake.diagnosis.features.phases import find_phases, known_values
from blockshake.measurement.motion.joint_histories import joint_histories

BASE = base_motion()


def _phases(run, **noise):
    return find_phases(joint_histories(seen(run, **noise), STRUCTURE, SENSORS, BASE))


def test_onset_is_where_the_motion_exceeds_the_noise():
    rocking = [bump(TIME, 2.0, 0.4, -0.02), bump(TIME, 2.5, 0.4, 0.02)]
    found = _phases(moved_run(BASE, rocking=rocking))
    # 5 sigma are 0.5 mrad: a half sine of 20 mrad and 0.4 s passes them after 3.2 ms, the next reading is at 5 ms
    np.testing.assert_allclose(found.rotation_onset[0], [np.inf, 2.005], atol=1e-9)
    np.testing.assert_allclose(found.rotation_onset[1], [2.505, np.inf], atol=1e-9)
    assert np.isinf(found.slip_onset).all()
    np.testing.assert_array_equal(found.quiet, TIME < 2.0049)


def test_phases_share_no_time_and_leave_none_out():
    found = _phases(moved_run(BASE, rocking=[bump(TIME, 2.0, 0.4, 0.02)]), marker_noise=1e-4)
    total = sum(part.astype(int) for part in (found.quiet, found.strong, found.after))
    assert (total == 1).all()
    # the window's fourth power brings the velocity below 2 % of its peak some 0.3 of the half window early
    assert END - 1.3 < TIME[found.after][0] < END


def test_a_test_without_onset_is_quiet_until_the_base_rests():
    """White noise alone has no onset: three readings in a row beyond 5 sigma."""
    found = _phases(moved_run(BASE), marker_noise=1e-4, seed=2)
    assert not found.strong.any()
    assert np.isinf(found.rotation_onset).all()


def test_a_single_wrong_reading_is_no_onset():
    test = seen(moved_run(BASE))
    test["marker_displacement"][300, 5] += 0.05
    found = find_phases(joint_histories(test, STRUCTURE, SENSORS, BASE))
    assert not found.strong.any()


def test_gaps_are_bridged_and_ends_held():
    values = np.array([np.nan, 1.0, np.nan, 3.0, 4.0, 90.0, 5.0, np.nan])
    np.testing.assert_allclose(known_values(values), [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 5.0])
    assert (known_values(np.full(4, np.nan)) == 0.0).all()
