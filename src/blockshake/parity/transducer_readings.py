"""A displacement transducer against the markers of its two bodies."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.measurement.checks.quiet_noise import NORMAL
from blockshake.measurement.sensors.transducers import reach
from blockshake.parity.body_markers import (
    FEWEST_MARKERS,
    LARGEST_MAGNIFICATION,
    LARGEST_UNSEEN_ARM,
    sight,
)
from blockshake.parity.channel_pairs import COLOUR, between_readings

_SPAN = 0.1  # s, over which readings are averaged: the noise of a mean enters the equations, not that of a reading
_SEEN = 0.5  # of the span's marker readings that must be there
_FEWEST_MEANS = 12
STEP = 1e-3  # s, of the difference that gives the readings' rate
_SHIFTS = 4  # Gauss-Newton steps to the lag of the clocks


@dataclass(frozen=True)
class HeldReading:
    """One transducer in one test against what the markers say of it, as means over a tenth of a second."""

    time: np.ndarray  # float64 (n_means,); of the markers [s]
    misfit: np.ndarray  # float64 (n_means,); reading less expectation [m]
    expected: np.ndarray  # float64 (n_means,); from the poses of both bodies [m]: the column of a gain
    # float64 (n_means, 6); change of the expectation with the place of either end in the frame of its body
    # [1]
    places: np.ndarray
    late: np.ndarray  # float64 (n_means,); change of the reading with a lag of the optical clock [m/s]
    noise: float  # standard deviation of the expectation's own error [m]

    def reversed(self):
        """The reading with its sign turned."""
        return replace(self, misfit=-self.misfit - 2.0 * self.expected, late=-self.late)


def held_readings(structure, tests, poses, lags):
    """`HeldReading` by transducer and test, of every one that was read and whose ends the markers both see.

    Parameters
    ----------
    structure : Structure
    tests : dict of str to xarray.Dataset
        By name, as in a campaign.
    poses : dict of str to dict of str to MeasuredPose
        Of bodies, by test.
    lags : dict of str to float
        Of the optical clock behind the recorder's, as accelerometers tell it; 0 where they do not [s].

    Notes
    -----
    The clock of the transducer is shifted until reading and expectation fit best: at 1 m/s a lag of half a
    millisecond, which no check finds, is five times the noise.
    """
    held = {}
    for name, test in tests.items():
        for item in structure.file.displacement_transducers:
            if "transducer_displacement" not in test or item.name not in test["transducer"].values:
                continue
            by_test = held.setdefault(item.name, {})
            ends = [(point, poses[name].get(point.body)) for point in (item, item.anchor)]
            if any(pose is None for _, pose in ends):
                continue
            expected, places = _expectation(structure, item, ends)
            first = places[np.isfinite(places).all(axis=1).argmax()]
            for (point, pose), direction in zip(ends, np.split(first, 2), strict=True):
                expected[~_seen(pose, point.position, direction)] = np.nan
            read = test["transducer_displacement"].sel(transducer=item.name).to_numpy()
            reading = between_readings(test["time_acc"].to_numpy(), read)
            means = _held(ends[0][1].time, expected, places, reading, lags[name])
            if means is not None:
                by_test[name] = means
    return held


def _seen(pose, point, direction):
    """Times (n_times,) at which the markers that were read see a place of their body move along a direction of it."""
    seen = np.zeros(len(pose.read), dtype=bool)
    for kept in np.unique(pose.read[pose.read.sum(axis=1) >= FEWEST_MARKERS], axis=0):
        magnified, unseen = sight(pose.points[kept], point, direction)
        if magnified <= LARGEST_MAGNIFICATION and unseen <= LARGEST_UNSEEN_ARM:
            seen |= (pose.read == kept).all(axis=1)
    return seen


def _expectation(structure, item, ends):
    """Reach (n_times,) [m], and its derivatives with respect to the places of both ends (n_times, 6) [1]."""
    positions, turns = [], []
    for point, pose in ends:
        index = structure.body_names.index(point.body)
        # markers count from the centroid of the shape, and the poses put it where the mass centre is
        offset = structure.centroid[index] - structure.position[index]
        positions.append(pose.position + offset + pose.rotation @ np.array(point.position, dtype=float))
        turns.append(pose.rotation)
    length, pull = reach(structure, item, positions[0] - positions[1], *turns)
    of_ends = [
        np.einsum("tji,tj->ti", turn, sign * pull) for turn, sign in zip(turns, (1.0, -1.0), strict=True)
    ]
    return length, np.concatenate(of_ends, axis=1)


def _held(time, expected, places, reading, lag):
    """`HeldReading` at the lag of the clocks that fits best; None where too little was read."""
    usual = _SPAN / np.median(np.diff(time))
    noise = _noise(expected) * np.sqrt(COLOUR / usual)
    for _ in range(_SHIFTS):
        read, before, after = (reading(time - lag - shift) for shift in (0.0, STEP, -STEP))
        late = (before - after) / (2.0 * STEP)
        columns = np.column_stack([time, read - expected, expected, places, late])
        columns = columns[np.isfinite(columns).all(axis=1)]
        means = _means(columns, np.floor((columns[:, 0] - time[0]) / _SPAN).astype(int), _SEEN * usual)
        if len(means) < _FEWEST_MEANS:
            return None
        # the two constants of a transducer and of the markers have no meaning
        means[:, 1:] -= means[:, 1:].mean(axis=0)
        held = HeldReading(means[:, 0], means[:, 1], means[:, 2], means[:, 3:-1], means[:, -1], noise)
        # what remains of the lag, next to a gain of either sign
        lag -= np.linalg.lstsq(np.column_stack([held.late, held.expected]), held.misfit, rcond=None)[0][0]
    return held


def _noise(expected):
    """Standard deviation of an expectation's error [m], from its third differences, which no slow motion enters."""
    steps = np.abs(np.diff(expected, 3))
    return np.median(steps[np.isfinite(steps)]) / NORMAL / np.sqrt(20.0) if np.isfinite(steps).any() else 0.0


def _means(rows, group, fewest):
    """Mean row of each group that has enough of them."""
    count = np.bincount(group)
    sums = np.stack([np.bincount(group, column) for column in rows.T], axis=1)
    enough = count >= fewest
    return sums[enough] / count[enough, None]
