"""Expected answers: an effect of a size put into the rows of nominal tests, and how surely the decision tells it."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from blockshake.diagnosis.answer.answer import COARSENING, rank
from blockshake.diagnosis.answer.explain import Evidence, Tried, all_tried, explain, likelihoods
from blockshake.diagnosis.answer.limits import SURELY, from_null, limits_of, usual_column
from blockshake.diagnosis.answer.places import EVERYWHERE, joined_bodies, place_of
from blockshake.diagnosis.answer.static_tests import distance, expected_readings
from blockshake.diagnosis.answer.thresholds import ODDS, Thresholds, by_odds
from blockshake.diagnosis.evidence.closed_joints import closed_joints
from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.evidence.joint_rows import JointRows
from blockshake.diagnosis.evidence.likelihood import Likelihood
from blockshake.diagnosis.evidence.nuisances import nuisances_of
from blockshake.diagnosis.evidence.slab_motion import slab_motion, slab_turns
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE
from blockshake.effects.registry import EFFECTS

_AT_LIMIT = 5.5  # standard deviations of an amplitude at its limit, within a tenth for all effects


class NominalCampaign:
    """Nominal tests of one campaign, and the answers that they would give.

    ``limits`` are those of `limits_of`.
    """

    def __init__(self, seen):
        self.seen = seen
        self._rows, self._known = _rows_of(seen), {}
        self._slabs = [slab_motion(test) for test in seen]
        self._closed, self._joined = closed_joints(seen), joined_bodies(seen)
        self.limits = limits_of(self._rows, self._slabs, self._closed, Thresholds())

    def chance_seen(self, name, place, size):
        """Chance to see an effect as far from its null value."""
        limit = self.limits.get(name, {}).get(place)
        away = abs(limit - EFFECTS[name].parameters[0].null) if limit is not None else np.inf
        return float(ndtr(SURELY + _AT_LIMIT * (size / away - 1.0)))

    def chances(self, name, place, size, static=None):
        """Chance to see an effect as far from its null value, under None, and to tell it from each rival, by name.

        ``static`` is a `StaticTest` that is made with. Rivals that show in other readings are left out.
        """
        first, *others = EFFECTS[name].parameters
        true = {first.name: from_null(name, size)} | {one.name: one.null for one in others}
        read, seen, further = self._reads(name, place, true), self.chance_seen(name, place, size), 0.0
        if static:
            alone = np.sqrt(distance(static, read, {}, {}, {}))
            seen = max(seen, float(ndtr(alone - np.sqrt(2.0 * by_odds(name)))))
        chances = {None: seen}
        # no rival depends on the static test
        key = name, place, size
        if key not in self._known:
            self._known[key] = self._rivals(*key)
        for rival, (odds, deviation, where, values) in self._known[key].items():
            if static:
                further = distance(static, read, {}, self._reads(rival, where, values), {})
            sure = (odds + 0.5 * further - ODDS) / np.sqrt(max(deviation**2 + further, 1e-12))
            chances[rival] = min(seen, float(ndtr(sure)))
        return chances

    def _reads(self, cause, place, values):
        return expected_readings(self.seen[0], cause, place_of(cause, place, self.seen[0]), values)

    def _rivals(self, name, place, size):
        """`_odds` of the effect over each rival, and place and parameters of the rival at its best, by cause.

        All are tried on the rows that the effect would make, without noise.
        """
        if EFFECTS[name].columns is None:
            return self._of_slab(name, size) if EFFECTS[name].turns else {}
        soft, rows = name == JOINT_COMPLIANCE.name, self._rows
        if rows is None or (not soft and (name, place) not in rows.tried.variants):
            return {}
        likelihood, variants = rows.usual, rows.tried.variants.get((name, place), [])
        value = np.zeros_like(likelihood.value)
        if soft and variants:
            nearest = min(variants, key=lambda one: abs(np.log(one[0].values["compliance"] / size)))
            value = likelihood.whiten([columns.rows for columns in nearest])[:, 0]
        elif not soft:
            value = size * usual_column(name, variants, likelihood)[0]
        explained = explain(replace(likelihood, value=value), rows.tried)
        closed = {
            joint: one.expected(size * (soft and joint == place)) for joint, one in self._closed.items()
        }
        ranked = {
            rival.cause: rival for rival in rank(Evidence(rows.tried, [explained]), closed, self._joined)
        }
        if name not in ranked:
            return {}
        own, found = ranked.pop(name), {}
        for rival, one in ranked.items():
            odds = _odds(own.gain, own.gain - one.gain, one.score - one.gain - own.score + own.gain)
            found[rival] = *odds, one.place, _values(explained.by_key.get((rival, one.place)))
        return found

    def _of_slab(self, name, size):
        likelihood = slab_turns(self._slabs)
        variants = {
            other: list(zip(*(effect.turns(slab) for slab in self._slabs), strict=True))
            for other, effect in EFFECTS.items()
            if effect.turns
        }
        expected = replace(likelihood, value=size * usual_column(name, variants[name], likelihood)[0])
        explained = {other: best_of(expected, other, EVERYWHERE, tried) for other, tried in variants.items()}
        own = explained.pop(name).gain
        return {
            other: (*_odds(own, own - one.gain), EVERYWHERE, _values(one)) for other, one in explained.items()
        }


class _Rows(NamedTuple):
    """Rows of nominal tests, before any cause is tried on them: what `limits_of` takes of an `Evidence`."""

    tried: Tried
    usual: Likelihood  # the noise model with the largest evidence, which keeps what it computes for one value


def _rows_of(seen):
    """`_Rows` of seen tests; None where no joint turned, slipped or lifted in any test."""
    tests = [JointRows(test) for test in seen if len(test.rows.value)]
    if not tests:
        return None
    usual = max(likelihoods(tests, nuisances_of(tests)), key=lambda one: one.log_evidence)
    return _Rows(all_tried(tests, ()), replace(usual, kept={}))


def _odds(factor, apart, prior=0.0):
    """Coarsened odds of a cause over a less probable rival, and their standard deviation by the sensors' noise.

    ``prior`` is by how much the rival's score exceeds its log Bayes factor more than the cause's does.
    """
    share = 1.0 / (1.0 + COARSENING * max(factor, 0.0) / ODDS)
    return share * (apart - prior), share * np.sqrt(2.0 * max(apart, 0.0))


def _values(explanation):
    """Size of a rival, first, and what else its best variant is."""
    if explanation is None:
        return {}
    fit, effect = explanation.best, EFFECTS.get(explanation.cause)
    size = fit.size[0] if len(fit.mean) else 0.0  # a blow may be in no test
    if effect is None:
        return {"size": size, **fit.values}
    read = effect.reads(fit.values, np.array([size]), 0.0)
    return {key: float(np.broadcast_to(value, 1)[0]) for key, value in read.items()}
