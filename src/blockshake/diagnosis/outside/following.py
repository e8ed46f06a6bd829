"""Forces that follow a point's motion: a rope, a viscous drag, a dry drag."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.effects.effect import Columns

_ROPE, _DRAG, _DRY = 3e5, 3e4, 0.05  # N/m, N s/m, of the block's weight
_CREEP = 0.01  # m/s, below which a dry drag has no direction


def explain_following(likelihood, points, weight):
    """`Explanation` of a rope, a drag and a dry drag at one point.

    Parameters
    ----------
    likelihood : Likelihood
    points : Points
    weight : float
        Of the block [N].
    """
    laws = {
        "rope": (lambda one: one.displacement, _ROPE),
        "drag": (lambda one: one.velocity, _DRAG),
        "dry-drag": (lambda one: np.tanh(one.velocity / _CREEP), _DRY * weight),
    }
    for name, (law, scale) in laws.items():
        rows = [Columns({}, -(one.unit * law(one))[:, None], (scale,), True) for one in points.by_test]
        yield best_of(likelihood, name, points.place, [rows])
