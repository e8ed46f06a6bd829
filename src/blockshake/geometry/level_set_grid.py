"""Level sets of boxes and meshes sampled on a regular lattice, in one table for kernels, and their trilinear values."""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.meshes.mesh_distance import lattice_distances
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, triangles
from blockshake.jit import kernel_without_allocation

_MARGIN = 2  # cells beyond the bounding box on every side
# Below this the gradient, in m a cell, is none: on a medial axis, where no normal exists.
_NO_GRADIENT = 1e-100


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
    octant, index = zip(*[np.unique(np.abs(axis), return_inverse=True) for axis in axes], strict=True)
    values = lattice_distances(polyhedron.vertices, triangles(polyhedron), octant)[np.ix_(*index)]
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


@kernel_without_allocation
def locate(x, y, z, first, ox, oy, oz, n_x, n_y, n_z, inverse_spacing):
    """Cell of a point, clamped to the grid.

    Returns
    -------
    at : float
        Index of the cell's first corner in `GridTable.values`, a whole number.
    fx, fy, fz : float
        Place within the cell, 0 to 1.
    beyond : float
        How far outside the grid the point lies along the axis where it is farthest [cells].
    """
    u, v, w = (x - ox) * inverse_spacing, (y - oy) * inverse_spacing, (z - oz) * inverse_spacing
    top_x, top_y, top_z = n_x - 1.0, n_y - 1.0, n_z - 1.0
    # each select with the constant last, so that a point that is no number ends inside the array
    cu = u if u > 0.0 else 0.0
    cv = v if v > 0.0 else 0.0
    cw = w if w > 0.0 else 0.0
    cu = cu if cu < top_x else top_x
    cv = cv if cv < top_y else top_y
    cw = cw if cw < top_z else top_z
    # 32 bits because every vector unit converts to those; indices are whole numbers in a double
    i, j, k = np.float64(np.int32(cu)), np.float64(np.int32(cv)), np.float64(np.int32(cw))
    i = i if i < top_x - 1.0 else top_x - 1.0
    j = j if j < top_y - 1.0 else top_y - 1.0
    k = k if k < top_z - 1.0 else top_z - 1.0
    beyond, by, bz = abs(u - cu), abs(v - cv), abs(w - cw)
    beyond = by if by > beyond else beyond
    beyond = bz if bz > beyond else beyond
    return first + (i * n_y + j) * n_z + k, cu - i, cv - j, cw - k, beyond


@kernel_without_allocation
def corner_values(values, at, n_y, n_z):
    """Values at the eight corners of a cell, z fastest [m]."""
    # an unsigned index spares the look for a negative one
    here, step_z = np.uint64(np.int64(at)), np.uint64(1)
    step_y, step_x = np.uint64(n_z), np.uint64(n_y * n_z)
    c000, c001 = values[here], values[here + step_z]
    c010, c011 = values[here + step_y], values[here + step_y + step_z]
    here += step_x
    c100, c101 = values[here], values[here + step_z]
    c110, c111 = values[here + step_y], values[here + step_y + step_z]
    return c000, c001, c010, c011, c100, c101, c110, c111


@kernel_without_allocation
def interpolate(c000, c001, c010, c011, c100, c101, c110, c111, fx, fy, fz, beyond, inverse_spacing):
    """Level-set value, unit gradient and its length from a cell's corners; arguments as `locate` gives them."""
    d00, d01, d10, d11 = c001 - c000, c011 - c010, c101 - c100, c111 - c110
    a00, a01, a10, a11 = c000 + fz * d00, c010 + fz * d01, c100 + fz * d10, c110 + fz * d11
    e0, e1 = a01 - a00, a11 - a10
    b0 = a00 + fy * e0
    gx = a10 + fy * e1 - b0
    gy = e0 + fx * (e1 - e0)
    g0, g1 = d00 + fy * (d01 - d00), d10 + fy * (d11 - d10)
    gz = g0 + fx * (g1 - g0)
    phi = b0 + fx * gx
    length = np.sqrt(gx * gx + gy * gy + gz * gz)
    scale = 1.0 / (length if length > _NO_GRADIENT else _NO_GRADIENT)
    spacing = 1.0 / inverse_spacing
    away, bound = beyond * spacing, phi - spacing
    bound = away if away > bound else bound
    slope = length * inverse_spacing
    return bound if beyond > 0.0 else phi, gx * scale, gy * scale, gz * scale, slope


@kernel_without_allocation
def grid_distance(x, y, z, values, first, ox, oy, oz, n_x, n_y, n_z, inverse_spacing):
    """Level-set value, unit gradient and its length of a sampled shape at a point.

    Parameters
    ----------
    x, y, z : float
        Point in the body frame [m].
    values, first : float64 array, shape (n_values,), float
        Values of `GridTable` [m]; index of the shape's first one, a whole number.
    ox, oy, oz, n_x, n_y, n_z, inverse_spacing : float
        Origin of its lattice [m]; points along each axis, whole numbers; cells per metre.

    Returns
    -------
    phi : float
        Trilinear value [m], negative inside. Beyond the grid a bound: positive, at most the
        true distance, at most what the level set can have fallen by since a point inside.
    nx, ny, nz, slope : float
        The gradient of the interpolation, made a unit vector; zero where it has none. Beyond
        the grid, that of the nearest point of the grid. Its length is 1 over a flat, less where a cell holds an edge.

    Notes
    -----
    Beyond the grid, with c the nearest point of it at the distance r, the true distance is at
    least the larger of r and that at c, because the grid is convex and holds the body. The
    interpolated value at c is above the true one by at most sqrt(3)/2 of the spacing (a mean of
    corner values, each at most its distance from c above), hence the whole spacing taken off.
    """
    at, fx, fy, fz, beyond = locate(x, y, z, first, ox, oy, oz, n_x, n_y, n_z, inverse_spacing)
    c000, c001, c010, c011, c100, c101, c110, c111 = corner_values(values, at, n_y, n_z)
    return interpolate(c000, c001, c010, c011, c100, c101, c110, c111, fx, fy, fz, beyond, inverse_spacing)
