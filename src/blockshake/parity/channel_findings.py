"""Faults of accelerometers and clocks: each estimate is held against its tolerance."""

from typing import NamedTuple

import numpy as np

from blockshake.parity.channel_faults import channel_drifts, channel_gains, clock_lag, swapped_channels
from blockshake.parity.finding import Finding, chance_within

LAG_TOLERANCE = 5e-4  # s; half a millisecond of trigger jitter is no fault
SKEW_TOLERANCE = 5e-5  # two quartz clocks
GAIN_TOLERANCE = 1e-2  # of an accelerometer's calibration


class ChannelFindings(NamedTuple):
    """Clock lags by test and gains by channel, each a `Scored`, and the findings."""

    lags: dict
    gains: dict
    findings: list


def channel_findings(pairs, accelerometer_noise, level, looked_at):
    """`ChannelFindings` of clock and channels.

    Parameters
    ----------
    pairs : dict of str to list of ChannelPair
        By test.
    accelerometer_noise : float
        Stated standard deviation [m/s2]: the drift over a record that is tolerated.
    level : float
        Of all hypotheses together.
    looked_at : int
        Number of hypotheses in the campaign.
    """
    lags, common = clock_lag(pairs)
    gains = channel_gains(pairs, lags)
    tests = tuple(pairs)

    def clear(scored, tolerance):
        """Chance times the number of hypotheses, None where it is no finding."""
        p = looked_at * chance_within(scored.estimate, scored.covariance, tolerance, scored.freedom)
        return p if p < level else None

    findings = _of_clock(lags, common, clear)
    swapped, found = _of_swaps(pairs, lags, level, looked_at)
    findings += found
    for name, scored in gains.items():
        p = clear(scored, GAIN_TOLERANCE)
        if p is not None and name not in swapped:
            findings.append(
                Finding("sensor-gain", (name,), "gain", scored.estimate, scored.covariance, p, tests)
            )
    for test, items in pairs.items():
        lag = lags[test].estimate[0] if test in lags else 0.0
        for name, scored in channel_drifts(items, lag).items():
            p = clear(scored, accelerometer_noise)
            if p is not None and name not in swapped:
                length = np.ptp(items[0].time)
                rate, covariance = scored.estimate / length, scored.covariance / length**2
                findings.append(Finding("sensor-drift", (name,), "drift", rate, covariance, p, (test,)))
    return ChannelFindings(lags, gains, findings)


def _of_clock(lags, common, clear):
    """One lag and skew of all tests; the lag of single tests only where there is no common one."""
    findings = []
    if common is None:
        return findings
    where = ("optical clock",)
    for place, (quantity, tolerance) in enumerate((("lag", LAG_TOLERANCE), ("skew", SKEW_TOLERANCE))):
        one = type(common)(common.estimate[[place]], common.covariance[[place]][:, [place]], common.freedom)
        p = clear(one, tolerance)
        if p is not None:
            findings.append(
                Finding("clock-lag", where, quantity, one.estimate, one.covariance, p, tuple(lags))
            )
    if any(finding.quantity == "lag" for finding in findings):
        return findings
    for name, lag in lags.items():
        p = clear(lag, LAG_TOLERANCE)
        if p is not None:
            findings.append(Finding("clock-lag", where, "lag", lag.estimate, lag.covariance, p, (name,)))
    return findings


def _of_swaps(pairs, lags, level, looked_at):
    """Names of exchanged or reversed channels, and their findings; an exchange must be seen from both sides."""
    clear = {
        (name, other): p * looked_at
        for name, other, p in swapped_channels(pairs, lags)
        if p * looked_at < level
    }
    findings, swapped = [], set()
    for (name, other), p in clear.items():
        if name == other:
            where, quantity = (name,), "polarity"
        elif (other, name) in clear and name < other:
            where, quantity = (name, other), "swap"
        else:
            continue
        findings.append(
            Finding("channel-swap", where, quantity, np.empty(0), np.empty((0, 0)), p, tuple(pairs))
        )
        swapped |= set(where)
    return swapped, findings
