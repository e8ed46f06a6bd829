"""Whether places and rotations of blocks fit together at the joints: a block turns about its foot, which stays put.

Find the change of a map, such as reversed rotations or two bodies exchanged, without which blocks would slide on each
other by many times more. The slip is the tangential displacement of the upper block against the lower one at the
middle of their joint; a block that rocks about an edge opens there, and slips by next to nothing.
"""

import itertools
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.measurement.motion.joints import contact_normals, find_joints, rotation_vectors

_LEAST_SLIP = 1e-3  # m rms, of a slip that is looked at
ABOVE_NOISE = 10.0  # times the noise of a reading, that it must be
UNLIKE = 0.1  # of the mean square slip, below which another map must bring it
_STEP = 0.5  # of the mean square slip, below which one body's change must bring it
_LEVEL = 0.7  # upward part of the normal of a joint that bears
_MOST_TIMES = 500
_FALLEN = 0.5  # of the height of a joint below the upper block's centroid: farther off, blocks fall
# signed permutations of a rotation vector: first as it is, then turned back, then by the changes that each makes
_TURNS = sorted(
    (np.diag(signs) @ np.eye(3)[list(order)]
     for order in itertools.permutations(range(3)) for signs in itertools.product((1.0, -1.0), repeat=3)),
    key=lambda turn: (turn != np.eye(3)).any() + (turn != -np.eye(3)).any() * (turn != np.eye(3)).sum(),
)  # fmt: skip


class JointFit(NamedTuple):
    """Motion of all bodies from the first time on, at the joints that bear; see `joint_fit`."""

    pairs: np.ndarray  # int (n_joints, 2); lower and upper body
    arms: np.ndarray  # float64 (n_joints, 2, 3); joint's middle seen from both, world frame at the start [m]
    normals: np.ndarray  # float64 (n_joints, 3)
    moved: np.ndarray  # float64 (n_times, n_bodies, 3) [m]
    turned: np.ndarray  # float64 (n_times, n_bodies, 3); rotation vectors, world frame [rad]
    use: np.ndarray  # bool (n_times, n_joints); both bodies are read, and neither falls

    def slip(self, turned=None, bodies=None):
        """Mean square slip over all joints [m2], with other rotation vectors or other bodies' motions."""
        rotations = self.turned if turned is None else turned
        moved = self.moved
        if bodies is not None:
            rotations, moved = rotations[:, bodies], moved[:, bodies]
        total = 0.0
        for (low, high), arms, normal, use in zip(
            self.pairs, self.arms, self.normals, self.use.T, strict=True
        ):
            ends = [
                moved[use, body] + Rotation.from_rotvec(rotations[use, body]).apply(arm) - arm
                for body, arm in zip((low, high), arms, strict=True)
            ]
            away = ends[1] - ends[0]
            away -= (away @ normal)[:, None] * normal
            total += (away**2).sum()
        return total / self.use.sum()

    def worth_a_look(self, noise):
        """Whether blocks slip by more than noise does."""
        return self.use.any() and self.slip() > max(_LEAST_SLIP, ABOVE_NOISE * noise) ** 2


def joint_fit(structure, position, rotation):
    """`JointFit` of bodies whose position (n_times, n_bodies, 3) [m] and rotation (..., 3, 3) are known; NaN elsewhere.

    Both count from the first time at which they are known, where bodies stand as in the structure.
    """
    pairs, centres = find_joints(structure)
    normals = contact_normals(structure, pairs)
    rows = np.unique(np.linspace(0, len(position) - 1, _MOST_TIMES).astype(int))
    known = np.isfinite(position).all(axis=2) & np.isfinite(rotation).all(axis=(2, 3))
    first, bodies = known.argmax(axis=0), np.arange(len(structure.mass))
    moved = (position - position[first, bodies])[rows]
    turned = rotation_vectors(np.einsum("tbij,bkj->tbik", rotation[rows], rotation[first, bodies]))
    bears = np.abs(np.nan_to_num(normals)[:, 2]) > _LEVEL
    pairs, centres, normals = pairs[bears], centres[bears], normals[bears]
    arms = centres[:, None] - structure.centroid[pairs]
    near = np.linalg.norm(moved[:, pairs[:, 1]] - moved[:, pairs[:, 0]], axis=2)
    use = known[rows][:, pairs].all(axis=2) & (near < _FALLEN * np.linalg.norm(arms[:, 1], axis=1))
    return JointFit(pairs, arms, normals, moved, turned, use)


def other_turns(fit, bodies, noise):
    """Signed permutations (3, 3) by body, of rotation vectors of ``bodies``, by which blocks hardly slip; or none.

    One permutation for all of them is tried first, then one for each body.
    """
    if not fit.worth_a_look(noise):
        return {}
    given = fit.slip()

    def changed(turned, mine, turn):
        turned = turned.copy()
        turned[:, mine] = turned[:, mine] @ turn.T
        return turned

    def best(turned, mine):
        slips = [fit.slip(changed(turned, mine, turn)) for turn in _TURNS]
        near = 2.0 * min(slips)
        return next(
            (turn, slip) for turn, slip in zip(_TURNS, slips, strict=True) if slip <= near
        )  # fewest changes

    turn, slip = best(fit.turned, list(bodies))
    if slip < UNLIKE * given:
        return {} if np.array_equal(turn, np.eye(3)) else dict.fromkeys(bodies, turn)
    found, turned, slip = {}, fit.turned, given
    for _ in bodies:
        tried = {body: best(turned, [body]) for body in bodies if body not in found}
        body = min(tried, key=lambda one: tried[one][1])
        if tried[body][1] > _STEP * slip:
            break
        found[body], slip = tried[body]
        turned = changed(turned, [body], found[body])
    return found if slip < UNLIKE * given else {}


def exchanged_bodies(fit, bodies, noise):
    """Two of ``bodies`` without whose exchange blocks would hardly slip, or None."""
    if not fit.worth_a_look(noise):
        return None
    order, best, least = np.arange(fit.moved.shape[1]), None, UNLIKE * fit.slip()
    for one, other in itertools.combinations(bodies, 2):
        swapped = order.copy()
        swapped[[one, other]] = other, one
        slip = fit.slip(bodies=swapped)
        if slip < least:
            best, least = (one, other), slip
    return best
