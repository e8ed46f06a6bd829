"""Trilinear value and gradient of a sampled level set, in steps that a loop over points can take one by one."""

import numpy as np

from blockshake.jit import inline_kernel

# Below this the gradient, in m a cell, is none: on a medial axis, where no normal exists.
_NO_GRADIENT = 1e-100


@inline_kernel
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


@inline_kernel
def corner_values(values, at, n_y, n_z):
    """Values at the eight corners of a cell, z fastest [m]."""
    # an unsigned index spares the look for a negative one
    here, one = np.uint64(np.int64(at)), np.uint64(1)
    step_y, step_x = np.uint64(n_z), np.uint64(n_y * n_z)
    c000, c001 = values[here], values[here + one]
    c010, c011 = values[here + step_y], values[here + step_y + one]
    here += step_x
    c100, c101 = values[here], values[here + one]
    c110, c111 = values[here + step_y], values[here + step_y + one]
    return c000, c001, c010, c011, c100, c101, c110, c111


@inline_kernel
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


@inline_kernel
def grid_distance(x, y, z, values, first, ox, oy, oz, n_x, n_y, n_z, inverse_spacing):
    """Level-set value, unit gradient and its length of a sampled shape at a point.

    Parameters
    ----------
    x, y, z : float
        Point in the body frame [m].
    values : float64 array, shape (n_values,)
        As in `GridTable` [m].
    first : float
        Index of the shape's first value, a whole number.
    ox, oy, oz : float
        Origin of its lattice [m].
    n_x, n_y, n_z : float
        Points along each axis, whole numbers.
    inverse_spacing : float
        Cells per metre.

    Returns
    -------
    phi : float
        Trilinear value [m], negative inside. Beyond the grid a bound: positive, at most the
        true distance, at most what the level set can have fallen by since a point inside.
    nx, ny, nz : float
        The gradient of the interpolation, made a unit vector; zero where it has none. Beyond
        the grid, that of the nearest point of the grid.
    slope : float
        Length of the gradient [1]: 1 over a flat, less where a cell holds an edge.

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
