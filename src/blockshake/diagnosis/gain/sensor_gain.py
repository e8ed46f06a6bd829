"""Gain of a named sensor fault on sealed tests: its corrected readings against the other sensors."""

from dataclasses import replace

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.campaign_gain import CampaignGain
from blockshake.diagnosis.verdict.verdict import Contrast, Gain, MeasuredGain
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.motion.body_frame import outlying
from blockshake.parity.body_markers import BodyMarkers
from blockshake.parity.correction import corrected
from blockshake.parity.parity import check_parity

OF_MARKERS = ("place", "gain")
_REST = 1.0  # s, before which nothing has moved: what is left there is noise


def sensors_gain(campaign, opened, sealed, findings):
    """`CampaignGain` of the sensor fault whose gain can be measured.

    ``opened`` and ``sealed`` are names of tests, ``findings`` those of the open ones.
    """
    structure = load_structure(campaign.structure)
    opened, sealed = ({name: load_test(campaign, name) for name in names} for names in (opened, sealed))
    return sensor_gain(gaining(findings, structure), opened, sealed, structure, campaign.sensors)


def sensor_gain(finding, opened, sealed, structure, sensors):
    """Gain of a named sensor fault, taken out of sealed tests with the estimate from the open ones.

    Parameters
    ----------
    finding : Finding or None
        From the open tests, as from `gaining`: of a marker (`OF_MARKERS`) or of the optical clock (``lag``).
    opened, sealed : dict of str to xarray.Dataset
        Tests by name, as read.
    structure : Structure
    sensors : Sensors

    Returns
    -------
    CampaignGain
        Gain over all sealed tests; its interval spans those of the single tests. None without a finding. ``scores``
        along ``test`` and ``kind`` (``nominal``, ``extended``, ``discrepancy``): ``score``, root mean square distance
        of the marker from where its body's other markers put it [m], or magnitude of the lag that is left [s];
        ``floor``.

    Notes
    -----
    The rigid body, or the other clock, predicts the reading; no simulation does, so that the recalibrated model is the
    nominal one. The rival without a name is the marker's mean distance in the open tests, taken off in the sealed
    ones. The floor is the distance while nothing moves, or the standard error of the lag.
    """
    if finding is None:
        caveat = "no gain was measured: the sensors' faults do not hold in all tests"
        return CampaignGain(MeasuredGain(gain=None, caveats=[caveat], runs=0), xr.Dataset())
    of_clock = finding.quantity == "lag"
    score = _lag_left if of_clock else _distance
    rows, floors = [], []
    for name, test in sealed.items():
        mended = corrected(test, name, structure, [replace(finding, tests=(name,))])
        raw, floor = score(test, name, finding, structure, sensors)
        extended, _ = score(mended, name, finding, structure, sensors)
        rival = raw if of_clock else _distance_less_mean(test, opened, finding, structure)
        rows.append([raw, extended, rival])
        floors.append(floor)
    scores, floors = np.array(rows), np.array(floors)
    gain = Gain(
        recalibrated=_contrast(scores[:, 0], scores[:, 1], floors),
        nominal=_contrast(scores[:, 0], scores[:, 1], floors),
        discrepancy=_contrast(scores[:, 2], scores[:, 1], floors),
    )
    unit = "s" if of_clock else "m"
    scores = xr.Dataset(
        {"score": (("test", "kind"), scores, {"units": unit}), "floor": ("test", floors, {"units": unit})},
        {"test": list(sealed), "kind": ["nominal", "extended", "discrepancy"]},
        {"effect": finding.effect, "where": finding.where[0]},
    )
    caveat = "the gain of a sensor's fault is that of its readings against the other sensors'; no simulation enters it"
    return CampaignGain(MeasuredGain(gain=gain, caveats=[caveat], runs=0), scores)


def gaining(findings, structure):
    """The finding whose gain can be measured, of several the one with the smallest chance; None if there is none.

    A marker's place and gain hold in all tests, as the lag of the clock does; a drift or an exchange may not.
    """
    markers = {marker.name for marker in structure.file.markers}
    able = [
        one
        for one in findings
        if one.quantity == "lag" or (one.quantity in OF_MARKERS and one.where[0] in markers)
    ]
    return min(able, key=lambda one: (one.p, one.where), default=None)


def _contrast(rival, extended, floor):
    """Gain over all tests, and the span of the single ones; cut off at -1 and 1."""

    def gained(score, own, least):
        return float(np.clip((score - own) / max(score - least, 1e-12 + abs(own - least)), -1.0, 1.0))

    single = [gained(*one) for one in zip(rival, extended, floor, strict=True)]
    whole = gained(rival.mean(), extended.mean(), floor.mean())
    return Contrast(estimate=whole, lower=min(*single, whole), upper=max(*single, whole))


def _distance(test, name, finding, structure, sensors):
    left = _residual(test, finding.where[0], structure)
    start = test["time"].to_numpy() <= test["time"].to_numpy()[0] + _REST
    return _rms(left), _rms(left[start])


def _distance_less_mean(test, opened, finding, structure):
    means = [np.nanmean(_residual(one, finding.where[0], structure), axis=0) for one in opened.values()]
    return _rms(_residual(test, finding.where[0], structure) - np.mean(means, axis=0))


def _residual(test, marker, structure):
    """Marker in its body's frame less where it should be, the rigid motion of all taken out, (n_times, 3)."""
    name = next(item.body for item in structure.file.markers if item.name == marker)
    body = BodyMarkers.of(structure, name, {"": test}, test["marker"].values)
    left = body.frame(body.readings[0][1]).residual
    left[outlying(left)] = np.nan
    return left[:, body.markers.index(marker)]


def _rms(values):
    return float(np.sqrt(np.nanmean((values**2).sum(axis=1))))


def _lag_left(test, name, finding, structure, sensors):
    clock = check_parity({name: test}, structure, sensors).clock.sel(test=name)
    return abs(float(clock["lag"])), float(clock["lag_error"])
