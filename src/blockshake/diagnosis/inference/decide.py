"""The rule of decision: none, one name, a set, two effects together, or an effect that no candidate explains."""

import numpy as np

from blockshake.diagnosis.inference.calibration import (
    as_case,
    best_place,
    chance_of,
    chance_of_constancy,
    chance_of_distance,
    chance_of_none,
    detected,
    shown_above,
    size_error,
)
from blockshake.diagnosis.inference.decision import (
    FALSE_ALARM,
    INADEQUATE,
    INCONSTANT,
    NOT_IN_SET,
    CandidateScore,
    Decision,
    SizeRange,
)
from blockshake.diagnosis.inference.posterior import calibrated_weights, parameter_estimates
from blockshake.diagnosis.libraries.candidates import effect_of

PLACEBOS = 19  # none of which may explain more than a cause does: a chance of 5 %
SEPARABLE = 4.0  # log ratio that two models must differ by (Sivula et al. 2020), and a second effect add
_FIRSTS_OF_A_PAIR = 3  # strongest effects that are tried with a second one beside them
_UNLIKELY = 2.0  # log density below the largest, by which a test's own sizes end: a factor e^2


def decide(library, features, cases, places_of):
    """Decide on readings, at levels that the library's own cases calibrate.

    Parameters
    ----------
    library : ScoreLibrary
    features : list of float64 array, shape (n_features,)
        Measured, by test, tamed.
    cases : list of ScoredReadings
        From `library_cases`, of the same tests.
    places_of : dict of str to dict
        By key of a candidate: its place in the structure.

    Returns
    -------
    Decision

    Notes
    -----
    Class-conditional (Mondrian) conformal prediction (Vovk, Gammerman and Shafer 2005): an effect that is the truth
    and is detected at all is in the set with at least 90 %. An effect is struck out if its best fit is worse than
    where it is the truth, if it needs another size in each test, or if it explains no more than meaningless
    candidates do. Where none is left, the strongest is corrected for and the others are tried again beside it. If
    that leaves too much as well, the cause is unknown.
    """
    scores = library.score(features)
    case = as_case(scores)
    p_none = chance_of_none(case, cases)
    seen = detected(cases, FALSE_ALARM)
    effects = sorted(case.shortfall, key=case.shortfall.get)
    places = {effect: best_place(scores, effect) for effect in effects}
    looked_at = {
        "p_none": p_none,
        "probabilities": {effect: chance_of(effect, case, seen) for effect in effects},
        "adequacy": {effect: chance_of_distance(effect, case.distance[effect], seen) for effect in effects},
        "constancy": {effect: chance_of_constancy(effect, case, seen) for effect in effects},
        "placebo": float(library.placebo_ratios(features, PLACEBOS).max()),
    }
    kind, causes, sizes, struck_out = "none", [], {}, {}
    if p_none <= FALSE_ALARM:
        struck_out = {
            effect: _reasons(effect, looked_at, scores.log_ratio[places[effect]]) for effect in effects
        }
        causes = [effect for effect in effects if not struck_out[effect]]
        sizes = {effect: scores.size[places[effect]] for effect in causes}
        kind = {0: "unknown", 1: "named"}.get(len(causes), "ambiguous")
        pair = None if causes else _pair(library, features, effects[:_FIRSTS_OF_A_PAIR], scores, places, seen)
        if pair:
            kind, causes = "combination", list(pair)
            places |= {effect: key for effect, (key, _) in pair.items()}
            sizes = {effect: size for effect, (_, size) in pair.items()}
    # beside the first effect of a combination, the size of the second is a single estimate
    sized = causes[:1] if kind == "combination" else causes
    above = {effect: shown_above(effect, cases, seen) for effect in effects}
    return Decision(
        decision=kind,
        causes=causes,
        places=places,
        sizes=sizes,
        **looked_at,
        struck_out={effect: why for effect, why in struck_out.items() if effect not in causes},
        solver_dependent=_dissenting(library.models, causes, scores) if kind == "named" else [],
        shown_above={effect: None if np.isnan(size) else size for effect, size in above.items()},
        nominal_distance=scores.distance["nominal"],
        parameters={effect: _parameters(effect, places[effect], scores, seen) for effect in sized},
        location={effect: places_of[places[effect]] for effect in causes},
        candidates=[
            _row(key, scores) for key in sorted(scores.log_ratio, key=scores.log_ratio.get, reverse=True)
        ],
    )


def _parameters(effect, key, scores, seen):
    posterior = calibrated_weights(scores.sizes[key], scores.weights[key], size_error(effect, seen))
    return parameter_estimates(effect, scores.sizes[key], posterior)


def _row(key, scores):
    return CandidateScore(
        key=key,
        effect=effect_of(key),
        log_ratio=scores.log_ratio[key],
        by_model=scores.by_model[key],
        size=scores.size[key],
        sizes=scores.sizes[key].tolist(),
        weights=scores.weights[key].tolist(),
        model=scores.model[key],
        distance=scores.distance[key],
        by_test=[_own_size(scores.sizes[key], densities) for densities in scores.by_test[key]],
    )


def _own_size(sizes, densities):
    """Size that one test by itself finds likeliest, with the ends of the sizes that are hardly less likely."""
    likely = sizes[densities >= densities.max() - _UNLIKELY]
    return SizeRange(estimate=sizes[densities.argmax()], lower=likely.min(), upper=likely.max())


def _reasons(effect, looked_at, log_ratio):
    """Reasons for which an effect is no cause; empty if it may be one."""
    reasons = []
    if looked_at["probabilities"][effect] <= NOT_IN_SET:
        reasons.append("another effect explains more")
    if looked_at["adequacy"][effect] <= INADEQUATE:
        reasons.append("its best fit leaves too much")
    if looked_at["constancy"][effect] <= INCONSTANT:
        reasons.append("it would need another size in each test")
    if log_ratio <= looked_at["placebo"]:
        reasons.append("it explains no more than a placebo")
    return reasons


def _pair(library, features, firsts, scores, places, seen):
    """Two effects that together leave little enough, as effect to (key, size); None if there are none."""
    found = []
    for first in firsts:
        key, size = places[first], scores.size[places[first]]
        beside = library.score_beside(features, key, size)
        if not beside.log_ratio:
            continue
        other = max(beside.log_ratio, key=beside.log_ratio.get)
        second = effect_of(other)
        adequate = chance_of_distance(second, beside.distance[other], seen) > INADEQUATE
        if beside.log_ratio[other] > SEPARABLE and adequate:
            together = scores.log_ratio[key] + beside.log_ratio[other]
            found.append((together, {first: (key, size), second: (other, beside.size[other])}))
    return max(found, key=lambda item: item[0])[1] if found else None


def _dissenting(models, causes, scores):
    """Solvers by which alone another effect explains clearly more than the cause."""
    (cause,) = causes
    dissenting = []
    for model in models:
        alone = {key: ratios[model] for key, ratios in scores.by_model.items()}
        own = max(ratio for key, ratio in alone.items() if effect_of(key) == cause)
        if max(alone.values()) - own > SEPARABLE or own <= 0.0:
            dissenting.append(model)
    return dissenting
