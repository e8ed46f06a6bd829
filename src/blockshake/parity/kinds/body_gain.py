"""A gain of all markers of one body: the joints above and below it seem to slip in proportion to its displacement.

A rigid motion that reads too large is a rigid motion still, so that no residual of the body's own markers shows it. Its
joints do: the body seems to slip on the one below by the gain's share of its displacement, and the one above to slip
on it by as much the other way, also while both are closed. No friction slips so.
"""

from dataclasses import replace

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.measurement.motion.body_poses import PLANAR, POSE, body_poses
from blockshake.measurement.motion.joints import find_joints, joint_coordinates
from blockshake.parity.finding import chance_within
from blockshake.parity.kinds.gain import GAIN, SEGMENT
from blockshake.parity.regression import Size, regression

_EVERY = 0.05  # s, between readings that are compared
_TOLERANCE = 0.002  # of a gain
_MOST_SLIP = 0.4  # share of every joint's slip that the gain may leave
_MOST_OF_ONE = 0.05  # the same of a body with one joint: of a real slip alone 0.8 or more are left
_LARGEST = 0.3  # a body that slides slips by as much as it moves
_SEEN = 3.0  # standard deviations: of a slip worth a look
_FLAT = 1e-4  # m2: markers that are nearly level, or nearly upright, show no turn by one axis
_SHARP = 0.01  # standard error of a gain along z that is taken over
_ROUNDS = 3  # of finding the gains again
_REST = 10  # readings, whose mean counts as rest


def body_gains(structure, tests, sensors, level):
    """`Finding` of the body whose markers all have one gain; an empty list without one.

    Parameters
    ----------
    structure : Structure
    tests : dict of str to xarray.Dataset
        By name, without outliers.
    sensors : Sensors
    level : Level

    Notes
    -----
    The gain is the regression of the slips along x on the body's displacement since rest, over all its joints and
    tests; its standard error comes from the scatter of the scores of segments of half a second. The gain along z
    follows from that along x and from the turn about y, which readings along x and readings along z show each by
    themselves; of a body that hardly turns it is taken as none. The turn is misread too, and moves the joints' points:
    both gains are found again from the readings that they correct.
    """
    if not structure.touching.any():
        return []
    seen = _all_slips(structure, tests.values(), sensors)
    pairs, findings = find_joints(structure)[0], []
    for body, name in enumerate(structure.body_names):
        gain = _gain(pairs, body, seen)
        if gain is None:
            continue
        (along,), ((variance,),) = gain.estimate, gain.covariance
        across, across_variance = _gain_across(structure, tests.values(), body, sensors, along)
        p = level.hypotheses * chance_within(gain.estimate, gain.covariance, _TOLERANCE, gain.freedom)
        if p < level.chance:
            markers = tuple(marker.name for marker in structure.file.markers if marker.body == name)
            covariance = np.diag([variance, _TOLERANCE**2, across_variance])
            findings.append((GAIN.finding(markers, p, tests, [along, 0.0, across], covariance), body))
    # a body that accounts for the slips of two joints before one that accounts for one of them
    findings.sort(key=lambda found: (-np.sum(np.equal(pairs, found[1])), found[0].p))
    return [_refined(*found, structure, tests, sensors) for found in findings[:1]]


def _refined(finding, body, structure, tests, sensors):
    """The finding on a body with the gains that leave no further one in the readings that it corrects."""
    pairs = find_joints(structure)[0]
    for _ in range(_ROUNDS):
        again = [test.transpose("time", "marker", "axis", ...).copy(deep=True) for test in tests.values()]
        for test in again:
            GAIN.correct(test, [finding], structure)
        share = _share(_of_joints(pairs, body, _all_slips(structure, again, sensors)))
        along = share.estimate[0] / (1.0 - share.estimate[0])
        across, _ = _gain_across(structure, again, body, sensors, along)
        estimate = (1.0 + finding.estimate) * (1.0 + np.array([along, 0.0, across])) - 1.0
        finding = replace(finding, estimate=estimate)
    return finding


def _all_slips(structure, tests, sensors):
    return [slips for slips in (_slips(structure, test, sensors) for test in tests) if slips is not None]


def _slips(structure, test, sensors):
    """Slips of the joints, displacements of the bodies along x, their noise [m], and times since the start [s].

    None where a pose is not read.
    """
    displacement, structure = test["marker_displacement"], initial_poses(structure, test)
    rest = displacement.isel(time=slice(0, _REST)).mean("time").fillna(0.0)
    every = max(1, round(_EVERY / float(np.median(np.diff(test["time"])))))
    counted = test.assign(marker_displacement=displacement - rest).isel(time=slice(None, None, every))
    poses = body_poses(counted, structure, sensors.marker_noise)
    if any(known not in (POSE, PLANAR) for known in poses.known):
        return None
    position = np.concatenate([structure.position[None], poses.position])
    rotation = np.concatenate([rotation_matrices(structure.orientation)[None], poses.rotation])
    slip = joint_coordinates(structure, position, rotation)["slip"].to_numpy()[1:, :, 0]
    moved = poses.position[..., 0] - structure.position[:, 0]
    time = counted["time"].to_numpy()
    return slip, moved, np.sqrt(poses.covariance[:, 0, 0]), time - time[0]


def _of_joints(pairs, body, seen):
    """For every joint of a body: parts of the regression of its slip, and its noise [m]."""
    joints = []
    for joint, pair in enumerate(pairs):
        if body in pair and seen:
            sign, known = 1.0 if body == pair[1] else -1.0, []
            for slip, moved, _, since in seen:
                rows = np.column_stack([sign * moved[:, body], slip[:, joint], since])
                rows = rows[np.isfinite(rows).all(axis=1)]
                known.append((rows[:, :1], rows[:, 1], rows[:, 2]))
            joints.append((known, np.hypot(*seen[0][2][pair])))
    return joints


def _share(joints):
    """Slip over the body's displacement, `Size` or None."""
    return regression([part for known, _ in joints for part in known], SEGMENT) if joints else None


def _gain(pairs, body, seen):
    """Gain of a body by all its joints and tests, `Size`; None where it does not explain every joint."""
    joints = _of_joints(pairs, body, seen)
    share = _share(joints)
    if share is None:
        return None
    ratio = share.estimate[0]  # reading over truth, less 1, over the reading
    if abs(ratio) > _LARGEST:
        return None
    most = _MOST_SLIP if len(joints) > 1 else _MOST_OF_ONE
    for known, noise in joints:
        slip = np.concatenate([slip for _, slip, _ in known])
        rest = np.concatenate([slip - ratio * moved[:, 0] for moved, slip, _ in known])
        size = (slip**2).mean()
        if not size > (_SEEN * noise) ** 2 or (rest**2).mean() > most * size:
            return None
    return Size(share.estimate / (1.0 - ratio), share.covariance / (1.0 - ratio) ** 4, share.freedom)


def _gain_across(structure, tests, body, sensors, along):
    """Gain along z and its variance, by the turn about y that readings along x and along z show."""
    carried = [marker for marker in structure.file.markers if marker.body == structure.body_names[body]]
    arms = (structure.arms(carried) @ rotation_matrices(structure.orientation[body]).T)[:, [0, 2]]
    x, z = (arms - arms.mean(axis=0)).T
    if min((x**2).sum(), (z**2).sum()) < _FLAT:
        return 0.0, 0.0
    by_x, by_z = [], []
    for test in tests:
        moved = test["marker_displacement"].sel(marker=[marker.name for marker in carried], axis=["x", "z"])
        moved = moved.transpose("time", "marker", "axis").to_numpy()
        known = np.isfinite(moved).all(axis=(1, 2))
        by_x.append(moved[known, :, 0] @ z / (z**2).sum())
        by_z.append(-moved[known, :, 1] @ x / (x**2).sum())
    by_x, by_z = np.concatenate(by_x), np.concatenate(by_z)
    turned = by_x @ by_x - len(by_x) * sensors.marker_noise**2 / (z**2).sum()  # of the noise alone: the rest
    error = sensors.marker_noise / np.sqrt((x**2).sum() * max(turned, np.finfo(float).tiny))
    if not error < _SHARP:
        return 0.0, 0.0
    return float((1.0 + along) * (by_x @ by_z) / turned - 1.0), error**2
