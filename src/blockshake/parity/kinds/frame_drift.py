"""The whole frame of the optical system creeps: the driven bodies seem to, where nothing moves them."""

import numpy as np

from blockshake.measurement.sensors.markers import slab_displacement
from blockshake.parity.finding import chance_within
from blockshake.parity.kinds.drift import DRIFT, FRAME, SEGMENT
from blockshake.parity.regression import regression

_FEWEST = 100  # readings
_SHORTEST = 3.0  # s: a shorter record has fewer than four segments, whose scatter tells no error
_HALVES_DIFFER_BY_ERRORS = 3.0  # standard errors by which the drifts of a record's halves may differ
_HALVES_DIFFER_BY_SHARE = 0.3  # of the drift itself, by which they may differ besides


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
        allowed = _HALVES_DIFFER_BY_ERRORS * np.sqrt(gap_variance) + _HALVES_DIFFER_BY_SHARE * np.abs(
            estimate
        )
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
    basis = np.linalg.qr(np.column_stack([np.ones(len(since)), *(column[known] for column in nuisance)]))[0]
    columns, rest = (part - basis @ (basis.T @ part) for part in (columns, values[known]))
    return regression([(columns, rest, since)], SEGMENT)
