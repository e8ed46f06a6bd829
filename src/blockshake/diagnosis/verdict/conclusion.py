"""The verdict of a campaign, from the sensors, the decision and the sealed tests."""

from typing import NamedTuple

from blockshake.diagnosis.inference.lawful_decision import READ
from blockshake.diagnosis.libraries.candidates import effect_of
from blockshake.diagnosis.libraries.plan import sealed_tests
from blockshake.diagnosis.verdict.ladder import rung
from blockshake.diagnosis.verdict.sensor_causes import sensor_causes
from blockshake.diagnosis.verdict.verdict import BrokenLaw, Estimate, Misfit, Verdict
from blockshake.effects.registry import EFFECTS


class Judged(NamedTuple):
    """The largest misfit in words, and the number of open tests that were judged by."""

    where: str
    tests: int


def no_gain(campaign, causes):
    """Reason why no gain was measured, where there are causes, or a description of an unknown one."""
    if not causes:
        return []
    if not sealed_tests(campaign):
        return ["no gain was measured: there is no sealed test"]
    return ["no gain was measured: an extension is not simulated at quick effort"]


def conclude(decision, findings, kinds, judged, runs, caveats, effort, size=None, measured=None, scores=None):
    """`Verdict` of a campaign.

    Parameters
    ----------
    decision : Decision
    findings : sequence of Finding
        Sensor faults, which were taken out before anything was simulated.
    kinds : dict of str to str
        ``channel`` or ``transducer`` by the name of the recorder's sensor; any other sensor with a fault is a marker.
    judged : Judged
        Largest misfit and number of tests.
    runs : int
        Simulated tests.
    caveats : sequence of str
    effort : str
        One of `EFFORTS`.
    size : CauseSize, optional
        Of the first cause: better known than in the decision.
    measured : MeasuredGain, optional
    scores : xarray.Dataset, optional
        From `gain_on`, where a physical cause's gain was measured.

    Notes
    -----
    A sensor fault beside a physical cause is a combination: it was corrected first, and the tests judged again. Where
    the physical cause is unknown, so is the whole: misfit and gain are those of the corrected readings, a gain of the
    sensors' faults is none of the verdict's, and the faults stand among the caveats. Its entry in
    ``probabilities`` is 1 less the parity check's p: a score, neither a conformal p value nor a probability.
    """
    sensors = sensor_causes(findings, kinds)
    kind, causes = decision.decision, [*sensors, *decision.causes]
    gain, law_gain = (measured.gain, measured.laws) if measured else (None, None)
    caveats = [*caveats]
    if gain is not None and kind == "unknown" and decision.described is None:
        gain = None  # of the sensors' faults alone: what is unknown extends no model
        caveats.append("no gain was measured: the model was not extended, as no cause is known")
    if sensors and kind == "unknown":
        causes = []
        titles = ", ".join(EFFECTS[name].title for name in sensors)
        caveats.append(f"faults of sensors were found and taken out: {titles}")
    elif sensors:
        kind = "named" if len(causes) == 1 else "combination"
        if decision.decision == "ambiguous":
            names = " and ".join(decision.causes)
            caveats.append(f"{names} cannot be told apart: one of them acts beside the sensor fault, not all")
    if effort == "quick" and kind not in ("none", "unknown"):
        caveats.append("quick effort: no stronger word than probable")
    for solver in decision.solver_dependent:
        caveats.append(f"solver-dependent: by {solver} alone another effect explains more")
    physical = dict(decision.parameters)
    if size:
        cause = effect_of(size.key)
        physical[cause] = size.parameters | _read_from_laws(cause, decision)
    for name, values in physical.items():
        unknown = [key for key, value in values.items() if not value.informed]
        if unknown and name in causes:
            caveats.append(f"{name}: {', '.join(unknown)} not informed by the tests, its prior is given")
    parameters = {name: cause.parameters for name, cause in sensors.items() if cause.parameters} | physical
    location = {name: cause.location for name, cause in sensors.items()} | decision.location
    word, missing = rung(kind, decision, bool(sensors), effort, judged.tests, gain, scores)
    return Verdict(
        decision=kind,
        causes=causes,
        probabilities=decision.probabilities | {name: 1.0 - cause.p for name, cause in sensors.items()},
        parameters={
            name: {
                key: Estimate(**value.model_dump(exclude={"informed"}))
                for key, value in parameters[name].items()
            }
            for name in causes
            if name in parameters
        },
        location={name: location[name] for name in causes if location.get(name)},
        misfit=_misfit(decision, sensors, judged.where),
        excluded_above=_excluded(decision, causes),
        next_test=_next_test(kind, causes),
        gain=gain,
        law_gain=law_gain,
        runs=runs,
        caveats=caveats,
        laws=[
            BrokenLaw(name=one.name, unit=one.unit, measured=one.measured, departures=one.departures)
            for one in (decision.laws.broken if decision.laws else ())
        ],
        outside=decision.laws.outside if decision.laws else None,
        word=word,
        missing=missing,
    )


def _read_from_laws(cause, decision):
    """Parameters of a cause that the laws isolate and read: sharper than those of simulated draws."""
    isolated = decision.laws.isolated if decision.laws else ()
    own = decision.parameters.get(cause, {})
    return {name: own[name] for name in READ.get(cause, ()) if cause in isolated and own[name].informed}


def _misfit(decision, sensors, where):
    """The smaller chance of readings like these, with sound sensors or by the nominal model: the latter if unknown."""
    first = min(sensors.values(), key=lambda cause: cause.p, default=None)
    if first is None or decision.decision == "unknown" or first.p >= decision.p_none:
        return Misfit(p=decision.p_none, where=where)
    (where,) = first.location.values() or ["the optical system"]
    return Misfit(p=first.p, where=f"readings of {where}, against the other sensors")


def _excluded(decision, causes):
    """Sizes above which the tests would have shown an effect, in the unit of the effect's first parameter."""
    found = {}
    for name, size in decision.shown_above.items():
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
