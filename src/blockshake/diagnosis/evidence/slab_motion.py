"""Rotation and vertical displacement of the slab: evidence of a pitching table, a compliant base, a vertical motion."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from blockshake.diagnosis.evidence.explanation import Explanation, Fit, mean_evidence
from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.effects.registry import EFFECTS
from blockshake.forces.joint_motion import from_rest
from blockshake.geometry.rotations import rotation_matrices

_EVERY = 3  # instants
_TURN_NOISE, _LIFT_NOISE = 1.5e-5, 2e-5  # rad, m: no sensor is better
_COLOURED, _MEMORY = 5e-6, 0.1  # rad, s: of the rotation
_OFFSET, _BY_ACCELERATION, _BY_MOMENT = 3e-5, 1.5e-5, 2.5e-11  # rad, rad s2/m, rad/(N m): of undamaged tables
_LIFT_COLOURED, _LIFT_OFFSET, _LIFT_BY_FORCE, _LIFT_BY_TURN = 1e-5, 3e-5, 1e-8, 0.6  # m, m, m/N, m
_BOUNCE, _BOUNCE_MEMORY = 1.5e-4, 0.03  # m, s: of a base that gives
_MULTIPLES = ((1.0, 0.0), (3.0, -2.0), (9.0, -8.0))  # of the coloured error, and the logarithm of their prior
_RIDGES = 0.05, 0.1
# s, 1: of a vertical motion that follows the horizontal one
_DELAYS, _RATIO = np.arange(-0.2, 0.2001, 0.01), 0.5
_FREE_SHARE, _FREE_MEMORY = 0.1, 0.15  # of the vertical motion, s: what of it does not follow


@dataclass(frozen=True)
class SlabMotion:
    """Motion of the first driven body in one test, at uniform times."""

    # time, turn, lift, travel: float64 (n_times,); rotation about y, vertical displacement, and displacement
    # along x, from rest [s, rad, m, m]
    time: np.ndarray
    turn: np.ndarray
    lift: np.ndarray
    travel: np.ndarray
    # acceleration, moment, force: float64 (n_times,); of the slab along x; on its base, by what stands on it
    # and by its own inertia along x: about y through the middle of its bottom; and by what stands on it,
    # downwards. From rest [m/s2, N m, N]; zero where unknown; smoothed as displacements are
    acceleration: np.ndarray
    moment: np.ndarray
    force: np.ndarray
    at: np.ndarray  # int array; instants that are compared
    # turn_noise, lift_noise: [rad, m]
    turn_noise: float
    lift_noise: float
    width: float  # of the smoothing kernel [s]

    @property
    def step(self):
        """Between times [s]."""
        return float(self.time[1] - self.time[0])


def slab_motion(test):
    """`SlabMotion` of a `ReconstructedTest`."""
    motion, body = test.motion, int(np.flatnonzero(test.structure.driven)[0])
    start = motion.rotation[:, body] @ rotation_matrices(test.structure.orientation[body]).T
    turn = from_rest(np.arcsin(np.clip(start[:, 0, 2], -1.0, 1.0)), test.still)
    lift, travel = (from_rest(motion.position[:, body, axis], test.still) for axis in (2, 0))
    carried = [body, *test.free]
    wrench = test.required.wrench[:, carried]
    wrench[:, 0, 3:] = 0.0  # the slab hardly turns, and its own readings' noise would go with the rotation's
    vertices = test.structure.solids[test.structure.file.bodies[body].shape].vertices
    bottom = motion.position[:, body] + [0.0, 0.0, vertices[:, 2].min()]
    arm = motion.position[:, carried] - bottom[:, None]
    moment = from_rest(-(wrench[..., 3:] + np.cross(arm, wrench[..., :3]))[..., 1].sum(axis=1), test.still)
    force = from_rest(wrench[:, 1:, 2].sum(axis=1), test.still)
    known = np.isfinite(turn + lift + moment + motion.acceleration[:, body, 0])
    drives = (np.nan_to_num(one) for one in (motion.acceleration[:, body, 0], moment, force))
    return SlabMotion(
        motion.time, turn, lift, np.nan_to_num(travel), *(_as_fitted(one, motion) for one in drives),
        np.flatnonzero(known)[::_EVERY],
        _noise(turn, test, 4, _TURN_NOISE), _noise(lift, test, 2, _LIFT_NOISE),
        motion.width,
    )  # fmt: skip


def _as_fitted(history, motion):
    """A history smoothed by the kernel alone, as the local quadratic fits of displacements smooth: ``h - w^2 h'' / 2``.

    The fitted value passes ``(1 + s^2 / 2) exp(-s^2 / 2)`` of a frequency, ``s = omega w``, and the second derivative
    passes the second factor alone.
    """
    step = motion.time[1] - motion.time[0]
    bend = np.pad(np.diff(history, 2), 1) / step**2
    return history - 0.5 * motion.width**2 * bend


def _noise(values, test, direction, least):
    """Noise of a component of the slab's pose: its scatter at rest, and no less than that of its markers' readings."""
    body = int(np.flatnonzero(test.structure.driven)[0])
    rest = values[test.still & np.isfinite(values)]
    stated = np.nan_to_num(test.motion.pose_covariance[body, direction, direction])
    return float(max(rest.std() if len(rest) else 0.0, np.sqrt(stated), least))


def explain_slab(slabs, without=()):
    """`Explanation` by every effect that moves the slab but for some, by name; ``slabs`` are `SlabMotion` by test."""
    explanations = {}
    likelihoods = [_turn_likelihood(slabs, multiple, prior) for multiple, prior in _MULTIPLES]
    for name, effect in EFFECTS.items():
        if effect.turns and name not in without:
            explanations[name] = _turning(effect, slabs, likelihoods)
        if effect.lifts and name not in without:
            explanations[name] = explain_lift(effect, slabs)
    return explanations


def slab_turns(slabs):
    """`Likelihood` of the rotation of the slab with the usual errors."""
    return _turn_likelihood(slabs, *_MULTIPLES[0])


def _turn_likelihood(slabs, multiple, prior):
    covariances = []
    for slab in slabs:
        apart = np.abs(slab.time[slab.at][:, None] - slab.time[slab.at])
        covariance = slab.turn_noise**2 * np.exp(-(apart**2) / (4.0 * slab.width**2))
        covariance += (multiple * _COLOURED) ** 2 * np.exp(-apart / _MEMORY)
        covariance[np.diag_indices(len(apart))] += (_RIDGES[0] * slab.turn_noise) ** 2
        covariances.append(covariance)
    nuisances = [
        *([_OFFSET * (slab is own) * np.ones(len(slab.at)) for slab in slabs] for own in slabs),
        [_BY_ACCELERATION * slab.acceleration[slab.at] for slab in slabs],
        [_BY_MOMENT * slab.moment[slab.at] for slab in slabs],
    ]
    return from_rows(covariances, [slab.turn[slab.at] for slab in slabs], nuisances, prior)


def _turning(effect, slabs, likelihoods):
    none = logsumexp([likelihood.log_evidence for likelihood in likelihoods])
    fits, gains = [], []
    for variant in zip(*(effect.turns(slab) for slab in slabs), strict=True):
        columns = [of_test.rows for of_test in variant]
        over_none = []
        for likelihood in likelihoods:
            amplitudes = likelihood.amplitudes(likelihood.whiten(columns), variant[0].scales)
            over_none.append(amplitudes.gain + likelihood.log_evidence - none)
            scales = np.array(variant[0].scales)
            fits.append(
                Fit(variant[0].values, over_none[-1], columns, scales, amplitudes.mean, amplitudes.covariance)
            )
        gains.append(logsumexp(over_none))
    return Explanation(effect.name, "all", float(mean_evidence(gains)), tuple(fits), np.array(gains))


def explain_lift(effect, slabs):
    """`Explanation` by an effect that lifts the slab: a random motion of any size, of a base that gives or does not."""
    return Explanation(effect.name, "all", lift_gain(slabs, lift_roots(effect, slabs)), lift_ratios(slabs))


def lift_roots(effect, slabs):
    """Roots of the covariances of the slab's vertical motion, which do not depend on the motion that is read.

    A list by slab, in it one by whether the base gives, in it lower roots: without the effect, then of its motions.
    """
    roots = []
    for slab in slabs:
        by = ((_LIFT_BY_FORCE, slab.force), (_LIFT_BY_TURN, slab.turn), (_LIFT_BY_TURN, np.abs(slab.turn)))
        apart = np.abs(slab.time[slab.at][:, None] - slab.time[slab.at])
        pressed = _BOUNCE**2 * np.exp(-apart / _BOUNCE_MEMORY)
        pressed += sum(share**2 * np.outer(one[slab.at], one[slab.at]) for share, one in by)
        motions = (0.0, *effect.lifts(slab))
        bases = _lift_noise(slab), _lift_noise(slab) + pressed
        roots.append([[np.linalg.cholesky(base + motion) for motion in motions] for base in bases])
    return roots


def lift_gain(slabs, roots):
    """Logarithm of how many times more probable the vertical motion of slabs is by an effect than without it."""
    logs = sum(
        np.array([[_log_density(slab.lift[slab.at], root) for root in of_base] for of_base in of_slab])
        for slab, of_slab in zip(slabs, roots, strict=True)
    )
    prior = np.array([0.0, -1.0])[:, None]
    moved = logsumexp(logs[:, 1:] + prior) - np.log(2 * (logs.shape[1] - 1))
    return float(moved - logsumexp(logs[:, :1] + prior))


def lift_ratios(slabs):
    """`Fit` of the vertical by the horizontal motion, by delay; what is not in proportion is coloured noise."""
    covariances = []
    for slab in slabs:
        apart = slab.time[slab.at][:, None] - slab.time[slab.at]
        spread = np.std(slab.lift[slab.at]) if len(slab.at) else 0.0  # nothing of the slab may be read
        free = (_FREE_SHARE * spread) ** 2 * np.exp(-0.5 * (apart / _FREE_MEMORY) ** 2)
        covariances.append(_lift_noise(slab) + free)
    likelihood = from_rows(covariances, [slab.lift[slab.at] for slab in slabs], [])
    fits = []
    for delay in _DELAYS:
        columns = [np.interp(slab.time[slab.at] - delay, slab.time, slab.travel)[:, None] for slab in slabs]
        amplitudes = likelihood.amplitudes(likelihood.whiten(columns), (_RATIO,))
        fits.append(
            Fit(
                {"delay": float(delay)},
                amplitudes.gain,
                columns,
                np.array([_RATIO]),
                amplitudes.mean,
                amplitudes.covariance,
            )
        )
    return tuple(fits)


def _lift_noise(slab):
    apart = np.abs(slab.time[slab.at][:, None] - slab.time[slab.at])
    noise = slab.lift_noise**2 * np.exp(-(apart**2) / (4.0 * slab.width**2))
    noise += _LIFT_COLOURED**2 * np.exp(-apart / 0.1) + _LIFT_OFFSET**2
    noise[np.diag_indices(len(apart))] += (_RIDGES[1] * slab.lift_noise) ** 2
    return noise


def _log_density(values, root):
    whitened = solve_triangular(root, values, lower=True, check_finite=False)
    return -0.5 * whitened @ whitened - np.log(np.diag(root)).sum()
