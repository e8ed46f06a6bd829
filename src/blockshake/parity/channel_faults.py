"""Clock lag and skew, gain, drift and swapped channels, from accelerometers against markers."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

_CROSS_SPREAD = 1e-2  # rad, by which a sensor's axes may be turned
_SEGMENT = 0.5  # s; longer than the kernels, so that segments are independent
_SLOW_SEGMENT = 1.0  # s
_SIGNAL_TO_NOISE_NEEDED = 10.0  # times its own noise that a channel must show in the band
_READINGS_NEEDED = 50
_SEGMENTS_NEEDED = 4  # segments that carry the information
_MISFIT_LEFT_AT_MOST = 0.5  # of the misfit that another assignment may leave at most
_READINGS_PER_INDEPENDENT = 12.0  # marker readings for one independent value in the band, 200 Hz over 16
_COARSE_STRIDE = 5  # readings, a quarter of the band's shortest period
_FARTHEST_LAG = 0.1  # s, that is searched


@dataclass(frozen=True)
class Scored:
    """A linear estimate whose error comes from the scatter between segments."""

    estimate: np.ndarray
    covariance: np.ndarray
    freedom: float


class ClockLag(NamedTuple):
    """Lag of each test [s]; lag at the middle of a record and skew of all tests together [s, 1], or None."""

    by_test: dict
    common: Scored | None


def clock_lag(pairs_by_test):
    """`ClockLag` of the optical clock against the accelerometers, test by test and over time, from the pairs by test.

    Tests that tell nothing are missing.
    """
    lags, blocks = {}, []
    for name, pairs in pairs_by_test.items():
        informed = [pair for pair in pairs if _informed(pair) and not pair.unseen]
        if not informed:
            continue
        lag = _coarse_lag(informed)
        for _ in range(4):
            normals, scores = _lag_equations(informed, lag)
            if not len(normals):
                break
            lag += scores[:, 0].sum() / normals[:, 0, 0].sum()
        if not len(normals):
            continue
        alone = np.array([lag])
        found = _scored(alone, normals[:, :1, :1].sum(axis=0), list(scores[:, :1]))
        if found is not None:
            lags[name] = found
            blocks.append((np.array([lag, 0.0]), normals, scores))
    if not blocks:
        return ClockLag({}, None)
    normal = sum(normals.sum(axis=0) for _, normals, _ in blocks)
    right = sum(normals.sum(axis=0) @ start + scores.sum(axis=0) for start, normals, scores in blocks)
    estimate = np.linalg.solve(normal, right)
    left = [scores - normals @ (estimate - start) for start, normals, scores in blocks]
    return ClockLag(lags, _scored(estimate, normal, list(np.concatenate(left))))


def channel_gains(pairs_by_test, lags):
    """Gain of every channel, reading over truth less 1, over all tests: dict of str to Scored."""
    names = dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs)
    found = {}
    for name in names:
        normal, right, parts = 0.0, 0.0, []
        for test, pairs in pairs_by_test.items():
            pair = next((pair for pair in pairs if pair.name == name), None)
            if pair is None or pair.unseen or not _informed(pair):
                continue
            lag = lags[test].estimate[0] if test in lags else 0.0
            others = [item for item in pairs if item.sensor == pair.sensor and item is not pair]
            data = _together(pair, [pair, *others], lag)
            if data is None:
                continue
            expected, columns, place = data
            cross = _cross_fit(columns, expected)
            column = columns[:, 0] - columns[:, 1:] @ (cross @ columns[:, 0])
            normal, right = normal + column @ columns[:, 0], right + column @ expected
            parts.append((column, columns, cross, expected, place))
        if not parts:
            continue
        slope = right / normal
        scores = []
        for column, columns, cross, expected, place in parts:
            left = expected - slope * columns[:, 0]
            left = left - columns[:, 1:] @ (cross @ left)
            scores += _by_segment((column * left)[:, None], place)
        scored = _scored(np.array([slope]), np.array([[normal]]), scores)
        if scored is not None and slope != 0.0:
            found[name] = Scored(1.0 / scored.estimate - 1.0, scored.covariance / slope**4, scored.freedom)
    return found


def channel_drifts(pairs, lag):
    """Change of each channel's zero over the record: dict of str to Scored [m/s2]."""
    found = {}
    for pair in pairs:
        if pair.unseen:
            continue
        read = pair.read_slow(pair.time - lag)
        known = np.isfinite(read) & np.isfinite(pair.expected_slow)
        if known.sum() < _READINGS_NEEDED:
            continue
        length = pair.time[-1] - pair.time[0]
        scale = (pair.time[known] - pair.time[0]) / length - 0.5
        others = np.column_stack([np.ones(known.sum()), pair.expected_slow[known]])
        others = others[:, : 2 if np.std(others[:, 1]) > 1e-3 else 1]
        basis = np.linalg.qr(others)[0]
        column = scale - basis @ (basis.T @ scale)
        left = read[known] - pair.expected_slow[known]
        left = left - basis @ (basis.T @ left)
        normal = column @ column
        slope = column @ left / normal
        place = np.floor((pair.time[known] - pair.time[0]) / _SLOW_SEGMENT)
        scored = _scored(
            np.array([slope]),
            np.array([[normal]]),
            _by_segment((column * (left - slope * column))[:, None], place),
        )
        if scored is not None:
            found[pair.name] = scored
    return found


def swapped_channels(pairs_by_test, lags):
    """Exchanged channels, and channels of reversed polarity.

    Returns
    -------
    list of (channel, other, p)
        ``other`` is the channel itself for a reversed polarity. p bounds the chance that the wrong assignment beats
        the true one by this ratio of likelihoods.
    """
    names = list(dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs))
    found = []
    for name in names:
        for other in names:
            own_misfit = other_misfit = noise = count = 0.0
            for test, pairs in pairs_by_test.items():
                by_name = {pair.name: pair for pair in pairs}
                if name not in by_name or other not in by_name or not _informed(by_name[name]):
                    continue
                pair, rival = by_name[name], by_name[other]
                read = pair.read(pair.time - (lags[test].estimate[0] if test in lags else 0.0))
                instead = rival.expected if other != name else -pair.expected
                known = np.isfinite(read) & np.isfinite(pair.expected) & np.isfinite(instead)
                own_misfit += ((read - pair.expected)[known] ** 2).sum()
                other_misfit += ((read - instead)[known] ** 2).sum()
                noise = max(noise, pair.noise)
                count += known.sum()
            if not count or other_misfit > _MISFIT_LEFT_AT_MOST * own_misfit:
                continue
            variance = max(other_misfit / count, noise**2)
            found.append((
                name, other,
                float(np.exp(-(own_misfit - other_misfit) / (2.0 * variance * _READINGS_PER_INDEPENDENT))),
            ))  # fmt: skip
    return found


def _informed(pair):
    read = pair.read(pair.time)
    return (
        np.isfinite(read).sum() > _READINGS_NEEDED and np.nanstd(read) > _SIGNAL_TO_NOISE_NEEDED * pair.noise
    )


def _coarse_lag(pairs):
    """Lag of the largest correlation, on a grid of the markers' step."""
    step = pairs[0].time[1] - pairs[0].time[0]
    grid = np.arange(-_FARTHEST_LAG, _FARTHEST_LAG + 1e-9, step)
    misfit = np.zeros(len(grid))
    for pair in pairs:
        rows = np.flatnonzero(np.isfinite(pair.expected))[::_COARSE_STRIDE]
        time, expected = pair.time[rows], pair.expected[rows]
        for index, lag in enumerate(grid):
            read = np.nan_to_num(pair.read(time - lag))
            slope = (read @ expected) / (read @ read)
            misfit[index] += ((expected - slope * read) ** 2).sum() / (expected @ expected)
    return grid[misfit.argmin()]


def _lag_equations(pairs, lag):
    """Normal matrices and scores of (change of lag, skew) in each segment, all channels together."""
    normals, scores = {}, {}
    for pair in pairs:
        step = 1e-3
        late = (pair.read(pair.time - lag - step) - pair.read(pair.time - lag + step)) / (2.0 * step)
        read = np.where(np.isfinite(late), pair.read(pair.time - lag), np.nan)
        known = np.isfinite(pair.expected) & np.isfinite(read)
        if known.sum() < _READINGS_NEEDED:
            continue
        expected, read = pair.expected[known], read[known]
        late = late[known] * (read @ expected) / (read @ read)
        time = pair.time[known] - 0.5 * (pair.time[0] + pair.time[-1])
        design = np.column_stack([late, late * time])
        design = design - np.outer(read, read @ design) / (read @ read)
        left = expected - read * (read @ expected) / (read @ read)
        weight = 1.0 / np.var(left - design @ np.linalg.lstsq(design, left, rcond=None)[0])
        place = np.floor((pair.time[known] - pair.time[0]) / _SEGMENT)
        for segment in np.unique(place):
            rows = place == segment
            normals[segment] = normals.get(segment, 0.0) + weight * design[rows].T @ design[rows]
            scores[segment] = scores.get(segment, 0.0) + weight * design[rows].T @ left[rows]
    return np.array(list(normals.values())), np.array(list(scores.values()))


def _together(pair, regressors, lag):
    """Expected values, readings of the regressors and segment numbers where everything is known."""
    columns = np.column_stack([item.read(pair.time - lag) for item in regressors])
    known = np.isfinite(pair.expected) & np.isfinite(columns).all(axis=1)
    if known.sum() < _READINGS_NEEDED:
        return None
    place = np.floor((pair.time[known] - pair.time[0]) / _SEGMENT)
    return pair.expected[known], columns[known], place


def _cross_fit(columns, expected):
    """Matrix that fits the sensor's other axes, turned by a small unknown angle, to a signal."""
    own, others = columns[:, 0], columns[:, 1:]
    noise = np.var(expected - own * (own @ expected) / (own @ own))
    return np.linalg.solve(others.T @ others + noise / _CROSS_SPREAD**2 * np.eye(others.shape[1]), others.T)


def _by_segment(scores, place):
    return [scores[place == segment].sum(axis=0) for segment in np.unique(place)]


def _scored(estimate, normal, scores):
    """Sandwich covariance from the segments' scores, with as many degrees of freedom as segments carry weight."""
    scores = np.array(scores)
    power = (scores**2).sum(axis=1)
    if len(scores) < _SEGMENTS_NEEDED or not power.sum():
        return None
    effective = power.sum() ** 2 / (power**2).sum()
    freedom = max(0.5 * (len(scores) + effective) - len(estimate), 1.0)
    inverse = np.linalg.inv(normal)
    covariance = inverse @ (scores.T @ scores) @ inverse * len(scores) / max(len(scores) - len(estimate), 1)
    return Scored(estimate, covariance, freedom)
