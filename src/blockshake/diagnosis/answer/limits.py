"""Sizes from which causes would be seen: known from the rows before any cause is looked for."""

import numpy as np

from blockshake.diagnosis.answer.answer import needed_of, needed_of_slab
from blockshake.diagnosis.answer.places import EVERYWHERE, place_name
from blockshake.diagnosis.evidence.limits import detection_limit
from blockshake.effects.registry import EFFECTS

_USUAL_GAP = 0.02  # m, at which a stop's limit is told


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
    found = {}
    for name, explained in slab.items():
        fit = explained.best
        error = float(np.sqrt(fit.covariance[0, 0]))
        needed = needed_of_slab(name)
        limit = _parameter(
            name, fit.values, error * np.sqrt(2.0 * needed + 2.0 * np.log(fit.scales[0] / error + 1.0))
        )
        if _possible(name, limit):
            found[name] = {EVERYWHERE: limit}
    if evidence is None:
        return found
    none = max(evidence.explained, key=lambda one: one.likelihood.log_evidence).likelihood
    for name in {name: None for name, _ in evidence.tried.variants}:
        variants = {place: own for (effect, place), own in evidence.tried.variants.items() if effect == name}
        needed = needed_of(name, evidence.tests[0].seen.tree) + np.log(len(variants))
        limits = {place: _limit(name, none, own, needed) for place, own in variants.items()}
        found[name] = {place: one for place, one in limits.items() if _possible(name, one)}
    return found


def _possible(name, limit):
    size = EFFECTS[name].parameters[0]
    return size.lower <= limit <= size.upper


def excluded_above(limits, structure):
    """Sizes above which an effect would have been seen wherever it may be, by name; of effects that have one alone."""
    found = {}
    for name, by_place in limits.items():
        effect = EFFECTS[name]
        needed = {place_name(place) for place in effect.places(structure)}
        stated = {place.partition("@")[0] for place in by_place}
        if stated and (needed <= stated or needed == {EVERYWHERE}):
            size = effect.parameters[0]
            found[name] = max(by_place.values(), key=lambda value: abs(value - size.null))
    return found


def _limit(name, likelihood, variants, needed):
    """The smallest of the usual variant, in the effect's own unit; infinite where the rows do not tell it."""
    if variants[0][0].scales is None:  # no amplitude: the smallest variant that would be seen
        for variant in variants:
            whitened = likelihood.whiten([one.rows for one in variant])
            if likelihood.normal_equations(whitened)[1][0, 0] >= 2.0 * needed:
                return _parameter(name, variant[0].values, 1.0)
        return np.inf
    usual = min(variants, key=lambda variant: abs(variant[0].values.get("gap", _USUAL_GAP) - _USUAL_GAP))
    columns = [one.rows[:, 0] for one in usual]
    if not any(rows.any() for rows in columns):
        return np.inf
    size = detection_limit(likelihood, columns, usual[0].scales[0], needed)
    return _parameter(name, usual[0].values, size) if np.isfinite(size) else np.inf


def _parameter(name, values, size):
    if "gap" in values:
        return float(size)
    read = EFFECTS[name].reads(values, np.array([size]), 0.0)
    return float(np.broadcast_to(read[EFFECTS[name].parameters[0].name], 1)[0])
