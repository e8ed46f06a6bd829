"""The verdict of a campaign: what the sensors, the decision and the sealed tests say, put together."""

import json

import numpy as np

from blockshake.diagnosis.calibration import detected, size_error
from blockshake.diagnosis.candidates import effect_of
from blockshake.diagnosis.decision import FALSE_ALARM
from blockshake.diagnosis.posterior import calibrated_weights, parameter_estimates
from blockshake.diagnosis.sensor_causes import sensor_causes
from blockshake.diagnosis.verdict import Estimate, Misfit, Verdict
from blockshake.effects.registry import EFFECTS


def conclude(decision, findings, channels, where, runs, caveats, effort, size=None, gain=None):
    """Verdict of a campaign.

    Parameters
    ----------
    decision : dict
        As written by `decision_as_json`.
    findings : sequence of Finding
        Sensor faults, which were taken out before anything was simulated.
    channels : sequence of str
        Names of the accelerometer channels; what else has a fault is a marker.
    where : str
        The largest misfit in words.
    runs : int
        Simulated tests.
    caveats : sequence of str
    effort : str
        One of `plan.EFFORTS`.
    size : dict, optional
        Of the first cause, from `size_of_cause`: better known than in the decision.
    gain : Gain, optional

    Returns
    -------
    Verdict

    Notes
    -----
    A sensor fault beside a physical cause is a combination: it was corrected first, and the tests judged again. Where
    the physical cause is unknown, so is the whole, and the sensor fault stands among the caveats. Its entry in
    ``probabilities`` is 1 less the parity check's p: a score, neither a conformal p value nor a probability.
    """
    if size is not None:
        known = decision["parameters"] | {effect_of(size["key"]): size["parameters"]}
        decision = decision | {"parameters": known}
    sensors = sensor_causes(findings, channels)
    physical = decision["decision"]
    causes = [*sensors, *decision["causes"]]
    if not sensors:
        kind = physical
    elif physical == "unknown":
        kind, causes, gain = "unknown", [], None
        caveats = [*caveats, f"sensor faults were found and taken out: {', '.join(sensors)}"]
    else:
        kind = "named" if len(causes) == 1 else "combination"
        if physical == "ambiguous":
            names = " and ".join(decision["causes"])
            caveats = [
                *caveats,
                f"{names} cannot be told apart: one of them acts beside the sensor fault, not all",
            ]
    if effort == "quick" and kind not in ("none", "unknown"):
        caveats = [*caveats, "quick effort: no stronger word than probable"]
    for solver in decision["solver_dependent"]:
        caveats = [*caveats, f"solver-dependent: by {solver} alone another effect explains more"]
    parameters = {name: cause["parameters"] for name, cause in sensors.items() if cause["parameters"]}
    parameters |= decision["parameters"]
    for name, values in decision["parameters"].items():
        unknown = [key for key, value in values.items() if not value["informed"]]
        if unknown and name in causes:
            caveats = [
                *caveats,
                f"{name}: {', '.join(unknown)} not informed by the tests, its prior is given",
            ]
    location = {name: cause["location"] for name, cause in sensors.items() if cause["location"]}
    location |= decision["location"]
    return Verdict(
        decision=kind,
        causes=causes,
        probabilities=decision["probabilities"] | {name: 1.0 - cause["p"] for name, cause in sensors.items()},
        parameters={
            name: {
                key: Estimate(**{part: value[part] for part in ("estimate", "lower", "upper", "unit")})
                for key, value in parameters[name].items()
            }
            for name in causes
            if name in parameters
        },
        location={name: location[name] for name in causes if location.get(name)},
        misfit=_misfit(decision, sensors, where),
        excluded_above=_excluded(decision, causes),
        next_test=_next_test(kind, causes),
        gain=gain,
        runs=runs,
        caveats=tuple(caveats),
    )


def decision_as_json(decision, scores, candidates, cases):
    """A decision with the table of candidates behind it, as JSON-like values.

    Parameters
    ----------
    decision : Decision
    scores : Scores
    candidates : sequence of Candidate
        Of the structure.
    cases : list of Case

    Returns
    -------
    dict
        The decision's entries; of the causes ``parameters`` as of `parameter_estimates` and ``location``;
        ``candidates``: for each ``key``, ``effect``, ``log_ratio``, ``by_model``, ``size``, ``sizes``, ``weights``,
        ``model``, ``distance`` and, by test, the size of the largest density and the ends of the sizes less likely by a
        factor e^2.
    """
    seen = detected(cases, FALSE_ALARM)
    place_of = {candidate.key: candidate.place for candidate in candidates}
    parameters = {}
    for effect in decision.causes:
        key = decision.places[effect]
        if decision.decision == "combination" and effect != decision.causes[0]:
            continue  # its size beside the first is a single estimate
        posterior = calibrated_weights(scores.sizes[key], scores.weights[key], size_error(effect, seen))
        parameters[effect] = parameter_estimates(effect, scores.sizes[key], posterior)
    rows = [
        {
            "key": key,
            "effect": effect_of(key),
            "log_ratio": scores.log_ratio[key],
            "by_model": scores.by_model[key],
            "size": scores.size[key],
            "sizes": scores.sizes[key].tolist(),
            "weights": scores.weights[key].tolist(),
            "model": scores.model[key],
            "distance": scores.distance[key],
            "by_test": [_own_size(scores.sizes[key], densities) for densities in scores.by_test[key]],
        }
        for key in sorted(scores.log_ratio, key=scores.log_ratio.get, reverse=True)
    ]
    values = vars(decision) | {
        "shown_above": {
            name: None if np.isnan(size) else size for name, size in decision.shown_above.items()
        },
        "nominal_distance": scores.distance["nominal"],
        "parameters": parameters,
        "location": {effect: place_of[decision.places[effect]] for effect in decision.causes},
        "candidates": rows,
    }
    return json.loads(json.dumps(values, default=float))


def _own_size(sizes, densities):
    """Size that one test by itself finds likeliest, with the ends of all less likely by a factor e^2 at most."""
    likely = sizes[densities >= densities.max() - 2.0]
    return {"estimate": sizes[densities.argmax()], "lower": likely.min(), "upper": likely.max()}


def _misfit(decision, sensors, where):
    """The smaller chance of readings like these: with sound sensors, or by the nominal model."""
    first = min(sensors, key=lambda name: sensors[name]["p"], default=None)
    if first is None or sensors[first]["p"] >= decision["p_none"]:
        return Misfit(p=decision["p_none"], where=where)
    (where,) = sensors[first]["location"].values() or ["the optical system"]
    return Misfit(p=sensors[first]["p"], where=f"readings of {where}, against the other sensors")


def _excluded(decision, causes):
    """Sizes above which the tests would have shown an effect, in its own unit."""
    found = {}
    for name, size in decision["shown_above"].items():
        if name not in causes and size is not None:
            first = EFFECTS[name].parameters[0]
            found[name] = first.null + size * (first.visible - first.null)
    return found


def _next_test(kind, causes):
    """The measurement that would decide between what is left."""
    if kind == "none" or not causes:
        return None
    told = dict.fromkeys(EFFECTS[name].told_apart_by for name in causes[:2] if name in EFFECTS)
    return "; ".join(told) or None
