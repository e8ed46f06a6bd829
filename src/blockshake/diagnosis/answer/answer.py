"""From evidences to an answer: none, a named cause, a set that cannot be distinguished, a combination, or unknown."""

from dataclasses import dataclass

import numpy as np

from blockshake.diagnosis.answer.thresholds import ODDS, score_of
from blockshake.diagnosis.evidence.explanation import mean_evidence
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE
from blockshake.effects.registry import EFFECTS

_MORE_AFTER_SLAB = 10.0  # nats more of a cause in the joints of a slab that has one of its own
_MORE_AFTER_FIRST = 5.0  # nats more of a second cause in the joints
_SHARE_OF_FIRST = 0.1  # of the first one's gain, in addition
_MOST_CAUSES = 3
_LEADING = 4  # effects that are tried with a second one each
COARSENING = 0.05  # share of what it explains that the form of a cause may leave unexplained


@dataclass(frozen=True)
class Alternative:
    """A cause with its best place."""

    cause: str
    place: str
    gain: float  # logarithm of the evidence over none, averaged over the places
    score: float  # the same with the prior, and of a free force the share that a form must explain
    places: tuple  # of str; places that cannot be distinguished


@dataclass(frozen=True)
class Group:
    """Causes that cannot be distinguished in one part of the readings, the most probable first."""

    rivals: tuple  # of Rival
    # odds, gains: str to float; of the first over each cause, as a logarithm, coarsened; and of each over
    # none
    odds: dict
    gains: dict
    asserted: bool = True  # else the evidence of the first is within what tests without any cause give


def rank(evidence, closed=None, joined=(), known=()):
    """`Alternative` by falling score, from `Evidence` or None.

    Parameters
    ----------
    evidence : Evidence or None
    closed : dict of str to float64 array, optional
        By joint, the gain of every compliance from closed joints.
    joined : list of set of str
        Bodies that are one place, from `joined_bodies`.
    known : sequence of Alternative
        Causes that act already: at the places of one of them its cause is no other one.
    """
    gains, taken = {}, {(one.cause, place) for one in known for place in one.places}
    for cause, place in evidence.keys if evidence else ():
        if cause != JOINT_COMPLIANCE.name and (cause, place) not in taken:
            gains.setdefault(cause, {})[place] = evidence.gain((cause, place))
    rivals = [_rival(cause, places, evidence, joined) for cause, places in gains.items()]
    soft = _soft_joints(evidence, closed or {})
    if soft:
        rivals.append(_rival(JOINT_COMPLIANCE.name, soft, None, ()))
    return sorted(rivals, key=lambda one: -one.score)


def _soft_joints(evidence, closed):
    """Gain of a soft layer by joint, of closed and turned joints together.

    The lever of a turned joint follows the layer's law or does not (few asperities): both are averaged.
    """
    turned = {
        place: evidence.gains_of_variants((cause, place))
        for cause, place in (evidence.keys if evidence else ())
        if cause == JOINT_COMPLIANCE.name
    }
    return {
        place: float(mean_evidence(soft_gains(turned.get(place, 0.0), closed.get(place, 0.0))))
        for place in {**turned, **closed}
    }


def soft_gains(turned, closed):
    """Gain of every compliance of one joint, from the gains of the turned and of the closed joint."""
    return np.logaddexp(turned + closed, closed) - np.log(2.0)


def _rival(cause, places, evidence, joined):
    gain = float(mean_evidence(list(places.values())))
    best, *_ = ordered = sorted(places, key=lambda one: -places[one])
    if evidence is None:
        apart = [coarsened(places[best] - places[place], places[best]) for place in ordered]
    else:
        apart = evidence.apart(cause, ordered)
    near = {place for place, odds in zip(ordered, apart, strict=True) if odds < ODDS}
    bodies = {place.partition("@")[0] for place in near}
    near |= {
        place
        for place in ordered
        for group in joined
        if place.partition("@")[0] in group and not bodies.isdisjoint(group)
    }
    near = tuple(place for place in ordered if place in near)
    return Alternative(cause, best, gain, score_of(cause, gain), near)


def find_causes(ranked, needed, in_pairs=False):
    """`Group` by falling strength, each found given the first causes of those before it: rank, compare, add, go on.

    Parameters
    ----------
    ranked : callable
        Of the first `Alternative` of every group found so far: all rivals with them, by falling score.
    needed : callable
        Of the name of a cause and these: the log Bayes factor over none from which the cause is no chance.
    in_pairs : bool
        Whether leading effects are tried with a second one each: ``ranked`` then answers to any first cause.

    Notes
    -----
    A cause that ranks before the first one that is no chance, and whose odds over none would do, is an error that this
    structure's own runs show: it becomes a group that is not asserted, and others are compared with it.

    One cause may take up what two made: the first one is the strongest of those that, each with the effect that comes
    next given it, explain as much as any pair does within the odds that tell.
    """
    groups = []
    while len(groups) < _MOST_CAUSES:
        known = [group.rivals[0] for group in groups]
        rivals = ranked(known)
        strong = [one for one in rivals if one.gain > needed(one.cause, known)]
        if not strong:
            break
        first = next(one for one in rivals if one is strong[0] or one.score > ODDS)
        scores = {rival.cause: rival.score for rival in rivals}
        if in_pairs and first is strong[0] and not known:
            pairs = _pair_scores(strong, scores, ranked, needed)
            most = max(pairs.values())
            likely = (one for one in strong if coarsened(most - pairs.get(one.cause, -np.inf), most) < ODDS)
            first = next(likely)
            scores |= {} if first is strong[0] else pairs
        groups.append(group_of(first, rivals, scores, asserted=first in strong))
    while groups and not groups[-1].asserted:
        groups.pop()
    return groups


def _pair_scores(strong, scores, ranked, needed):
    """Scores of pairs by the name of the first: of the strongest cause, and of the leading effects of the registry.

    Each is paired with what comes next given it: an effect that is weaker alone, by ``scores``, and no chance.
    """
    pairs = {}
    for first in dict.fromkeys([strong[0], *[one for one in strong if one.cause not in FORMS][:_LEADING]]):
        seconds = ranked([first])
        second = next((one for one in seconds if one.score > ODDS), None)
        counts = second and second.gain > needed(second.cause, [first]) and second.cause not in FORMS
        weaker = counts and scores.get(second.cause, 0.0) <= first.score
        pairs[first.cause] = first.score + (second.score if weaker else 0.0)
    return pairs


def group_of(first, ranked, scores=None, asserted=True):
    """`Group` of a cause and all that cannot be distinguished from it, by their own scores or by others, by name."""
    scores = scores or {rival.cause: rival.score for rival in ranked}
    best = scores[first.cause]
    odds = {cause: max(coarsened(best - score, best), 0.0) for cause, score in scores.items()}
    near = [rival for rival in ranked if rival is not first and odds[rival.cause] < ODDS]
    return Group((first, *near), odds, {rival.cause: rival.gain for rival in ranked}, asserted)


def further_need(cause, slab, known=()):
    """Gain that a cause needs beyond the usual one.

    ``slab`` states whether the slab's own motion has a cause, and ``known`` are `Alternative` found in the joints
    before. Two forms from outside are described as one: none is added to another.
    """
    if cause in FORMS and any(one.cause in FORMS for one in known):
        return np.inf
    return (_MORE_AFTER_SLAB if slab else 0.0) + (after(known) if known else 0.0)


def after(known):
    """Gain more that is needed after some `Alternative`: errors of their form."""
    return _MORE_AFTER_FIRST + share_of(known)


def share_of(known):
    """Share of what the `Alternative` found before gain, that one more needs besides: errors of their form."""
    return _SHARE_OF_FIRST * sum(one.gain for one in known)


def slab_groups(explained, thresholds):
    """Pairs of the name of readings and their `Group`: of the slab's rotation and of its vertical motion.

    ``explained`` are `Explanation` by effect.
    """
    groups = []
    for readings, moves in (("rotation of the slab", "turns"), ("vertical motion of the slab", "lifts")):
        rivals = [
            Alternative(name, "all", one.gain, one.gain, ("all",))
            for name, one in explained.items()
            if getattr(EFFECTS[name], moves)
        ]
        ranked = sorted(rivals, key=lambda one: -one.gain)
        if ranked and ranked[0].gain > thresholds.of(ranked[0].cause):
            groups.append((readings, group_of(ranked[0], ranked)))
    return groups


def coarsened(difference, gain):
    """Logarithm of the odds of two causes whose scores differ, the better one gaining ``gain``.

    The likelihood is raised to ``1 / (1 + delta gain / ln 20)``: a form may leave a share delta of what it explains
    (Miller and Dunson 2019, coarsened posteriors).
    """
    return difference / (1.0 + COARSENING * max(gain, 0.0) / ODDS)
