"""Measures of a run that have limits, from the poses of its bodies."""

from itertools import product
from typing import NamedTuple

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import Structure
from blockshake.measurement.motion.joints import contact_normals, find_joints
from blockshake.simulation.pounding import blow_velocities, gap_of_pair
from blockshake.simulation.run_histories import drift_histories
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW


class SeenRun(NamedTuple):
    """Poses of a run until its end, with the structure that it started from."""

    structure: Structure
    time: np.ndarray  # float64 (n_times,) [s]
    position: np.ndarray  # float64 (n_times, n_bodies, 3); mass centres, inertial frame [m]
    turns: np.ndarray  # float64 (n_times, n_bodies, 3, 3); body to world
    is_whole: bool  # the run completed

    @classmethod
    def of(cls, sample, structure):
        """From a sample of `join_batches`, a Dataset without the dimension ``sample``."""
        seen = sample.isel(time=sample["position"].notnull().all(("body", "axis")).to_numpy())
        seen = seen.transpose("time", "body", "axis", "quaternion", ...)
        turns = rotation_matrices(seen["orientation"].to_numpy())
        whole = str(sample["status"].values) == "completed"
        return cls(structure, seen["time"].to_numpy(), seen["position"].to_numpy(), turns, whole)


def value_of(run, state):
    """Value of a `LimitState`'s measure in a `SeenRun`, SI; NaN where the run does not tell it."""
    names = run.structure.body_names
    return measured(run, state.measure, [names.index(name) for name in state.bodies])


def measured(run, measure, bodies):
    """Value of one of `MEASURES` of a body, or of the joint of two, by their numbers, as of `value_of`."""
    if measure == "tilt":
        return _tilt(run, *bodies)
    if measure == "drift":
        return float(np.hypot(*_drift(run, *bodies).T).max())
    if measure == "residual":
        late = run.time >= run.time[-1] - RESIDUAL_WINDOW
        return float(np.hypot(*_drift(run, *bodies)[late].mean(axis=0))) if run.is_whole else np.nan
    joints = _joints_of(run.structure, bodies, with_above=measure == "impact_velocity")
    values = [_of_joint(run, measure, joint) for joint in joints]
    if measure == "impact_velocity":
        values += [_fastest(gap_of_pair(run.structure, run.position, run.turns, *pair), run.time)
                   for pair in pairs_apart(run.structure, bodies)]  # fmt: skip
    known = [value for value in values if np.isfinite(value)]
    return max(known) if known else np.nan


def _drift(run, body):
    """Horizontal displacement of a mass centre against the base, (n_times, 2) [m]."""
    return drift_histories(run.structure, run.position, run.turns)[:, body, :2]


def _tilt(run, body):
    """Largest angle between up and the axis of a body that was up at the start, both against the base [rad]."""
    turned = run.turns[:, body] @ run.turns[0, body].T
    if run.structure.driven.any():
        base = int(np.argmax(run.structure.driven))
        based = run.turns[:, base] @ run.turns[0, base].T
        turned = based.transpose(0, 2, 1) @ turned
    up = -np.array(run.structure.file.gravity)
    up /= np.linalg.norm(up)
    return float(np.arccos(np.clip(np.einsum("i,tij,j->t", up, turned, up), -1.0, 1.0)).max())


def _joints_of(structure, bodies, with_above):
    """Rows of `find_joints` between two bodies, or of one body with those below, and ``with_above`` with others too."""
    pairs, _ = find_joints(structure)
    if len(bodies) == 2:
        return np.flatnonzero((np.sort(pairs, axis=1) == sorted(bodies)).all(axis=1))
    mine = (pairs == bodies[0]).any(axis=1) if with_above else pairs[:, 1] == bodies[0]
    return np.flatnonzero(mine)


def pairs_apart(structure, bodies):
    """Pairs of bodies that stand apart: the two bodies, or the one with all others that are not driven."""
    if len(bodies) == 2:
        others = [tuple(bodies)]
    else:
        others = [(bodies[0], other) for other in np.flatnonzero(~structure.driven) if other != bodies[0]]
    return [pair for pair in others if not structure.touching[pair]]


def _of_joint(run, measure, joint):
    """Value of a measure of one joint; NaN where its normal is not known."""
    structure = run.structure
    pairs, centres = find_joints(structure)
    lower, upper = pairs[joint]
    (normal,) = contact_normals(structure, pairs[[joint]])
    points = (
        [centres[joint]]
        if measure in ("uplift", "slip")
        else _corners(structure, lower, upper, centres[joint], normal)
    )
    moved = _moved(run, lower, upper, np.array(points))
    gaps = moved @ normal
    if measure == "slip":
        return float(np.linalg.norm(moved - gaps[..., None] * normal, axis=-1).max())
    if measure == "impact_velocity":
        return max(_fastest(gap, run.time) for gap in gaps.T)
    if measure not in ("uplift", "opening"):
        raise ValueError(measure)
    return float(gaps.max())


def _corners(structure, lower, upper, centre, normal):
    """Corners of what the bounding boxes of two bodies have in common, in the plane of their joint, (8, 3) [m]."""
    ends = []
    for body in (lower, upper):
        corners = (
            structure.position[body]
            + structure.solid(body).vertices @ rotation_matrices(structure.orientation[body]).T
        )
        ends.append((corners.min(axis=0), corners.max(axis=0)))
    low, high = np.maximum(ends[0][0], ends[1][0]), np.minimum(ends[0][1], ends[1][1])
    box = np.array(list(product(*zip(low, high, strict=True))))
    return box - ((box - centre) @ normal)[:, None] * normal


def _moved(run, lower, upper, points):
    """Motion of points of the upper body since the start, as the lower body sees it in the axes of the start,
    (n_times, n_points, 3) [m]; ``points`` (n_points, 3) in the inertial frame at the start."""
    arms = (points - run.position[0, upper]) @ run.turns[0, upper]
    seen = run.position[:, upper, None] + np.einsum("tik,pk->tpi", run.turns[:, upper], arms)
    seen = np.einsum("tki,tpk->tpi", run.turns[:, lower], seen - run.position[:, lower, None])
    return (seen - seen[:1]) @ run.turns[0, lower].T


def _fastest(gap, time):
    """Velocity of the fastest blow of a gap over time, 0 without any; NaN where there is no gap to tell [m/s]."""
    if gap is None:
        return np.nan
    return max((float(one) for one in blow_velocities(gap, np.diff(time))), default=0.0)
