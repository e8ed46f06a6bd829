"""A blow: a short pulse at one time of some tests."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import Explanation, Fit, mean_evidence
from blockshake.diagnosis.outside.form import Form, force_entry, with_entry
from blockshake.forces.motion import WIDTH

_WIDTHS = (0.04, 0.08, 0.16, 0.4)  # s
_APART = 0.02  # s, between the times tried of blows as short; of longer ones as long as they are
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
        gain, mean, deviation = likelihood.single(likelihood.whiten_one(test, shapes), scale, test=test)
        evidence = mean_evidence(gain)
        total += np.logaddexp(0.0, evidence) - np.log(2.0)  # struck or not, alike likely
        if evidence > _CLEAR:
            best = int(np.argmax(gain))
            at, width = tried[best]
            area = np.sqrt(2.0 * np.pi) * np.hypot(0.5 * width, WIDTH)  # of a pulse of 1 N, N s
            struck.append(
                (evidence, test, shapes[:, best] / area, mean[best] * area, deviation[best] * area, at, width)
            )
    struck.sort(key=lambda one: -one[0])
    columns = [
        np.stack([one[2] if test == one[1] else np.zeros(len(point.unit)) for one in struck], axis=1)
        if struck
        else np.zeros((len(point.unit), 0))
        for test, point in enumerate(points.by_test)
    ]
    impulses, deviations = np.array([one[3] for one in struck]), np.array([one[4] for one in struck])
    blows = {points.tests[one[1]]: {"time": one[5], "width": one[6]} for one in struck}
    scales = np.maximum(np.abs(impulses), 1.0)  # of what stands beside another cause: free
    fit = Fit({"blows": blows}, float(total), columns, scales, impulses, np.diag(deviations**2))
    return Explanation("blow", points.place, float(total), (fit,), np.zeros(0))


def _pulses(point):
    """Rows of all pulses of one test, (n_rows, n_pulses), and their times and widths; widened by the kernel."""
    # a blow that turns a joint over leaves rows before and after it alone
    times = np.arange(point.time[0] - _APART, point.time[-1] + _APART, _APART)
    shapes, tried = [], []
    for width in _WIDTHS:
        at = times[:: max(1, round(width / _APART))]
        widened = np.hypot(0.5 * width, WIDTH)
        shapes.append(point.unit[:, None] * np.exp(-0.5 * ((point.time[:, None] - at) / widened) ** 2))
        tried += [(float(time), width) for time in at]
    return np.concatenate(shapes, axis=1), tried


def _act(experiment, size, place, when, test):
    if test not in when["blows"]:
        return experiment
    at, width = when["blows"][test]["time"], when["blows"][test]["width"]
    entry = force_entry(
        experiment.structure,
        place,
        amplitude=size / width,
        start=max(at - 0.5 * width, 0.0),
        end=at + 0.5 * width,
    )
    return with_entry(experiment, "external_forces", entry)


FORM = Form("blow", "a blow", "impulse", "N s", None, _act, lasts=lambda when: False)
