"""All causes under every noise model of the rows, and the log Bayes factor of each over none."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from blockshake.diagnosis.answer.answer import coarsened
from blockshake.diagnosis.answer.places import place_name
from blockshake.diagnosis.answer.thresholds import ODDS
from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.evidence.joint_rows import JointRows
from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.diagnosis.evidence.nuisances import expected_rows, nuisances_of, possible
from blockshake.diagnosis.evidence.row_covariance import form_error, row_covariance
from blockshake.diagnosis.evidence.stop_search import explain_stops
from blockshake.diagnosis.outside.blow import explain_blow
from blockshake.diagnosis.outside.changed_edge import explain_changed_edge
from blockshake.diagnosis.outside.following import explain_following
from blockshake.diagnosis.outside.free_force import explain_free_force
from blockshake.diagnosis.outside.loose_weight import explain_loose_weight
from blockshake.diagnosis.outside.push import explain_push
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.outside.spring_once import explain_spring_once
from blockshake.effects.block_mass import HEIGHTS
from blockshake.effects.registry import EFFECTS
from blockshake.effects.stopper_contact import EFFECT as STOPPER_CONTACT
from blockshake.forces.seen.point_rows import point_rows

NOISES = (0.75, 1.0, 1.3)  # standard deviation of the sensors over the stated one
_IMPLAUSIBLE = 20.0  # nats below the best, from which on a noise model is dropped
_LOOKED_AT = 4  # causes
EVERY = (*EFFECTS, *FORMS)
DISCREPANCIES = ((1.0, 0.0), (4.0, -3.0), (16.0, -10.0))  # multiple, logarithm of its prior
_FIRST_LOOK = 4  # number of the noise model in the middle of both


@dataclass(frozen=True)
class Explained:
    """Explanations of the rows under one noise model, by cause and place."""

    likelihood: object
    by_key: dict


def likelihoods(tests, nuisances):
    """`Likelihood` of tests with rows and their `Nuisance`, by noise and discrepancy."""
    values = [test.rows.value - expected_rows(test) for test in tests]
    columns = [one.columns for one in nuisances]
    return [
        from_rows([row_covariance(test, noise, multiple) for test in tests], values, columns, prior)
        for noise in NOISES
        for multiple, prior in DISCREPANCIES
    ]


@dataclass(frozen=True)
class Tried:
    """All that is tried on tests with rows: made once, for every likelihood."""

    tests: list  # of JointRows
    points: list  # of Points; at which forces from outside are tried
    variants: dict  # (str, str) to list of list of Columns; by effect and place, by variant and test

    def of_tests(self, numbers, cause):
        """`Tried` of one cause on some of the tests, given by their numbers."""
        points = [point.of_tests(numbers) for point in self.points]
        variants = {
            key: [[variant[n] for n in numbers] for variant in by_variant]
            for key, by_variant in self.variants.items()
            if key[0] == cause
        }
        return Tried([self.tests[n] for n in numbers], points, variants)


def all_tried(tests, without):
    """`Tried` of tests with rows, but for some effects."""
    structure, variants = tests[0].seen.structure, {}
    for name, effect in EFFECTS.items():
        if effect.columns is None or name in without:
            continue
        for place in (effect.seen_at or effect.places)(structure):
            by_variant = list(zip(*(effect.columns(test.seen, place) for test in tests), strict=True))
            if any(columns.rows.any() for variant in by_variant for columns in variant):
                variants[name, place_name(place)] = by_variant
    return Tried(tests, force_points(tests), variants)


def plausible(tried, nuisances):
    """Noise models within 20 nats of the best one for any leading cause of a first look.

    Without a cause, a large force that nobody modelled would select the widest errors alone. A tolerance that no
    structure has given the best of these causes is left out: a body of less mass needs less of any force.
    """
    among, kept, best, leading = likelihoods(tried.tests, nuisances), set(), {}, []
    for explanation in explain(among[_FIRST_LOOK], tried).by_key.values():
        if explanation.cause not in best or explanation.gain > best[explanation.cause].gain:
            best[explanation.cause] = explanation
    for cause in sorted(best.values(), key=lambda explanation: -explanation.gain)[:_LOOKED_AT]:
        conditional = [given(likelihood, tried.tests, cause) for likelihood in among]
        logs = np.array([one.log_evidence for one in conditional])
        kept |= set(np.flatnonzero(logs > logs.max() - _IMPLAUSIBLE))
        leading.append(conditional[int(logs.argmax())])
    most_probable = max(leading, key=lambda one: one.log_evidence)
    left = possible(nuisances, most_probable.nuisance_amplitudes[: len(nuisances)])
    return [among[index] for index in sorted(kept)] if len(left) == len(nuisances) else plausible(tried, left)


def explain(likelihood, tried, causes=EVERY):
    """`Explained` by causes of some names at all places."""
    explanations = [
        explain_stops(likelihood, place, variants)
        if name == STOPPER_CONTACT.name
        else best_of(likelihood, name, place, variants)
        for (name, place), variants in tried.variants.items()
        if name in causes
    ]
    if not FORMS.keys().isdisjoint(causes):
        explanations += _from_outside(likelihood, tried.tests, tried.points)
    by_key = {(one.cause, one.place): one for one in explanations if one.cause in causes}
    return Explained(likelihood, by_key)


def _from_outside(likelihood, tests, points):
    structure = tests[0].seen.structure
    gravity = float(np.linalg.norm(structure.file.gravity))
    for point in points:
        weight = structure.mass[point.body] * gravity
        yield from explain_following(likelihood, point, weight)
        for search in (explain_push, explain_blow, explain_spring_once):
            yield search(likelihood, point, weight)
    # the height hardly matters to a force of any history
    highest = {point.body: point for point in points}
    yield from (explain_free_force(likelihood, point) for point in highest.values())
    for key in sorted({key for test in tests for key in test.hinges}):
        yield from explain_changed_edge(likelihood, tests, tests[0].seen.faces[key[0]].name, key)
    top = int(tests[0].seen.free[np.argmax(structure.position[tests[0].seen.free, 2])])
    yield explain_loose_weight(likelihood, tests, structure.body_names[top], top)


@dataclass(frozen=True)
class Evidence:
    """Explanations of all rows under several noise models."""

    tried: Tried
    explained: list  # of Explained; by likelihood

    @property
    def tests(self):
        """`JointRows` of the tests with rows."""
        return self.tried.tests

    @property
    def usual(self):
        """The noise model (`Likelihood`) with the largest evidence when no cause acts."""
        return max((one.likelihood for one in self.explained), key=lambda one: one.log_evidence)

    def gain(self, key):
        """Gain of a cause at a place over none, summed over the likelihoods."""
        return float(self._log_sum([explained.by_key[key].gain for explained in self.explained]))

    def gains_of_variants(self, key):
        """Gains over none of all variants of a cause at a place, before their average."""
        return self._log_sum([explained.by_key[key].gains for explained in self.explained])

    def best(self, key):
        """Explanation by a cause at a place, under its most probable noise model."""
        return self.most_probable(key).by_key[key]

    def most_probable(self, key):
        """`Explained` under the most probable noise model of a cause at a place."""
        return self.explained[int(np.argmax(self._log_evidence(key)))]

    def fits(self, cause, places):
        """All `Fit` of a cause at places that cannot be distinguished, with the logarithms of their weights.

        Returns
        -------
        list of Fit, float64 array
            Over all likelihoods; from place to place by `apart`, the best one first.
        """
        fits, logs = [], []
        for place, apart in zip(places, self.apart(cause, places), strict=True):
            here, weights = [], []
            for explained in self.explained:
                for fit in explained.by_key[cause, place].fits:
                    here.append(fit)
                    weights.append(fit.gain + explained.likelihood.log_evidence)
            fits += here
            logs += list(np.array(weights) - logsumexp(weights) - min(apart, ODDS))
        return fits, np.array(logs)

    def apart(self, cause, places):
        """Logarithms of the odds of a cause at the first of some places over each of them, coarsened, list of float.

        No more than the readings are expected to give: half the square of what the first one's rows differ by from the
        best ones of the other place, nuisances free. More is an error of the model, which one of the columns takes up.
        """
        first, *others = (self.gain((cause, place)) for place in places)
        explained = self.most_probable((cause, places[0]))
        made, found = [rows[:, None] for rows in explained.by_key[cause, places[0]].rows], [0.0]
        for place, gain in zip(places[1:], others, strict=True):
            odds = coarsened(first - gain, first)
            if odds >= ODDS and first > ODDS:
                fit = explained.by_key[cause, place].best
                rival = [column * fit.scales for column in fit.columns]
                both = [np.hstack(pair) for pair in zip(made, rival, strict=True)]
                gram = explained.likelihood.normal_equations(explained.likelihood.whiten(both))[1]
                shared = np.linalg.solve(gram[1:, 1:] + np.eye(len(gram) - 1), gram[1:, 0])
                odds = coarsened(min(first - gain, 0.5 * float(gram[0, 0] - gram[0, 1:] @ shared)), first)
            found.append(odds)
        return found

    @property
    def keys(self):
        """Causes and places, tuples of str."""
        return list(self.explained[0].by_key)

    def _log_sum(self, gains):
        logs = np.array([explained.likelihood.log_evidence for explained in self.explained])
        gains = np.array(gains)
        return logsumexp(gains + logs.reshape(-1, *[1] * (gains.ndim - 1)), axis=0) - logsumexp(logs)

    def of_tests(self, numbers, cause):
        """`Evidence` by one cause alone of some tests with rows, given by their numbers."""
        tried = self.tried.of_tests(numbers, cause)
        likelihoods = [one.likelihood.of_tests(numbers) for one in self.explained]
        return Evidence(tried, [explain(likelihood, tried, {cause}) for likelihood in likelihoods])

    def plausible(self, key):
        """`Evidence` of the noise models that are plausible given a cause at a place."""
        log_evidence = self._log_evidence(key)
        kept = np.flatnonzero(log_evidence > log_evidence.max() - _IMPLAUSIBLE)
        return Evidence(self.tried, [self.explained[index] for index in kept])

    def _log_evidence(self, key):
        return np.array([one.by_key[key].gain + one.likelihood.log_evidence for one in self.explained])

    def given(self, found, causes=EVERY):
        """`Evidence` of causes given some `Explanation`, whose columns are nuisances now."""
        explained = []
        for likelihood in (one.likelihood for one in self.explained):
            for cause in found:
                likelihood = given(likelihood, self.tests, cause)
            explained.append(explain(likelihood, self.tried, causes))
        return Evidence(self.tried, explained)


def given(likelihood, tests, cause):
    """A likelihood with the best fit of an `Explanation` among its nuisances, and the error of its form."""
    errors = [form_error(test.rows.time, rows) for test, rows in zip(tests, cause.rows, strict=True)]
    return likelihood.given(cause.best.columns, cause.best.scales, errors)


def gather_evidence(seen, without=()):
    """`Evidence` of seen tests without some effects; None where no joint turned, slipped or lifted in any test."""
    tests = [JointRows(test) for test in seen if len(test.rows.value)]
    if not tests:
        return None
    tried = all_tried(tests, without)
    return Evidence(
        tried, [explain(likelihood, tried) for likelihood in plausible(tried, nuisances_of(tests))]
    )


@dataclass(frozen=True)
class Points:
    """A point of one body in all tests."""

    place: str  # body, and height above its centre over its own height
    body: int
    by_test: list  # of PointRows
    tests: list  # of str

    def of_tests(self, numbers):
        """The point in some of the tests, given by their numbers."""
        return replace(
            self, by_test=[self.by_test[n] for n in numbers], tests=[self.tests[n] for n in numbers]
        )


def force_points(tests):
    """`Points` of all free bodies on which a force makes rows."""
    seen = tests[0].seen
    points = []
    for body in seen.free:
        name = seen.structure.body_names[body]
        for height in HEIGHTS:
            rows = [point_rows(test.seen, name, height) for test in tests]
            if any(point.unit.any() for point in rows):
                points.append(
                    Points(f"{name}@{height:g}", int(body), rows, [test.seen.name for test in tests])
                )
    return points
