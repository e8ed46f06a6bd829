"""The decision: none, one name, a set, two effects together, or that none of the known effects explains the tests."""

from dataclasses import dataclass

from blockshake.diagnosis.calibration import (
    as_case,
    best_place,
    chance_of,
    chance_of_constancy,
    chance_of_distance,
    chance_of_none,
    detected,
    shown_above,
)
from blockshake.diagnosis.candidates import effect_of

FALSE_ALARM = 0.05  # level at which readings are called an effect
NOT_IN_SET = 0.10  # level below which an effect leaves the set
INADEQUATE = 0.05  # level below which even the best fit of an effect leaves too much
INCONSTANT = 0.05  # level below which an effect compensates for another, rather than being the cause
PLACEBOS = 19  # none of which may explain more than a cause does: a chance of 5 %
SEPARABLE = 4.0  # log ratio that two models must differ by (Sivula et al. 2020), and a second effect add
_FIRST = 3  # strongest effects that are tried with a second one beside them


@dataclass(frozen=True)
class Decision:
    """What the scores say.

    Attributes
    ----------
    decision : str
        ``none``, ``named``, ``ambiguous``, ``combination`` or ``unknown``.
    causes : list of str
        Effects that are not excluded, the likeliest first.
    places : dict of str to str
        By effect: key of the candidate that stands for it.
    sizes : dict of str to float
        By cause: its best size, in units of the visible one.
    p_none : float
        Chance of scores like these without an effect [1].
    probabilities : dict of str to float
        By effect: its conformal p value [1].
    adequacy : dict of str to float
        By effect: chance of as bad a best fit where it is the truth [1].
    constancy : dict of str to float
        By effect: chance of sizes that differ as much from test to test [1].
    placebo : float
        Largest log ratio of a candidate that means nothing [1].
    struck_out : dict of str to list of str
        By effect: why it is not among the causes, in words.
    solver_dependent : list of str
        Solvers by which alone another effect than the named one explains more.
    shown_above : dict of str to float
        By effect: size from which on nine in ten would have been seen, in units of the visible one; NaN: none.
    """

    decision: str
    causes: list
    places: dict
    sizes: dict
    p_none: float
    probabilities: dict
    adequacy: dict
    constancy: dict
    placebo: float
    struck_out: dict
    solver_dependent: list
    shown_above: dict


def decide(library, features, cases):
    """Decision on readings, at levels that the library's own cases calibrate.

    Parameters
    ----------
    library : ScoreLibrary
    features : list of float64 array, shape (n_features,)
        Measured, by test, tamed.
    cases : list of Case
        From `library_cases`, of the same tests.

    Returns
    -------
    decision : Decision
    scores : Scores
        Of the measured tests.

    Notes
    -----
    Class-conditional (Mondrian) conformal prediction (Vovk, Gammerman and Shafer 2005): where an effect is the truth
    and is detected at all, it is in the set with at least 90 %. An effect whose best fit is worse than where it is the
    truth explains nothing, whatever its rivals; neither does one that needs another size in each test, or that explains
    no more than meaningless candidates do. Where none is left, the strongest is corrected for and the others are
    tried again beside it; if that leaves too much as well, the answer is that the cause is unknown.
    """
    scores = library.score(features)
    case = as_case(scores)
    p_none = chance_of_none(case, cases)
    seen = detected(cases, FALSE_ALARM)
    effects = sorted(case.shortfall, key=case.shortfall.get)
    places = {effect: best_place(scores, effect) for effect in effects}
    found = Decision(
        decision="none",
        causes=[],
        places=places,
        sizes={},
        p_none=p_none,
        probabilities={effect: chance_of(effect, case, seen) for effect in effects},
        adequacy={effect: chance_of_distance(effect, case.distance[effect], seen) for effect in effects},
        constancy={effect: chance_of_constancy(effect, case, seen) for effect in effects},
        placebo=float(library.placebo_ratios(features, PLACEBOS).max()),
        struck_out={},
        solver_dependent=[],
        shown_above={effect: shown_above(effect, cases, seen) for effect in effects},
    )
    if p_none > FALSE_ALARM:
        return found, scores
    struck_out = {effect: _reasons(effect, found, scores) for effect in effects}
    causes = [effect for effect in effects if not struck_out[effect]]
    sizes = {effect: scores.size[places[effect]] for effect in causes}
    decision = {0: "unknown", 1: "named"}.get(len(causes), "ambiguous")
    if not causes:
        pair = _pair(library, features, effects[:_FIRST], scores, places, seen)
        if pair:
            decision, causes = "combination", list(pair)
            places |= {effect: key for effect, (key, _) in pair.items()}
            sizes = {effect: size for effect, (_, size) in pair.items()}
    return Decision(
        **{
            **vars(found),
            "decision": decision,
            "causes": causes,
            "places": places,
            "sizes": sizes,
            "struck_out": {effect: why for effect, why in struck_out.items() if effect not in causes},
            "solver_dependent": _dissenting(library.models, causes, scores) if decision == "named" else [],
        }
    ), scores


def _reasons(effect, found, scores):
    """Why an effect is no cause; empty if it may be one."""
    reasons = []
    if found.probabilities[effect] <= NOT_IN_SET:
        reasons.append("another effect explains more")
    if found.adequacy[effect] <= INADEQUATE:
        reasons.append("its best fit leaves too much")
    if found.constancy[effect] <= INCONSTANT:
        reasons.append("it would need another size in each test")
    if scores.log_ratio[found.places[effect]] <= found.placebo:
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
