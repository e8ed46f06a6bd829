"""A blow: a short pulse at one time of some tests."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.evidence.explanation import Explanation, Fit, mean_evidence
from blockshake.diagnosis.outside.form import LoadShape, force_entry, with_entry
from blockshake.forces.motion import WIDTH

_WIDTHS = (0.04, 0.08, 0.16, 0.4)  # s
_APART = 0.02  # s, between the times tried of blows as short; of longer ones as long as they are
_SCALE = 0.5  # of the block's weight
_CLEAR = 3.0  # nats, from which a test counts as struck
_EVENT, _RAISED = (
    0.15,
    (3.0, 10.0, 30.0, 100.0, 300.0, 1000.0),
)  # s to either side; variance over the usual one
# of what an event without a form gains there, that a blow must: of 148 blows of 8 to 2,000 nats, put into the rows of
# four clean campaigns, none gained less than 84 %, and of 77 such events 12 let a blow gain 70 %
_OF_EVENT = 0.7


class _Struck(NamedTuple):
    """A test that counts as struck: its evidence, rows of 1 N s, impulse with its error [N s], time and width [s]."""

    evidence: float
    test: int
    rows: np.ndarray
    impulse: float
    deviation: float
    time: float
    width: float


def explain_blow(likelihood, points, weight):
    """`Explanation` of at most one blow a test at one point, of any size and sign in each.

    Where joints change, errors have heavy tails: a blow that explains too little of what happened is such an event.
    """
    scale, total, struck = _SCALE * weight, 0.0, []
    for test, point in enumerate(points.by_test):
        shapes, tried = _pulses(point)
        gain, mean, deviation = likelihood.single(likelihood.whiten_one(test, shapes), scale, test=test)
        evidence, best = mean_evidence(gain), int(np.argmax(gain))
        time, width = tried[best]
        if evidence > _CLEAR and evidence < _OF_EVENT * _gain_of_event(likelihood, test, point.time, time):
            evidence = -np.inf
        total += np.logaddexp(0.0, evidence) - np.log(2.0)  # struck or not, alike likely
        if evidence > _CLEAR:
            area = np.sqrt(2.0 * np.pi) * np.hypot(0.5 * width, WIDTH)  # of a pulse of 1 N, N s
            rows, impulse, error = shapes[:, best] / area, mean[best] * area, deviation[best] * area
            struck.append(_Struck(evidence, test, rows, impulse, error, time, width))
    struck.sort(key=lambda blow: -blow.evidence)
    columns = []
    for test, point in enumerate(points.by_test):
        rows = np.zeros((len(point.unit), len(struck)))
        for column, blow in enumerate(struck):
            if blow.test == test:
                rows[:, column] = blow.rows
        columns.append(rows)
    impulses = np.array([blow.impulse for blow in struck])
    covariance = np.diag(np.array([blow.deviation for blow in struck]) ** 2)
    blows = {points.tests[blow.test]: {"time": blow.time, "width": blow.width} for blow in struck}
    scales = np.maximum(np.abs(impulses), 1.0)  # of what stands given another cause: free
    fit = Fit({"blows": blows}, float(total), columns, scales, impulses, covariance)
    return Explanation("blow", points.place, float(total), (fit,))


def _gain_of_event(likelihood, test, times, at):
    """Gain of errors that are larger around a time of one test, the factor averaged."""
    root, near = likelihood.roots[test], np.flatnonzero(np.abs(times - at) <= _EVENT)
    errors = np.zeros((len(times), len(near)))
    errors[near] = np.linalg.cholesky(root[near] @ root[near].T)
    whitened = np.zeros((len(likelihood.value), len(near)))
    whitened[slice(*likelihood.ends[test : test + 2])] = likelihood.whiten_one(test, errors)
    scales = np.sqrt(np.array(_RAISED) - 1.0)[:, None] * np.ones(len(near))
    return mean_evidence([likelihood.amplitudes(whitened, scale).gain for scale in scales])


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


FORM = LoadShape("blow", "a blow", "impulse", "N s", None, _act, lasts=lambda when: False)
