"""A spring in one test alone: a cable that is taut once, a bar that leans against a block."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import mean_evidence, single
from blockshake.diagnosis.outside.form import Form, above_centre, with_entry
from blockshake.effects.stopper_contact import spring_rows

_GAPS = np.concatenate([[-0.02], np.arange(0.0, 0.0401, 0.002)])  # m; below 0 it is taut from the start
_STIFFNESS_SCALE = 1e7  # N/m


def explain_spring_once(likelihood, points, weight):
    """`Explanation` of a spring beyond a gap to one side in one test, at one point."""
    found = []
    for test, one in enumerate(points.by_test):
        for side in (1, -1):
            rows = np.stack([spring_rows(one, side, gap) for gap in _GAPS], axis=1)
            gain, mean, deviation = likelihood.single(
                likelihood.whiten_one(test, rows), _STIFFNESS_SCALE, positive=True, test=test
            )
            best = int(np.argmax(gain))
            fitted = float(mean[best]), float(deviation[best])
            found.append((float(mean_evidence(gain)), test, rows[:, best], fitted, side, _GAPS[best]))
    best = max(found, key=lambda one: one[0])
    _, own, rows, fitted, side, gap = best
    columns = [rows if test == own else np.zeros(len(one.unit)) for test, one in enumerate(points.by_test)]
    values = {"test": points.tests[own], "side": side, "gap": float(gap)}
    return single(
        "spring-once",
        points.place,
        mean_evidence([one[0] for one in found]),
        columns,
        _STIFFNESS_SCALE,
        fitted,
        values,
    )


def _act(experiment, size, place, when, test):
    if test != when["test"]:
        return experiment
    structure = experiment.structure
    entry = {
        "body": place["body"],
        "position": above_centre(structure, structure.body_names.index(place["body"]), place["height"]),
        "axis": "+x" if when["side"] > 0 else "-x",
        "gap": when["gap"],
        "stiffness": max(size, 0.0),
    }
    return with_entry(experiment, "stoppers", entry)


FORM = Form("spring-once", "a spring in one test", "stiffness", "N/m", None, _act, lasts=lambda when: False)
