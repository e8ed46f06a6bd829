"""The zero of a sensor, or the whole optical frame, creeps: reading = truth + d t; or it slips once."""

import numpy as np

from blockshake.measurement.sensors.markers import slab_displacement
from blockshake.parity.finding import chance_within
from blockshake.parity.kinds.kind import Column, Kind, readings_of
from blockshake.parity.regression import regression

FRAME = ("optical frame",)
SEGMENT = 1.0  # s
_MOVES = 1e-3  # m/s2, of what a channel should read at low frequencies: less tells no gain there
_FEWEST = 100  # readings, of the optical frame
_SHORTEST = 3.0  # s: a shorter record has fewer than four segments, whose scatter tells no error
_HALVES_BY_ERRORS = 3.0  # standard errors by which the drifts of a record's halves may differ
_HALVES_BY_SHARE = 0.3  # of the drift itself, by which they may differ besides


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


def _take_step_out(test, findings, structure):
    for finding in findings:
        variable, selection = readings_of(test, *finding.where)
        size, time = finding.estimate
        test[variable].loc[selection] -= size * (test["time_acc"].to_numpy() > time)


SLIP = Kind(
    "slip", "sensor-drift", "reading = truth + s H(t - t0)", _take_step_out, units=("m", "m"), size=None
)
# m, of a hook or a bracket that beds in; what a slip leaves is a step, whose time is searched
OF_END = Column(SLIP, 1, 5e-4, lambda held: held.misfit[:, None] * 0.0, by_test=True)


def of_marker(noise):
    """Column of a marker's drift over the record, of which its stated noise [m] is tolerated."""
    return Column(
        DRIFT, 3, noise, lambda seen: (seen.scale[:, None, None] * seen.back)[:, None], by_test=True
    )


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
    return _regression(others, (since / np.ptp(pair.time) - 0.5)[:, None], read[known] - expected, since)


def _regression(others, columns, values, since):
    """Regression of values on columns with others, which have no meaning: `Size` or None."""
    basis = np.linalg.qr(np.column_stack(others))[0]
    columns, values = (part - basis @ (basis.T @ part) for part in (columns, values))
    return regression([(columns, values, since)], SEGMENT)


def frame_drift(structure, tests, marker_noise, level):
    """Drifts that all markers of the driven bodies share, of each test: list of Finding.

    Across the shaking direction a table does not go anywhere; along it the displacement of the table's control, where
    there is one, is taken off first, and where there is none x is not judged. Neither is a direction that is not
    measured. A step is no drift: both halves of the record must creep alike.
    """
    findings = []
    for name, test in tests.items():
        time, along, nuisance = test["time"].to_numpy(), slab_displacement(test, structure), []
        if "table_displacement" in test:
            nuisance = [test["table_displacement"].to_numpy()]
            along[:, 0] -= nuisance[0]
        slopes = {axis: _slope(time, along[:, axis], nuisance) for axis in range(1 - len(nuisance), 3)}
        slopes = {axis: slope for axis, slope in slopes.items() if slope is not None}
        if not slopes:
            continue
        axes, sizes = list(slopes), slopes.values()
        estimate, gap = np.transpose([slope.estimate for slope in sizes])
        variance, gap_variance = np.transpose([np.diagonal(slope.covariance) for slope in sizes])
        freedom = min(slope.freedom for slope in sizes)
        p = level.hypotheses * chance_within(estimate, np.diag(variance), marker_noise, freedom)
        allowed = _HALVES_BY_ERRORS * np.sqrt(gap_variance) + _HALVES_BY_SHARE * np.abs(estimate)
        if p >= level.chance or (np.abs(gap) > allowed).any():
            continue
        vector, square = np.zeros(3), np.full(3, np.inf)
        vector[axes], square[axes] = estimate, variance
        length = np.ptp(time)
        findings.append(DRIFT.finding(FRAME, p, (name,), vector / length, np.diag(square) / length**2))
    return findings


def short_lines(test):
    """Lines for a reader on a record that is too short for this check."""
    length = float(test["time"][-1] - test["time"][0])
    if length >= _SHORTEST:
        return []
    return [f"a record of {length:.3g} s is too short to show a drift of the optical frame"]


def _slope(time, values, nuisance):
    """Change over the record, and what the halves change by otherwise, `Size` [m]; None where too little is read."""
    known = np.isfinite(values)
    if known.sum() < _FEWEST:
        return None
    since = time[known] - time[0]
    scale = since / (time[-1] - time[0]) - 0.5
    # the coefficient of its size is half the difference of the slopes
    columns = np.column_stack([scale, 0.5 * np.abs(scale)])
    others = [np.ones(len(since)), *(column[known] for column in nuisance)]
    return _regression(others, columns, values[known], since)
