"""After a test: the measurements that would split a set of causes, and the share of cases in which they do."""

import numpy as np
from scipy.special import ndtr

from blockshake.diagnosis.answer.answer import COARSENING
from blockshake.diagnosis.answer.decision import Measurement
from blockshake.diagnosis.answer.places import place_of, unmoved_joints
from blockshake.diagnosis.answer.static_tests import (
    carried_bodies,
    distance,
    expected_readings,
    static_tests,
)
from blockshake.diagnosis.answer.thresholds import ODDS
from blockshake.diagnosis.outside.registry import FORMS

_LEAST = 0.05  # share of split cases, below which a measurement is no advice
_MOST = 6  # measurements that are reported
_SIGMAS = 3.29  # in an interval of 90 %
REPEAT = "shake"


def next_tests(causes, seen, evidence):
    """`Measurement` by falling share of split cases, of causes, or bodies of one, that the tests do not tell apart.

    Parameters
    ----------
    causes : sequence of Cause
    seen : list of ReconstructedTest
    evidence : Evidence or None
        In which the causes stand.

    Notes
    -----
    A measurement whose readings lie R squared standard deviations apart under two causes adds to the logarithm of their
    odds R/2 in the mean, with the variance R. Of further rows that is coarsened, as all rows are. A set is split where
    the true cause is left alone: by the rival that leaves it latest, averaged over the causes by their odds and over
    the places of each; a rival may be at any of its own.
    """
    causes, between = _hypotheses(causes)
    if len(causes) < 2:
        return ()
    numbers, unmoved = range(len(causes)), unmoved_joints(seen)
    read = [readings_of_cause(seen[0], cause) for cause in causes]
    apart = {}
    for static in static_tests(seen[0], unmoved):
        apart[static.kind, static.words] = {
            (one, other): [
                (min(distance(static, *true, *rival) for rival in read[other]), 0.0) for true in read[one]
            ]
            for one in numbers
            for other in numbers
        }
    for number, test in enumerate(evidence.tests if evidence else ()):
        apart[REPEAT, f"repeat {test.seen.name}"] = _further_rows(causes, evidence, number)
    for face in unmoved if seen[0].tree else ():
        name = seen[0].faces[face].name
        apart[REPEAT, f"a stronger test, in which {name} opens"] = _opened(causes, seen[0], face)
    weights = np.exp([-cause.odds for cause in causes])
    found = []
    for (kind, words), squares in apart.items():
        shares = []
        for one in numbers:
            by_rival = [
                [
                    _split(causes[one], causes[other], *square, kind == REPEAT)
                    for square in squares.get((one, other), [(0.0, 0.0)])
                ]
                for other in numbers
                if other != one
            ]
            shares.append(np.mean(np.min(by_rival, axis=0)))
        share = float(weights @ shares / weights.sum())
        if share >= _LEAST:
            found.append(Measurement(between=between, kind=kind, test=words, share=share))
    return tuple(sorted(found, key=lambda one: (-one.share, one.test))[:_MOST])


def _hypotheses(causes):
    """Causes between which a measurement decides, and their names: those of a set, or a single one at each body."""
    if len(causes) > 1:
        return causes, tuple(cause.name for cause in causes)
    by_body = {}
    for place in causes[0].places if "body" in causes[0].place else ():
        by_body.setdefault(place.partition("@")[0], []).append(place)
    return [causes[0].model_copy(update={"places": tuple(own)}) for own in by_body.values()], tuple(by_body)


def _opened(causes, seen, face):
    """By true cause and rival: squares of rows that a joint would show, were it to open as the others have.

    As much as all rows so far, of causes that act on a body, one above the joint and one below it.
    """
    above = {seen.structure.body_names[body] for body in carried_bodies(seen, face)}
    sides = [
        {place.partition("@")[0] in above for place in cause.places} if "body" in cause.place else set()
        for cause in causes
    ]
    numbers = range(len(causes))
    return {
        (one, other): [(2.0 * causes[one].gain, causes[one].gain)]
        for one in numbers
        for other in numbers
        if sides[one] and sides[other] and sides[one].isdisjoint(sides[other])
    }


def _split(true, rival, square, gained, rows):
    """Chance that a rival is left beyond the odds of a set, where another cause is the true one."""
    if not square > 0.0:
        return 0.0
    share = 1.0 / (1.0 + COARSENING * max(true.gain + gained, 0.0) / ODDS) if rows else 1.0
    mean = rival.odds - true.odds + 0.5 * share * square
    return float(ndtr((mean - ODDS) / (share * np.sqrt(square))))


def readings_of_cause(seen, cause):
    """Expected static readings of a `Cause`, and their standard deviations from that of its size, at each place."""
    values = {name: one.estimate for name, one in cause.parameters.items()}
    values |= {key: value for key, value in cause.when.items() if key not in values}
    name, found = next(iter(cause.parameters), None), []
    moved = dict(values)
    if name is not None:
        moved[name] += (cause.parameters[name].upper - cause.parameters[name].lower) / _SIGMAS
    for words in cause.places:
        place = place_of(cause.name, words, seen)
        middle, further = (expected_readings(seen, cause.name, place, one) for one in (values, moved))
        found.append((middle, {reading: abs(further[reading] - value) for reading, value in middle.items()}))
    return found


def _further_rows(causes, evidence, number):
    """By true cause and rival: the square of the rows of a test made again that the rival leaves, and the gain more.

    Amplitudes and nuisances of the rival are those that fit the true cause's rows of all tests. A cause that acts once
    is not there again; of one that shows in closed joints alone nothing is known.
    """
    keys = [(cause.name, cause.places[0]) for cause in causes]
    known = [number for number, key in enumerate(keys) if key in evidence.keys]
    if not known:
        return {}
    likelihood = evidence.most_probable(keys[known[0]]).likelihood
    again = slice(likelihood.ends[number], likelihood.ends[number + 1])
    fits = {one: evidence.best(keys[one]).best for one in known}
    columns = {one: likelihood.whiten(fit.columns) for one, fit in fits.items()}
    lasts = {
        one: float(not causes[one].outside or FORMS[causes[one].name].lasts(causes[one].when))
        for one in known
    }
    nuisances, squares = likelihood.nuisances, {}
    for one in known:
        made = columns[one] @ fits[one].mean
        shown = lasts[one] * made[again]
        for other in known:
            if other == one:
                continue
            against = np.column_stack([nuisances, columns[other] * fits[other].scales])
            fitted = np.linalg.solve(np.eye(against.shape[1]) + against.T @ against, against.T @ made)
            fitted[nuisances.shape[1] :] *= lasts[other]
            left = shown - against[again] @ fitted
            squares[one, other] = [(float(left @ left), 0.5 * float(shown @ shown))]
    return squares
