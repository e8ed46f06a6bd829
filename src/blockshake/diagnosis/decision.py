"""The decision: none, one name, a set, or that none of the known effects explains the tests."""

from dataclasses import dataclass

from blockshake.diagnosis.calibration import (
    as_case,
    chance_of,
    chance_of_distance,
    chance_of_none,
    detected,
    shown_above,
)

FALSE_ALARM = 0.05  # level at which readings are called an effect
NOT_IN_SET = 0.10  # level below which an effect leaves the set
INADEQUATE = 0.05  # level below which even the best fit of an effect leaves too much


@dataclass(frozen=True)
class Decision:
    """What the scores say.

    Attributes
    ----------
    decision : str
        ``none``, ``named``, ``ambiguous`` or ``unknown``.
    causes : list of str
        Effects that are not excluded, the likeliest first.
    p_none : float
        Chance of scores like these without an effect [1].
    probabilities : dict of str to float
        By effect: its conformal p value [1].
    adequacy : dict of str to float
        By effect: chance of as bad a best fit where it is the truth [1].
    shown_above : dict of str to float
        By effect: size from which on nine in ten would have been seen, in units of the visible one; NaN: none.
    """

    decision: str
    causes: list
    p_none: float
    probabilities: dict
    adequacy: dict
    shown_above: dict


def decide(scores, cases):
    """Decision on scores, at levels that the library's own cases calibrate.

    Parameters
    ----------
    scores : Scores
        Of the measured tests.
    cases : list of Case
        From `library_cases`, of the same tests.

    Returns
    -------
    Decision

    Notes
    -----
    Class-conditional (Mondrian) conformal prediction (Vovk, Gammerman and Shafer 2005): where an effect is the truth
    and is detected at all, it is in the set with at least 90 %. An effect whose best fit is worse than where it is the
    truth explains nothing, whatever its rivals: so the answer may be that none does.
    """
    case = as_case(scores)
    p_none = chance_of_none(case, cases)
    seen = detected(cases, FALSE_ALARM)
    effects = list(case.shortfall)
    probabilities = {effect: chance_of(effect, case, seen) for effect in effects}
    adequacy = {effect: chance_of_distance(effect, case, seen) for effect in effects}
    causes = [
        effect
        for effect in sorted(effects, key=case.shortfall.get)
        if probabilities[effect] > NOT_IN_SET and adequacy[effect] > INADEQUATE
    ]
    if p_none > FALSE_ALARM:
        decision, causes = "none", []
    elif not causes:
        decision = "unknown"
    else:
        decision = "named" if len(causes) == 1 else "ambiguous"
    return Decision(
        decision=decision,
        causes=causes,
        p_none=p_none,
        probabilities=probabilities,
        adequacy=adequacy,
        shown_above={effect: shown_above(effect, cases, FALSE_ALARM) for effect in effects},
    )
