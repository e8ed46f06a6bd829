"""Sensor faults that the parity checks found, as causes of the verdict."""

from blockshake.effects.registry import EFFECTS

_SIGMAS = 1.645  # of a Gaussian, within which nine tenths lie


def sensor_causes(findings, channels):
    """Causes by name: parameters with 90 % intervals, place, and chance.

    Parameters
    ----------
    findings : sequence of Finding
    channels : sequence of str
        Names of the accelerometer channels.

    Returns
    -------
    dict of str to dict
        By registry name: ``parameters`` as of `parameter_estimates`, ``location`` and ``p``. Of several findings of one
        name the one with the smallest chance stands for all.
    """
    causes = {}
    for finding in sorted(findings, key=lambda finding: (finding.p, finding.where, finding.tests)):
        if finding.effect in causes:
            continue
        causes[finding.effect] = {
            "parameters": _estimates(finding),
            "location": _location(finding.where[0], channels),
            "p": finding.p,
        }
    return causes


def _location(sensor, channels):
    if sensor.startswith("optical "):
        return {}
    return {"channel" if sensor in channels else "marker": sensor}


def _estimates(finding):
    effect = EFFECTS.get(finding.effect)
    if effect is None or not len(finding.estimate):
        return {}
    size = effect.parameters[0]
    # a wrong place is a vector in the body's frame, of which the registry's effect has the height
    component = 2 if len(finding.estimate) == 3 else 0
    estimate, error = float(finding.estimate[component]), float(finding.standard_error[component])
    return {
        size.name: {
            "estimate": estimate,
            "lower": estimate - _SIGMAS * error,
            "upper": estimate + _SIGMAS * error,
            "unit": size.unit,
            "informed": True,
        }
    }
