"""Level sets sampled on a regular lattice, of boxes and of meshes, in one table for kernels."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.meshes.mesh_distance import lattice_distances
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, triangles

_MARGIN = 2  # cells beyond the bounding box on every side


class LevelSetGrid(NamedTuple):
    """Signed distance of one shape at the points of a lattice.

    ``values`` float64 (n_x, n_y, n_z): signed distance [m], negative inside. ``origin`` (3,): the
    first point, body frame [m]. ``spacing``: edge of a cell [m].
    """

    values: np.ndarray
    origin: np.ndarray
    spacing: float


class GridTable(NamedTuple):
    """The grids of all shapes as kernels read them.

    ``values`` float64 (n_values,): one grid after the other, z fastest [m]. ``first`` int64 (n_shapes + 1,): where each
    begins. ``origin`` (n_shapes, 3) [m], ``counts`` int64 (n_shapes, 3): points along each axis; ``spacing``
    (n_shapes,) [m]. ``steepest`` (n_shapes,): the interpolated level set changes by at most this times the distance
    moved, at least 1. A list of near nodes with a skin must hold those below ``steepest * skin``.
    """

    values: np.ndarray
    first: np.ndarray
    origin: np.ndarray
    counts: np.ndarray
    spacing: np.ndarray
    steepest: np.ndarray


def box_grid(size, chamfer, spacing, shift=(0.0, 0.0, 0.0)):
    """Sampled signed distance of a chamfered box, exact at every point of the lattice.

    Parameters
    ----------
    size : sequence of 3 floats
        Full edge lengths along body x, y, z [m].
    chamfer : float
        Leg of the 45-degree chamfer [m]; 0 gives the sharp box.
    spacing : float
        Edge of a cell [m].
    shift : sequence of 3 floats
        Displacement of the lattice against the body [cells]. Without it the lattice is symmetric
        about the body's centre; along an axis whose edge is a multiple of the spacing both
        faces lie on lattice planes, else the lattice overhangs both alike.

    Returns
    -------
    LevelSetGrid
        Inside it agrees with `level_set.box_distance`; outside it is the Euclidean distance.

    Notes
    -----
    Zhou et al. (2023), Eq. (1), with 0.02 m. Over a flat, a cell away from its perimeter, the
    interpolation is exact. Where a cell holds a ridge it cuts the corner by a part of the
    spacing: with a spacing as coarse as the chamfer the answer depends on how the lattice lies.
    """
    polyhedron = convex_polyhedron(box_vertices(size, chamfer))
    half = np.asarray(size, dtype=float) / 2.0
    axes = _lattice(-half, half, spacing, shift)
    # the box is symmetric: one octant holds every distance, and both sides get the same bits
    octant, place = zip(*[np.unique(np.abs(axis), return_inverse=True) for axis in axes], strict=True)
    values = lattice_distances(polyhedron.vertices, triangles(polyhedron), octant)[np.ix_(*place)]
    return LevelSetGrid(values, np.array([axis[0] for axis in axes]), float(spacing))


def mesh_grid(vertices, faces, spacing):
    """Sampled signed distance of a closed triangulated surface, convex or not.

    Parameters
    ----------
    vertices : float64 array, shape (n_vertices, 3)
        Body frame [m].
    faces : int array, shape (n_triangles, 3)
        Outward triangles.
    spacing : float
        Edge of a cell [m]. The lattice is symmetric about the bounding box.

    Returns
    -------
    LevelSetGrid
        Euclidean distance at every point of the lattice, near and far.

    Raises
    ------
    InputError
        The surface is not closed.
    """
    vertices = np.asarray(vertices, dtype=float)
    axes = _lattice(vertices.min(axis=0), vertices.max(axis=0), spacing, (0.0, 0.0, 0.0))
    values = lattice_distances(vertices, faces, axes)
    return LevelSetGrid(values, np.array([axis[0] for axis in axes]), float(spacing))


def _lattice(low, high, spacing, shift):
    """Coordinates of the lattice along each axis, body frame [m]."""
    margin = _MARGIN + int(np.ceil(np.abs(shift).max()))
    # a billionth of a cell is rounding, not a reason for one more cell
    cells = np.ceil((high - low) / spacing - 1e-9).astype(int) + 2 * margin
    return [
        0.5 * (low[axis] + high[axis])
        + spacing * (np.arange(cells[axis] + 1) - 0.5 * cells[axis] + shift[axis])
        for axis in range(3)
    ]


def grid_table(grids):
    """Grids of all shapes in one table; None for a shape without one, which then has no points."""
    counts = [grid.values.shape if grid is not None else (0, 0, 0) for grid in grids]
    return GridTable(
        values=np.concatenate([grid.values.ravel() for grid in grids if grid is not None] or [np.empty(0)]),
        first=np.concatenate([[0], np.cumsum(np.prod(counts, axis=1, dtype=np.int64))]).astype(np.int64),
        origin=np.array([grid.origin if grid is not None else np.zeros(3) for grid in grids]),
        counts=np.array(counts, dtype=np.int64),
        spacing=np.array([grid.spacing if grid is not None else 1.0 for grid in grids]),
        steepest=np.array([_steepest(grid) if grid is not None else 1.0 for grid in grids]),
    )


def _steepest(grid):
    """Largest gradient of the interpolated level set in cells that are not wholly inside, at least 1.

    Each component of the gradient is linear in every coordinate of the cell, so that its length is
    largest at a corner, where the components are the differences along the three edges that meet there.
    """
    sides = (slice(None, -1), slice(1, None))
    steepest = 0.0
    for plane in range(len(grid.values) - 1):
        values = grid.values[plane : plane + 2]
        along_x = [[(values[1:, b, c] - values[:-1, b, c]) ** 2 for c in sides] for b in sides]
        along_y = [[(values[a, 1:, c] - values[a, :-1, c]) ** 2 for c in sides] for a in sides]
        along_z = [[(values[a, b, 1:] - values[a, b, :-1]) ** 2 for b in sides] for a in sides]
        squared, highest = 0.0, -np.inf
        for a, b, c in np.ndindex(2, 2, 2):
            squared = np.maximum(squared, along_x[b][c] + along_y[a][c] + along_z[a][b])
            highest = np.maximum(highest, values[sides[a], sides[b], sides[c]])
        steepest = max(steepest, squared[highest >= 0.0].max(initial=0.0))
    return max(1.0, float(np.sqrt(steepest)) / grid.spacing)
