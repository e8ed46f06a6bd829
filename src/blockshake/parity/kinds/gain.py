"""A sensor reads too large or too small: reading = (1 + g) truth."""

import numpy as np

from blockshake.parity.kinds.kind import Column, Kind, readings_of
from blockshake.parity.scored import Scored, by_segment, scored

_REST = 0.1  # s, whose mean is an accelerometer's reading at rest
_TOLERANCE = 1e-2  # of an accelerometer's calibration
_CROSS_SPREAD = 1e-2  # rad, by which a sensor's axes may be turned
_SEGMENT = 0.5  # s; longer than the kernels, so that segments are independent


def _correct(test, findings, structure):
    for finding in findings:
        for sensor in finding.where:
            variable, own = readings_of(test, sensor)
            if sensor not in test[next(iter(own))].values:
                continue
            values, rest = test[variable].loc[own].to_numpy(), 0.0
            if variable == "accelerometer":
                time = test["time_acc"].to_numpy()
                rest = np.nanmean(values[time <= time[0] + _REST])
            test[variable].loc[own] = rest + (values - rest) / (1.0 + finding.estimate)


GAIN = Kind("gain", "sensor-gain", "reading = (1 + g) truth", _correct)
OF_MARKER = Column(GAIN, 1, 2e-3, lambda seen: seen.moved[..., None])
OF_TRANSDUCER = Column(GAIN, 1, 1e-2, lambda held: held.expected[:, None], visible=0.03)


def gain_findings(gains, tests, level):
    """`Finding` of each channel whose gain (`Scored` by name) is beyond its tolerance, list."""
    return [
        one for name, gain in gains.items() for one in gain.finding(GAIN, (name,), tests, _TOLERANCE, level)
    ]


def channel_gains(pairs_by_test, lags):
    """Gain of every channel, reading over truth less 1, over all tests: dict of str to Scored.

    Parameters
    ----------
    pairs_by_test : dict of str to list of ChannelPair
    lags : dict of str to float
        Of the optical clock, by test [s].

    Notes
    -----
    The expectation is regressed on the reading, which has the smaller noise: the other way round the gain would be
    drawn towards zero. The sensor's other axes enter turned by a small unknown angle.
    """
    gains = {}
    for name in dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs):
        parts = []
        for test, pairs in pairs_by_test.items():
            pair = next((pair for pair in pairs if pair.name == name), None)
            if pair is None or pair.unseen or not pair.informed:
                continue
            others = [one for one in pairs if one.sensor == pair.sensor and one is not pair]
            columns = np.column_stack([one.read(pair.time - lags[test]) for one in (pair, *others)])
            known = pair.enough(columns.sum(axis=1))
            if known is not None:
                parts.append(
                    (pair.time[known] - pair.time[0], *_equation(columns[known], pair.expected[known]))
                )
        if not parts:
            continue
        normal, right = (sum(part[key] for part in parts) for key in (1, 2))
        slope = right / normal
        scores = [
            one
            for since, _, _, column, left in parts
            for one in by_segment((column * (left - slope * column))[:, None], since, _SEGMENT)
        ]
        inverse = scored(np.array([slope]), np.array([[normal]]), scores)
        if inverse is not None and slope != 0.0:
            gains[name] = Scored(1.0 / slope - np.ones(1), inverse.covariance / slope**4, inverse.freedom)
    return gains


def _equation(columns, expected):
    """Normal equation of a channel's slope, and channel and expectation without the sensor's other axes."""
    first, others = columns[:, 0], columns[:, 1:]
    noise = np.var(expected - first * (first @ expected) / (first @ first))
    tied = others.T @ others + noise / _CROSS_SPREAD**2 * np.eye(others.shape[1])
    column, left = (one - others @ np.linalg.solve(tied, others.T @ one) for one in (first, expected))
    return column @ first, column @ expected, column, left
