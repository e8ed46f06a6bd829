"""Expected answers: an effect of a size put into the rows of nominal tests, and how surely the decision tells it."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from blockshake.diagnosis.answer.answer import COARSENING, ODDS, needed_of, rank
from blockshake.diagnosis.answer.explain import Evidence, explain, gather_evidence
from blockshake.diagnosis.answer.limits import Visible, distances, usual_column, visible_sizes
from blockshake.diagnosis.answer.places import EVERYWHERE, place_of
from blockshake.diagnosis.answer.static_tests import distance, expected_readings
from blockshake.diagnosis.evidence.closed_joints import closed_joints
from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.evidence.slab_motion import slab_motion, slab_turns
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE
from blockshake.effects.registry import EFFECTS


class Rivalry(NamedTuple):
    """A true effect against one rival: odds expected of it, their standard deviation, and the rival's place and size.

    ``odds`` and ``deviation`` are logarithms, coarsened; ``place`` in words, ``values`` parameters of the rival.
    """

    odds: float
    deviation: float
    place: str
    values: dict


class NominalCampaign:
    """Nominal tests of one campaign, and the answers that they would give.

    Attributes
    ----------
    seen : list of SeenTest
    visible : dict of str to dict of str to Visible
        From `visible_sizes`.
    """

    def __init__(self, seen):
        self.seen = seen
        self._evidence = gather_evidence(seen)
        self._slabs = [slab_motion(test) for test in seen]
        self._closed = closed_joints(seen)
        self.visible = visible_sizes(self._evidence, self._slabs, self._closed)

    def rivals(self, name, place, distance_from_null):
        """`Rivalry` by cause of an effect at a place, whose size is so far from its null value.

        Causes of other readings than the effect's are told from it for nothing, and are left out.
        """
        if place == EVERYWHERE and (EFFECTS[name].turns or EFFECTS[name].lifts):
            return self._of_slab(name, distance_from_null)
        if self._evidence is None or (name != JOINT_COMPLIANCE.name and (name, place) not in self._evidence.keys):
            return {}
        tried = self._evidence.tried
        likelihood = max(self._evidence.explained, key=lambda one: one.likelihood.log_evidence).likelihood
        closed = {joint: one._replace(target=0.0) for joint, one in self._closed.items()}
        value = np.zeros_like(likelihood.value)
        if name == JOINT_COMPLIANCE.name:
            if place in closed:
                information = closed[place].information
                closed[place] = closed[place]._replace(target=distance_from_null * information)
            variants = tried.variants.get((name, place), [])
            nearest = min(
                variants, key=lambda one: abs(np.log(one[0].values["compliance"] / distance_from_null)), default=None
            )
            if nearest:
                value = likelihood.whiten([columns.rows for columns in nearest])[:, 0]
        else:
            value = distance_from_null * usual_column(name, tried.variants[name, place], likelihood)[0]
        evidence = Evidence(tried, [explain(replace(likelihood, value=value), tried)])
        ranked = rank(evidence, {joint: one.gains for joint, one in closed.items()})
        own = next((rival for rival in ranked if rival.cause == name), None)
        if own is None:
            return {}
        return {
            rival.cause: _rivalry(own.score - rival.score, own.gain - rival.gain, own.gain, rival.place, evidence, rival)
            for rival in ranked
            if rival is not own
        }

    def _of_slab(self, name, size):
        if not EFFECTS[name].turns:
            return {}
        likelihood = slab_turns(self._slabs)
        variants = {
            other: list(zip(*(effect.turns(slab) for slab in self._slabs), strict=True))
            for other, effect in EFFECTS.items()
            if effect.turns
        }
        true = usual_column(name, variants[name], likelihood)[0]
        expected = replace(likelihood, value=size * true)
        explained = {other: best_of(expected, other, EVERYWHERE, tried) for other, tried in variants.items()}
        gains = {other: one.gain for other, one in explained.items()}
        return {
            other: Rivalry(*_odds(gains[name] - gain, gains[name] - gain, gains[name]), EVERYWHERE, _values(explained[other]))
            for other, gain in gains.items()
            if other != name
        }

    def visible_at(self, name, place):
        """`Visible` of an effect at a place; of no chance where these tests tell nothing of it."""
        grid = distances(name)
        return self.visible.get(name, {}).get(place) or Visible(grid, np.full_like(grid, -np.inf), {})

    def chance_seen(self, name, place, size, static=None):
        """Chance that an effect of a size is seen by the tests, or by a `StaticTest` beside them."""
        one = self.visible_at(name, place)
        chance = float(ndtr(np.interp(np.log(size), np.log(one.distance), one.sigmas)))
        if static is None:
            return chance
        alone = np.sqrt(distance(static, self._reads(name, place, self._true(name, size)), {}, {}, {}))
        return max(chance, float(ndtr(alone - np.sqrt(2.0 * needed_of(name)))))

    def chance_apart(self, name, place, size, rival, static=None):
        """Chance that an effect is told from a rival, a pair of its name and `Rivalry`, with a `StaticTest` beside."""
        cause, one = rival
        further = 0.0
        if static is not None:
            true = self._reads(name, place, self._true(name, size))
            further = distance(static, true, {}, self._reads(cause, one.place, one.values), {})
        sure = (one.odds + 0.5 * further - ODDS) / np.sqrt(max(one.deviation**2 + further, 1e-12))
        return float(ndtr(sure))

    def _true(self, name, size):
        first = EFFECTS[name].parameters[0]
        usual = {one.name: one.null for one in EFFECTS[name].parameters[1:]}
        return {first.name: first.null + np.sign(first.visible - first.null) * size, **usual}

    def _reads(self, cause, place, values):
        return expected_readings(self.seen[0], cause, place_of(cause, place, self.seen[0]), values)


def _odds(score, gain, own):
    share = 1.0 / (1.0 + COARSENING * max(own, 0.0) / ODDS)
    return share * score, share * np.sqrt(2.0 * max(gain, 0.0))


def _rivalry(score, gain, own, place, evidence, rival):
    explanation = evidence.explained[0].by_key.get((rival.cause, place))
    values = _values(explanation) if explanation else {}
    return Rivalry(*_odds(score, gain, own), place, values)


def _values(explanation):
    """Size of a rival, first, and what else its best variant is."""
    fit, effect = explanation.best, EFFECTS.get(explanation.cause)
    size = float(fit.contrast @ fit.mean) if len(fit.mean) else 0.0  # a blow may be in no test
    if effect is None:
        return {"size": size, **fit.values}
    read = effect.reads(fit.values, np.array([size]), 0.0)
    return {key: float(np.broadcast_to(value, 1)[0]) for key, value in read.items()}
