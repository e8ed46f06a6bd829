"""Parity checks of a campaign's sensors against each other, without a simulator."""

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from blockshake.files import load_made_json
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.campaigns.faulty_readings import faulty_lines
from blockshake.measurement.motion.fall import Fall
from blockshake.measurement.sensors.markers import whole_markers
from blockshake.parity.acceleration_parity import channel_pairs
from blockshake.parity.body_gain import body_gains
from blockshake.parity.channel_findings import channel_findings
from blockshake.parity.correction import corrected
from blockshake.parity.finding import Finding
from blockshake.parity.frame_drift import frame_drift
from blockshake.parity.marker_equations import MarkerFaults
from blockshake.parity.marker_faults import BodyMarkers, check_body
from blockshake.parity.marker_swaps import unswapped
from blockshake.parity.saturation import saturation
from blockshake.parity.transducer_equations import held_readings
from blockshake.parity.transducer_faults import check_transducer, hypotheses

LEVEL = 0.01  # chance of any finding on a campaign of sound sensors
_FEWEST_MARKERS = 3
_MARKER_UNITS = {"noise": "m", "misfit": "m"}
_CLOCK_UNITS = {"lag": "s", "lag_error": "s"}
_GAIN_UNITS = {"gain": "1", "gain_error": "1"}


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
        """As JSON-like values, NaN as null."""
        transducers = _columns(self.transducers, "transducer")
        return {
            "findings": [finding.as_json() for finding in self.findings],
            "markers": _columns(self.markers, "marker"),
            "clock": _columns(self.clock, "test"),
            "channels": _columns(self.channels, "channel"),
            **({"transducers": transducers} if transducers else {}),
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
            markers=_table(values["markers"], "marker", _MARKER_UNITS),
            clock=_table(values["clock"], "test", _CLOCK_UNITS),
            channels=_table(values["channels"], "channel", _GAIN_UNITS),
            transducers=_table(values.get("transducers", {}), "transducer", _GAIN_UNITS),
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


def _columns(table, dim):
    """Columns of a table by the names along its dimension."""
    return {
        str(name): {
            column: float(table[column].sel({dim: name}))
            if np.isfinite(table[column].sel({dim: name}))
            else None
            for column in table.data_vars
        }
        for name in table[dim].values
    }


def _table(rows, dim, units):
    """Table of such columns; null is NaN."""
    return xr.Dataset(
        {
            column: (dim, np.array([row[column] for row in rows.values()], dtype=float), {"units": unit})
            for column, unit in units.items()
        },
        {dim: list(rows)},
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
    findings = saturation(tests, level, 2 * len(tests) * _channel_count(tests))
    bodies = _bodies(structure, tests)
    looked_at = _looked_at(bodies, tests)
    of_bodies = body_gains(structure, tests, sensors, level, looked_at)
    findings += of_bodies
    tests = {name: corrected(test, name, structure, of_bodies) for name, test in tests.items()}
    bodies = _bodies(structure, tests)
    tests, found = unswapped(tests, bodies, sensors.marker_noise, level, looked_at)
    findings += found
    bodies = _bodies(structure, tests)
    checks = {name: check_body(body, sensors.marker_noise, level, looked_at) for name, body in bodies.items()}
    findings += [finding for check in checks.values() for finding in check.findings]
    findings += frame_drift(structure, tests, sensors.marker_noise, level, looked_at)
    pairs = {
        name: channel_pairs(structure, test, *_of_one_test(name, bodies, checks), sensors.accelerometer_noise)
        for name, test in tests.items()
        if "accelerometer" in test
    }
    lags, gains, found = channel_findings(pairs, sensors.accelerometer_noise, level, looked_at)
    transducers = _transducer_checks(structure, tests, bodies, checks, lags, level, looked_at)
    found += [finding for check in transducers.values() for finding in check.findings]
    return Parity(
        findings=tuple(findings + found),
        markers=_table(_marker_rows(bodies, checks, tests), "marker", _MARKER_UNITS),
        clock=_table(_scored_rows(lags, "lag"), "test", _CLOCK_UNITS),
        channels=_table(_scored_rows(gains, "gain"), "channel", _GAIN_UNITS),
        transducers=_table(
            {name: {key: getattr(check, key) for key in _GAIN_UNITS} for name, check in transducers.items()},
            "transducer",
            _GAIN_UNITS,
        ),
        looked_at=looked_at,
        falls={},
        gaps={name: faulty_lines(test) for name, test in tests.items()},
    )


def _bodies(structure, tests):
    """`BodyMarkers` of every body that has three markers, with all directions measured, in all tests."""
    bodies = {}
    shared = set.intersection(*(set(whole_markers(test)) for test in tests.values()))
    for index, name in enumerate(structure.body_names):
        own = [marker for marker in structure.file.markers if marker.body == name and marker.name in shared]
        if len(own) < _FEWEST_MARKERS:
            continue
        names = [marker.name for marker in own]
        bodies[name] = BodyMarkers(
            name,
            tuple(names),
            np.array([marker.position for marker in own], dtype=float),
            structure.position[index],
            rotation_matrices(structure.orientation[index]),
            tuple(tests),
            [
                (
                    test["time"].to_numpy(),
                    test["marker_displacement"]
                    .sel(marker=names)
                    .transpose("time", "marker", "axis")
                    .to_numpy(),
                )
                for test in tests.values()
            ],
        )
    return bodies


def _of_one_test(name, bodies, checks):
    """Bodies as one test shows them, and the faults of their markers in it."""
    single, faults = {}, {}
    for key, body in bodies.items():
        place, found = body.tests.index(name), checks[key].faults
        single[key] = replace(body, tests=(name,), readings=[body.readings[place]])
        faults[key] = MarkerFaults(found.gain, found.place, found.drift[[place]])
    return single, faults


def _transducer_checks(structure, tests, bodies, checks, lags, level, looked_at):
    """`TransducerCheck` by name of every one that was read, the markers' faults taken out."""
    held = {}
    for name, test in tests.items():
        if "transducer_displacement" in test:
            for transducer in test["transducer"].values:
                held.setdefault(str(transducer), {})
            lag = lags[name].estimate[0] if name in lags else 0.0
            of_test = held_readings(structure, test, *_of_one_test(name, bodies, checks), lag)
            for transducer, one in of_test.items():
                held[transducer][name] = one
    return {name: check_transducer(name, one, level, looked_at) for name, one in held.items()}


def _channel_count(tests):
    return sum(
        3 * test.sizes["marker"] + test.sizes.get("channel", 0) + test.sizes.get("transducer", 0)
        for test in tests.values()
    )


def _looked_at(bodies, tests):
    """Hypotheses: of markers, the optical frame and the clock, of channels and their pairs, and of transducers."""
    channels, transducers = (
        max(test.sizes.get(name, 0) for test in tests.values()) for name in ("channel", "transducer")
    )
    of_markers = sum(len(body.hypotheses) for body in bodies.values())
    of_channels = channels * (1 + channels + len(tests)) + transducers * hypotheses(len(tests))
    return of_markers + 2 + 2 * len(tests) + of_channels


def _marker_rows(bodies, checks, tests):
    names = [str(name) for name in next(iter(tests.values()))["marker"].values]
    rows = {name: {"noise": np.nan, "misfit": np.nan} for name in names}
    for key, check in checks.items():
        for index, marker in enumerate(bodies[key].markers):
            rows[marker] = {
                "noise": check.equations.noise[index], "misfit": check.equations.misfit[index],
            }  # fmt: skip
    return rows


def _scored_rows(scores, name):
    """Estimate and standard error of each score."""
    return {
        key: {name: one.estimate[0], f"{name}_error": np.sqrt(one.covariance[0, 0])}
        for key, one in scores.items()
    }
