"""All causes beside every likelihood of the rows, and what each gains over none."""

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.evidence.joint_rows import JointRows
from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.diagnosis.evidence.nuisances import expected_rows, nuisance_columns
from blockshake.diagnosis.evidence.row_covariance import row_covariance
from blockshake.diagnosis.evidence.stop_search import explain_stops
from blockshake.diagnosis.outside.blow import explain_blow
from blockshake.diagnosis.outside.changed_edge import explain_changed_edge
from blockshake.diagnosis.outside.following import explain_following
from blockshake.diagnosis.outside.free_force import explain_free_force
from blockshake.diagnosis.outside.loose_weight import explain_loose_weight
from blockshake.diagnosis.outside.points import force_points
from blockshake.diagnosis.outside.push import explain_push
from blockshake.diagnosis.outside.spring_once import explain_spring_once
from blockshake.effects.registry import EFFECTS

NOISES = (0.75, 1.0, 1.3)  # standard deviation of the sensors over the stated one
_UNHEARD = 20.0  # nats: a likelihood that says so much less for the first cause adds nothing
_LOOKED_AT = 4  # causes
_FIRST_LOOK = (1.0,), ((4.0, 0.0),)
DISCREPANCIES = ((1.0, 0.0), (4.0, -3.0), (16.0, -10.0))  # multiple, logarithm of its prior


@dataclass(frozen=True)
class Explained:
    """Explanations of the rows beside one likelihood, by cause and place."""

    likelihood: object
    by_key: dict


def likelihoods(tests, noises=NOISES, discrepancies=DISCREPANCIES):
    """`Likelihood` of tests with rows, by noise and discrepancy."""
    nuisances = nuisance_columns(tests)
    values = [test.rows.value - expected_rows(test) for test in tests]
    return [
        from_rows([row_covariance(test, noise, multiple) for test in tests], values, nuisances, prior)
        for noise in noises
        for multiple, prior in discrepancies
    ]


def heard(tests, points):
    """Likelihoods that matter to any of the best causes of a first look: within 20 nats of the loudest beside it.

    Without a cause beside it, a large force that nobody modelled speaks for the widest errors alone.
    """
    (first,) = likelihoods(tests, *_FIRST_LOOK)
    best = {}
    for one in explain(first, tests, points).by_key.values():
        if one.cause not in best or one.gain > best[one.cause].gain:
            best[one.cause] = one
    among, kept = likelihoods(tests), set()
    for cause in sorted(best.values(), key=lambda one: -one.gain)[:_LOOKED_AT]:
        logs = np.array([one.beside(cause.columns, cause.scales).log_evidence for one in among])
        kept |= set(np.flatnonzero(logs > logs.max() - _UNHEARD))
    return [among[index] for index in sorted(kept)]


def explain(likelihood, tests, points):
    """`Explained` by all causes at all places.

    Parameters
    ----------
    likelihood : Likelihood
    tests : list of JointRows
        Those with rows.
    points : list of Points
        From `force_points`.
    """
    found = [*_by_effects(likelihood, tests), *_from_outside(likelihood, tests, points)]
    return Explained(likelihood, {(one.cause, one.place): one for one in found})


def _by_effects(likelihood, tests):
    structure = tests[0].seen.structure
    for name, effect in EFFECTS.items():
        if effect.columns is None:
            continue
        for place in (effect.seen_at or effect.places)(structure):
            variants = list(zip(*(effect.columns(test.seen, place) for test in tests), strict=True))
            if not any(one.rows.any() for variant in variants for one in variant):
                continue
            search = explain_stops if name == "stopper-contact" else best_of_cause(name)
            yield search(likelihood, place_name(place), variants)


def best_of_cause(name):
    """Search of an effect whose variants have the same prior."""
    return lambda likelihood, place, variants: best_of(likelihood, name, place, variants)


def place_name(place):
    """A place in words: body and height, or a joint; ``all`` where the effect is everywhere."""
    if "joint" in place:
        return "-".join(place["joint"])
    return f"{place['body']}@{place['height']:g}" if "height" in place else place.get("body", "all")


def _from_outside(likelihood, tests, points):
    structure = tests[0].seen.structure
    gravity = float(np.linalg.norm(structure.file.gravity))
    for one in points:
        weight = structure.mass[one.body] * gravity
        yield from explain_following(likelihood, one, weight)
        for search in (explain_push, explain_blow, explain_spring_once):
            yield search(likelihood, one, weight)
    for one in {
        one.body: one for one in points
    }.values():  # the height hardly matters to a force of any history
        yield explain_free_force(likelihood, one)
    for key in sorted({key for test in tests for key in test.hinges}):
        yield explain_changed_edge(likelihood, tests, tests[0].seen.faces[key[0]].name, key)
    top = int(tests[0].seen.free[np.argmax(structure.position[tests[0].seen.free, 2])])
    yield explain_loose_weight(likelihood, tests, structure.body_names[top], top)


@dataclass(frozen=True)
class Evidence:
    """Explanations of all rows beside several likelihoods.

    Attributes
    ----------
    tests : list of JointRows
        Those with rows.
    points : list of Points
        At which forces from outside were tried.
    explained : list of Explained
        By likelihood.
    """

    tests: list
    points: list
    explained: list

    def gain(self, key):
        """Gain of a cause at a place over none, summed over the likelihoods."""
        return float(self._log_sum([one.by_key[key].gain for one in self.explained]))

    def gains_of_variants(self, key):
        """The same of every variant of the cause there, before their average."""
        return self._log_sum([one.by_key[key].gains for one in self.explained])

    def best(self, key):
        """Explanation by a cause at a place beside the likelihood that speaks loudest for it."""
        speaks = [one.by_key[key].gain + one.likelihood.log_evidence for one in self.explained]
        return self.explained[int(np.argmax(speaks))].by_key[key]

    def amplitudes(self, key):
        """Mean and covariance of the best variant's amplitudes at a place, over the likelihoods of that variant."""
        speaks = np.array([one.by_key[key].gain + one.likelihood.log_evidence for one in self.explained])
        values = self.best(key).values
        alike = [one.by_key[key].values == values for one in self.explained]
        weights = np.where(alike, np.exp(speaks - speaks.max()), 0.0)
        weights /= weights.sum()
        parts = [one.by_key[key] for one, weight in zip(self.explained, weights, strict=True) if weight > 0.0]
        weights = weights[weights > 0.0]
        mean = sum(weight * one.mean for weight, one in zip(weights, parts, strict=True))
        spread = sum(
            weight * (one.covariance + np.outer(one.mean - mean, one.mean - mean))
            for weight, one in zip(weights, parts, strict=True)
        )
        return mean, spread

    @property
    def keys(self):
        """Causes and places, tuples of str."""
        return list(self.explained[0].by_key)

    def _log_sum(self, gains):
        logs = np.array([one.likelihood.log_evidence for one in self.explained])
        gains = np.array(gains)
        return logsumexp(gains + logs.reshape(-1, *[1] * (gains.ndim - 1)), axis=0) - logsumexp(logs)

    def beside(self, key):
        """`Evidence` of the causes beside that of a cause at a place, whose columns are nuisances now."""
        speaks = np.array([one.by_key[key].gain + one.likelihood.log_evidence for one in self.explained])
        heard = [
            one for one, says in zip(self.explained, speaks, strict=True) if says > speaks.max() - _UNHEARD
        ]
        return Evidence(
            self.tests,
            self.points,
            [explain(_beside(one, key), self.tests, self.points) for one in heard],
        )


def _beside(explained, key):
    first = explained.by_key[key]
    return explained.likelihood.beside(first.columns, first.scales)


def gather_evidence(seen):
    """`Evidence` of seen tests; None where no test has rows: no joint turned, slipped or lifted.

    Parameters
    ----------
    seen : list of SeenTest
    """
    tests = [JointRows(one) for one in seen if len(one.rows.value)]
    if not tests:
        return None
    points = force_points(tests)
    return Evidence(tests, points, [explain(one, tests, points) for one in heard(tests, points)])
