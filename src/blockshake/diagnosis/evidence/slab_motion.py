"""Rotation and vertical displacement of the slab: evidence of a pitching table, a compliant base, a vertical motion."""

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from blockshake.diagnosis.evidence.explanation import mean_evidence
from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.effects.registry import EFFECTS
from blockshake.geometry.rotations import rotation_matrices

_EVERY = 3  # instants
_TURN_NOISE, _LIFT_NOISE = 1.5e-5, 2e-5  # rad, m: no sensor is better
_COLOURED, _MEMORY = 5e-6, 0.1  # rad, s: of the rotation
_OFFSET, _BY_ACCELERATION, _BY_MOMENT = 3e-5, 1.5e-5, 2.5e-11  # rad, rad s2/m, rad/(N m): of sound tables
_LIFT_COLOURED, _LIFT_OFFSET, _LIFT_BY_FORCE = 1e-5, 3e-5, 3e-9  # m, m, m/N
_MULTIPLES = ((1.0, 0.0), (3.0, -2.0), (9.0, -8.0))  # of the coloured error, and the logarithm of their prior
_RIDGES = 0.05, 0.1


@dataclass(frozen=True)
class SlabMotion:
    """Motion of the first driven body in one test, at uniform times.

    Attributes
    ----------
    time, turn, lift : float64 arrays, shape (n_times,)
        Rotation about y and vertical displacement, from rest [s, rad, m].
    acceleration, moment, force : float64 arrays, shape (n_times,)
        Of the slab along x, and of the contacts on it: about y through its centre, and downwards, from rest [m/s2, N m,
        N]; zero where unknown.
    at : int array
        Instants that are compared.
    turn_noise, lift_noise : float
        [rad, m]
    width : float
        Of the smoothing kernel [s].
    """

    time: np.ndarray
    turn: np.ndarray
    lift: np.ndarray
    acceleration: np.ndarray
    moment: np.ndarray
    force: np.ndarray
    at: np.ndarray
    turn_noise: float
    lift_noise: float
    width: float

    @property
    def step(self):
        """Between times [s]."""
        return float(self.time[1] - self.time[0])


def slab_motion(test):
    """`SlabMotion` of a `SeenTest`."""
    motion, body = test.motion, int(np.flatnonzero(test.structure.driven)[0])
    start = motion.rotation[:, body] @ rotation_matrices(test.structure.orientation[body]).T
    turn = _from_rest(np.arcsin(np.clip(start[:, 0, 2], -1.0, 1.0)), test.still)
    lift = _from_rest(motion.position[:, body, 2], test.still)
    wrench = test.required.wrench[:, test.free]
    arm = motion.position[:, test.free] - motion.position[:, [body]]
    moment = _from_rest(-(wrench[..., 3:] + np.cross(arm, wrench[..., :3]))[..., 1].sum(axis=1), test.still)
    force = _from_rest(wrench[..., 2].sum(axis=1), test.still)
    known = np.isfinite(turn + lift + moment + motion.acceleration[:, body, 0])
    return SlabMotion(
        motion.time, turn, lift, np.nan_to_num(motion.acceleration[:, body, 0]), np.nan_to_num(moment),
        np.nan_to_num(force), np.flatnonzero(known)[::_EVERY],
        _noise(turn, test, 4, _TURN_NOISE), _noise(lift, test, 2, _LIFT_NOISE),
        motion.width,
    )  # fmt: skip


def _noise(values, test, direction, least):
    """Noise of a component of the slab's pose: its scatter at rest, and no less than that of its markers' readings."""
    body = int(np.flatnonzero(test.structure.driven)[0])
    rest = values[test.still & np.isfinite(values)]
    stated = np.nan_to_num(test.motion.pose_covariance[body, direction, direction])
    return float(max(rest.std() if len(rest) else 0.0, np.sqrt(stated), least))


def _from_rest(values, still):
    rest = values[still & np.isfinite(values)]
    return values - (rest.mean() if len(rest) else 0.0)


def slab_gains(slabs):
    """Gain of every effect that moves the slab, over none, and its best values.

    Parameters
    ----------
    slabs : list of SlabMotion
        By test.

    Returns
    -------
    dict of str to tuple of float and dict
    """
    found = {}
    likelihoods = [_turn_likelihood(slabs, multiple, prior) for multiple, prior in _MULTIPLES]
    none = logsumexp([one.log_evidence for one in likelihoods])
    for name, effect in EFFECTS.items():
        if effect.turns:
            found[name] = _turning(effect, slabs, likelihoods, none)
        if effect.lifts:
            found[name] = _lifting(effect, slabs)
    return found


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


def _turning(effect, slabs, likelihoods, none):
    variants = list(zip(*(effect.turns(slab) for slab in slabs), strict=True))
    gains = np.empty((len(variants), len(likelihoods)))
    means = []
    for place, variant in enumerate(variants):
        rows = [one.rows for one in variant]
        fits = [one.amplitudes(one.whiten(rows), variant[0].scales) for one in likelihoods]
        gains[place] = [fit.gain + one.log_evidence for fit, one in zip(fits, likelihoods, strict=True)]
        means.append(float(fits[int(np.argmax(gains[place]))].mean[0]))
    by_variant = logsumexp(gains, axis=1) - none
    best = int(np.argmax(by_variant))
    size = effect.parameters[0].name
    return float(mean_evidence(by_variant)), {size: means[best], **variants[best][0].values}


def _lifting(effect, slabs):
    """Gain of a random vertical motion of any size over none, with or without a force that compresses the base."""
    logs = np.zeros((2, 1 + len(effect.lifts(slabs[0]))))
    for slab in slabs:
        apart = np.abs(slab.time[slab.at][:, None] - slab.time[slab.at])
        noise = slab.lift_noise**2 * np.exp(-(apart**2) / (4.0 * slab.width**2))
        noise += _LIFT_COLOURED**2 * np.exp(-apart / 0.1) + _LIFT_OFFSET**2
        noise[np.diag_indices(len(apart))] += (_RIDGES[1] * slab.lift_noise) ** 2
        pressed = _LIFT_BY_FORCE**2 * np.outer(slab.force[slab.at], slab.force[slab.at])
        for gives, base in enumerate((noise, noise + pressed)):
            for size, motion in enumerate((0.0, *effect.lifts(slab))):
                logs[gives, size] += _log_density(slab.lift[slab.at], base + motion)
    prior = np.array([0.0, -1.0])[:, None]
    moved = logsumexp(logs[:, 1:] + prior) - np.log(2 * (logs.shape[1] - 1))
    return float(moved - logsumexp(logs[:, :1] + prior)), {}


def _log_density(values, covariance):
    root = np.linalg.cholesky(covariance)
    whitened = np.linalg.solve(root, values)
    return -0.5 * whitened @ whitened - np.log(np.diag(root)).sum()
