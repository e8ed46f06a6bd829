"""The decision on seen tests: evidences of all causes ranked, the answer with its sizes, and what was seen of it."""

from functools import cache
from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.answer.answer import (
    coarsened,
    find_causes,
    further_need,
    rank,
    slab_groups,
    soft_gains,
)
from blockshake.diagnosis.answer.decision import Cause, Decision, Part
from blockshake.diagnosis.answer.departures import departures, departures_of_no_test, largest, slab_departures
from blockshake.diagnosis.answer.explain import EVERY, gather_evidence
from blockshake.diagnosis.answer.held_out import held_out_rows, held_out_slab
from blockshake.diagnosis.answer.history import histories, of_last_test
from blockshake.diagnosis.answer.limits import cannot_see, excluded_above, limits_of
from blockshake.diagnosis.answer.next_test import next_tests
from blockshake.diagnosis.answer.places import EVERYWHERE, joined_bodies, place_of
from blockshake.diagnosis.answer.size import members_of, size_of
from blockshake.diagnosis.answer.thresholds import RATE, Thresholds, by_odds
from blockshake.diagnosis.evidence.angular_momentum_ratio import restitution_gain
from blockshake.diagnosis.evidence.closed_joints import closed_joints
from blockshake.diagnosis.evidence.explanation import Fit, mean_evidence
from blockshake.diagnosis.evidence.slab_motion import explain_slab, slab_motion
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.impact_restitution import EFFECT as RESTITUTION
from blockshake.effects.joint_compliance import COMPLIANCES
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE
from blockshake.effects.registry import EFFECTS, title_of

_JOINTS = "joints", "joints, beside the first"
_BY_ODDS = Thresholds()
_NOT_SHOWN = "no departure larger than chance"


class Decided(NamedTuple):
    """A decision, and for the report what was measured and explained, from `departures` and `slab_departures`."""

    decision: Decision
    evidence: xr.Dataset


def decide(seen, without=(), unseen=(), thresholds=_BY_ODDS, select=()):
    """`Decided`: what the tests support.

    Parameters
    ----------
    seen : list of ReconstructedTest
        Open tests, at least one.
    without : sequence of str
        Effects that are left out, as if nobody had thought of them.
    unseen : sequence of str
        Lines on tests of which nothing was read.
    thresholds : Thresholds
        Evidence that every cause needs.
    select : sequence of str
        Names of the tests to select by, on which the chosen causes are tested.
    """
    joints = {} if JOINT_COMPLIANCE.name in without else closed_joints(seen)
    closed = {name: joint.gains for name, joint in joints.items()}
    slabs = [slab_motion(test) for test in seen]
    slab = explain_slab(slabs, without)
    of_slab = slab_groups(slab, thresholds)
    stages, groups = _in_joints(seen, gather_evidence(seen, without), closed, bool(of_slab), thresholds)
    fitted, explained = _together(stages, groups)
    acting = [
        _part(group, seen, evidence, {} if number else closed, held_out=held_out_rows(stage, group, select))
        for number, (group, evidence, stage) in enumerate(
            zip(groups, fitted, stages[: len(groups)], strict=True)
        )
        if group.asserted
    ]
    acting = [part.model_copy(update={"readings": _JOINTS[min(n, 1)]}) for n, part in enumerate(acting)]
    explained = [one for one, group in zip(explained, groups, strict=False) if group.asserted]
    evidence, given_first = stages[0], stages[1] if stages[1:] else None
    first = groups[0].rivals[0] if groups and groups[0].asserted else None
    paths = histories(evidence, given_first, first, seen[0])
    if first:
        acting[0] = _with_last_sizes(acting[0], paths)
    by_name = {test.name: motion for test, motion in zip(seen, slabs, strict=True)}
    for readings, group in of_slab:
        held_out = held_out_slab(by_name, group, slab, select, without)
        acting.append(_part(group, seen, None, {}, slab, readings, held_out))
    impacts = restitution_gain(seen)
    if impacts.gain > thresholds.of(RESTITUTION.name) and RESTITUTION.name not in without:
        acting.append(_of_impacts(impacts))
    parts = tuple(sorted(acting, key=lambda part: -part.causes[0].gain))
    shown = departures(seen, evidence, explained)
    limits = limits_of(evidence, slabs, joints, thresholds, without)
    decision = Decision(
        decision=kind_of(parts),
        parts=parts,
        probabilities=probabilities(parts, without),
        limits=limits,
        excluded_above=excluded_above(limits, seen[0].structure),
        p=min(1.0, sum(map(chance, parts))) if parts else 1.0,
        where=largest(shown) if parts else _NOT_SHOWN,
        tests=[test.name for test in seen],
        silent=[test.name for test in seen if not len(test.rows.value)],
        n_rows=sum(len(test.rows.value) for test in seen),
        impacts=impacts.statement,
        cannot_see=(
            *unseen,
            *_by_chance(stages[0], closed, thresholds, groups),
            *cannot_see(seen),
        ),
        clean_runs=thresholds.runs,
        thresholds={name: thresholds.of(name) for name in sorted({*EVERY, *EFFECTS} - set(without))},
        histories=paths,
    )
    return Decided(decision, shown.merge(slab_departures(seen, slabs, slab, parts)))


def undecided(structure, without, unseen):
    """`Decided` of a campaign of which no test shows any forces: no cause, and why nothing was read."""
    decision = Decision(
        decision="none",
        parts=(),
        probabilities=probabilities((), without),
        limits={},
        excluded_above={},
        p=1.0,
        where="no test shows any forces",
        tests=(),
        silent=(),
        n_rows=0,
        cannot_see=tuple(unseen),
    )
    return Decided(decision, departures_of_no_test(structure))


def _by_chance(evidence, closed, thresholds, groups):
    """Lines on causes in the joints whose odds would do, but whose evidence simulated tests without any reach."""
    asserted = groups and groups[0].asserted
    return [
        f"{_title(one.cause)}: evidence of {one.gain:.0f} nats is not enough; of {thresholds.runs} simulated campaigns "
        f"without a cause, {100.0 * RATE:.0f} % are expected above {thresholds.of(one.cause):.0f} nats"
        for one in ([] if asserted else rank(evidence, closed))
        if by_odds(one.cause) < one.gain <= thresholds.of(one.cause)
    ]


def _title(cause):
    return FORMS[cause].title if cause in FORMS else title_of(cause)


def _in_joints(seen, evidence, closed, slab, thresholds):
    """Lists of `Evidence`, each given the first cause of one group more, and of `Group`; see `find_causes`.

    ``closed`` is as of `rank`, and ``slab`` states whether the slab's own motion has a cause.
    """
    joined = joined_bodies(seen)

    @cache
    def stage(*known):
        if not known:
            return evidence
        last, key = stage(*known[:-1]), known[-1]
        if last is None or key not in last.keys:  # it shows in closed joints alone
            return None
        return last.plausible(key).given([last.best(key)])

    def given(known):
        return stage(*((one.cause, one.place) for one in known))

    def ranked(known):
        if not known:
            return rank(evidence, closed, joined)
        return rank(given(known), {}, joined, known)

    def needed(cause, known):
        return thresholds.of(cause) + further_need(cause, slab, known)

    groups = find_causes(ranked, needed, in_pairs=True)
    firsts = [group.rivals[0] for group in groups]
    stages = [given(firsts[:count]) for count in range(len(firsts) + 1)]
    return [evidence, *(one for one in stages[1:] if one)], groups


def _together(stages, groups):
    """`Evidence` of the causes of every group given the first ones of all others, and the `Explanation` of its first.

    So sizes are those of the joint posterior. A group whose cause shows in closed joints alone has no explanation.
    """
    keys = [(group.rivals[0].cause, group.rivals[0].place) for group in groups]
    found = [stage.best(key) for stage, key in zip(stages, keys, strict=False) if stage and key in stage.keys]
    fitted = list(stages[: len(groups)])
    for number, group in enumerate(groups[:-1]):
        if len(found) == len(groups):
            causes = {rival.cause for rival in group.rivals}
            others = [one for other, one in enumerate(found) if other != number]
            fitted[number] = stages[0].plausible(keys[0]).given(others, causes)
            found[number] = fitted[number].best(keys[number])
    return fitted, found


def _with_last_sizes(part, paths):
    """The `Part` with its first cause as large as in the last test, where the cause changes from test to test."""
    first, *others = part.causes
    for path in paths:
        if path.quantity == first.name and path.changes:
            first = of_last_test(first, path)
    return part.model_copy(update={"causes": (first, *others)})


def _of_impacts(impacts):
    """`Part` of impacts that lose less than any undamaged model; by how much the solvers' restitution is unknown."""
    name, gain = RESTITUTION.name, impacts.gain
    cause = Cause(name=name, place={}, places=(EVERYWHERE,), gain=gain, odds=0.0, parameters={}, members=())
    return Part(readings="impacts", causes=(cause,), odds={name: 0.0}, gains={name: gain})


def chance(part):
    """Largest chance of as much without a cause: a mean of evidence ratios exceeds x with the chance 1 / x at most."""
    gains = np.array(list(part.gains.values()))
    return float(np.exp(-min(mean_evidence(gains), 700.0)))


def kind_of(parts):
    """Kind of the answer; an outside form alone is unknown, in a part of its own next to an effect a combination."""
    if not parts:
        return "none"
    effects = {cause.name for part in parts for cause in part.effects}
    if not effects:
        return "unknown"
    if any(part.effects and len(part.causes) > 1 for part in parts):
        return "ambiguous"
    return "named" if len(effects) == 1 and all(part.effects for part in parts) else "combination"


def probabilities(parts, without):
    """Probability of every effect in its part, among all rivals and nothing, from coarsened odds; 0 of all others."""
    found = {name: 0.0 for name in EFFECTS if name not in without}
    for part in parts:
        best = part.causes[0].gain
        none = coarsened(best, best)
        total = float(np.exp(-none)) + sum(float(np.exp(-odds)) for odds in part.odds.values())
        for name, odds in part.odds.items():
            if name in found:
                found[name] = max(found[name], float(np.exp(-odds)) / total)
    return found


def _part(group, seen, evidence, closed, slab=None, readings=_JOINTS[0], held_out=None):
    causes = []
    for rival in group.rivals:
        fits, logs = _fits(rival, [rival.place], evidence, closed, slab)
        alike = _fits(rival, rival.places, evidence, closed, slab)
        best = fits[int(np.argmax(logs))]
        causes.append(
            Cause(
                name=rival.cause,
                place=place_of(rival.cause, rival.place, seen[0]),
                places=rival.places,
                gain=rival.gain,
                odds=group.odds[rival.cause],
                parameters=size_of(rival.cause, rival.place, (fits, logs), alike),
                members=members_of(rival.cause, rival.place, fits, logs),
                when=best.values,
                amplitudes=best.mean.tolist(),
            )
        )
    measurements = next_tests(causes, seen, evidence)
    return Part(
        readings=readings, causes=causes, odds=group.odds, gains=group.gains, next_tests=measurements,
        held_out=held_out,
    )  # fmt: skip


def _fits(rival, places, evidence, closed, slab):
    """Fits of a rival at some of its places, and the logarithms of their weights."""
    if slab is not None:
        explained = slab[rival.cause]
        return explained.fits, np.array([fit.gain for fit in explained.fits])
    if rival.cause != JOINT_COMPLIANCE.name:
        return evidence.fits(rival.cause, places)
    key = rival.cause, rival.place
    turned = evidence.gains_of_variants(key) if evidence and key in evidence.keys else 0.0
    gains = soft_gains(turned, closed.get(rival.place, 0.0)) * np.ones(len(COMPLIANCES))
    fits = [
        Fit({"compliance": float(value)}, float(gain), [], np.ones(1), np.ones(1), np.zeros((1, 1)))
        for value, gain in zip(COMPLIANCES, gains, strict=True)
    ]
    return fits, gains
