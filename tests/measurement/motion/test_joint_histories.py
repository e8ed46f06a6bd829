import numpy as np
import pytest
from known_motion import SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, ramp, seen
from scipy.spatial.transform import Rotation

from blockshake.geometry.structure import load_structure
from blockshake.measurement.motion.body_poses import body_poses
from blockshake.measurement.motion.joint_histories import joint_histories
from blockshake.measurement.sensors.instruments import Instruments, observe

BASE = base_motion()
ANGLE = bump(TIME, 1.5, 0.6, 0.02)
SLIP = ramp(TIME, 2.5, 0.2, 0.004)


def _markers(test, per_body):
    """The first so many markers of every block, all of the slab."""
    chosen, count = [], {}
    for marker in STRUCTURE.file.markers:
        count[marker.body] = count.get(marker.body, 0) + 1
        if count[marker.body] <= (3 if marker.body == "slab" else per_body):
            chosen.append(marker.name)
    return test.sel(marker=chosen)


@pytest.fixture(scope="module")
def run():
    return moved_run(BASE, rocking=[0.0, ANGLE], slips=[SLIP])


def test_a_body_that_is_asked_for_alone_has_the_pose_that_it_has_among_all(run):
    test, driven = seen(run), STRUCTURE.driven
    alone, among = (body_poses(test, STRUCTURE, 1e-4, selected) for selected in (driven, None))
    for part in ("position", "rotation"):
        np.testing.assert_array_equal(getattr(alone, part)[:, driven], getattr(among, part)[:, driven])
        assert np.isnan(getattr(alone, part)[:, ~driven]).all()
    np.testing.assert_array_equal(alone.covariance[driven], among.covariance[driven])


def test_prescribed_joints_come_back(run):
    """Kinematics: a turn by theta about the edge at b shifts the centre by b (1 - cos)."""
    found = joint_histories(seen(run), STRUCTURE, SENSORS)
    # least squares on exact positions: rounding of metres only
    np.testing.assert_allclose(found["rotation"].to_numpy().T, [0 * TIME, ANGLE, 0 * TIME], atol=1e-12)
    np.testing.assert_allclose(found["slip"][:, 0], SLIP, atol=1e-12)
    np.testing.assert_allclose(found["slip"][:, 1], 0.38 * (1.0 - np.cos(ANGLE)), atol=1e-12)


def test_a_table_that_moves_in_all_ways_stays_out_of_the_joints():
    run = moved_run(
        BASE, pitch=4e-4 * BASE.acceleration, yaw=1e-3 * BASE.velocity, vertical=0.2 * BASE.displacement
    )
    found = joint_histories(seen(run), STRUCTURE, SENSORS)
    for name in ("slip", "rotation", "drift"):
        # pitch and yaw together are a roll of 5e-4 * 3e-4 / 2, part of which is taken for noise, 1.5 m away
        assert abs(found[name]).max() < 1e-7


def test_a_table_whose_markers_are_in_line_does_not_roll_by_noise():
    """Those on the slab's face lie within 5 cm of a line along x: roll noise 2.4 mrad if nothing else were known."""
    structure = load_structure("configuration-1")
    faces = [marker.name for marker in structure.file.markers if not marker.name.endswith("-end")]
    read = observe(moved_run(BASE), structure, Instruments(), 3).sel(marker=faces)
    found = joint_histories(read, structure, SENSORS)
    # standard error of a deviation 2 %, largest of 3: 4 of them
    np.testing.assert_allclose(found["slip"].std("time") / found["slip_noise"], 1.0, atol=0.09)
    poses, (slab,) = body_poses(read, structure, SENSORS.marker_noise), np.flatnonzero(structure.driven)
    roll = Rotation.from_matrix(poses.rotation[:, slab]).as_rotvec()[:, 0]
    assert roll.std() < 1e-4
    np.testing.assert_allclose(roll.std() / np.sqrt(poses.covariance[slab, 3, 3]), 1.0, atol=0.09)


def test_stated_noise_is_the_noise(run):
    """Monte Carlo in time: 1200 readings of each channel, standard error of a deviation 1 / sqrt(2400) = 2 %."""
    exact = joint_histories(seen(run), STRUCTURE, SENSORS)
    read = joint_histories(seen(run, marker_noise=1e-4, seed=3), STRUCTURE, SENSORS)
    for name in ("slip", "rotation", "drift"):
        error = (read[name] - exact[name]).std("time")
        stated = read[f"{name}_noise"]
        known = (stated > 0.0).to_numpy()
        ratio = (error / stated).to_numpy()[known]
        # largest of at most 12 ratios: 4 standard errors
        assert np.abs(ratio - 1.0).max() < 0.09, name


def test_two_markers_tell_what_happens_in_the_plane(run):
    test = seen(run)
    poses = body_poses(_markers(test, 2), STRUCTURE, SENSORS.marker_noise)
    assert poses.known == ["pose", "planar", "planar", "planar"]
    found = joint_histories(_markers(test, 2), STRUCTURE, SENSORS)
    np.testing.assert_allclose(found["rotation"][:, 1], ANGLE, atol=1e-12)
    np.testing.assert_allclose(found["slip"][:, 0], SLIP, atol=1e-12)
    noisy = joint_histories(_markers(seen(run, marker_noise=1e-4), 2), STRUCTURE, SENSORS)
    error = (noisy - found).std("time")
    for name in ("slip", "rotation"):
        assert float(abs(error[name] / noisy[f"{name}_noise"] - 1.0).max()) < 0.09


def test_one_marker_tells_no_joint(run):
    test = _markers(seen(run), 1)
    poses = body_poses(test, STRUCTURE, SENSORS.marker_noise)
    assert poses.known == ["pose", "translation", "translation", "translation"]
    found = joint_histories(test, STRUCTURE, SENSORS)
    assert np.isnan(found["slip"]).all()
    assert np.isnan(found["rotation"]).all()
