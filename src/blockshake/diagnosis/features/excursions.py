"""Excursions of one history: turning points, steps of slip, swings of rocking and how they die out."""

from typing import NamedTuple

import numpy as np
from scipy.stats import theilslopes

_SWING_LEVEL = 0.25  # of the peak, above the noise of a swing of 5 sigma
_FEWEST_STEPS = 4  # for an exponent
_FARTHEST_TURNS = 3
_PARABOLA_HALF_WIDTH = 5  # readings to each side in the parabola at a turning point: 25 ms at 200 Hz


class Decay(NamedTuple):
    """Decay of swings: mean period [s], number of half-cycles [1], logarithmic decrement of a half-cycle [1]."""

    period: float
    half_cycles: int
    decrement: float


def turning_points(values, threshold):
    """Places at which a history turns back by more than a threshold.

    Parameters
    ----------
    values : float64 array, shape (n_times,)
        Finite.
    threshold : float
        In the history's unit.

    Returns
    -------
    int64 array
        Maxima and minima alternate; neither the start nor the end is one.
    """
    if not len(values):
        return np.empty(0, dtype=np.int64)
    # only local extremes and the ends can be turning points
    change = np.sign(np.diff(values))
    moving = np.flatnonzero(change)
    turns = moving[1:][change[moving[1:]] != change[moving[:-1]]]
    found, direction = [], 0
    low = high = 0
    for place in [*turns.tolist(), len(values) - 1]:
        if values[place] > values[high]:
            high = place
        if values[place] < values[low]:
            low = place
        if direction <= 0 and values[place] - values[low] > threshold:
            if direction < 0:
                found.append(low)
            direction, high = 1, place
        elif direction >= 0 and values[high] - values[place] > threshold:
            if direction > 0:
                found.append(high)
            direction, low = -1, place
        if direction > 0:
            low = place
        elif direction < 0:
            high = place
    return np.array(found, dtype=np.int64)


class Steps(NamedTuple):
    """Places from and to of each step, shape (n_steps, 2), and signed sizes, shape (n_steps,)."""

    places: np.ndarray
    sizes: np.ndarray


def steps(values, threshold):
    """Changes of a history from turn to turn.

    Returns
    -------
    Steps
        Each larger than the threshold.
    """
    ends = np.concatenate([[0], turning_points(values, threshold), [len(values) - 1]])
    places = np.column_stack([ends[:-1], ends[1:]])
    sizes = values[places[:, 1]] - values[places[:, 0]]
    return Steps(places[np.abs(sizes) > threshold], sizes[np.abs(sizes) > threshold])


def growth(values, drive, threshold):
    """Exponent of the growth of steps with the drive.

    Parameters
    ----------
    values, drive : float64 arrays, shape (n_times,)
        History, and its drive, of which the largest magnitude while the step goes from 10 to 90 % counts.
    threshold : float
        Smaller steps are none.

    Returns
    -------
    float or None
        Median of the slopes of ln|step| over ln|drive| between all pairs of steps (Theil 1950, Sen 1968); None with
        fewer than four.
    """
    places, sizes = steps(values, threshold)
    if len(sizes) < _FEWEST_STEPS:
        return None
    drives = []
    for (begin, end), size in zip(places, sizes, strict=True):
        share = (values[begin : end + 1] - values[begin]) / size
        moving = (share >= 0.1) & (share <= 0.9)
        driven = np.abs(drive[begin : end + 1])
        drives.append(driven[moving].max() if moving.any() else driven.max())
    drives = np.log(np.maximum(drives, 1e-12))
    if np.ptp(drives) < 1e-3:
        return None
    return float(theilslopes(np.log(np.abs(sizes)), drives)[0])


def decay(time, values, threshold):
    """Decay of a free swing.

    Returns
    -------
    Decay or None
        None with fewer than three turning points.

    Notes
    -----
    The size of a swing is half the way from turn to turn, so that a residual does not enter. Decrement: median of
    ln(swing / next swing). Period: twice the median time from turn to turn.
    """
    places = turning_points(values, threshold)
    if len(places) < 3:
        return None
    swings = np.abs(np.diff(values[places]))
    return Decay(
        float(2.0 * np.median(np.diff(time[places]))), len(swings), float(np.median(np.log(swings[:-1] / swings[1:])))
    )  # fmt: skip


def largest_swing(time, values):
    """Time around the peak for which a history stays beyond a quarter of its largest magnitude [s]."""
    peak = int(np.argmax(np.abs(values)))
    beyond = values / values[peak] - _SWING_LEVEL if values[peak] else np.zeros(len(values))
    other = np.flatnonzero(beyond <= 0.0)
    before, after = other[other < peak], other[other > peak]
    begin = _crossing(time, beyond, before[-1]) if len(before) else time[0]
    end = _crossing(time, beyond, after[0] - 1) if len(after) else time[-1]
    return float(end - begin)


def turning_acceleration(time, values, threshold):
    """Second derivative at the farthest turning points, median over three of them.

    Returns
    -------
    float or None
        Magnitude, in the history's unit / s2; None without a turning point.

    Notes
    -----
    Of a parabola through 11 readings. A block that turns by gravity has about g times its slenderness; one that a
    stopper turns has its stiffness.
    """
    places = turning_points(values, threshold)
    places = places[(places >= _PARABOLA_HALF_WIDTH) & (places < len(values) - _PARABOLA_HALF_WIDTH)]
    if not len(places):
        return None
    places = places[np.argsort(-np.abs(values[places]), kind="stable")[:_FARTHEST_TURNS]]
    curvatures = [
        2.0
        * np.polyfit(
            time[p - _PARABOLA_HALF_WIDTH : p + _PARABOLA_HALF_WIDTH + 1] - time[p],
            values[p - _PARABOLA_HALF_WIDTH : p + _PARABOLA_HALF_WIDTH + 1],
            2,
        )[0]
        for p in places
    ]
    return float(np.median(np.abs(curvatures)))


def _crossing(time, values, place):
    """Time at which the line from a reading to the next crosses zero [s]."""
    first, second = values[place], values[place + 1]
    return (
        time[place] - first * (time[place + 1] - time[place]) / (second - first)
        if first != second
        else time[place]
    )
