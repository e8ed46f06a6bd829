"""A decision with the laws of the joints: they overrule features of the whole test wherever they tell."""

import numpy as np

from blockshake.diagnosis.inference.decision import ParameterEstimate
from blockshake.diagnosis.laws.judged_laws import accounts_for, is_told, law_that_holds, leans_to, own_laws
from blockshake.diagnosis.laws.mean_of_tests import mean_of_tests
from blockshake.diagnosis.laws.signatures import SIGNATURES, STOP
from blockshake.diagnosis.libraries.candidates import effect_of
from blockshake.effects.registry import EFFECTS

_GAP_ERROR = 1e-3  # m, standard deviation of a fitted gap: steps of the search, and the form of the law
# parameters of an effect that the laws read directly
READ = {
    "table-pitch": ("coefficient",),
    "base-compliance": ("compliance",),
    "reduced-bearing": ("inset",),
    "eccentricity": ("offset",),
    "weak-joint": ("factor",),
    STOP: ("stiffness", "gap"),
}


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
    An effect is isolated if its own law is broken and it accounts for all laws that are: the cause, at the joint whose
    law is broken. An effect whose own law was told at its place and holds is struck out, and so is one towards which no
    law leans, and one that does not account for the broken laws. The features of whole tests decide among the effects
    that are left. Where laws are broken and no effect is left, the cause is unknown, and is described.
    """
    isolated = [effect for effect in findings.isolated if effect in decision.places]
    told = bool(findings.broken or findings.outside)
    places = dict(decision.places)
    for effect in isolated:
        places[effect] = _place_by_law(effect, places[effect], findings, places_of)
    struck_out = {effect: list(why) for effect, why in decision.struck_out.items()}
    for effect in decision.places:
        if effect not in isolated:
            struck_out.setdefault(effect, []).extend(_reasons(effect, places_of[places[effect]], findings))
    if isolated:
        causes, kind = tuple(isolated), "named" if len(isolated) == 1 else "ambiguous"
    else:
        causes = tuple(effect for effect in decision.causes if not struck_out[effect])
        kind = "unknown" if told and not causes else _kind(decision, causes)
    if decision.causes and kind == "none":
        for effect in decision.causes:
            struck_out[effect].append(f"features of whole tests by themselves gave p = {decision.p_none:.2g}")
    sizes, parameters = {}, {}
    for effect in causes:
        if effect in isolated:
            parameters[effect] = _parameters(effect, decision, findings, places_of[places[effect]])
            sizes[effect] = _visible(effect, parameters[effect])
        else:
            parameters |= {effect: decision.parameters[effect]} if effect in decision.parameters else {}
            sizes[effect] = decision.sizes[effect]
    return decision.model_copy(
        update={
            "decision": kind,
            "causes": causes,
            "places": {effect: places[effect] for effect in [*causes, *places]},
            "sizes": sizes,
            "p_none": _chance_of_none(decision, findings, kind),
            "struck_out": {
                effect: tuple(why) for effect, why in struck_out.items() if effect not in causes and why
            },
            "solver_dependent": () if isolated else decision.solver_dependent,
            "parameters": parameters,
            "location": {effect: places_of[places[effect]] for effect in causes},
            "laws": findings,
        }
    )


def _reasons(effect, place, findings):
    """Reasons for which the laws strike an effect out."""
    law = law_that_holds(effect, place, findings)
    if law:
        yield f"its law holds: {law} departs by less than counts as an effect"
    elif findings.laws and not leans_to(effect, place, findings):
        told = effect not in SIGNATURES or is_told(effect, place, findings)
        yield "no law departs its way" if told else "its law is not told"
    if (findings.broken or findings.outside) and not accounts_for(effect, findings):
        yield f"it does not account for the {'laws that are broken' if findings.broken else 'force from outside'}"


def _chance_of_none(decision, findings, kind):
    """Chance of such readings without an effect: by the laws where they decide, else by features of whole tests."""
    if kind == "none" and decision.causes:
        return findings.p
    return min(decision.p_none, findings.p) if findings.broken or findings.outside else decision.p_none


def _kind(decision, causes):
    """Kind of the answer once effects whose laws hold are struck out."""
    if causes == decision.causes:
        return decision.decision
    return {0: "none", 1: "named"}.get(len(causes), "ambiguous")


def _place_by_law(effect, otherwise, findings, places_of):
    """Key of the candidate where the laws see an isolated effect, else that of the features."""
    if effect == STOP:
        outside = findings.outside_of_stop
        side = "+x" if next(iter(outside.tests.values()))["side"] > 0.0 else "-x"
        wanted = ("body", outside.bodies[0]), ("axis", side)
    else:
        broken = next(one for one in own_laws(effect, findings.laws) if one.broken)
        wanted = (("joint", broken.joint),)
    for key, place in places_of.items():
        known = place | ({"joint": "-".join(place["joint"])} if "joint" in place else {})
        if effect_of(key) == effect and tuple((name, known.get(name)) for name, _ in wanted) == wanted:
            return key
    return otherwise


def _parameters(effect, decision, findings, place):
    """Parameters of an isolated effect, those that a law reads from the law."""
    known = dict(decision.parameters.get(effect, {}))
    first, *others = EFFECTS[effect].parameters
    for item in others:
        known.setdefault(item.name, _prior(item))
    if effect == STOP and findings.outside_of_stop is not None:
        outside = findings.outside_of_stop
        gaps = np.array([test["gap"] for test in outside.tests.values()])
        known["stiffness"] = _estimate(outside.amplitude, max(outside.lower, 0.0), outside.upper, "N/m")
        mean, half = mean_of_tests(gaps, np.full(len(gaps), _GAP_ERROR), form=0.0)
        known["gap"] = _estimate(mean, mean - half, mean + half, "m")
    elif sizes := sizes_by_law(effect, findings, place):
        mean, half = mean_of_tests(*np.array([one[1:] for one in sizes]).T)
        known[first.name] = _estimate(mean, mean - half, mean + half, first.unit)
    else:
        known.setdefault(first.name, _prior(first))
    return known


def sizes_by_law(effect, findings, place):
    """Size of an effect that its own law reads directly, of every test that tells the law where it is broken.

    Parameters
    ----------
    effect : str
    findings : LawFindings
    place : dict
        Of the effect.

    Returns
    -------
    list of (str, float, float)
        Test, value of the effect's parameter and its standard error, in the parameter's unit; empty for an effect whose
        size no law reads. The levers of a joint tell an eccentric block in proportion to its share of the weight above:
        with the block's mass taken at its centroid both resultants seem to lie the other way.
    """
    if effect == STOP or effect not in READ:
        return []
    broken = [law for law in own_laws(effect, findings.laws) if law.broken]
    factor, null, nominal = 1.0, 0.0, effect in ("reduced-bearing", "eccentricity", "weak-joint")
    if effect == "eccentricity":
        broken = [law for law in broken if law.beneath]
        factor = -1.0 / findings.shares[place["body"]]
    if effect == "weak-joint":
        factor, null = -1.0, 1.0
    return [
        (test, null + factor * (value - nominal * law.expected[test]), abs(factor) * law.errors[test])
        for law in broken
        for test, value in law.measured.items()
    ]


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
