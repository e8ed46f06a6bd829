"""Sensor faults that the parity checks found, as causes of the verdict."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.answer.decision import Estimate
from blockshake.effects.registry import EFFECTS
from blockshake.parity.kinds.registry import KINDS

_SIGMAS = 1.645  # of a Gaussian, within which nine tenths lie
_FORM = 0.05  # share of a fault's size by which it may vary with the reading, as that of a real sensor does


class SensorCause(NamedTuple):
    """A sensor fault: its parameters with 90 % intervals, its sensor (empty for the optical system), its chance."""

    parameters: dict
    location: dict
    p: float


def sensor_causes(findings, kinds):
    """`SensorCause` by registry name, from findings and the kinds of the recorder's sensors by name.

    Of several findings of one name the one with the smallest chance stands for all.
    """
    causes = {}
    for finding in sorted(findings, key=lambda finding: (finding.p, finding.where, finding.tests)):
        if finding.effect in causes:
            continue
        causes[finding.effect] = SensorCause(
            _estimates(finding), _location(finding.where[0], kinds), finding.p
        )
    return causes


def _location(sensor, kinds):
    if sensor.startswith("optical "):
        return {}
    return {kinds.get(sensor, "marker"): sensor}


def _estimates(finding):
    effect, component = EFFECTS.get(finding.effect), KINDS[finding.quantity].size
    if effect is None or component is None or not len(finding.estimate):
        return {}
    size = effect.parameters[0]
    component = component if len(finding.estimate) == 3 else 0
    estimate = float(finding.estimate[component])
    error = float(np.hypot(finding.standard_error[component], _FORM * estimate))
    return {
        size.name: Estimate(
            estimate=estimate,
            lower=estimate - _SIGMAS * error,
            upper=estimate + _SIGMAS * error,
            unit=size.unit,
        )
    }
