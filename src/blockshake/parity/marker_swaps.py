"""Exchanged names and axes of markers, found by trial of every exchange."""

from dataclasses import replace

import numpy as np

from blockshake.measurement.motion.body_frame import see_from_body
from blockshake.parity.finding import Finding
from blockshake.parity.marker_faults import check_body

_SUSPECT_VARIANCE = 2.0  # times the stated variance that calls for a search
_SQUARES_LEFT_AT_MOST = 0.5  # of the sum of squares that putting back may leave at most
_AS_GOOD = 1.1  # times what the best single faults leave
_MOST_EXCHANGES = 4
_STRIDE = 4  # readings; noise of that distance is nearly independent
_VARIANCE_OF_COLOUR = 1.5  # what is left of the dependence
ORDERS = {"x and y": [1, 0, 2], "x and z": [2, 1, 0], "y and z": [0, 2, 1]}


def marker_swaps(bodies, marker_noise, level):
    """Findings of exchanged markers.

    Parameters
    ----------
    bodies : dict of str to BodyMarkers
    marker_noise, level
        As in `check_body`.

    Returns
    -------
    list of Finding
        With the quantity ``swap`` (two markers), ``axes`` (of one marker) or ``polarity`` (one axis); an exchange holds
        for all tests.

    Notes
    -----
    Every exchange is tried on the bodies whose markers do not move as one; it is accepted where it halves the sum of
    squares and leaves no more than gains, places and drifts would. Its chance is bounded by the ratio of likelihoods: a
    wrong hypothesis beats the true one by a factor L with a chance of at most 1/L.
    """
    findings = []
    while len(findings) < _MOST_EXCHANGES:
        squares = {name: _squares(body) for name, body in bodies.items()}
        best = (0.0, None)
        for name, (size, count) in squares.items():
            if size <= _SUSPECT_VARIANCE * marker_noise**2 * count:
                continue
            for quantity, where, change in _changes(name, bodies):
                tried = {key: bodies[key] for (key, _), _, _ in change}
                for (key, marker), source, turned in change:
                    tried[key] = _with_marker(tried[key], marker, _readings(bodies, source), turned)
                before = sum(squares[key][0] for key in tried)
                left = np.sum([_squares(body) for body in tried.values()], axis=0)
                if left[0] < _SQUARES_LEFT_AT_MOST * before and before - left[0] > best[0]:
                    best = (before - left[0], (quantity, where, tried, left))
        gained, exchange = best
        if exchange is None:
            break
        quantity, where, tried, left = exchange
        variance = max(left[0] / left[1], marker_noise**2)
        trials = level.hypotheses + sum(len(body.markers) for body in bodies.values()) ** 2
        p = trials * float(np.exp(-gained / (2.0 * variance * _VARIANCE_OF_COLOUR)))
        single = sum(
            (check_body(bodies[key], marker_noise, level).equations.noise ** 2).sum() for key in tried
        )
        exchanged = sum(
            (check_body(body, marker_noise, level).equations.noise ** 2).sum() for body in tried.values()
        )
        if p >= level.chance or exchanged >= _AS_GOOD * single:
            break
        findings.append(Finding.of(quantity, where, p, next(iter(bodies.values())).tests))
        bodies = bodies | tried
    return findings


def _changes(name, bodies):
    """Quantity and sensors of every exchange that touches a body: for each marker a source and a matrix."""
    same = np.eye(3)
    for marker in bodies[name].markers:
        own = (name, marker)
        for label, order in ORDERS.items():
            yield "axes", (marker, label), [(own, own, same[order])]
        for axis in range(3):
            yield "polarity", (marker, "xyz"[axis]), [(own, own, np.diag(1.0 - 2.0 * same[axis]))]
        for other_body, body in bodies.items():
            for other in ((other_body, marker) for marker in body.markers):
                if other > own:
                    yield "swap", (marker, other[1]), [(own, other, same), (other, own, same)]


def _readings(bodies, marker):
    """Readings (n_times, 3) of a marker of a body, by test."""
    body = bodies[marker[0]]
    return [values[:, body.markers.index(marker[1])] for _, values in body.readings]


def _with_marker(body, marker, readings, turned):
    """The body with other readings of a marker, along other axes; a gap along one axis is one along all."""
    column, changed = body.markers.index(marker), []
    for (time, values), new in zip(body.readings, readings, strict=True):
        values = values.copy()
        values[:, column] = new @ turned
        changed.append((time, values))
    return replace(body, readings=changed)


def _squares(body):
    """Sum of the squared residuals of all tests [m2] and the number of values that it is made of."""
    total = count = 0.0
    places = body.position + body.points @ body.rotation.T
    for _, displacement in body.readings:
        pose = see_from_body(body.points, places + displacement[::_STRIDE], body.position, body.rotation)
        checked = pose.projector.any(axis=(1, 2))
        if checked.any():
            residual = pose.residual[checked] - np.nanmean(pose.residual[checked], axis=0)
            total += np.nansum(residual**2)
            count += np.trace(pose.projector[checked], axis1=1, axis2=2).sum()
    return total, count
