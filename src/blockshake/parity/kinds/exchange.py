"""Exchanges of sensors, of axes and of signs, each tried by taking it out of the readings."""

import numpy as np

from blockshake.parity.body_markers import BodyMarkers, bodies_with_markers
from blockshake.parity.finding import MOST_MISFIT, chance_of_misfit
from blockshake.parity.kinds.channel_swap import AXES, ORDERS, POLARITY, SWAP
from blockshake.parity.marker_faults import check_body

_SUSPECT_VARIANCE = 2.0  # times the stated variance that calls for a search
_AS_GOOD = 1.1  # times what the best single faults leave
_MOST_EXCHANGES = 4
_STRIDE = 4  # readings of markers; noise of that distance is nearly independent
_VARIANCE_OF_COLOUR = 1.5  # what is left of the dependence
_READINGS_PER_INDEPENDENT = 12.0  # marker readings for one independent value in the band, 200 Hz over 16


def marker_exchanges(structure, tests, marker_noise, level):
    """Exchanged names, axes and signs of markers, each in all tests: list of Finding.

    Every exchange is tried on the bodies whose markers do not move as one; it is accepted where it halves the sum of
    squares and leaves no more than gains, places and drifts would.

    Parameters
    ----------
    structure : Structure
    tests : dict of str to xarray.Dataset
        By name, without outliers.
    marker_noise, level
        As in `check_body`.
    """
    tests = {name: test[["marker_displacement"]] for name, test in tests.items()}
    bodies, findings = bodies_with_markers(structure, tests), []
    trials = level.hypotheses + sum(len(body.markers) for body in bodies.values()) ** 2
    while len(findings) < _MOST_EXCHANGES:
        squares, best, most = {name: _squares(body) for name, body in bodies.items()}, None, 0.0
        for name, (size, count) in squares.items():
            if size <= _SUSPECT_VARIANCE * marker_noise**2 * count:
                continue
            for kind, where in _exchanges(name, bodies):
                trial = _taken_out(kind, where, structure, tests, bodies)
                before = sum(squares[key][0] for key in trial[1])
                after, values = np.sum([_squares(body) for body in trial[1].values()], axis=0)
                if after < MOST_MISFIT * before and before - after > most:
                    most, best = before - after, (kind, where, *trial, before, after, after / values)
        if best is None:
            break
        kind, where, changed, touched, before, after, variance = best
        p = trials * chance_of_misfit(before, after, max(variance, marker_noise**2) * _VARIANCE_OF_COLOUR)
        single, exchanged = (
            sum((check_body(group[name], marker_noise, level).noise ** 2).sum() for name in touched)
            for group in (bodies, touched)
        )
        if p >= level.chance or exchanged >= _AS_GOOD * single:
            break
        findings.append(kind.finding(where, p, tests))
        tests, bodies = changed, bodies | touched
    return findings


def _exchanges(name, bodies):
    """Kind and sensors of every exchange that touches a body."""
    for marker in bodies[name].markers:
        yield from ((AXES, (marker, axes)) for axes in ORDERS)
        yield from ((POLARITY, (marker, axis)) for axis in "xyz")
        for other_body, body in bodies.items():
            for other in body.markers:
                if (other_body, other) > (name, marker):
                    yield SWAP, (marker, other)


def _taken_out(kind, where, structure, tests, bodies):
    """Tests without an exchange, and the bodies that it touches."""
    changed = {name: test.copy(deep=True) for name, test in tests.items()}
    for test in changed.values():
        kind.correct(test, [kind.finding(where, 0.0, tests)], structure)
    touched = [name for name, body in bodies.items() if set(where) & set(body.markers)]
    return changed, {name: BodyMarkers.of(structure, name, changed, bodies[name].markers) for name in touched}


def _squares(body):
    """Sum of the squared residuals of all tests [m2] and the number of values that it is made of."""
    total = count = 0.0
    for number, (_, displacement) in enumerate(body.readings):
        pose = body.in_test(number).frame(displacement[::_STRIDE])
        checked = pose.projector.any(axis=(1, 2))
        if checked.any():
            residual = pose.residual[checked] - np.nanmean(pose.residual[checked], axis=0)
            total += np.nansum(residual**2)
            count += np.trace(pose.projector[checked], axis1=1, axis2=2).sum()
    return total, count


def channel_exchanges(pairs_by_test, lags, level):
    """Exchanged channels, and channels of reversed polarity: list of Finding; an exchange is seen from both sides."""
    names = list(dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs))
    clear = {}
    for name in names:
        for other in names:
            p = level.hypotheses * _chance_without_fault(name, other, pairs_by_test, lags)
            if p < level.chance:
                clear[name, other] = p
    findings = []
    for (name, other), p in clear.items():
        if name == other:
            findings.append(POLARITY.finding((name,), p, pairs_by_test))
        elif (other, name) in clear and name < other:
            findings.append(SWAP.finding((name, other), p, pairs_by_test))
    return findings


def _chance_without_fault(name, other, pairs_by_test, lags):
    """Chance of the misfit of a channel that is neither exchanged with ``other`` nor, of the same name, reversed."""
    before = after = noise = count = 0.0
    for test, pairs in pairs_by_test.items():
        by_name = {pair.name: pair for pair in pairs}
        if name not in by_name or other not in by_name or not by_name[name].informed:
            continue
        pair = by_name[name]
        read = pair.read(pair.time - lags[test])
        instead = by_name[other].expected if other != name else -pair.expected
        known = np.isfinite(read) & np.isfinite(pair.expected) & np.isfinite(instead)
        before += ((read - pair.expected)[known] ** 2).sum()
        after += ((read - instead)[known] ** 2).sum()
        noise, count = max(noise, pair.noise), count + known.sum()
    variance = max(after / count, noise**2) if count else 1.0
    return chance_of_misfit(before, after, variance * _READINGS_PER_INDEPENDENT)
