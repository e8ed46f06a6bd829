"""A spring in one test alone: a cable that is taut once, a bar that leans against a block."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import mean_evidence, single
from blockshake.diagnosis.outside.form import LoadShape, above_centre, with_entry
from blockshake.effects.stopper_contact import spring_rows

_GAPS = np.concatenate([[-0.02], np.arange(0.0, 0.0401, 0.002)])  # m; below 0 it is taut from the start
_STIFFNESS_SCALE = 1e7  # N/m


def explain_spring_once(likelihood, points, weight):
    """`Explanation` of a spring beyond a gap to one side in one test, at one point."""
    springs = []
    for test, point in enumerate(points.by_test):
        for side in (1, -1):
            rows = np.stack([spring_rows(point, side, gap) for gap in _GAPS], axis=1)
            gain, mean, deviation = likelihood.single(
                likelihood.whiten_one(test, rows), _STIFFNESS_SCALE, positive=True, test=test
            )
            best = int(np.argmax(gain))
            fitted = float(mean[best]), float(deviation[best])
            springs.append((float(mean_evidence(gain)), test, rows[:, best], fitted, side, _GAPS[best]))
    _, struck, rows, fitted, side, gap = max(springs, key=lambda spring: spring[0])
    columns = [
        rows if test == struck else np.zeros(len(point.unit)) for test, point in enumerate(points.by_test)
    ]
    values = {"test": points.tests[struck], "side": side, "gap": float(gap)}
    evidence = mean_evidence([spring[0] for spring in springs])
    return single("spring-once", points.place, evidence, columns, _STIFFNESS_SCALE, fitted, values)


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


FORM = LoadShape(
    "spring-once", "a spring in one test", "stiffness", "N/m", None, _act, lasts=lambda when: False
)
