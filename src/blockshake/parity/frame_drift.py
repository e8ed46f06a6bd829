"""Drift of the optical system's whole frame, seen as a creep of the driven body."""

import numpy as np

from blockshake.measurement.sensors.markers import directions_read, marker_bodies
from blockshake.parity.finding import Finding, chance_within
from blockshake.parity.marker_equations import record_scale

_SEGMENT = 1.0  # s
_HALVES_DIFFER_BY_ERRORS = 3.0  # standard errors by which the drifts of a record's halves may differ
_HALVES_DIFFER_BY_SHARE = 0.3  # of the drift itself, by which they may differ besides


def frame_drift(structure, tests, marker_noise, level, looked_at):
    """Drifts that all markers of the driven bodies share, of each test: list of Finding.

    Across the shaking direction a table does not go anywhere; along it the displacement of the table's control, where
    there is one, is taken off first, and where there is none x is not judged. Neither is a direction that is not
    measured. A step is no drift: both halves of the record must creep alike.
    """
    driven = {body.name for body in structure.file.bodies if body.driven}
    findings = []
    for name, test in tests.items():
        own = [body in driven for body in marker_bodies(structure, test["marker"].values)]
        time = test["time"].to_numpy()
        values = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()[:, own]
        read = directions_read(values)
        centred = values - np.nanmedian(np.where(read, values, 0.0), axis=0)
        mean = np.where(read, centred, 0.0).sum(axis=1) / np.maximum(read.sum(axis=0), 1)
        table = test["table_displacement"].to_numpy() if "table_displacement" in test else None
        nuisance = [np.ones(len(time))] if table is None else [np.ones(len(time)), table]
        along = mean - (0.0 if table is None else np.column_stack([table, 0.0 * table, 0.0 * table]))
        axes = [axis for axis in range(0 if table is not None else 1, 3) if read[:, axis].any()]
        if not axes:
            continue
        whole = _slopes(time, along[:, axes], nuisance, np.isfinite(along[:, axes]).all(axis=1))
        if whole is None:
            continue
        estimate, covariance, freedom, gap, gap_error = whole
        p = looked_at * chance_within(estimate, covariance, marker_noise, freedom)
        allowed = _HALVES_DIFFER_BY_ERRORS * gap_error + _HALVES_DIFFER_BY_SHARE * np.abs(estimate)
        if p >= level or (np.abs(gap) > allowed).any():
            continue
        length = time[-1] - time[0]
        vector, square = np.zeros(3), np.full((3, 3), 0.0)
        vector[axes] = estimate / length
        square[np.ix_(axes, axes)] = covariance / length**2
        unseen = [axis for axis in range(3) if axis not in axes]
        square[unseen, unseen] = np.inf
        findings.append(Finding("sensor-drift", ("optical frame",), "drift", vector, square, p, (name,)))
    return findings


def _slopes(time, values, nuisance, known):
    """Change over the record of each column, its covariance, and the halves' difference with its error [m]."""
    if known.sum() < 100:
        return None
    scale = record_scale(time)[known]
    bend = np.abs(scale)  # its coefficient is half the difference of the slopes
    basis = np.linalg.qr(np.column_stack([column[known] for column in nuisance]))[0]
    design = np.column_stack([scale, bend])
    design = design - basis @ (basis.T @ design)
    left = values[known] - basis @ (basis.T @ values[known])
    inverse = np.linalg.inv(design.T @ design)
    slopes = inverse @ design.T @ left
    left = left - design @ slopes
    place = np.floor((time[known] - time[0]) / _SEGMENT)
    segments = np.unique(place)
    scores = np.array(
        [(inverse @ design[place == segment].T @ left[place == segment]) for segment in segments]
    )
    many = len(segments) / max(len(segments) - 3, 1)
    covariance = many * np.einsum("si,sj->ij", scores[:, 0], scores[:, 0])
    gap_error = 2.0 * np.sqrt(many * (scores[:, 1] ** 2).sum(axis=0))
    return slopes[0], covariance, max(len(segments) - 3, 4), 2.0 * slopes[1], gap_error
