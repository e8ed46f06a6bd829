"""Forces that follow a point's motion: a rope, a viscous drag, a dry drag."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.outside.form import Form, force_entry, with_entry
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


def _against(name):
    """A force entry whose value of a name is the size."""

    def act(experiment, size, place, when, test):
        entry = force_entry(experiment.structure, place, **{name: max(size, 0.0)})
        return with_entry(experiment, "external_forces", entry)

    return act


FORMS = (
    Form("rope", "a rope or spring to either side", "stiffness", "N/m", _against("stiffness")),
    Form("drag", "a viscous drag", "damping", "N s/m", _against("damping")),
    Form("dry-drag", "a dry drag", "force", "N", _against("drag")),
)
