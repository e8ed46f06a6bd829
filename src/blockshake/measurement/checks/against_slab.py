"""Accelerometers and blocks against the slab's markers: clocks, units, signs and axes that the readings betray."""

import numpy as np

from blockshake.errors import InputError
from blockshake.measurement.campaigns.clocks import (
    AS_GOOD,
    BAND,
    RELATED,
    SHORTEST,
    correlation_summits,
    correlations_by_lag,
    in_band,
    other_lags,
    seconds,
)
from blockshake.measurement.sensors.accelerometers import EVEN

_END = 0.5  # s at both ends, where the filter is not yet itself
_GAPS = 0.05  # of the readings, which may be lost
_SEEN = 5.0  # times its noise, that the acceleration of the markers must have
_AS_GOOD = (
    0.01  # of correlation, by which another lag may fall short: two standard errors in noise of a fifth
)
_LAG = 0.01  # s without a word; the campaigns of data/ are found within 0.0012 s
_GAIN = (0.8, 1.25)  # accelerometer over marker, without a word; those of data/ are within 0.97 to 1.01
_IN_G = (0.5, 2.0)  # the same of readings in g
_GRAVITY = 9.81  # m/s2
_LOW_PART = 0.2  # of the slab's largest displacement along x: till then blocks have hardly slipped or rocked
_CARRIED = (0.2, 2.0)  # of the slab's displacement, by which blocks move in the low part; 0.4 to 1.1 in data/
_SEEN_READING = 10.0  # times the noise of a reading, that a displacement must reach to be judged
_FEWEST = 20  # readings


def clock_remarks(time, marker, time_acc, acceleration, noise, path, moved=False):
    """Lag of the accelerometers' clock by the slab's channels and markers along x; remarks on it, sign and size.

    Parameters
    ----------
    time, marker : float64 arrays, shape (n_times,)
        [s]; mean displacement of the slab's markers along x [m], gaps are NaN.
    time_acc, acceleration : float64 arrays, shape (n_readings,)
        [s]; mean of the slab's channels along x [m/s2], gaps are NaN.
    noise : float
        Standard deviation of ``marker`` [m].
    path : path
        File that is named in an error.
    moved : bool
        Whether `on_one_clock` has moved ``time_acc`` already.

    Returns
    -------
    lag : float or None
        By how much ``time_acc`` is too late [s]; 0 where nothing tells it, None where both agree at no lag.
    remarks : list of str

    Raises
    ------
    InputError
        The accelerometer reads in g.

    Notes
    -----
    Both are seen in 1 to 8 Hz, where the second difference of 0.1 mm of noise is 0.03 m/s2, at all lags that leave 3 s
    of both, by steps of a marker's reading; a parabola through the best gives the rest. A lag of at most 10 ms is taken
    where no other one is better by more than 0.01 of correlation.
    """
    if unfit(time, marker) or unfit(time_acc, acceleration):
        return 0.0, []
    step = np.median(np.diff(time))
    felt_at = np.arange(time_acc[0], time_acc[-1], step)
    inside = (time >= time[0] + _END) & (time <= time[-1] - _END)
    felt_inside = (felt_at >= felt_at[0] + _END) & (felt_at <= felt_at[-1] - _END)
    slab = np.gradient(np.gradient(banded(time, marker), step), step)[inside]
    read = banded(time_acc, acceleration)
    felt = np.interp(felt_at, time_acc, read)[felt_inside]
    if min(len(slab), len(felt)) * step < SHORTEST or not seen(slab, time, noise):
        return 0.0, []
    lags, correlation = correlations_by_lag(slab, felt, time[inside][0] - felt_at[felt_inside][0], 1.0 / step)
    peaks = correlation_summits(lags, correlation)
    best = max(peaks, key=lambda peak: abs(peak[1]), default=(0.0, 0.0))
    if abs(best[1]) < RELATED:
        tried = lags[correlation != 0.0]
        return None, [
            "the slab's accelerometer along x does not read what its markers do at any lag of its clock from "
            f"{tried.min(initial=0.0):.3g} to {tried.max(initial=0.0):.3g} s (correlation at most {abs(best[1]):.2f})"
        ]
    good = [peak for peak in peaks if abs(peak[1]) > abs(best[1]) - AS_GOOD]
    at_once = [peak for peak in good if abs(peak[0]) <= _LAG and peak[1] > 0.0]
    lag, _ = best = at_once[0] if at_once else best
    both = (time_acc - lag >= time[inside][0]) & (time_acc - lag <= time[inside][-1])
    shaken = np.interp(time_acc[both] - lag, time[inside], slab)
    gain = float(shaken @ read[both] / (shaken @ shaken))
    if _IN_G[0] < abs(gain) * _GRAVITY < _IN_G[1]:
        raise InputError(
            path, "accelerometer",
            f"expected m/s2; the slab's reads {gain:.3g} of what its markers do: it looks like g, or the markers have "
            "another unit",
        )  # fmt: skip
    others = [peak for peak in good if peak is not best]
    doubt = f"; {other_lags(best, others)}" if others else ""
    remarks = []
    if not _GAIN[0] < gain < _GAIN[1]:
        unsure = doubt if gain < 0.0 and abs(lag) <= _LAG else ""
        remarks.append(f"the slab's accelerometer along x reads {gain:.3g} of what its markers do{unsure}")
    if abs(lag) > _LAG:
        change = f"subtract {seconds(lag)} from" if lag > 0.0 else f"add {seconds(-lag)} to"
        remarks.append(
            f"{change} the accelerometers' times, by which the slab's accelerometer reads what its markers do "
            f"(correlation {abs(best[1]):.2f}){doubt}"
        )
    elif moved and others:
        remarks.append(
            f"the accelerometers' clock may be wrong by cycles of the shaking: {other_lags(best, others)}"
        )
    return lag, remarks


def carried_remarks(time, readings, names, slab, noise):
    """Remarks on markers of blocks that do not move with the slab while it moves little.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        [s]
    readings : float64 array, shape (n_times, n_markers, 3)
        Displacements of markers on blocks [m]; gaps are NaN, as is a direction that a marker does not measure.
    names : list of str, length n_markers
    slab : float64 array, shape (n_times, 3)
        Mean displacement of the slab's markers [m].
    noise : float
        Standard deviation of a reading [m].
    """
    size = np.abs(slab[:, 0])
    largest = np.nanmax(size)
    low = np.arange(len(time)) < np.argmax(size > _LOW_PART * largest)
    wrong = []
    if low.sum() >= _FEWEST and _LOW_PART * largest > _SEEN_READING * noise:
        for index, name in enumerate(names):
            read = np.isfinite(readings[:, index]).any(axis=0)
            known = low & np.isfinite(readings[:, index, read]).all(axis=1) & np.isfinite(slab[:, 0])
            base = slab[known, 0] - slab[known, 0].mean() if known.sum() >= _FEWEST else np.zeros(1)
            if not base.any() or not read[0]:
                continue
            share = base @ readings[known, index] / (base @ base)
            if not _CARRIED[0] < share[0] < _CARRIED[1]:
                along = ", ".join(
                    f"{part:.2f}" if is_read else "unknown" for part, is_read in zip(share, read, strict=True)
                )
                wrong.append(f"{name} moves by {along}")
    remarks = []
    if wrong:
        more = f", and {len(wrong) - 1} more markers likewise" if len(wrong) > 1 else ""
        remarks.append(
            f"{wrong[0]} (x, y, z) of the slab's x while that is below {1e3 * _LOW_PART * largest:.2g} mm, "
            f"expected near 1, 0, 0{more}"
        )
    return remarks


def seen(acceleration, time, noise):
    """Whether an acceleration in `BAND` [m/s2] stands out of that of white noise [m] at the times of the readings."""
    step = np.median(np.diff(time))
    unseen = noise * (2.0 * np.pi) ** 2 * np.sqrt((BAND[1] ** 5 - BAND[0] ** 5) / 5.0 * 2.0 * step)
    return acceleration.any() and np.sqrt(np.mean(acceleration**2)) >= _SEEN * unseen


def unfit(time, values):
    """Whether readings (n_times,) are too few, have too many gaps, or are uneven in time [s], to be filtered."""
    steps = np.diff(time)
    lost = np.mean(~np.isfinite(values))
    return time[-1] - time[0] < SHORTEST or lost > _GAPS or np.ptp(steps) > EVEN * np.median(steps)


def banded(time, values):
    """Readings (n_times,) in `BAND`, gaps bridged, without lag."""
    known = np.isfinite(values)
    return in_band(np.interp(time, time[known], values[known]), 1.0 / np.median(np.diff(time)))
