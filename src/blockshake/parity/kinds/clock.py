"""The optical clock is behind the recorder's, or slow: its reading at t is of t - lag - skew (t - middle)."""

import numpy as np

from blockshake.parity.kinds.gain import SEGMENT
from blockshake.parity.kinds.kind import Kind
from blockshake.parity.regression import regression
from blockshake.parity.transducer_readings import STEP

_LAG_TOLERANCE = 5e-4  # s; half a millisecond of trigger jitter is no fault
_SKEW_TOLERANCE = 5e-5  # two quartz clocks
_COARSE_STRIDE = 5  # readings, a quarter of the band's shortest period
_FARTHEST_LAG = 0.1  # s, that is searched
_STEPS = 4  # of Newton's method


def _correct_lag(test, findings, structure):
    """Move the recorder's times onto the optical clock, which stays."""
    if "time_acc" in test.coords:
        for finding in findings:
            test.coords["time_acc"] = test["time_acc"] + finding.estimate[0]


def _correct_skew(test, findings, structure):
    if "time_acc" in test.coords:
        middle = 0.5 * float(test["time"][0] + test["time"][-1])
        for finding in findings:
            since = test["time_acc"] - middle
            test.coords["time_acc"] = test["time_acc"] + finding.estimate[0] * since


LAG = Kind("lag", "clock-lag", "marker read at t shows t - lag", _correct_lag, units=("s", "s"))
SKEW = Kind("skew", "clock-lag", "lag = skew (t - middle)", _correct_skew, size=None)


def clock_lags(pairs_by_test):
    """Lag of the optical clock behind the accelerometers', from the pairs by test.

    Returns
    -------
    lags : dict of str to Size
        Of each test [s]; a test that does not show it is missing.
    common : Size or None
        Lag at the middle of a record and skew, of all tests together [s, 1].
    """
    lags, parts = {}, []
    for name, pairs in pairs_by_test.items():
        informed = [pair for pair in pairs if pair.informed and not pair.unseen]
        lag, part = _coarse_lag(informed) if informed else 0.0, None
        for _ in range(_STEPS if informed else 0):
            part = _lag_equations(informed, lag)
            if part is None:
                break
            lag = (part[0][:, 0] @ part[1]) / (part[0][:, 0] @ part[0][:, 0])
        alone = regression([(part[0][:, :1], *part[1:])], SEGMENT) if part else None
        if alone is not None:
            lags[name] = alone
            parts.append(part)
    return lags, regression(parts, SEGMENT) if parts else None


def clock_findings(lags, common, level):
    """One lag and skew of all tests; the lag of single tests only where there is no common one: list of Finding."""
    if common is None:
        return []
    where = ("optical clock",)
    findings = common.part(0).finding(LAG, where, lags, _LAG_TOLERANCE, level)
    for name, lag in [] if findings else lags.items():
        findings += lag.finding(LAG, where, (name,), _LAG_TOLERANCE, level)
    return findings + common.part(1).finding(SKEW, where, lags, _SKEW_TOLERANCE, level)


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
    """Columns of lag and skew, values and times of all channels, linear about a lag; None of too little."""
    columns, values, times = [], [], []
    for pair in pairs:
        late = (pair.read(pair.time - lag - STEP) - pair.read(pair.time - lag + STEP)) / (2.0 * STEP)
        read = np.where(np.isfinite(late), pair.read(pair.time - lag), np.nan)
        known = pair.enough(read)
        if known is None:
            continue
        expected, read, since = pair.expected[known], read[known], pair.time[known] - pair.time[0]
        late = late[known] * (read @ expected) / (read @ read)
        design = np.column_stack([late, late * (since - 0.5 * np.ptp(pair.time))])
        design = design - np.outer(read, read @ design) / (read @ read)
        rest = expected - read * (read @ expected) / (read @ read)
        error = np.std(rest - design @ np.linalg.lstsq(design, rest, rcond=None)[0])
        columns.append(design / error)
        values.append(rest / error + lag * design[:, 0] / error)
        times.append(since)
    return tuple(map(np.concatenate, (columns, values, times))) if columns else None
