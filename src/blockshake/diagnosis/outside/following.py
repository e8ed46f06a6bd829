"""Forces that follow a point's motion: a rope, a viscous drag, a dry drag."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.outside.form import LoadShape, force_entry, with_entry
from blockshake.effects.effect import DesignMatrix
from blockshake.forces.seen.point_rows import point_rows
from blockshake.geometry.schema import CREEP

_ROPE, _DRAG, _DRY = 3e5, 3e4, 0.05  # N/m, N s/m, of the block's weight


def explain_following(likelihood, points, weight):
    """`Explanation` of a rope, a drag and a dry drag at one point."""
    scales = {"rope": _ROPE, "drag": _DRAG, "dry-drag": _DRY * weight}
    for name, scale in scales.items():
        rows = [DesignMatrix({}, _against(name, one)[:, None], (scale,), True) for one in points.by_test]
        yield best_of(likelihood, name, points.place, [rows])


def _against(name, point):
    """Rows of a force against the displacement or the velocity of a point, at the size 1."""
    if name == "dry-drag":  # it has a kink: computed before it is smoothed
        return -point.unit * point.through_kernel(np.tanh(point.fine_velocity / CREEP))
    return -point.unit * (point.displacement if name == "rope" else point.velocity)


def _rows(name):
    return lambda test, place, when: _against(name, point_rows(test.seen, place["body"], place["height"]))


def _acts(name):
    """A force entry whose value of a name is the size."""

    def act(experiment, size, place, when, test):
        entry = force_entry(experiment.structure, place, **{name: max(size, 0.0)})
        return with_entry(experiment, "external_forces", entry)

    return act


FORMS = (
    LoadShape(
        "rope", "a rope or spring to either side", "stiffness", "N/m", _rows("rope"), _acts("stiffness")
    ),
    LoadShape("drag", "a viscous drag", "damping", "N s/m", _rows("drag"), _acts("damping")),
    LoadShape("dry-drag", "a dry drag", "force", "N", _rows("dry-drag"), _acts("drag")),
    # of free flights alone: on blocks that rock it is not distinguished from a viscous one
    LoadShape("square-drag", "a drag with the square of the speed", "coefficient", "kg/m"),
)
