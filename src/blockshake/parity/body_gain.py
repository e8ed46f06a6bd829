"""A gain of all markers of one body: the joints above and below it seem to slip in proportion to its displacement.

A rigid motion that reads too large is a rigid motion still, so that no residual of the body's own markers shows it. Its
joints do: the body seems to slip on the one below by the gain's share of its displacement, and the one above to slip
on it by as much the other way, also while both are closed. No friction slips so.
"""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_poses import PLANAR, POSE, body_poses
from blockshake.measurement.motion.joint_coordinates import joint_coordinates
from blockshake.measurement.motion.outliers import without_outliers
from blockshake.parity.finding import Finding, chance_within

_EVERY = 0.05  # s, between readings that are compared
_SEGMENT = 0.5  # s: residuals of one segment count as one
_TOLERANCE = 0.002  # of a gain
_LEFT = 0.4  # share of every joint's slip that the gain may leave
_SEEN = 3.0  # standard deviations: of a slip worth a look
_FEWEST_JOINTS = 2  # a slip of one joint alone may be one
_FLAT = 1e-4  # m2: markers that are nearly level, or nearly upright, show no turn by one axis
_SHARP = 0.01  # standard error of a gain along z that is taken over
_REST = 10  # readings, whose mean counts as rest


def body_gains(structure, tests, sensors, level, looked_at):
    """`Finding` of the body whose markers all have one gain; an empty list without one.

    Parameters
    ----------
    structure : Structure
    tests : dict of str to xarray.Dataset
        By name.
    sensors : Sensors
    level : float
        Chance of a finding with sound sensors.
    looked_at : int
        Number of hypotheses.

    Notes
    -----
    The gain is the regression of the slips along x on the body's displacement since rest, over all its joints and
    tests; its standard error comes from the scatter of the scores of segments of half a second. The gain along z
    follows from that along x and from the turn about y, which readings along x and readings along z show each by
    themselves; of a body that hardly turns it is taken as none.
    """
    if not structure.touching.any():
        return []
    seen = [one for one in (_joints_of(structure, test, sensors) for test in tests.values()) if one]
    found = []
    for body in range(len(structure.mass)):
        own = [_of_body(one, body) for one in seen]
        along = _gain(own)
        if along is None:
            continue
        gain, variance = along
        across = _gain_across(structure, tests.values(), body, sensors, gain)
        p = looked_at * chance_within(np.array([gain]), np.array([[variance]]), _TOLERANCE)
        if p < level:
            names = tuple(
                marker.name for marker in structure.file.markers if marker.body == structure.body_names[body]
            )
            found.append(
                Finding(
                    "sensor-gain", names, "gain", np.array([gain, 0.0, across[0]]),
                    np.diag([variance, _TOLERANCE**2, across[1]]), min(p, 1.0), tuple(tests),
                )
            )  # fmt: skip
    return sorted(found, key=lambda one: one.p)[:1]


def _joints_of(structure, test, sensors):
    """Slips of the joints and displacements of the bodies in one test; None where a pose is not read."""
    displacement = test["marker_displacement"]
    rest = displacement.isel(time=slice(0, _REST)).mean("time").fillna(0.0)
    counted = without_outliers(test.assign(marker_displacement=displacement - rest), structure)
    every = max(1, round(_EVERY / float(np.median(np.diff(test["time"])))))
    poses = body_poses(counted.isel(time=slice(None, None, every)), structure, sensors.marker_noise)
    if any(known not in (POSE, PLANAR) for known in poses.known):
        return None
    position = np.concatenate([structure.position[None], poses.position])
    rotation = np.concatenate([rotation_matrices(structure.orientation)[None], poses.rotation])
    joints = joint_coordinates(structure, position, rotation).isel(time=slice(1, None))
    names = structure.body_names
    return {
        "slip": joints["slip"].to_numpy()[..., 0],
        "lower": [names.index(name) for name in joints["lower"].values],
        "upper": [names.index(name) for name in joints["upper"].values],
        "moved": position[1:, :, 0] - structure.position[:, 0],
        "noise": np.sqrt(poses.covariance[:, 0, 0]),
        "segment": (np.arange(len(position) - 1) * _EVERY // _SEGMENT).astype(int),
    }


def _of_body(seen, body):
    """Slips of the joints at a body, the displacement that would explain them, numbers of segments, and the noise."""
    pairs = []
    for joint, (lower, upper) in enumerate(zip(seen["lower"], seen["upper"], strict=True)):
        if body in (lower, upper):
            sign = 1.0 if body == upper else -1.0
            noise = float(np.hypot(*seen["noise"][[lower, upper]]))
            pairs.append((seen["slip"][:, joint], sign * seen["moved"][:, body], seen["segment"], noise))
    return pairs


def _gain_across(structure, tests, body, sensors, along):
    """Gain along z and its variance, by the turn about y that readings along x and along z show."""
    own = [marker for marker in structure.file.markers if marker.body == structure.body_names[body]]
    arms = (structure.arms(own) @ rotation_matrices(structure.orientation[body]).T)[:, [0, 2]]
    arms = arms - arms.mean(axis=0)
    x, z = arms.T
    if min((x**2).sum(), (z**2).sum()) < _FLAT:
        return 0.0, 0.0
    by_x, by_z = [], []
    for test in tests:
        moved = test["marker_displacement"].sel(marker=[marker.name for marker in own], axis=["x", "z"])
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


def _gain(tests):
    """Gain and its variance by all joints and tests; None where it does not explain every joint."""
    n_joints = len(tests[0]) if tests else 0
    if n_joints < _FEWEST_JOINTS:
        return None
    read = [_pooled([test[joint] for test in tests]) for joint in range(n_joints)]
    slip, moved = (np.concatenate([one[key] for one in read]) for key in (0, 1))
    if not (moved**2).sum() > 0.0:
        return None
    ratio = (slip @ moved) / (moved @ moved)  # reading over truth, less 1, over the reading
    for own_slip, own_moved, noise in ((one[0], one[1], one[3]) for one in read):
        size = (own_slip**2).mean()
        if not size > (_SEEN * noise) ** 2 or ((own_slip - ratio * own_moved) ** 2).mean() > _LEFT * size:
            return None
    scores = np.concatenate([np.bincount(one[2], one[1] * (one[0] - ratio * one[1])) for one in read])
    variance = (scores**2).sum() / (moved @ moved) ** 2
    gain = ratio / (1.0 - ratio)
    return gain, variance / (1.0 - ratio) ** 4


def _pooled(tests):
    """Readings of one joint in all tests: slip, displacement, number of the segment; and the noise."""
    parts, first = [], 0
    for slip, moved, segment, _ in tests:
        known = np.isfinite(slip) & np.isfinite(moved)
        parts.append((slip[known], moved[known], first + segment[known]))
        first += int(segment[-1]) + 1
    return (*(np.concatenate(column) for column in zip(*parts, strict=True)), tests[0][3])
