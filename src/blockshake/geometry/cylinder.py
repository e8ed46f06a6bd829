"""A cylinder as a prism on a regular polygon, and what the polygon gets wrong."""

from typing import NamedTuple

import numpy as np


class PrismErrors(NamedTuple):
    """Errors of a prism that has the volume, and so the mass, of its cylinder."""

    narrow: float  # half the width across the flat sides over the radius, less 1 [1]
    wide: float  # half the width across the corners over the radius, less 1 [1]
    inertia: float  # about the axis, over the cylinder's, less 1 [1]
    slope: float  # up to which the prism lies on its side without rolling [rad]


def prism_vertices(cylinder):
    """Corners of the prism: float64 array, shape (2 sides, 3), about the centroid, the axis along z [m]."""
    middle = np.pi * (2.0 * np.arange(cylinder.sides) + 1.0) / cylinder.sides
    radius = 0.5 * cylinder.diameter * (1.0 + prism_errors(cylinder.sides).wide)
    ring = radius * np.column_stack([np.cos(middle), np.sin(middle)])
    ends = np.full((cylinder.sides, 1), 0.5 * cylinder.height)
    return np.vstack([np.hstack([ring, -ends]), np.hstack([ring, ends])])


def prism_errors(sides):
    """`PrismErrors` of a number of sides.

    Notes
    -----
    The polygon has the circle's area: ``n R^2 sin(2 pi / n) / 2 = pi r^2``. Its inertia about the axis is
    ``area R^2 (2 + cos(2 pi / n)) / 6``. On its side the prism is at rest while its centre stands over the flat below,
    up to a slope of ``pi / n``.
    """
    angle = 2.0 * np.pi / sides
    wide = np.sqrt(angle / np.sin(angle))
    return PrismErrors(
        narrow=float(wide * np.cos(angle / 2.0) - 1.0),
        wide=float(wide - 1.0),
        inertia=float(wide**2 * (2.0 + np.cos(angle)) / 3.0 - 1.0),
        slope=float(angle / 2.0),
    )
