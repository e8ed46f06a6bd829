"""Edges of one joint that change: in one test, or from an instant of a test on, at once or as they crush under load."""

from dataclasses import replace

import numpy as np
import scipy
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from blockshake.diagnosis.evidence.explanation import NEVER, mean_evidence, single
from blockshake.diagnosis.outside.form import LoadShape

_STARTS_EVERY = 0.5  # s
_INSET_SCALE = 0.05  # m
_STEP_SCALE = 0.02  # m, by which an edge that crushes goes further in each time that it bears
_APART = 0.1  # s, without which it bears on


def explain_changed_edge(likelihood, tests, place, key):
    """`Explanation` of an inset of one edge, or of both, of a hinge; none where the tests leave nothing to change.

    ``key`` is the face and the tangent of the hinge.
    """
    tried, columns = [], [[] for _ in tests]
    for changed, test in enumerate(tests):
        for start in np.arange(test.rows.time[0], test.rows.time[-1], _STARTS_EVERY):
            for lasts in (False, True):
                if lasts and changed == 0 and start == test.rows.time[0]:
                    continue  # in all tests: no change
                for edge in (0, 1, -1):
                    tried.append((changed, float(start), lasts, edge))
                    for number, other in enumerate(tests):
                        columns[number].append(_rows(other, key, edge, number, changed, start, lasts))
    if not tried:
        return
    whitened = likelihood.whiten([np.stack(rows, axis=1) for rows in columns])
    gain, mean, deviation = likelihood.single(whitened, _INSET_SCALE, positive=True)
    widest = 0.5 * float(np.ptp(tests[0].seen.faces[key[0]].corners[:, key[1]]))
    gain = np.where(mean < widest, gain, NEVER)  # an edge lies on its face
    best = int(np.argmax(gain))
    changed, start, lasts, edge = tried[best]
    values = _values(tests, key, changed, start, lasts, edge)
    fitted = float(mean[best]), float(deviation[best])
    rows = [rows[best] for rows in columns]
    at_once = single("changed-edge", place, mean_evidence(gain), rows, _INSET_SCALE, fitted, values)
    tried = [(number, side) for number in range(len(tests)) for side in (1, -1)]
    crushed = [
        one for number, side in tried for one in _crushed(likelihood, tests, place, key, number, side, widest)
    ]
    gains = [at_once.gain, *(one.gain - np.log(len(crushed)) for one in crushed)]
    found = replace(
        max([at_once, *crushed], key=lambda one: one.gain), gain=float(logsumexp(gains) - np.log(2.0))
    )
    yield found


def _crushed(likelihood, tests, place, key, changed, edge, widest):
    """`Explanation` of one edge that goes further in when it bears in one test, and stays so; none where it bears once.

    The steps, from one time that the edge bears to the next, are at their best with none of them back.
    """
    test, hinge = tests[changed], tests[changed].hinges.get(key)
    time = test.rows.time[(hinge.edge == edge) & (hinge.inward != 0.0)] if hinge else np.zeros(0)
    begins = time[np.diff(time, prepend=-np.inf) > _APART]
    if len(begins) < 2:
        return
    columns = [
        np.stack([_rows(other, key, edge, number, changed, begin, True) for begin in begins], axis=1)
        for number, other in enumerate(tests)
    ]
    scales = np.array([_INSET_SCALE, *[_STEP_SCALE] * (len(begins) - 1)])
    target, gram = likelihood.normal_equations(likelihood.whiten(columns))
    precision = gram + np.diag(scales**-2.0)
    root = np.linalg.cholesky(precision)
    steps = scipy.optimize.nnls(root.T, solve_triangular(root, target, lower=True))[0]
    inset = float(steps.sum())
    if not 0.0 < inset < widest:
        return
    gain = target @ steps - 0.5 * steps @ precision @ steps
    gain -= 0.5 * np.linalg.slogdet(np.eye(len(scales)) + gram * scales**2)[1]
    fitted = inset, inset * float(steps @ precision @ steps) ** -0.5
    values = _values(tests, key, changed, float(begins[0]), True, edge) | {"crushed": True}
    rows = [column @ steps / inset for column in columns]
    yield single("changed-edge", place, gain, rows, _INSET_SCALE, fitted, values)


def _values(tests, key, changed, start, lasts, edge):
    """Values of a change from a start in the test of a number on."""
    before = [test.seen.name for test in tests[:changed]]
    one = {"test": tests[changed].seen.name, "start": start, "lasts": lasts, "edge": edge}
    return one | {"before": before, "tangent": key[1]}


def _rows(test, key, edge, number, changed, start, lasts):
    """Rows of the inset in one test, where it is there."""
    if key not in test.hinges or number < changed or (number > changed and not lasts):
        return np.zeros(len(test.rows.value))
    return _inset(test.hinges[key], edge) * ((number > changed) | (test.rows.time >= start))


def _inset(hinge, edge):
    """Rows of an inset of 1 m of one edge, or of both (0)."""
    return hinge.inward * (hinge.edge == edge) if edge else hinge.inward


def _act(experiment, size, place, when, test):
    """Edges of the joint's upper body further in, on all sides; the tests before the change have none."""
    if test in when["before"]:
        return experiment
    file = experiment.structure.file
    body = next(body for body in file.bodies if body.name == place["joint"][1])
    shape = file.shapes[body.shape]
    if shape.box is None:
        return experiment
    worn = {"box": list(shape.box), "chamfer": shape.chamfer + max(size, 0.0)}
    name = f"{body.name}-worn"
    return experiment.with_parameters(**{f"shapes.{name}": worn, f"bodies.{body.name}.shape": name})


def _of_test(test, place, when):
    """Rows of a test to come: the change is there from its start on."""
    names = test.seen.structure.body_names
    pair = [names.index(name) for name in place["joint"]]
    face = next(index for index, joint in enumerate(test.seen.faces) if [joint.lower, joint.upper] == pair)
    key = face, when["tangent"]
    return _inset(test.hinges[key], when["edge"]) if key in test.hinges else np.zeros(len(test.rows.value))


FORM = LoadShape(
    "changed-edge", "an edge that changed", "inset", "m", _of_test, _act, lasts=lambda when: when["lasts"]
)
