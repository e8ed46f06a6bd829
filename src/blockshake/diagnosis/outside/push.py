"""A steady push that begins at a time of each test, alike in all."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import mean_evidence, single
from blockshake.diagnosis.outside.form import Form, force_entry, with_entry

_STARTS_EVERY, _RISE = 0.1, 0.25  # s
_SCALE = 0.1  # of the block's weight
_SWEEPS = 3


def explain_push(likelihood, points, weight):
    """`Explanation` of a push at one point; the starts are searched test by test, those of the others kept.

    Parameters
    ----------
    likelihood : Likelihood
    points : Points
    weight : float
        Of the block [N].
    """
    scale = _SCALE * weight
    starts, columns, parts = [], [], []
    for test, one in enumerate(points.by_test):
        tried = np.arange(one.time[0] - _RISE, one.time[-1], _STARTS_EVERY)
        shapes = one.unit[:, None] * np.clip((one.time[:, None] - tried) / _RISE, 0.0, 1.0)
        starts.append(tried)
        columns.append(shapes)
        parts.append(likelihood.parts(likelihood.whiten_one(test, shapes), test))
    found = [_climb(likelihood, parts, scale, sign) for sign in (1.0, -1.0)]
    evidence, chosen, fitted = max(found, key=lambda one: one[0])
    return single(
        "push", points.place, evidence,
        [shapes[:, place] for shapes, place in zip(columns, chosen, strict=True)], scale, fitted,
        {"starts": {
            name: float(tried[place])
            for name, tried, place in zip(points.tests, starts, chosen, strict=True)
        }},
    )  # fmt: skip


def _climb(likelihood, parts, scale, sign):
    """For one sign of the force: evidence averaged over the starts, best start of each test, force with its error."""
    chosen = [_best(*likelihood.gain_of_sum(*part, scale)[:2], sign) for part in parts]
    for _ in range(_SWEEPS):
        logs = []
        for test, part in enumerate(parts):
            others = [
                [own[..., place] for own in other]
                for number, (other, place) in enumerate(zip(parts, chosen, strict=True))
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


def _act(experiment, size, place, when, test):
    start = when["starts"].get(test, float(np.median(list(when["starts"].values()))))
    entry = force_entry(experiment.structure, place, amplitude=size, start=max(start, 0.0))
    return with_entry(experiment, "external_forces", entry)


FORM = Form("push", "a steady push from an instant of each test on", "force", "N", _act)
