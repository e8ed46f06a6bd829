"""A decision with the laws of the joints: they overrule features of the whole test wherever they tell."""

import numpy as np

from blockshake.diagnosis.inference.decision import ParameterEstimate
from blockshake.diagnosis.laws.judged_laws import accounts_for
from blockshake.diagnosis.laws.law_table import kind_of
from blockshake.diagnosis.laws.signatures import SIGNATURES, STOP
from blockshake.effects.registry import EFFECTS

_NORMAL_90 = 1.645
# parameter of an effect that its own law reads directly
_DIRECT = {"table-pitch": "coefficient", "reduced-bearing": "inset"}


def with_laws(decision, findings, places_of):
    """Decision in which the laws have their say.

    Parameters
    ----------
    decision : Decision
        From the features of whole tests.
    findings : LawFindings
    places_of : dict of str to dict
        By key of a candidate: its place in the structure.

    Returns
    -------
    Decision

    Notes
    -----
    An effect is isolated if its own law is broken and it accounts for all laws that are: the cause. An effect whose
    own law was told and holds is struck out, and so is one that does not account for the broken laws. The features of
    whole tests decide among the effects that are left. Where laws are broken and no effect is left, the cause is
    unknown, and is described.
    """
    holding = {effect: law for effect, law in findings.holding.items() if effect in decision.places}
    isolated = [effect for effect in findings.isolated if effect in decision.places]
    told = bool(findings.broken or findings.outside)
    places = dict(decision.places)
    if STOP in isolated:
        places[STOP] = _stop_at(findings.outside_of_stop, places[STOP], places_of)
    struck_out = dict(decision.struck_out)
    for effect, law in holding.items():
        struck_out[effect] = (*struck_out.get(effect, ()), f"its law holds: {law} is as in the nominal model")
    if isolated:
        causes, kind = tuple(isolated), "named" if len(isolated) == 1 else "ambiguous"
    else:
        causes = tuple(
            effect for effect in decision.causes if effect not in holding and accounts_for(effect, findings)
        )
        kind = "unknown" if told and not causes else _kind(decision, causes)
    parameters = {effect: _parameters(effect, decision, findings) for effect in causes}
    return decision.model_copy(
        update={
            "decision": kind,
            "causes": causes,
            "places": {effect: places[effect] for effect in [*causes, *places]},
            "sizes": {
                effect: _visible(effect, parameters[effect]) if effect in isolated else decision.sizes[effect]
                for effect in causes
            },
            "p_none": min(decision.p_none, findings.p) if told else decision.p_none,
            "struck_out": {effect: why for effect, why in struck_out.items() if effect not in causes and why},
            "solver_dependent": () if isolated else decision.solver_dependent,
            "parameters": parameters,
            "location": {effect: places_of[places[effect]] for effect in causes},
            "laws": findings,
        }
    )


def _kind(decision, causes):
    """Kind of the answer once effects whose laws hold are struck out."""
    if causes == decision.causes:
        return decision.decision
    return {0: "none", 1: "named"}.get(len(causes), "ambiguous")


def _stop_at(outside, otherwise, places_of):
    """Key of the candidate at the block and on the side of a stop."""
    side = "+x" if next(iter(outside.tests.values()))["side"] > 0.0 else "-x"
    wanted = {"body": outside.bodies[0], "axis": side}
    keys = [key for key, place in places_of.items() if key.startswith(f"{STOP}@") and place == wanted]
    return keys[0] if keys else otherwise


def _parameters(effect, decision, findings):
    """Parameters of an effect, those that a law reads from the law."""
    known = dict(decision.parameters.get(effect, {}))
    first, *others = EFFECTS[effect].parameters
    for item in others:
        known.setdefault(item.name, _prior(item))
    if effect == STOP and findings.outside_of_stop is not None:
        outside = findings.outside_of_stop
        gaps = np.array([test["gap"] for test in outside.tests.values()])
        known["stiffness"] = _estimate(outside.amplitude, outside.lower, outside.upper, "N/m")
        half = _NORMAL_90 * float(gaps.std() / np.sqrt(len(gaps)))
        known["gap"] = _estimate(
            float(gaps.mean()), float(gaps.mean()) - half, float(gaps.mean()) + half, "m"
        )
    elif effect in _DIRECT and effect in findings.isolated:
        known[_DIRECT[effect]] = _read(effect, findings)
    elif first.name not in known:
        known[first.name] = _prior(first)
    return known


def _read(effect, findings):
    """Size of an effect from its own law, with an interval from the scatter between tests and the law's error."""
    (law,) = (one for one in findings.laws if kind_of(one.name) == SIGNATURES[effect].own and one.broken)
    nominal = np.array(list(law.expected.values())) if effect == "reduced-bearing" else 0.0
    values = np.array(list(law.measured.values())) - nominal
    spread = float(values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else 0.0
    half = _NORMAL_90 * max(spread, 0.02 * abs(float(values.mean())))
    mean = float(values.mean())
    return _estimate(mean, mean - half, mean + half, EFFECTS[effect].parameters[0].unit)


def _estimate(value, lower, upper, unit):
    return ParameterEstimate(estimate=value, lower=lower, upper=upper, unit=unit, informed=True)


def _prior(item):
    width = item.upper - item.lower
    return ParameterEstimate(
        estimate=item.lower + 0.5 * width, lower=item.lower + 0.05 * width, upper=item.upper - 0.05 * width,
        unit=item.unit, informed=False,
    )  # fmt: skip


def _visible(effect, parameters):
    """Size in units of the visible one."""
    first = EFFECTS[effect].parameters[0]
    return (parameters[first.name].estimate - first.null) / (first.visible - first.null)
