"""Forces that follow a point's motion: a rope, a viscous drag, both together, a dry drag."""

from dataclasses import replace

import numpy as np
from scipy.special import log_ndtr

from blockshake.diagnosis.evidence.explanation import NEVER, best_of
from blockshake.diagnosis.outside.form import LoadShape, force_entry, with_entry
from blockshake.effects.effect import DesignMatrix
from blockshake.forces.seen.point_rows import point_rows
from blockshake.geometry.schema import CREEP

_ROPE, _DRAG, _DRY = 3e5, 3e4, 0.05  # N/m, N s/m, of the block's weight
# nats, and share of the gain, within which the smaller part is an error of form
_SURE, _OF_SHARE = np.log(20.0), 0.05


def explain_following(likelihood, points, weight):
    """`Explanation` of a rope, a drag, a dry drag, and a spring and a damper together at one point."""
    scales, alone = {"rope": _ROPE, "drag": _DRAG, "dry-drag": _DRY * weight}, {}
    for name, scale in scales.items():
        rows = [DesignMatrix({}, _against(name, one)[:, None], (scale,), True) for one in points.by_test]
        alone[name] = best_of(likelihood, name, points.place, [rows])
        yield alone[name]
    yield _together(likelihood, points, max(alone["rope"].gain, alone["drag"].gain))


def _together(likelihood, points, alone):
    """`Explanation` of both sizes; none where one of them alone explains as much, but for the error of its form."""
    rows = [DesignMatrix({}, _both(one), (_ROPE, _DRAG), True) for one in points.by_test]
    found = best_of(likelihood, "spring-and-damper", points.place, [rows])
    fit = replace(found.best, apart=True)
    # the second size is not negative either
    gain = found.gain + np.log(2.0) + log_ndtr(fit.mean[1] / np.sqrt(fit.covariance[1, 1]))
    if min(fit.mean) <= 0.0 or gain - alone <= _SURE + _OF_SHARE * max(gain, 0.0):
        gain = NEVER
    return replace(found, gain=float(gain), fits=(replace(fit, gain=float(gain)),), gains=np.array([gain]))


def _both(point):
    return np.column_stack([_against("rope", point), _against("drag", point)])


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


def _rows_of_both(test, place, when):
    return _both(point_rows(test.seen, place["body"], place["height"]))


def _act_both(experiment, stiffness, damping, place, when, test):
    entry = force_entry(experiment.structure, place, stiffness=max(stiffness, 0.0), damping=max(damping, 0.0))
    return with_entry(experiment, "external_forces", entry)


FORMS = (
    LoadShape(
        "rope", "a rope or spring to either side", "stiffness", "N/m", _rows("rope"), _acts("stiffness")
    ),
    LoadShape("drag", "a viscous drag", "damping", "N s/m", _rows("drag"), _acts("damping")),
    LoadShape(
        "spring-and-damper",
        "a spring and a damper to either side",
        "stiffness",
        "N/m",
        _rows_of_both,
        _act_both,
        more=(("damping", "N s/m"),),
    ),
    LoadShape("dry-drag", "a dry drag", "force", "N", _rows("dry-drag"), _acts("drag")),
    # of free flights alone: on blocks that rock it is not distinguished from a viscous one
    LoadShape("square-drag", "a drag with the square of the speed", "coefficient", "kg/m"),
)
