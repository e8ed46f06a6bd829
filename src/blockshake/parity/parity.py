"""Parity checks of a campaign's sensors against each other, without a simulator."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.files import load_made_json
from blockshake.measurement.campaigns.faulty_readings import faulty_lines
from blockshake.measurement.campaigns.initial_poses import initial_pose_lines, initial_poses
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.fall import Fall
from blockshake.measurement.sensors.instruments import Sensors
from blockshake.parity import marker_faults, transducer_faults
from blockshake.parity.body_markers import bodies_with_markers, measured_pose
from blockshake.parity.channel_pairs import channel_pairs
from blockshake.parity.correction import corrected
from blockshake.parity.finding import Finding, Level
from blockshake.parity.kinds.body_gain import body_gains
from blockshake.parity.kinds.clock import clock_findings, clock_lags
from blockshake.parity.kinds.drift import drift_findings, frame_drift, short_lines
from blockshake.parity.kinds.exchange import channel_exchanges, marker_exchanges
from blockshake.parity.kinds.gain import channel_gains, gain_findings
from blockshake.parity.kinds.saturation import limited_markers, saturation
from blockshake.parity.transducer_readings import held_readings

LEVEL = 0.01  # chance of any finding on a campaign of faultless sensors
_TABLES = {
    "markers": ("marker", ["noise", "misfit"]),
    "clock": ("test", ["lag", "lag_error"]),
    "channels": ("channel", ["gain", "gain_error"]),
    "transducers": ("transducer", ["gain", "gain_error"]),
}


@dataclass(frozen=True)
class Parity:
    """Outcome of the parity checks."""

    findings: tuple  # of Finding
    sensors: Sensors  # with the noise that they were held to, found in the rests of the tests
    # xarray.Dataset; ``noise(marker)`` of the readings after the findings are taken out and
    # ``misfit(marker)`` before [m]; NaN on bodies with fewer than three markers
    markers: xr.Dataset
    clock: xr.Dataset  # xarray.Dataset; ``lag(test)`` of the optical clock, with ``lag_error(test)`` [s]
    # xarray.Dataset; ``gain(channel)`` of every channel, reading over truth less 1, with
    # ``gain_error(channel)`` [1]; NaN where the markers do not tell it
    channels: xr.Dataset
    # xarray.Dataset; ``gain(transducer)`` of displacement transducers, with ``gain_error(transducer)`` [1];
    # NaN where markers do not see both ends, or the bodies hardly moved apart
    transducers: xr.Dataset
    looked_at: int  # number of hypotheses
    falls: dict  # str to Fall; by test: the block that fell first; the test is judged until then
    # str to list of str; by test: lines on the readings that were taken as gaps, and on a record that is too
    # short
    gaps: dict

    def as_json(self):
        """JSON-like values, NaN as null; transducers are listed only where there are any."""
        tables = {name: _rows(getattr(self, name)) for name in _TABLES}
        return {
            "findings": [finding.as_json() for finding in self.findings],
            "sensors": self.sensors.model_dump(mode="json"),
            **{name: rows for name, rows in tables.items() if rows or name != "transducers"},
            "looked_at": self.looked_at,
            "falls": {name: fall._asdict() for name, fall in self.falls.items()},
            "gaps": self.gaps,
        }

    @property
    def recorder_sensors(self):
        """Kind of each sensor of the recorder by its name, ``channel`` or ``transducer``; all others are markers."""
        return {
            str(name): kind
            for table, kind in ((self.channels, "channel"), (self.transducers, "transducer"))
            for name in table[kind].values
        }

    @classmethod
    def from_json(cls, values):
        """Read the outcome from the values of `as_json`."""
        return cls(
            findings=tuple(map(Finding.from_json, values["findings"])),
            sensors=Sensors(**values["sensors"]),
            **{name: _table(name, values.get(name, {})) for name in _TABLES},
            looked_at=values["looked_at"],
            falls={name: Fall(**fall) for name, fall in values["falls"].items()},
            gaps=values["gaps"],
        )


def load_parity(path):
    """Parity of the file ``parity.json``.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    return load_made_json(path, Parity.from_json)


def _rows(table):
    """Values of every row of a table by its name, NaN as null."""
    frame = table.to_dataframe()
    return frame.astype(object).where(frame.notna(), None).to_dict("index")


def _table(name, rows):
    """Table of such rows; null is NaN."""
    dim, columns = _TABLES[name]
    frame = pd.DataFrame.from_dict(rows, orient="index", columns=columns, dtype=float)
    return xr.Dataset.from_dataframe(frame.rename_axis(dim))


def campaign_parity(readings, sensors, without=()):
    """`Parity` of the `OpenReadings` of a campaign; see `check_parity`.

    Findings of the effects ``without`` are left out, as if nobody had thought of them: the readings keep the fault.
    """
    parity = check_parity(readings.tests, readings.structure, sensors)
    findings = tuple(finding for finding in parity.findings if finding.effect not in without)
    return replace(parity, findings=findings, falls=readings.falls)


def check_parity(tests, structure, sensors, level=LEVEL):
    """`Parity`: faults of the sensors, found from readings alone.

    Parameters
    ----------
    tests : dict of str to xarray.Dataset
        By name, as in a campaign.
    structure : Structure
    sensors : Sensors
        Stated noise.
    level : float
        Chance of any finding where all sensors are within their tolerances; shared evenly by all hypotheses.

    Notes
    -----
    Markers are checked body by body against a rigid motion first; accelerometers and displacement transducers are then
    compared with the markers as corrected.
    """
    sensors = sensors.not_noiseless()
    noise, axes = sensors.marker_noise, sensors.marker_axes
    gaps = {
        name: faulty_lines(test) + short_lines(test) + initial_pose_lines(test)
        for name, test in tests.items()
    }
    findings = saturation(tests, level)
    tests = {name: without_outliers(test, initial_poses(structure, test)) for name, test in tests.items()}
    share = Level(level, _looked_at(bodies_with_markers(structure, tests), tests))

    def without(faults):
        findings.extend(faults)
        return {name: corrected(test, name, structure, faults) for name, test in tests.items()}

    tests = without(limited_markers(bodies_with_markers(structure, tests, axes).values(), noise, share))
    scaled = _whole_gains(structure, tests, sensors, share)
    tests = without(scaled)
    tests = without(marker_exchanges(structure, tests, noise, share))
    bodies = bodies_with_markers(structure, tests, axes)
    checks = {name: marker_faults.check_body(body, noise, share) for name, body in bodies.items()}
    creep = frame_drift(structure, tests, noise, share)
    tests = without([finding for check in checks.values() for finding in check.findings])
    findings += creep
    bodies = bodies_with_markers(structure, tests, axes)
    poses = {
        name: {key: pose for key, body in bodies.items() if (pose := measured_pose(body, index)) is not None}
        for index, name in enumerate(tests)
    }
    pairs = {
        name: channel_pairs(structure, test, poses[name], sensors.accelerometer_noise)
        for name, test in tests.items()
        if "accelerometer" in test
    }
    clock, common = clock_lags(pairs)
    lags = {name: clock[name].estimate[0] if name in clock else 0.0 for name in tests}
    gains, exchanges = channel_gains(pairs, lags), channel_exchanges(pairs, lags, share)
    exchanged = {name for finding in exchanges for name in finding.where}
    faultless = {
        name: [pair for pair in of_test if pair.name not in exchanged] for name, of_test in pairs.items()
    }
    findings += clock_findings(clock, common, share) + exchanges
    body_of = {marker.name: marker.body for marker in structure.file.markers}
    unsure = {
        f"{sensor.name}-{axis}": abs(finding.estimate[0])
        for finding in scaled
        for sensor in structure.file.accelerometers
        for axis in sensor.axes
        if sensor.body == body_of[finding.where[0]]
    }
    findings += gain_findings(
        {name: gain for name, gain in gains.items() if name not in exchanged}, pairs, share, unsure
    )
    findings += drift_findings(faultless, lags, sensors.accelerometer_noise, share)
    transducers = {
        name: transducer_faults.check_transducer(name, held, share)
        for name, held in held_readings(structure, tests, poses, lags).items()
    }
    findings += [finding for check in transducers.values() for finding in check.findings]
    markers = {str(name): (np.nan, np.nan) for name in next(iter(tests.values()))["marker"].values}
    read = (test["channel"].values for test in tests.values() if "channel" in test)
    channels = {str(name): (np.nan, np.nan) for names in read for name in names}
    for name, check in checks.items():
        markers |= zip(bodies[name].markers, zip(check.noise, check.misfit, strict=True), strict=True)
    return Parity(
        findings=tuple(findings),
        sensors=sensors,
        markers=_table("markers", markers),
        clock=_table("clock", _sizes(clock)),
        channels=_table("channels", channels | _sizes(gains)),
        transducers=_table("transducers", {name: check[:2] for name, check in transducers.items()}),
        looked_at=share.hypotheses,
        falls={},
        gaps=gaps,
    )


def _whole_gains(structure, tests, sensors, share):
    """Gains of all markers of a body, unless the rigid fit shows a fault of one marker alone: it moves the fit too."""
    bodies = bodies_with_markers(structure, tests, sensors.marker_axes)
    of_body = {marker.name: marker.body for marker in structure.file.markers}
    whole = []
    for finding in body_gains(structure, tests, sensors, share):
        body = bodies.get(of_body[finding.where[0]])
        faults = marker_faults.check_body(body, sensors.marker_noise, share).findings if body else ()
        if len({fault.where for fault in faults}) != 1:
            whole.append(finding)
    return whole


def _looked_at(bodies, tests):
    """Hypotheses: of markers, the optical frame and the clock, of channels and their pairs, and of transducers."""
    channels, transducers = (
        max(test.sizes.get(name, 0) for test in tests.values()) for name in ("channel", "transducer")
    )
    of_markers = sum(marker_faults.hypotheses(body) for body in bodies.values())
    of_channels = channels * (1 + channels + len(tests))
    of_transducers = transducers * transducer_faults.hypotheses(len(tests))
    return of_markers + 2 + 2 * len(tests) + of_channels + of_transducers


def _sizes(sizes):
    """Estimate and standard error of each `Size`."""
    return {name: (size.estimate[0], np.sqrt(size.covariance[0, 0])) for name, size in sizes.items()}


# of bodies that are filmed as poses, one reading each
UNCHECKED = Parity.from_json({"findings": [], "sensors": {}, "looked_at": 0, "falls": {}, "gaps": {}})
