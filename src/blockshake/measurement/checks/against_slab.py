"""Accelerometers and blocks against the slab's markers: clocks, units, signs and axes that the readings betray."""

import numpy as np

from blockshake.errors import InputError
from blockshake.measurement.campaigns.clocks import BAND, RELATED, SHORTEST, in_band
from blockshake.measurement.sensors.accelerometers import EVEN

_END = 0.5  # s at both ends, where the filter is not yet itself
_GAPS = 0.05  # of the readings, which may be lost
_SEEN = 5.0  # times its noise, that the acceleration of the markers must have
_LARGEST_LAG = 0.05  # s searched: less than half a period of 8 Hz, so that a sine's sign is never in doubt
_LAG = 0.01  # s without a word; the campaigns of data/ are found within 0.0012 s
_GAIN = (0.8, 1.25)  # accelerometer over marker, without a word; those of data/ are within 0.97 to 1.01
_IN_G = (0.5, 2.0)  # the same of readings in g
_GRAVITY = 9.81  # m/s2
_LOW_PART = 0.2  # of the slab's largest displacement along x: till then blocks have hardly slipped or rocked
_CARRIED = (0.2, 2.0)  # of the slab's displacement, by which blocks move in the low part; 0.4 to 1.1 in data/
_SEEN_READING = 10.0  # times the noise of a reading, that a displacement must reach to be judged
_FEWEST = 20  # readings
_SIDEWAYS = 3.0  # times the motion along z, that blocks shaken along x do not move along y


def clock_remarks(time, marker, time_acc, acceleration, noise, path):
    """Remarks on the slab's accelerometer along x against the slab's markers: clock, sign and size.

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

    Raises
    ------
    InputError
        The accelerometer reads in g.

    Notes
    -----
    Both are seen in 1 to 8 Hz, where the second difference of 0.1 mm of noise is 0.03 m/s2; lags up to 50 ms are
    tried by steps of a reading, and a parabola through the best gives the rest.
    """
    if _unfit(time, marker) or _unfit(time_acc, acceleration):
        return []
    begin = max(time[0], time_acc[0]) + _END + _LARGEST_LAG
    end = min(time[-1], time_acc[-1]) - _END - _LARGEST_LAG
    inside = (time >= begin) & (time <= end)
    if end - begin < SHORTEST:
        return []
    step = np.median(np.diff(time))
    moved = np.gradient(np.gradient(_band(time, marker), time), time)[inside]
    unseen = noise * (2.0 * np.pi) ** 2 * np.sqrt((BAND[1] ** 5 - BAND[0] ** 5) / 5.0 * 2.0 * step)
    if np.sqrt(np.mean(moved**2)) < _SEEN * unseen or not moved.any():
        return []
    read = _band(time_acc, acceleration)
    lags = step * np.arange(-int(_LARGEST_LAG / step), int(_LARGEST_LAG / step) + 1)
    shifted = [np.interp(time[inside] - lag, time_acc, read) for lag in lags]
    correlation = np.array([_correlation(moved, values) for values in shifted])
    best = int(np.abs(correlation).argmax())
    if abs(correlation[best]) < RELATED:
        return [
            f"the slab's accelerometer along x does not read what its markers do (correlation {correlation[best]:.2f})"
        ]
    gain = float(moved @ shifted[best] / (moved @ moved))
    if _IN_G[0] < abs(gain) * _GRAVITY < _IN_G[1]:
        raise InputError(
            path, "accelerometer",
            f"expected m/s2; the slab's reads {gain:.3g} of what its markers do: it looks like g, or the markers have "
            "another unit",
        )  # fmt: skip
    remarks = []
    if not _GAIN[0] < gain < _GAIN[1]:
        remarks.append(f"the slab's accelerometer along x reads {gain:.3g} of what its markers do")
    lag = lags[best] + step * _parabola(np.abs(correlation), best)
    if abs(lag) > _LAG:
        late = "behind" if lag > 0.0 else "ahead of"
        remarks.append(f"the markers' clock is {1e3 * abs(lag):.3g} ms {late} the accelerometers'")
    return remarks


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
    spread = [
        np.sqrt(np.mean(part[np.isfinite(part)] ** 2 if np.isfinite(part).any() else 0.0))
        for part in np.moveaxis(readings, -1, 0)
    ]
    if np.isfinite(readings[..., 2]).any() and spread[1] > max(_SIDEWAYS * spread[2], _SEEN_READING * noise):
        remarks.append(
            f"the blocks move by {1e3 * spread[1]:.2g} mm along y and {1e3 * spread[2]:.2g} mm along z (rms): "
            "are y and z swapped?"
        )
    return remarks


def _unfit(time, values):
    """Too short, too many gaps, or uneven."""
    steps = np.diff(time)
    lost = np.mean(~np.isfinite(values))
    return time[-1] - time[0] < SHORTEST or lost > _GAPS or np.ptp(steps) > EVEN * np.median(steps)


def _band(time, values):
    known = np.isfinite(values)
    return in_band(np.interp(time, time[known], values[known]), 1.0 / np.median(np.diff(time)))


def _correlation(first, second):
    size = np.sqrt((first @ first) * (second @ second))
    return first @ second / size if size > 0.0 else 0.0


def _parabola(values, best):
    """Place of the summit next to the best value, in steps; 0 at an end."""
    if not 0 < best < len(values) - 1:
        return 0.0
    before, here, after = values[best - 1 : best + 2]
    return 0.5 * (before - after) / (before - 2.0 * here + after)
