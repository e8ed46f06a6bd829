"""The verdict of a campaign, from the sensors, the decision and the sealed tests."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.answer.decision import Estimate
from blockshake.diagnosis.answer.size import NINE_TENTHS
from blockshake.diagnosis.verdict.grade import grade
from blockshake.diagnosis.verdict.verdict import MeasuredGain, Misfit, Outside, Verdict
from blockshake.diagnosis.wording import history_words
from blockshake.effects.registry import EFFECTS
from blockshake.parity.kinds.registry import KINDS

_WHERE = ("joint", "body")
_FORM = 0.05  # share of a fault's size by which it may vary with the reading, as that of a real sensor does


def conclude(decision, findings, kinds, caveats=(), measured=None, judged=None):
    """`Verdict` of a campaign.

    Parameters
    ----------
    decision : Decision
    findings : sequence of Finding
        Sensor faults, which were taken out before the tests were judged.
    kinds : dict of str to str
        ``channel`` or ``transducer`` by the name of the recorder's sensor; any other sensor with a fault is a marker.
    caveats : sequence of str
    measured : MeasuredGain, optional
    judged : dict, optional
        ``structure`` and ``tests`` of the verdict.

    Notes
    -----
    A sensor fault next to what acts in the forces, an effect or a form from outside, is a combination: the fault was
    corrected first. The entry of a fault in ``probabilities`` is 1 less the chance of the parity check. Causes that
    gain nothing on the tests to select by stay named, and the model with them is not proposed.
    """
    sensors, measured = sensor_causes(findings, kinds), measured or MeasuredGain()
    kind, causes = decision.decision, [*sensors, *(one.name for one in decision.causes)]
    caveats = [*caveats, *measured.caveats, *decision.cannot_see, *_caveats(decision)]
    caveats += [decision.impacts] if decision.impacts else []
    if sensors and kind != "ambiguous":
        kind = "combination" if decision.parts or len(sensors) > 1 else "named"
    word, missing = grade(kind, decision, bool(sensors), measured)
    named = {one.name: one for one in decision.causes}
    places = {name: one.location for name, one in sensors.items()}
    places |= {
        name: {key: one.place[key] for key in _WHERE if key in one.place} for name, one in named.items()
    }
    # of one name the cause of the stronger part, which stands first, is the last and stays
    shown = [cause for part in reversed(decision.parts) for cause in reversed(part.causes)]
    measurements = tuple(one for part in decision.parts for one in part.next_tests)
    return Verdict(
        decision=kind,
        causes=causes,
        probabilities=decision.probabilities | {name: 1.0 - one.p for name, one in sensors.items()},
        parameters={name: one.parameters for name, one in (sensors | named).items() if one.parameters},
        location={name: place for name, place in places.items() if place},
        misfit=_misfit(decision, sensors),
        excluded_above={name: size for name, size in decision.excluded_above.items() if name not in causes},
        next_test=_next_test(measurements, causes),
        next_tests=measurements,
        gain=measured.gain,
        row_gain=measured.rows,
        runs=measured.runs,
        caveats=caveats,
        outside=_outside(decision.forms),
        odds={one.name: one.odds for one in shown},
        places={one.name: one.places for one in shown},
        limits=decision.limits,
        word=word,
        missing=missing,
        extension=decision.extending if measured.proposes else (),
        histories=decision.histories,
        **judged or {},
    )


def _caveats(decision):
    """Lines on rivals, forms given the causes, sizes that change, and tests that tell nothing."""
    for part in decision.parts:
        names = [cause.title for cause in part.causes]
        if len(names) > 1:
            yield f"{' or '.join(names)}: the tests do not tell these apart"
        elif part.forms and decision.causes:
            yield f"given the causes something acts that no effect of the registry is: {names[0]}"
    yield from (history_words(path) for path in decision.histories if path.changes)
    if decision.silent:
        yield f"no joint was seen to turn, slip or lift in {', '.join(decision.silent)}"


def _outside(forms):
    """`Outside` of the most probable form; None without one."""
    if not forms:
        return None
    first, when = forms[0], forms[0].when
    starts = {test: blow["time"] for test, blow in when.get("blows", {}).items()} or when.get("starts", {})
    if "start" in when:
        starts = {when["test"]: when["start"]}
    return Outside(
        form=first.name,
        title=first.title,
        place=first.place,
        places=first.places,
        size=first.parameters,
        starts=starts,
        before=tuple(when.get("before", ())),
    )


def _misfit(decision, sensors):
    """p-value of the readings: the smaller of that with faultless sensors and that without a cause."""
    first = min(sensors.values(), key=lambda cause: cause.p, default=None)
    if first is None or first.p >= decision.p:
        return Misfit(p=decision.p, where=decision.where)
    (where,) = first.location.values() or ["the optical system"]
    return Misfit(p=first.p, where=f"readings of {where}, against the other sensors")


def _next_test(measurements, causes):
    """The measurements that would split the sets, or the one by which the registry tells the causes from others."""
    ranked = [f"{one.test} (splits {100.0 * one.share:.0f} % of such cases)" for one in measurements]
    known = dict.fromkeys(EFFECTS[name].distinguished_by for name in causes[:2] if name in EFFECTS)
    return "; ".join(ranked or known) or None


class SensorCause(NamedTuple):
    """A sensor fault: its parameters with 90 % intervals, its sensor (empty for the optical system), its chance."""

    parameters: dict
    location: dict
    p: float


def sensor_causes(findings, kinds):
    """`SensorCause` by registry name: of several findings of one name that with the smallest chance."""
    causes = {}
    for finding in sorted(findings, key=lambda finding: (finding.p, finding.where, finding.tests)):
        sensor = finding.where[0]
        location = {} if sensor.startswith("optical ") else {kinds.get(sensor, "marker"): sensor}
        causes.setdefault(finding.effect, SensorCause(_estimates(finding, location), location, finding.p))
    return causes


def _estimates(finding, location):
    """Size of a fault by the name of the registry's parameter; empty where its quantity is not that parameter."""
    effect, kind = EFFECTS.get(finding.effect), KINDS[finding.quantity]
    component, (unit, other) = kind.size, kind.units
    alike = (
        unit == other or "marker" in location
    )  # the drift of a channel, or of the frame, is none of a marker
    if effect is None or component is None or not len(finding.estimate) or not alike:
        return {}
    size = effect.parameters[0]
    component = component if len(finding.estimate) == 3 else 0
    estimate = float(finding.estimate[component])
    reach = NINE_TENTHS * float(np.hypot(finding.standard_error[component], _FORM * estimate))
    return {
        size.name: Estimate(estimate=estimate, lower=estimate - reach, upper=estimate + reach, unit=size.unit)
    }
