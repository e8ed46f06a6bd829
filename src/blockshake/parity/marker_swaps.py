"""Exchanged names and axes of markers, found by trial of every exchange."""

from dataclasses import replace
from typing import NamedTuple

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
_ORDERS = {"x and y": [1, 0, 2], "x and z": [2, 1, 0], "y and z": [0, 2, 1]}


class Unswapped(NamedTuple):
    """Tests by name with exchanged markers put back, and the findings."""

    tests: dict
    findings: list


def unswapped(tests, bodies, marker_noise, level, looked_at):
    """Tests with exchanged markers put back, and the findings.

    Parameters
    ----------
    tests : dict of str to xarray.Dataset
    bodies : dict of str to BodyMarkers
    marker_noise, level, looked_at
        As in `check_body`.

    Returns
    -------
    Unswapped
        Findings are ``channel-swap`` with the quantity ``swap`` (two markers), ``axes`` (of one marker) or
        ``polarity`` (one axis).

    Notes
    -----
    Every exchange is tried on the bodies whose markers do not move as one; it is accepted where it halves the sum of
    squares and leaves no more than gains, places and drifts would. Its chance is bounded by the ratio of likelihoods: a
    wrong hypothesis beats the true one by a factor L with a chance of at most 1/L. An exchange holds for all tests.
    """
    readings = {
        (name, marker): [values[:, index] for _, values in body.readings]
        for name, body in bodies.items()
        for index, marker in enumerate(body.markers)
    }
    findings = []
    while len(findings) < _MOST_EXCHANGES:
        squares = {name: _squares(body, readings) for name, body in bodies.items()}
        suspects = [
            name
            for name in bodies
            if squares[name][0] > _SUSPECT_VARIANCE * marker_noise**2 * squares[name][1]
        ]
        best = None
        for name in suspects:
            for change in _changes(name, bodies):
                touched = {key[0] for key in change[1]}
                tried = readings | {key: value(readings) for key, value in change[1].items()}
                before = sum(squares[key][0] for key in touched)
                after = sum(_squares(bodies[key], tried)[0] for key in touched)
                if after < _SQUARES_LEFT_AT_MOST * before and (best is None or before - after > best[0]):
                    best = (before - after, change[0], tried, touched)
        if best is None:
            break
        gained, (quantity, where), tried, touched = best
        left = [_squares(bodies[key], tried) for key in touched]
        variance = max(sum(item[0] for item in left) / sum(item[1] for item in left), marker_noise**2)
        p = float(np.exp(-gained / (2.0 * variance * _VARIANCE_OF_COLOUR)))
        trials = looked_at + len(readings) ** 2
        if p * trials >= level or not _beats_faults(
            bodies, readings, tried, touched, (marker_noise, level, looked_at)
        ):
            break
        findings.append(
            Finding("channel-swap", where, quantity, np.empty(0), np.empty((0, 0)), p * trials, tuple(tests))
        )
        readings = tried
    return Unswapped(_written(tests, readings) if findings else tests, findings)


def _changes(name, bodies):
    """((quantity, where), {(body, marker): new readings from the old}) for the markers of one body."""
    for marker in bodies[name].markers:
        own = (name, marker)
        for label, order in _ORDERS.items():
            yield ("axes", (marker, label)), {own: _reordered(own, order)}
        for axis in range(3):
            sign = np.where(np.arange(3) == axis, -1.0, 1.0)
            yield ("polarity", (marker, "xyz"[axis])), {own: _signed(own, sign)}
        for other_body, body in bodies.items():
            for other in body.markers:
                if (other_body, other) > own:
                    there = (other_body, other)
                    yield ("swap", (marker, other)), {own: _taken(there), there: _taken(own)}


def _reordered(key, order):
    return lambda readings: [values[:, order] for values in readings[key]]


def _signed(key, sign):
    return lambda readings: [values * sign for values in readings[key]]


def _taken(key):
    return lambda readings: readings[key]


def _with(body, readings):
    """The body with these readings of its markers."""
    own = [
        (time, np.stack([readings[body.name, marker][test] for marker in body.markers], axis=1))
        for test, (time, _) in enumerate(body.readings)
    ]
    return replace(body, readings=own)


def _squares(body, readings):
    """Sum of the squared residuals of all tests [m2] and the number of values that it is made of."""
    total = count = 0.0
    places = body.position + body.points @ body.rotation.T
    for _, displacement in _with(body, readings).readings:
        pose = see_from_body(body.points, places + displacement[::_STRIDE], body.position, body.rotation)
        checked = pose.projector.any(axis=(1, 2))
        if checked.any():
            residual = pose.residual[checked] - np.nanmean(pose.residual[checked], axis=0)
            total += np.nansum(residual**2)
            count += np.trace(pose.projector[checked], axis1=1, axis2=2).sum()
    return total, count


def _beats_faults(bodies, readings, tried, touched, options):
    """True if the exchange explains the readings at least as well as faults of single markers do."""
    exchanged = sum(
        (check_body(_with(bodies[key], tried), *options).equations.noise ** 2).sum() for key in touched
    )
    single = sum(
        (check_body(_with(bodies[key], readings), *options).equations.noise ** 2).sum() for key in touched
    )
    return exchanged < _AS_GOOD * single


def _written(tests, readings):
    """Tests with these readings."""
    new = {}
    for place, (name, test) in enumerate(tests.items()):
        values = test["marker_displacement"].transpose("time", "marker", "axis")
        array = values.to_numpy().copy()
        markers = [str(marker) for marker in values["marker"].values]
        for (_, marker), own in readings.items():
            array[:, markers.index(marker)] = own[place]
        new[name] = test.assign(marker_displacement=values.copy(data=array))
    return new
