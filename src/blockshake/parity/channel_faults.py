"""Gain, drift and exchange of accelerometer channels, against the markers of the same bodies."""

import numpy as np

from blockshake.parity.finding import Finding
from blockshake.parity.scored import Scored, by_segment, scored

_GAIN_TOLERANCE = 1e-2  # of an accelerometer's calibration
_CROSS_SPREAD = 1e-2  # rad, by which a sensor's axes may be turned
_SEGMENT = 0.5  # s; longer than the kernels, so that segments are independent
_SLOW_SEGMENT = 1.0  # s
_MOVES = 1e-3  # m/s2, of what a channel should read at low frequencies: less tells no gain there
_MISFIT_LEFT_AT_MOST = 0.5  # of the misfit that another assignment may leave at most
_READINGS_PER_INDEPENDENT = 12.0  # marker readings for one independent value in the band, 200 Hz over 16


def channel_findings(pairs, lags, gains, noise, level):
    """Faults of the channels: list of Finding.

    Parameters
    ----------
    pairs : dict of str to list of ChannelPair
        By test.
    lags : dict of str to float
        Of the optical clock, by test [s].
    gains : dict of str to Scored
        From `channel_gains`.
    noise : float
        Stated standard deviation [m/s2]: the drift over a record that is tolerated.
    level : Level
    """
    swaps = channel_swaps(pairs, lags, level)
    swapped, findings = {name for finding in swaps for name in finding.where}, list(swaps)
    for name, gain in gains.items():
        if name not in swapped:
            findings += gain.finding("gain", (name,), pairs, _GAIN_TOLERANCE, level)
    for test, own in pairs.items():
        for pair in own:
            drift = None if pair.name in swapped else _drift(pair, lags[test])
            if drift is not None:
                length = np.ptp(pair.time)
                findings += drift.finding("drift", (pair.name,), (test,), noise, level, length)
    return findings


def channel_gains(pairs_by_test, lags):
    """Gain of every channel, reading over truth less 1, over all tests: dict of str to Scored."""
    names = dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs)
    gains = {}
    for name in names:
        normal, right, parts = 0.0, 0.0, []
        for test, pairs in pairs_by_test.items():
            pair = next((pair for pair in pairs if pair.name == name), None)
            if pair is None or pair.unseen or not pair.informed:
                continue
            others = [one for one in pairs if one.sensor == pair.sensor and one is not pair]
            columns = np.column_stack([one.read(pair.time - lags[test]) for one in (pair, *others)])
            known = pair.enough(columns.sum(axis=1))
            if known is None:
                continue
            columns, expected = columns[known], pair.expected[known]
            cross = _cross_fit(columns, expected)
            column = columns[:, 0] - columns[:, 1:] @ (cross @ columns[:, 0])
            normal, right = normal + column @ columns[:, 0], right + column @ expected
            parts.append((column, columns, cross, expected, pair.time[known] - pair.time[0]))
        if not parts:
            continue
        slope, scores = right / normal, []
        for column, columns, cross, expected, since in parts:
            left = expected - slope * columns[:, 0]
            left = left - columns[:, 1:] @ (cross @ left)
            scores += by_segment((column * left)[:, None], since, _SEGMENT)
        inverse = scored(np.array([slope]), np.array([[normal]]), scores)
        if inverse is not None and slope != 0.0:
            gains[name] = Scored(1.0 / slope - np.ones(1), inverse.covariance / slope**4, inverse.freedom)
    return gains


def _cross_fit(columns, expected):
    """Matrix that fits the sensor's other axes, turned by a small unknown angle, to a signal."""
    first, others = columns[:, 0], columns[:, 1:]
    noise = np.var(expected - first * (first @ expected) / (first @ first))
    return np.linalg.solve(others.T @ others + noise / _CROSS_SPREAD**2 * np.eye(others.shape[1]), others.T)


def _drift(pair, lag):
    """Change of a channel's zero over the record, `Scored` [m/s2], or None."""
    read = pair.read_slow(pair.time - lag)
    known = None if pair.unseen else pair.enough(read, pair.expected_slow)
    if known is None:
        return None
    since, expected = pair.time[known] - pair.time[0], pair.expected_slow[known]
    others = [np.ones(len(since)), expected] if np.std(expected) > _MOVES else [np.ones(len(since))]
    basis = np.linalg.qr(np.column_stack(others))[0]
    column, left = (
        values - basis @ (basis.T @ values)
        for values in (since / np.ptp(pair.time) - 0.5, read[known] - expected)
    )
    normal = column @ column
    slope = column @ left / normal
    scores = by_segment((column * (left - slope * column))[:, None], since, _SLOW_SEGMENT)
    return scored(np.array([slope]), np.array([[normal]]), scores)


def channel_swaps(pairs_by_test, lags, level):
    """Exchanged channels, and channels of reversed polarity: list of Finding.

    Notes
    -----
    p bounds the chance that the wrong assignment beats the true one by this ratio of likelihoods. An exchange must be
    seen from both sides.
    """
    names = list(dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs))
    clear = {}
    for name in names:
        for other in names:
            p = level.hypotheses * _chance_of_sound(name, other, pairs_by_test, lags)
            if p < level.chance:
                clear[name, other] = p
    findings = []
    for (name, other), p in clear.items():
        if name == other:
            findings.append(Finding.of("polarity", (name,), p, pairs_by_test))
        elif (other, name) in clear and name < other:
            findings.append(Finding.of("swap", (name, other), p, pairs_by_test))
    return findings


def _chance_of_sound(name, other, pairs_by_test, lags):
    """Chance of a misfit as it is, if the channel ``name`` is not ``other``, or itself reversed."""
    own_misfit = other_misfit = noise = count = 0.0
    for test, pairs in pairs_by_test.items():
        by_name = {pair.name: pair for pair in pairs}
        if name not in by_name or other not in by_name or not by_name[name].informed:
            continue
        pair = by_name[name]
        read = pair.read(pair.time - lags[test])
        instead = by_name[other].expected if other != name else -pair.expected
        known = np.isfinite(read) & np.isfinite(pair.expected) & np.isfinite(instead)
        own_misfit += ((read - pair.expected)[known] ** 2).sum()
        other_misfit += ((read - instead)[known] ** 2).sum()
        noise, count = max(noise, pair.noise), count + known.sum()
    if not count or other_misfit > _MISFIT_LEFT_AT_MOST * own_misfit:
        return 1.0
    variance = max(other_misfit / count, noise**2)
    return float(np.exp(-(own_misfit - other_misfit) / (2.0 * variance * _READINGS_PER_INDEPENDENT)))
