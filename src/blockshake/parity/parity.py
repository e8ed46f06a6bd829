"""Parity checks of a campaign's sensors against each other, without a simulator."""

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from blockshake.files import load_made_json
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.campaigns.faulty_readings import faulty_lines
from blockshake.measurement.motion.fall import Fall
from blockshake.measurement.sensors.markers import whole_markers
from blockshake.parity.acceleration_parity import channel_pairs, measured_pose
from blockshake.parity.body_gain import body_gains
from blockshake.parity.channel_faults import channel_findings, channel_gains
from blockshake.parity.clock import clock_findings, clock_lag
from blockshake.parity.correction import corrected
from blockshake.parity.finding import Finding, Level
from blockshake.parity.frame_drift import frame_drift
from blockshake.parity.marker_faults import BodyMarkers, check_body
from blockshake.parity.marker_swaps import marker_swaps
from blockshake.parity.transducer_equations import held_readings
from blockshake.parity.transducer_faults import check_transducer, hypotheses

LEVEL = 0.01  # chance of any finding on a campaign of sound sensors
_FEWEST_MARKERS = 3
_TABLES = {
    "markers": ("marker", {"noise": "m", "misfit": "m"}),
    "clock": ("test", {"lag": "s", "lag_error": "s"}),
    "channels": ("channel", {"gain": "1", "gain_error": "1"}),
    "transducers": ("transducer", {"gain": "1", "gain_error": "1"}),
}


@dataclass(frozen=True)
class Parity:
    """Outcome of the parity checks.

    Attributes
    ----------
    findings : tuple of Finding
    markers : xarray.Dataset
        ``noise(marker)`` of the readings after the findings are taken out and ``misfit(marker)`` before [m]; NaN on
        bodies with fewer than three markers.
    clock : xarray.Dataset
        ``lag(test)`` of the optical clock, with ``lag_error(test)`` [s].
    channels : xarray.Dataset
        ``gain(channel)``, reading over truth less 1, with ``gain_error(channel)`` [1].
    transducers : xarray.Dataset
        The same of displacement transducers; NaN where markers do not see the ends, or the bodies hardly moved apart.
    looked_at : int
        Number of hypotheses.
    falls : dict of str to Fall
        By test: the block that fell first; the test is judged until then.
    gaps : dict of str to list of str
        By test: lines on the readings that were taken as gaps.
    """

    findings: tuple
    markers: xr.Dataset
    clock: xr.Dataset
    channels: xr.Dataset
    transducers: xr.Dataset
    looked_at: int
    falls: dict
    gaps: dict

    def as_json(self):
        """As JSON-like values, NaN as null; of transducers only where there are any."""
        tables = {name: _rows(getattr(self, name), dim) for name, (dim, _) in _TABLES.items()}
        return {
            "findings": [finding.as_json() for finding in self.findings],
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
        """The parity of such values."""
        return cls(
            findings=tuple(map(Finding.from_json, values["findings"])),
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


def _rows(table, dim):
    """Values of every row of a table by its name, NaN as null."""
    columns = {name: column.to_numpy() for name, column in table.data_vars.items()}
    return {
        str(name): {key: float(own[row]) if np.isfinite(own[row]) else None for key, own in columns.items()}
        for row, name in enumerate(table[dim].values)
    }


def _table(name, rows):
    """Table of such rows; null is NaN."""
    dim, units = _TABLES[name]
    columns = {key: np.array([row[key] for row in rows.values()], dtype=float) for key in units}
    return xr.Dataset(
        {key: (dim, columns[key], {"units": unit}) for key, unit in units.items()}, {dim: list(rows)}
    )


def campaign_parity(readings, sensors, without=()):
    """`Parity` of the open tests of a campaign; see `check_parity`.

    Findings of the effects ``without`` are left out, as if nobody had thought of them: the readings keep the fault.

    Parameters
    ----------
    readings : OpenReadings
    sensors : Sensors
    without : sequence of str
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
    gaps = {name: faulty_lines(test) for name, test in tests.items()}
    share = Level(level, _looked_at(_bodies(structure, tests), tests))
    findings = body_gains(structure, tests, sensors, share)
    tests = _without(findings, tests, structure)
    swaps = marker_swaps(_bodies(structure, tests), sensors.marker_noise, share)
    tests = _without(swaps, tests, structure)
    bodies = _bodies(structure, tests)
    findings = _saturation(tests, level) + findings + swaps
    checks = {name: check_body(body, sensors.marker_noise, share) for name, body in bodies.items()}
    findings += [finding for check in checks.values() for finding in check.findings]
    findings += frame_drift(structure, tests, sensors.marker_noise, share)
    shown = {
        name: {key: measured_pose(body, checks[key].faults, index) for key, body in bodies.items()}
        for index, name in enumerate(tests)
    }
    pairs = {
        name: channel_pairs(structure, test, shown[name], sensors.accelerometer_noise)
        for name, test in tests.items()
        if "accelerometer" in test
    }
    clock = clock_lag(pairs)
    lags = {name: clock.by_test[name].estimate[0] if name in clock.by_test else 0.0 for name in tests}
    gains = channel_gains(pairs, lags)
    findings += clock_findings(clock, share)
    findings += channel_findings(pairs, lags, gains, sensors.accelerometer_noise, share)
    held = {}
    for name, test in tests.items():
        for transducer in test["transducer"].values if "transducer_displacement" in test else ():
            held.setdefault(str(transducer), {})
        for transducer, reading in held_readings(structure, test, shown[name], lags[name]).items():
            held[transducer][name] = reading
    transducers = {name: check_transducer(name, one, share) for name, one in held.items()}
    findings += [finding for check in transducers.values() for finding in check.findings]
    names = [str(name) for name in next(iter(tests.values()))["marker"].values]
    markers = {name: {"noise": np.nan, "misfit": np.nan} for name in names}
    for body, check in checks.items():
        for marker, noise, misfit in zip(
            bodies[body].markers, check.equations.noise, check.equations.misfit, strict=True
        ):
            markers[marker] = {"noise": noise, "misfit": misfit}
    return Parity(
        findings=tuple(findings),
        markers=_table("markers", markers),
        clock=_table("clock", _sizes(clock.by_test, "lag")),
        channels=_table("channels", _sizes(gains, "gain")),
        transducers=_table("transducers", {name: check._asdict() for name, check in transducers.items()}),
        looked_at=share.hypotheses,
        falls={},
        gaps=gaps,
    )


def _saturation(tests, level):
    """Findings of readings that stop at the end of a sensor's range, which were made gaps; a column has two ends."""
    looked_at = 2 * sum(
        3 * test.sizes["marker"] + test.sizes.get("channel", 0) + test.sizes.get("transducer", 0)
        for test in tests.values()
    )
    return [
        Finding.of("range", (fault.sensor,), fault.p * looked_at, (name,), [abs(fault.value)])
        for name, test in tests.items()
        for fault in test.attrs.get("faulty", ())
        if fault.kind == "clipped" and fault.p * looked_at < level
    ]


def _bodies(structure, tests):
    """`BodyMarkers` of every body that has three markers, with all directions measured, in all tests."""
    bodies = {}
    shared = set.intersection(*(set(whole_markers(test)) for test in tests.values()))
    for index, body in enumerate(structure.body_names):
        markers = [one for one in structure.file.markers if one.body == body and one.name in shared]
        if len(markers) < _FEWEST_MARKERS:
            continue
        names = [marker.name for marker in markers]
        readings = [
            (
                test["time"].to_numpy(),
                test["marker_displacement"].sel(marker=names).transpose("time", "marker", "axis").to_numpy(),
            )
            for test in tests.values()
        ]
        points = np.array([marker.position for marker in markers], dtype=float)
        start = structure.position[index], rotation_matrices(structure.orientation[index])
        bodies[body] = BodyMarkers(body, tuple(names), points, *start, tuple(tests), readings)
    return bodies


def _without(findings, tests, structure):
    """Tests without the faults that were found."""
    if not findings:
        return tests
    return {name: corrected(test, name, structure, findings) for name, test in tests.items()}


def _looked_at(bodies, tests):
    """Hypotheses: of markers, the optical frame and the clock, of channels and their pairs, and of transducers."""
    channels, transducers = (
        max(test.sizes.get(name, 0) for test in tests.values()) for name in ("channel", "transducer")
    )
    of_markers = sum(len(body.hypotheses) for body in bodies.values())
    of_channels = channels * (1 + channels + len(tests)) + transducers * hypotheses(len(tests))
    return of_markers + 2 + 2 * len(tests) + of_channels


def _sizes(scores, name):
    """Estimate and standard error of each score."""
    return {
        key: {name: one.estimate[0], f"{name}_error": np.sqrt(one.covariance[0, 0])}
        for key, one in scores.items()
    }
