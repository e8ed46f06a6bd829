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
_NOT_IN_ALL = "no gain was measured: the sensors' faults do not hold in all tests"
_NO_SIMULATION = (
    "the gain of a sensor's fault is that of its readings against the other sensors'; no simulation enters it"
)
_REST = 1.0  # s, before which nothing has moved: what is left there is noise


def sensor_gain(campaign, opened, findings):
    """Gain of a sensor fault, taken out of the sealed tests of a campaign with the estimate from the open ones.

    Parameters
    ----------
    campaign : Campaign
    opened : sequence of str
        Names of the open tests that were judged.
    findings : sequence of Finding
        From these; the gain is that of `gaining`.

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
    structure = load_structure(campaign.structure)
    finding = gaining(findings, structure)
    if finding is None:
        return CampaignGain(MeasuredGain(caveats=[_NOT_IN_ALL]), xr.Dataset())
    opened, sealed = (
        {name: load_test(campaign, name) for name in names} for names in (opened, campaign.sealed)
    )
    of_clock = finding.quantity == "lag"
    rows, floors = [], []
    for name, test in sealed.items():
        mended = corrected(test, name, structure, [replace(finding, tests=(name,))])
        if of_clock:
            (raw, floor), (extended, _) = (
                _lag(one, name, structure, campaign.sensors) for one in (test, mended)
            )
            rival = raw
        else:
            (raw, floor), (extended, _) = (_distance(one, finding, structure) for one in (test, mended))
            rival = _distance_less_mean(test, opened, finding, structure)
        rows.append([raw, extended, rival])
        floors.append(floor)
    scores, floors = np.array(rows), np.array(floors)
    over_nominal, over_discrepancy = (_contrast(scores[:, rival], scores[:, 1], floors) for rival in (0, 2))
    gain = Gain(recalibrated=over_nominal, nominal=over_nominal, discrepancy=over_discrepancy)
    unit = "s" if of_clock else "m"
    scores = xr.Dataset(
        {"score": (("test", "kind"), scores, {"units": unit}), "floor": ("test", floors, {"units": unit})},
        {"test": list(sealed), "kind": ["nominal", "extended", "discrepancy"]},
        {"where": finding.where[0]},
    )
    return CampaignGain(MeasuredGain(gain=gain, caveats=[_NO_SIMULATION]), scores)


def gaining(findings, structure):
    """The finding whose gain can be measured, of several the one with the smallest chance; None if there is none.

    A marker's place and gain hold in all tests, as the lag of the clock does; a drift or an exchange may not.
    """
    markers = {marker.name for marker in structure.file.markers}
    able = [
        finding
        for finding in findings
        if finding.quantity == "lag" or (finding.quantity in OF_MARKERS and finding.where[0] in markers)
    ]
    return min(able, key=lambda finding: (finding.p, finding.where), default=None)


def _contrast(rival, extended, floor):
    """Gain over all tests, and the span of the single ones; cut off at -1 and 1."""

    def gained(score, corrected_score, lowest):
        return float(
            np.clip(
                (score - corrected_score) / max(score - lowest, 1e-12 + abs(corrected_score - lowest)),
                -1.0,
                1.0,
            )
        )

    single = [gained(*one) for one in zip(rival, extended, floor, strict=True)]
    whole = gained(rival.mean(), extended.mean(), floor.mean())
    return Contrast.cut_off(whole, min(single), max(single))


def _distance(test, finding, structure):
    """Distance of a marker from where the others of its body put it, and its distance while nothing moves."""
    distance = _residual(test, finding.where[0], structure)
    start = test["time"].to_numpy() <= test["time"].to_numpy()[0] + _REST
    return _rms(distance), _rms(distance[start])


def _distance_less_mean(test, opened, finding, structure):
    means = [
        np.nanmean(_residual(opened_test, finding.where[0], structure), axis=0)
        for opened_test in opened.values()
    ]
    return _rms(_residual(test, finding.where[0], structure) - np.mean(means, axis=0))


def _residual(test, marker, structure):
    """Marker in its body's frame less where it should be, the rigid motion of all taken out, (n_times, 3)."""
    name = next(item.body for item in structure.file.markers if item.name == marker)
    body = BodyMarkers.of(structure, name, {"": test}, test["marker"].values).in_test()
    residual = body.frame(body.readings[0][1]).residual
    residual[outlying(residual)] = np.nan
    return residual[:, body.markers.index(marker)]


def _rms(values):
    return float(np.sqrt(np.nanmean((values**2).sum(axis=1))))


def _lag(test, name, structure, sensors):
    """Magnitude of the lag of the optical clock, and its standard error."""
    clock = check_parity({name: test}, structure, sensors).clock.sel(test=name)
    return abs(float(clock["lag"])), float(clock["lag_error"])
