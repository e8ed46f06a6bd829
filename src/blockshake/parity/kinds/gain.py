"""A sensor reads too large or too small: reading = (1 + g) truth."""

import numpy as np

from blockshake.parity.kinds.kind import Column, Kind, readings_of
from blockshake.parity.regression import Size, regression

_REST = 0.1  # s, whose mean is an accelerometer's reading at rest
_TOLERANCE = 1e-2  # of an accelerometer's calibration
_VARIES = 0.3  # of a gain of markers, by which it may vary with the displacement
_CROSS_SPREAD = 1e-2  # rad, by which a sensor's axes may be turned
SEGMENT = 0.5  # s; longer than the kernels, so that segments are independent


def _correct(test, findings, structure):
    for finding in findings:
        for sensor in finding.where:
            variable, selection = readings_of(test, sensor)
            if sensor not in test[next(iter(selection))].values:
                continue
            values, rest = test[variable].loc[selection].to_numpy(), 0.0
            if variable == "accelerometer":
                time = test["time_acc"].to_numpy()
                rest = np.nanmean(values[time <= time[0] + _REST])
            test[variable].loc[selection] = rest + (values - rest) / (1.0 + finding.estimate)


GAIN = Kind("gain", "sensor-gain", "reading = (1 + g) truth", _correct)
OF_MARKER = Column(GAIN, 1, 2e-3, lambda seen: seen.moved[..., None])
OF_TRANSDUCER = Column(GAIN, 1, 1e-2, lambda held: held.expected[:, None], visible=0.03)


def channel_gains(pairs_by_test, lags):
    """Gain of every channel, reading over truth less 1, over all tests: dict of str to Size.

    By test: a list of `ChannelPair`, and the lag of the optical clock [s].

    Notes
    -----
    The expectation is regressed on the reading, which has the smaller noise: the other way round the gain would be
    drawn towards zero. The sensor's other axes enter turned by a small unknown angle.
    """
    gains = {}
    for name in dict.fromkeys(pair.name for pairs in pairs_by_test.values() for pair in pairs):
        parts = []
        for test, pairs in pairs_by_test.items():
            for pair in pairs:
                if pair.name != name or pair.unseen or not pair.informed:
                    continue
                axes = [
                    pair,
                    *(other for other in pairs if other.sensor == pair.sensor and other is not pair),
                ]
                columns = np.column_stack([axis.read(pair.time - lags[test]) for axis in axes])
                known = pair.enough(columns.sum(axis=1))
                if known is not None:
                    parts.append((columns[known], pair.expected[known], pair.time[known] - pair.time[0]))
        slope = _slope(parts) if parts else None
        if slope is not None and slope.estimate[0] != 0.0:
            size = slope.estimate[0]
            gains[name] = Size(1.0 / slope.estimate - 1.0, slope.covariance / size**4, slope.freedom)
    return gains


def _slope(parts):
    """Expectation over the reading, `Size` or None."""
    expected = np.concatenate([values for _, values, _ in parts])
    read = np.concatenate([columns[:, 0] for columns, _, _ in parts])
    noise = np.var(expected - read * (read @ expected) / (read @ read))
    ridge = np.full(parts[0][0].shape[1], noise / _CROSS_SPREAD**2)
    ridge[0] = 0.0
    slope = regression(parts, SEGMENT, ridge)
    return None if slope is None else slope.part(0)


def gain_findings(gains, tests, level, unsure):
    """Gains of channels, as of `channel_gains`, beyond their tolerance: list of Finding.

    ``unsure`` has by channel the gain that the markers of its body had: it may vary with the displacement.
    """
    return [
        finding
        for name, gain in gains.items()
        for finding in gain.finding(GAIN, (name,), tests, _TOLERANCE + _VARIES * unsure.get(name, 0.0), level)
    ]
