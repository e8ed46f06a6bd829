"""The zero of a sensor creeps: reading = truth + d t."""

import numpy as np

from blockshake.parity.kinds.kind import Column, Kind, readings_of
from blockshake.parity.regression import regression

FRAME = ("optical frame",)
SEGMENT = 1.0  # s
_MOVES = 1e-3  # m/s2, of what a channel should read at low frequencies: less tells no gain there


def _correct(test, findings, structure):
    for finding in findings:
        variable, selection = (
            ("marker_displacement", {}) if finding.where == FRAME else readings_of(test, *finding.where)
        )
        readings = test[variable].loc[selection]
        clock = test["time" if variable == "marker_displacement" else "time_acc"].to_numpy()
        since = (clock - clock[0]).reshape(-1, *(readings.ndim - 1) * [1])
        test[variable].loc[selection] = readings - since * finding.estimate


DRIFT = Kind("drift", "sensor-drift", "reading = truth + d t", _correct, units=("m/s", "m/s3"))


def of_marker(noise):
    """Column of a marker's drift over the record, of which its stated noise [m] is tolerated."""
    return Column(DRIFT, 3, noise, _signature, by_test=True)


def _signature(seen):
    return (seen.scale[:, None, None] * seen.back)[:, None]


def drift_findings(pairs_by_test, lags, noise, level):
    """Drifts of single channels, in single tests, beyond the noise [m/s2] over a record: list of Finding."""
    findings = []
    for test, pairs in pairs_by_test.items():
        for pair in pairs:
            drift = _drift(pair, lags[test])
            if drift is not None:
                findings += drift.finding(DRIFT, (pair.name,), (test,), noise, level, np.ptp(pair.time))
    return findings


def _drift(pair, lag):
    """Change of a channel's zero over the record, `Size` [m/s2], or None."""
    read = pair.read_slow(pair.time - lag)
    known = None if pair.unseen else pair.enough(read, pair.expected_slow)
    if known is None:
        return None
    since, expected = pair.time[known] - pair.time[0], pair.expected_slow[known]
    others = [np.ones(len(since)), expected] if np.std(expected) > _MOVES else [np.ones(len(since))]
    basis = np.linalg.qr(np.column_stack(others))[0]
    column, rest = (
        values - basis @ (basis.T @ values)
        for values in (since / np.ptp(pair.time) - 0.5, read[known] - expected)
    )
    return regression([(column[:, None], rest, since)], SEGMENT)
