"""Flights of a body that touches nothing, and how far they are from any smooth path."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import null_space

from blockshake_flight.tracked_test import CLEAR

LEAST = 8  # readings of a flight; four are taken by a cubic
_BROKEN = 4.0  # times the usual residual about a cubic: something was hit, or the tracking slipped
_NEXT = 1.5  # usual steps of the clock
_STRUCK = (
    5.0  # times the usual distance of a reading from the middle of its neighbours: an impact lies between
)
_HELD = 0.2  # of gravity, that a mean acceleration may be off the usual: more, and the body slid or was held
_USUAL = 6.0  # times as far as usual, in addition


@dataclass(frozen=True, eq=False)
class Arc:
    """One flight of a test."""

    test: str
    # first, last: rows of the test, the last one included
    first: int
    last: int
    time: np.ndarray  # float64 (n,); from the flight's first reading [s]
    position: np.ndarray  # float64 (n, 3); of the centroid [m]; zero along an axis that was not filmed
    rotation: np.ndarray  # float64 (n, 3, 3); body to world
    axes: np.ndarray  # int array; axes that were filmed
    residual: float  # root mean square distance from a cubic, a coordinate [m]
    acceleration: np.ndarray  # float64 (3,); mean over the flight [m/s2]

    @cached_property
    def _beyond_lines(self):
        return null_space(np.stack([np.ones_like(self.time), self.time])).T

    def free(self, histories):
        """Histories (n, ...) without what place and velocity at the start can be: ((n - 2), ...)."""
        return np.tensordot(self._beyond_lines, histories, axes=1)

    def smooth(self):
        """Position and velocity of a cubic through the readings, (2, n, 3) [m, m/s]."""
        fit = np.polynomial.Polynomial
        paths = [fit.fit(self.time, self.position[:, axis], 3) for axis in range(3)]
        return np.array(
            [[path(self.time) for path in paths], [path.deriv()(self.time) for path in paths]]
        ).swapaxes(1, 2)


def find_arcs(tracked):
    """All flights of a `TrackedCampaign`: those that are smooth, and those that something broke.

    Returns
    -------
    (list of Arc, list of Arc)
    """
    smooth = [_is_up(tracked, test) for test in tracked.tests]
    kinks = [_kinks(tracked, test) for test in tracked.tests]
    usual = np.median(np.concatenate([kink[up] for kink, up in zip(kinks, smooth, strict=True)]))
    found = [
        arc
        for test, up, kink in zip(tracked.tests, smooth, kinks, strict=True)
        for arc in _arcs_of(test, up & (kink <= _STRUCK * usual))
    ]
    if not found:
        return [], []
    usual = np.median([arc.residual for arc in found])
    mean = np.array([arc.acceleration[arc.axes] for arc in found])
    away = np.linalg.norm(mean - np.median(mean, axis=0), axis=1)
    most = max(_HELD * np.linalg.norm(tracked.structure.file.gravity), _USUAL * np.median(away))
    free = [arc.residual <= _BROKEN * usual and off <= most for arc, off in zip(found, away, strict=True)]
    return tuple([arc for arc, one in zip(found, free, strict=True) if one == kept] for kept in (True, False))


def noise_of(arcs):
    """Noise of a coordinate of the poses, from what cubics leave of all flights [m]."""
    return float(np.sqrt(np.mean([arc.residual**2 for arc in arcs])))


def _is_up(tracked, test):
    """Whether the body is clear of the ground at each reading."""
    heights = tracked.heights(test).min(axis=1)
    read = np.isfinite(heights) & np.isfinite(test.position[:, test.axes]).all(axis=1)
    return read & (heights > CLEAR * tracked.radius)


def _kinks(tracked, test):
    """How far each reading of all vertices is from the middle of its neighbours, root mean square [m]."""
    moved = np.nan_to_num(test.position)[:, None] + np.einsum("tij,vj->tvi", test.rotation, tracked.vertices)
    second = 0.5 * np.diff(moved, 2, axis=0)
    kinks = np.zeros(len(moved))
    kinks[1:-1] = np.sqrt((second**2).sum(axis=2).mean(axis=1))
    return np.nan_to_num(kinks)


def _arcs_of(test, up):
    step = np.diff(test.time)
    joined = np.concatenate([[False], up[1:] & up[:-1] & (step < _NEXT * np.median(step)), [False]])
    first = np.flatnonzero(~joined[:-1] & joined[1:])
    last = np.flatnonzero(joined[:-1] & ~joined[1:])
    for start, end in zip(first, last, strict=True):
        # the readings next to a contact may hold some of it
        start, end = start + (start > 0), end - (end < len(up) - 1)
        if end - start + 1 >= LEAST:
            yield _arc(test, int(start), int(end))


def _arc(test, first, last):
    time = test.time[first : last + 1] - test.time[first]
    position = np.nan_to_num(test.position[first : last + 1])
    paths = [np.polynomial.Polynomial.fit(time, position[:, axis], 3) for axis in range(3)]
    left = np.array([position[:, axis] - paths[axis](time) for axis in test.axes])
    residual = np.sqrt((left**2).sum() / (len(test.axes) * (len(time) - 4)))
    acceleration = np.array([(path.deriv()(time[-1]) - path.deriv()(0.0)) / time[-1] for path in paths])
    return Arc(
        test.name,
        first,
        last,
        time,
        position,
        test.rotation[first : last + 1],
        test.axes,
        float(residual),
        acceleration,
    )
