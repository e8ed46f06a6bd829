"""A blow: a short pulse at one time of some tests."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import Explanation, mean_evidence
from blockshake.forces.motion import WIDTH

_WIDTHS = (0.04, 0.08, 0.16, 0.4)  # s
_APART = 0.02  # s, between the times tried of the shortest
_SCALE = 0.5  # of the block's weight
_CLEAR = 3.0  # nats, from which a test counts as struck


def explain_blow(likelihood, points, weight):
    """`Explanation` of at most one blow a test at one point, of any size and sign in each.

    Parameters
    ----------
    likelihood : Likelihood
    points : Points
    weight : float
        Of the block [N].
    """
    scale, total, struck = _SCALE * weight, 0.0, []
    for test, one in enumerate(points.by_test):
        shapes, tried = _pulses(one)
        gain, mean = likelihood.single(likelihood.whiten_one(test, shapes), scale, test=test)
        evidence = mean_evidence(gain)
        total += np.logaddexp(0.0, evidence) - np.log(2.0)  # struck or not, alike likely
        if evidence > _CLEAR:
            best = int(np.argmax(gain))
            struck.append((test, shapes[:, best], mean[best], tried[best]))
    columns = [
        np.stack([shape if test == own else np.zeros(len(one.unit)) for own, shape, _, _ in struck], axis=1)
        if struck
        else np.zeros((len(one.unit), 0))
        for test, one in enumerate(points.by_test)
    ]
    mean = np.array([size for _, _, size, _ in struck])
    blows = {points.tests[test]: {"time": at, "width": width} for test, _, _, (at, width) in struck}
    return Explanation(
        "blow", points.place, float(total), columns, np.full(len(struck), scale), mean, np.zeros((len(mean),) * 2),
        {"blows": blows},
    )  # fmt: skip


def _pulses(point):
    """Rows of all pulses of one test, (n_rows, n_pulses), and their times and widths; widened by the kernel."""
    times = np.unique(np.round(point.time, 3))
    shapes, tried = [], []
    for width in _WIDTHS:
        at = times[:: max(1, round(width / _APART))]
        widened = np.hypot(0.5 * width, WIDTH)
        shapes.append(point.unit[:, None] * np.exp(-0.5 * ((point.time[:, None] - at) / widened) ** 2))
        tried += [(float(time), width) for time in at]
    return np.concatenate(shapes, axis=1), tried
