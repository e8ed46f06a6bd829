"""Rows of a horizontal force at a point of a body, and how the point moves: for forces that follow from its motion."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from blockshake.forces.seen.wrench_histories import force_at, moves_at

_FINER = 4  # instants between two of the motion: a force with a kink is smoothed after it is computed
_REACH = 4.0  # widths of the kernel
_FEWEST = 8  # instants of a motion that is interpolated


@dataclass(frozen=True)
class PointRows:
    """A force along x at a point of a body."""

    unit: np.ndarray  # float64 (n_rows,); rows of 1 N
    time: np.ndarray  # float64 (n_rows,); of the rows [s]
    # displacement, velocity: float64 (n_rows,); of the point along x, against the table, from rest [m, m/s];
    # zero where the table's motion is not known
    displacement: np.ndarray
    velocity: np.ndarray
    # fine, fine_velocity: float64 (4 * n_times,); the displacement at instants four times as close, and its
    # rate [m, m/s]
    fine: np.ndarray
    fine_velocity: np.ndarray
    at: np.ndarray  # int (n_rows,); instants of the rows
    width: float  # of the kernel, in instants of ``fine``

    def through_kernel(self, fine):
        """A history at the fine instants, smoothed as the readings are, at the rows."""
        return gaussian_filter1d(fine, self.width, axis=0, mode="nearest", truncate=_REACH)[_FINER * self.at]


def point_rows(seen, body, height):
    """`PointRows` of a point of a `ReconstructedTest`, above a body's mass centre by ``height``, over the body's height
    [1]."""
    index = seen.structure.body_names.index(body)
    solid = seen.structure.solids[seen.structure.file.bodies[index].shape]
    above = height * float(np.ptp(solid.vertices[:, 2]))
    displacement, velocity = moves_at(seen, index, above)
    rows, time = seen.rows, seen.motion.time
    unit = rows.along(force_at(seen, index, np.array([1.0, 0.0, 0.0]), above))
    step = (time[1] - time[0]) / _FINER
    fine = np.zeros(_FINER * len(time))
    known = np.isfinite(displacement[:, 0])
    if known.sum() >= _FEWEST:
        fine = CubicSpline(time[known], displacement[known, 0])(time[0] + step * np.arange(len(fine)))
    return PointRows(
        unit, rows.time, np.nan_to_num(displacement[rows.instant, 0]), np.nan_to_num(velocity[rows.instant, 0]),
        fine, np.gradient(fine, step), rows.instant, seen.motion.width / step,
    )  # fmt: skip
