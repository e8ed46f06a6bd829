"""Rotation of closed joints against the moment that they carry: evidence of a soft layer, by joint and compliance."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import solveh_banded

from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.effects.joint_compliance import COMPLIANCES, rotation_by_compliance

_WITHIN = 0.6  # of the half width: a resultant nearer to the edge may have opened the joint
_FEWEST = 30  # instants
_NOMINAL, _SPREAD = 6e-11, 4e-11  # m3/N, of the layer that stands for elastic blocks
_COLOURED, _MEMORY, _CONSTANT = 8e-6, 0.3, 2e-5  # rad, s, rad
_NOISE_SHARE, _LEAST_NOISE, _RIDGE = 0.8, 1e-5, 0.1


class ClosedJoint(NamedTuple):
    """Rotation of a closed joint over its compliance, in addition of elastic blocks alone.

    ``target`` and ``information`` [N/m3, (N/m3)^2]: of the compliance, such that c gains ``c target - c^2 information /
    2``; a soft layer c has the target ``c information`` in the mean.
    """

    target: float
    information: float

    @property
    def gains(self):
        """Gain of every compliance, (n_compliances,)."""
        return COMPLIANCES * self.target - 0.5 * COMPLIANCES**2 * self.information

    def expected(self, compliance):
        """Mean gain of every compliance where the joint has this one."""
        return self._replace(target=compliance * self.information).gains


def closed_joints(tests):
    """`ClosedJoint` by joint of `ReconstructedTest`; only where joints are a tree, and of those that are closed long
    enough."""
    if not tests[0].tree:
        return {}
    joints = {}
    for face in range(len(tests[0].faces)):
        rows = [read for read in (_rows(test, face) for test in tests) if read is not None]
        if not rows:
            continue
        covariances, turns, slopes = zip(*rows, strict=True)
        values = [turn - _NOMINAL * slope for turn, slope in zip(turns, slopes, strict=True)]
        likelihood = from_rows(covariances, values, [[_SPREAD * slope for slope in slopes]])
        target, gram = likelihood.normal_equations(likelihood.whiten([slope[:, None] for slope in slopes]))
        joints[tests[0].faces[face].name] = ClosedJoint(float(target[0]), float(gram[0, 0]))
    return joints


def _rows(test, face):
    """Covariance and values of the rotation, and its slope on the compliance, of one test; None where too short."""
    half, length = test.faces[face].half_width, float(np.ptp(test.faces[face].corners[:, 1]))
    normal, moment = test.forces.force[:, face, 2], test.forces.moment[:, face, 1]
    closed = test.states.closed[:, face] & (normal > 0.0) & (np.abs(moment) < _WITHIN * half * normal)
    chosen = np.flatnonzero(closed)[::2]
    if len(chosen) < _FEWEST:
        return None
    slope = rotation_by_compliance(-moment[chosen] / normal[chosen], normal[chosen], half, length)
    noise = max(_NOISE_SHARE * test.joints.rotation_error[face], _LEAST_NOISE)
    apart = np.abs(test.motion.time[chosen][:, None] - test.motion.time[chosen])
    covariance = noise**2 * np.exp(-(apart**2) / (4.0 * test.motion.width**2))
    covariance += _COLOURED**2 * np.exp(-apart / _MEMORY) + _CONSTANT**2
    covariance[np.diag_indices(len(chosen))] += (_RIDGE * noise) ** 2
    return covariance, _as_forces(test.joints.rotation[:, face], test.motion)[chosen], slope


def _as_forces(rotation, motion):
    """A rotation smoothed by the kernel alone, as forces are: ``h`` of ``h - w^2 h'' / 2 = rotation``.

    The local parabola passes ``1 + (omega w)^2 / 2`` times as much of a frequency as the kernel does.
    """
    share = 0.5 * (motion.width / (motion.time[1] - motion.time[0])) ** 2
    bands = np.full((2, len(rotation)), -share)
    bands[1] = 1.0 + 2.0 * share
    bands[1, [0, -1]] = 1.0 + share
    return solveh_banded(bands, rotation)
