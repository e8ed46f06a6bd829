"""A steady push that begins at a time of each test, alike in all."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import mean_evidence, single
from blockshake.diagnosis.outside.form import LoadShape, force_entry, with_entry
from blockshake.forces.seen.point_rows import point_rows

_STARTS_EVERY, _RISE = 0.1, 0.25  # s
_SCALE = 0.1  # of the block's weight
_SWEEPS = 3


def explain_push(likelihood, points, weight):
    """`Explanation` of a push at one point; the starts are searched test by test, those of the others kept."""
    scale = _SCALE * weight
    starts, columns, parts = [], [], []
    for test, point in enumerate(points.by_test):
        tried = _starts(point.time)
        shapes = point.unit[:, None] * _rise(point.time, tried)
        starts.append(tried)
        columns.append(shapes)
        parts.append(likelihood.parts(likelihood.whiten_one(test, shapes), test))
    climbed = [_climb(likelihood, parts, scale, sign) for sign in (1.0, -1.0)]
    evidence, chosen, fitted = max(climbed, key=lambda result: result[0])
    rows = [shapes[:, index] for shapes, index in zip(columns, chosen, strict=True)]
    begins = [float(tried[index]) for tried, index in zip(starts, chosen, strict=True)]
    # no row tells of a start before a joint first opens, less the rise
    before = [test for test, index in zip(points.tests, chosen, strict=True) if index == 0]
    values = {
        "starts": dict(zip(points.tests, begins, strict=True)),
        **({"before": before} if before else {}),
    }
    return single("push", points.place, evidence, rows, scale, fitted, values)


def _climb(likelihood, parts, scale, sign):
    """For one sign of the force: evidence averaged over the starts, best start of each test, force with its error."""
    chosen = [_best(*likelihood.gain_of_sum(*part, scale)[:2], sign) for part in parts]
    for _ in range(_SWEEPS):
        logs = []
        for test, part in enumerate(parts):
            others = [
                [values[..., index] for values in other]
                for number, (other, index) in enumerate(zip(parts, chosen, strict=True))
                if number != test
            ]
            target, square = (part[key] + sum(other[key] for other in others) for key in range(2))
            crossed = part[2] + sum((other[2][:, None] for other in others), 0.0)
            gain, mean, deviation = likelihood.gain_of_sum(target, square, crossed, scale)
            chosen[test] = _best(gain, mean, sign)
            logs.append(mean_evidence(gain - gain.max()))
    last = chosen[-1]
    return gain[last] + sum(logs), chosen, (float(mean[last]), float(deviation[last]))


def _best(gain, mean, sign):
    return int(np.argmax(np.where(sign * mean > 0.0, gain, -np.inf)))


def _rise(time, starts):
    """A push of 1 N that begins at each start, (n_rows, n_starts)."""
    return np.clip((time[:, None] - starts) / _RISE, 0.0, 1.0)


def _rows(test, place, when):
    """As from the start that the test itself has; see `start_of_push`."""
    point = point_rows(test.seen, place["body"], place["height"])
    return point.unit * _rise(point.time, np.array([when["starts"][test.seen.name]]))[:, 0]


def start_of_push(place, size, test, likelihood, number):
    """Start of a push of a known size [N] in a further test that leaves least of its rows; ``number``: of the test."""
    point = point_rows(test.seen, place["body"], place["height"])
    tried = _starts(point.time)
    shapes = size * point.unit[:, None] * _rise(point.time, tried)
    value = likelihood.value[likelihood.ends[number] : likelihood.ends[number + 1]]
    unexplained = value[:, None] - likelihood.whiten_one(number, shapes)
    return float(tried[np.argmin((unexplained**2).sum(axis=0))])


def _starts(time):
    return np.arange(time[0] - _RISE, time[-1], _STARTS_EVERY)


def _act(experiment, size, place, when, test):
    start = when["starts"].get(test, float(np.median(list(when["starts"].values()))))
    entry = force_entry(experiment.structure, place, amplitude=size, start=max(start, 0.0))
    return with_entry(experiment, "external_forces", entry)


FORM = LoadShape("push", "a steady push", "force", "N", _rows, _act)
