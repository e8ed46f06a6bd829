"""A displacement transducer against the markers of its two bodies: linear equations of its faults."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.measurement.sensors.transducers import reach
from blockshake.parity.acceleration_parity import (
    LARGEST_MAGNIFICATION,
    LARGEST_UNSEEN_ARM,
    between_readings,
    sight,
)

PLACES = 6  # columns: three of the end at the body, three of the end at the reference
_SPAN = 0.1  # s, over which readings are averaged: the noise of a mean enters the equations, not that of a reading
_SEEN = 0.5  # of the span's marker readings that must be there
_FEWEST_MARKERS = 3
_STEP = 1e-3  # s, of the difference that gives the readings' rate
_COLOUR = 3.0  # noise with a coefficient of 0.5 from reading to reading averages out so much more slowly
_NORMAL = 0.6745  # of a standard deviation is the median size of a normal deviate
_SHIFTS = 4  # Gauss-Newton steps to the lag of the clocks


@dataclass(frozen=True)
class HeldReading:
    """One transducer in one test beside what the markers say of it, as means over a tenth of a second.

    Attributes
    ----------
    time : float64 array, shape (n_means,)
        Of the markers [s].
    left : float64 array, shape (n_means,)
        Reading less expectation [m].
    expected : float64 array, shape (n_means,)
        From the poses of both bodies [m]: the column of a gain.
    places : float64 array, shape (n_means, 6)
        Change of the expectation with the place of either end in the frame of its body [1].
    late : float64 array, shape (n_means,)
        Change of the reading with a lag of the optical clock [m/s].
    noise : float
        Standard deviation of the expectation's own error [m].
    """

    time: np.ndarray
    left: np.ndarray
    expected: np.ndarray
    places: np.ndarray
    late: np.ndarray
    noise: float

    def reversed(self):
        """The same with the reading's sign turned."""
        return replace(self, left=-self.left - 2.0 * self.expected, late=-self.late)


def held_readings(structure, test, poses, lag):
    """`HeldReading` of a test by transducer, of every one that was read and whose ends the markers both see.

    Parameters
    ----------
    structure : Structure
    test : xarray.Dataset
        As in a campaign.
    poses : dict of str to MeasuredPose
        Of bodies in this test.
    lag : float
        Of the optical clock behind the recorder's, as accelerometers tell it; 0 where they do not [s].

    Notes
    -----
    The clock of the transducer is shifted until reading and expectation fit best: at 1 m/s a lag of half a
    millisecond, which no check finds, is five times the noise.
    """
    if "transducer_displacement" not in test:
        return {}
    known = {name for name, pose in poses.items() if len(pose.time)}
    read = test["transducer_displacement"].transpose("transducer", "time_acc")
    names, clock = [str(name) for name in read["transducer"].values], test["time_acc"].to_numpy()
    held = {}
    for item in structure.file.displacement_transducers:
        if item.name not in names or not {item.body, item.reference} <= known:
            continue
        expected, places = _expectation(structure, item, poses)
        first = places[np.isfinite(places).all(axis=1).argmax()]
        for point, direction in zip((item, item.anchor), np.split(first, 2), strict=True):
            seen = _seen(poses[point.body], point.position, direction)
            expected[~seen] = np.nan
        reading = between_readings(clock, read.to_numpy()[names.index(item.name)])
        found = _held(poses[item.body].time, expected, places, reading, lag)
        if found is not None:
            held[item.name] = found
    return held


def _seen(pose, place, direction):
    """Times (n_times,) at which the markers that were read see a place of their body move along a direction of it."""
    seen = np.zeros(len(pose.read), dtype=bool)
    for kept in np.unique(pose.read[pose.read.sum(axis=1) >= _FEWEST_MARKERS], axis=0):
        magnified, unseen = sight(pose.points[kept], place, direction)
        if magnified <= LARGEST_MAGNIFICATION and unseen <= LARGEST_UNSEEN_ARM:
            seen |= (pose.read == kept).all(axis=1)
    return seen


def _expectation(structure, item, poses):
    """Reach (n_times,) [m], and its derivatives with respect to the places of both ends (n_times, 6) [1]."""
    ends, turns = [], []
    for point in (item, item.anchor):
        position, rotation = poses[point.body].position, poses[point.body].rotation
        index = structure.body_names.index(point.body)
        # markers count from the centroid of the shape, and the poses put it where the mass centre is
        offset = structure.centroid[index] - structure.position[index]
        ends.append(position + offset + rotation @ np.array(point.position, dtype=float))
        turns.append(rotation)
    length, pull = reach(structure, item, ends[0] - ends[1], *turns)
    of_ends = [
        np.einsum("tji,tj->ti", turn, sign * pull) for turn, sign in zip(turns, (1.0, -1.0), strict=True)
    ]
    return length, np.concatenate(of_ends, axis=1)


def _held(time, expected, places, reading, lag):
    """Means of all, at the lag that fits best; None where too little was read."""
    known = np.isfinite(expected) & np.isfinite(places).all(axis=1)
    usual = _SPAN / np.median(np.diff(time))
    noise = _noise(expected) * np.sqrt(_COLOUR / usual)
    for _ in range(_SHIFTS):
        read, before, after = (reading(time - lag - shift) for shift in (0.0, _STEP, -_STEP))
        late = (before - after) / (2.0 * _STEP)
        use = known & np.isfinite(read) & np.isfinite(late)
        columns = np.column_stack([time, read - expected, expected, places, late])
        means = _means(columns[use], np.floor((time[use] - time[0]) / _SPAN).astype(int), _SEEN * usual)
        if len(means) < 2 * PLACES:
            return None
        # the two constants of a transducer and of the markers have no meaning
        means[:, 1:] -= means[:, 1:].mean(axis=0)
        held = HeldReading(
            means[:, 0], means[:, 1], means[:, 2], means[:, 3 : 3 + PLACES], means[:, -1], noise
        )
        lag -= _lag_left(held)
    return held


def _lag_left(held):
    """Lag that remains [s], beside a gain of either sign."""
    design = np.column_stack([held.late, held.expected])
    return np.linalg.lstsq(design, held.left, rcond=None)[0][0]


def _noise(expected):
    """Standard deviation of an expectation's error [m], from its third differences, which no slow motion enters."""
    steps = np.abs(np.diff(expected, 3))
    return np.median(steps[np.isfinite(steps)]) / _NORMAL / np.sqrt(20.0) if np.isfinite(steps).any() else 0.0


def _means(rows, group, fewest):
    """Mean row of each group that has enough of them."""
    count = np.bincount(group)
    sums = np.stack([np.bincount(group, column) for column in rows.T], axis=1)
    enough = count >= fewest
    return sums[enough] / count[enough, None]
