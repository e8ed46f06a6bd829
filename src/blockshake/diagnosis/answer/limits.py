"""Sizes from which causes would be seen, before any cause is looked for; and motions that the sensors do not show."""

import numpy as np

from blockshake.diagnosis.answer.answer import needed_of, needed_of_slab
from blockshake.diagnosis.answer.places import EVERYWHERE, place_name
from blockshake.effects.registry import EFFECTS
from blockshake.measurement.motion.body_poses import PLANAR, POSE

_USUAL_GAP = 0.02  # m, at which a stop's limit is told
_LOST = 0.1  # of a test, for which a motion may be unknown without a word


def limits_of(evidence, slab):
    """Sizes from which effects would be seen, by effect and place.

    Parameters
    ----------
    evidence : Evidence or None
    slab : dict of str to Explanation

    Returns
    -------
    dict of str to dict of str to float
        Of the effect's first parameter, in its unit; only places where the tests tell it.
    """
    limits_by_name = {}
    for name, explained in slab.items():
        fit = explained.best
        error = float(np.sqrt(fit.covariance[0, 0]))
        needed = needed_of_slab(name)
        limit = _parameter(
            name, fit.values, error * np.sqrt(2.0 * needed + 2.0 * np.log(fit.scales[0] / error + 1.0))
        )
        if _possible(name, limit):
            limits_by_name[name] = {EVERYWHERE: limit}
    if evidence is None:
        return limits_by_name
    loudest = max(evidence.explained, key=lambda one: one.likelihood.log_evidence).likelihood
    tried = {}
    for (name, place), variants in evidence.tried.variants.items():
        tried.setdefault(name, {})[place] = variants
    for name, by_place in tried.items():
        needed = needed_of(name, evidence.tests[0].seen.tree) + np.log(len(by_place))
        limits = {place: _limit(name, loudest, variants, needed) for place, variants in by_place.items()}
        limits_by_name[name] = {place: limit for place, limit in limits.items() if _possible(name, limit)}
    return limits_by_name


def _possible(name, limit):
    size = EFFECTS[name].parameters[0]
    return size.lower <= limit <= size.upper


def excluded_above(limits, structure):
    """Sizes above which an effect would have been seen wherever it may be, by name; of effects that have one alone."""
    sizes = {}
    for name, by_place in limits.items():
        effect = EFFECTS[name]
        needed = {place_name(place) for place in effect.places(structure)}
        stated = {place.partition("@")[0] for place in by_place}
        if stated and (needed <= stated or needed == {EVERYWHERE}):
            size = effect.parameters[0]
            sizes[name] = max(by_place.values(), key=lambda value: abs(value - size.null))
    return sizes


def _limit(name, likelihood, variants, needed):
    """The size, in the effect's own unit, at which the gain reaches what is needed; infinite where no row tells it.

    With the standard deviation s of the amplitude, nuisances free, an amplitude a gains
    ``a^2 / (2 s^2) - ln(1 + scale^2 / s^2) / 2`` in the mean. It is that of the usual variant; of an effect without an
    amplitude the smallest variant that would be seen.
    """
    if variants[0][0].scales is None:
        for variant in variants:
            if _gram(likelihood, variant) >= 2.0 * needed:
                return _parameter(name, variant[0].values, 1.0)
        return np.inf
    usual = min(variants, key=lambda variant: abs(variant[0].values.get("gap", _USUAL_GAP) - _USUAL_GAP))
    gram = _gram(likelihood, usual)
    if not gram > 0.0:
        return np.inf
    size = float(np.sqrt((2.0 * needed + np.log1p(gram * usual[0].scales[0] ** 2)) / gram))
    return _parameter(name, usual[0].values, size)


def _gram(likelihood, variant):
    """One over the variance of a variant's first amplitude, nuisances free."""
    return float(
        likelihood.normal_equations(likelihood.whiten([columns.rows[:, :1] for columns in variant]))[1][0, 0]
    )


def _parameter(name, values, size):
    if "gap" in values:
        return float(size)
    read = EFFECTS[name].reads(values, np.array([size]), 0.0)
    return float(np.broadcast_to(read[EFFECTS[name].parameters[0].name], 1)[0])


def cannot_see(seen_tests):
    """Lines on motions and joints of seen tests that the sensors do not show.

    There is none where every motion of every body is read in every test, and every joint has moved in some test.
    """
    resting = [seen for seen in seen_tests if seen.still.any()]
    lines = [
        f"{seen.name}: no quiet start, from which its readings would count; nothing of it is judged"
        for seen in seen_tests
        if not seen.still.any()
    ]
    if not resting:
        return lines
    lines += [line for body in range(len(resting[0].structure.mass)) for line in _of_body(resting, body)]
    if len(resting) == 1:
        lines.append(f"{resting[0].name} alone: a cause that acts once is not told from one that lasts")
    if not resting[0].tree:
        lines.append("bodies that stand on several joints: the force of each joint is known in part")
    return [*lines, *_of_joints(resting)]


def _of_body(tests, body):
    name, driven = tests[0].structure.body_names[body], tests[0].structure.driven[body]
    known = {seen.motion.known[body] for seen in tests}
    if not known <= {POSE, PLANAR}:
        lost = "a pitch of the table and a soft base are" if driven else "forces of the joints at it are"
        yield f"{name}: its rotation is not read; {lost} not judged"
        return
    if PLANAR in known and not driven:
        yield f"{name}: turns out of the plane of shaking are not read, and taken as none"
    lost = max(float(np.mean(~np.isfinite(seen.required.wrench[:, body]).all(axis=1))) for seen in tests)
    if lost > _LOST:
        yield f"{name}: its motion is unknown for up to {100.0 * lost:.0f} % of a test"


def _of_joints(tests):
    for index, face in enumerate(tests[0].faces):
        read = [seen for seen in tests if np.isfinite(seen.forces.force[:, index]).any()]
        moved = any(
            seen.states.edge[:, index].any()
            or seen.states.slip[:, index].any()
            or seen.states.lifted[:, index].any()
            for seen in read
        )
        if read and not moved:
            yield f"{face.name}: turned, slipped and lifted in no test; of its causes a soft layer alone would show"
