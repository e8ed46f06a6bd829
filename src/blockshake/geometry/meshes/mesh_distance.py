"""Signed distance of lattice points to a closed triangulated surface, convex or not."""

import numpy as np

from blockshake.jit import inner_kernel, kernel, kernel_without_allocation

_BLOCK = 8  # points along the edge of the blocks in which far triangles are left out
# Features of a triangle ABC, rows of its pseudonormals
_FACE, _EDGE_AB, _EDGE_BC, _EDGE_CA, _A, _B, _C = range(7)


def lattice_distances(vertices, faces, axes):
    """Signed distance at the points of a lattice.

    Parameters
    ----------
    vertices : float64 array, shape (n_vertices, 3)
        [m]
    faces : int array, shape (n_triangles, 3)
        Outward triangles of a closed surface. Those without area are passed over: their points
        belong to their neighbours too.
    axes : sequence of 3 float64 arrays, shapes (n_x,), (n_y,), (n_z,)
        Coordinates of the lattice, increasing, same frame [m].

    Returns
    -------
    float64 array, shape (n_x, n_y, n_z)
        Euclidean distance to the surface [m], negative inside.

    Notes
    -----
    Sign by the angle-weighted pseudonormal of the nearest face, edge or corner: Baerentzen and
    Aanaes (2005), IEEE Transactions on Visualization and Computer Graphics 11(3), theorem 1.
    """
    vertices = np.ascontiguousarray(vertices, dtype=float)
    faces = np.ascontiguousarray(faces, dtype=np.int64)
    corners = vertices[faces]
    normals = _pseudonormals(corners, faces, len(vertices))
    kept = np.flatnonzero(np.linalg.norm(normals[:, _FACE], axis=1) > 0.0)
    corners, normals = corners[kept], normals[kept]
    centres = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    x, y, z = (np.ascontiguousarray(axis, dtype=float) for axis in axes)
    return _distances(corners, normals, centres, radii, x, y, z)


def _pseudonormals(corners, faces, n_vertices):
    """Outward normals of each triangle's features: float64 (n_triangles, 7, 3), not of unit length.

    The face's is a unit vector, zero for a triangle without area; an edge's is the sum of its two
    faces', a corner's the sum of its faces' weighted by their angles there.
    """
    along = np.roll(corners, -1, axis=1) - corners
    cross = np.cross(along[:, 0], along[:, 1])
    doubled, longest = np.linalg.norm(cross, axis=1), np.linalg.norm(along, axis=2).max(axis=1)
    flat = doubled <= 1e-12 * longest**2
    unit = np.where(flat[:, None], 0.0, cross / np.where(flat, 1.0, doubled)[:, None])
    back = -np.roll(along, 1, axis=1)
    sine = np.linalg.norm(np.cross(along, back), axis=2)
    angle = np.arctan2(sine, (along * back).sum(axis=2))
    at_vertex = np.zeros((n_vertices, 3))
    np.add.at(at_vertex, faces, angle[:, :, None] * unit[:, None, :])
    start, end = faces, np.roll(faces, -1, axis=1)
    code = np.minimum(start, end) * n_vertices + np.maximum(start, end)
    edges, edge = np.unique(code, return_inverse=True)
    at_edge = np.zeros((len(edges), 3))
    edge = edge.reshape(code.shape)
    np.add.at(at_edge, edge, np.repeat(unit[:, None, :], 3, axis=1))
    return np.concatenate([unit[:, None], at_edge[edge], at_vertex[faces]], axis=1)


@kernel_without_allocation
def _dot(ax, ay, az, bx, by, bz):
    return ax * bx + ay * by + az * bz


@kernel_without_allocation
def _nearest_on_triangle(triangle, px, py, pz):
    """Vector from the nearest point of a triangle (3, 3) to a point, and the feature it lies on.

    By the signs of the projections on the edges: which corner, edge or face the point is in front of.
    """
    ax, ay, az = px - triangle[0, 0], py - triangle[0, 1], pz - triangle[0, 2]
    bx, by, bz = px - triangle[1, 0], py - triangle[1, 1], pz - triangle[1, 2]
    cx, cy, cz = px - triangle[2, 0], py - triangle[2, 1], pz - triangle[2, 2]
    # edges from A
    ux, uy, uz = ax - bx, ay - by, az - bz
    vx, vy, vz = ax - cx, ay - cy, az - cz
    au, av = _dot(ux, uy, uz, ax, ay, az), _dot(vx, vy, vz, ax, ay, az)
    bu, bv = _dot(ux, uy, uz, bx, by, bz), _dot(vx, vy, vz, bx, by, bz)
    cu, cv = _dot(ux, uy, uz, cx, cy, cz), _dot(vx, vy, vz, cx, cy, cz)
    # areas of the triangles that the foot of the point forms with each edge
    over_ab, over_bc, over_ca = au * bv - bu * av, bu * cv - cu * bv, cu * av - au * cv
    feature, s, t = _FACE, 0.0, 0.0
    if au <= 0.0 and av <= 0.0:
        feature = _A
    elif bu >= 0.0 and bv <= bu:
        feature, s = _B, 1.0
    elif cv >= 0.0 and cu <= cv:
        feature, t = _C, 1.0
    elif over_ab <= 0.0 and au >= 0.0 and bu <= 0.0:
        feature, s = _EDGE_AB, au / (au - bu)
    elif over_ca <= 0.0 and av >= 0.0 and cv <= 0.0:
        feature, t = _EDGE_CA, av / (av - cv)
    elif over_bc <= 0.0 and bv - bu >= 0.0 and cu - cv >= 0.0:
        t = (bv - bu) / ((bv - bu) + (cu - cv))
        feature, s = _EDGE_BC, 1.0 - t
    else:
        whole = over_ab + over_bc + over_ca
        s, t = over_ca / whole, over_ab / whole
    return ax - s * ux - t * vx, ay - s * uy - t * vy, az - s * uz - t * vz, feature


@kernel
def _distances(corners, normals, centres, radii, x, y, z):
    """Signed distance at every lattice point, block by block: triangles too far from a block are left out."""
    n_triangles = len(radii)
    values = np.empty((len(x), len(y), len(z)))
    near = np.empty(n_triangles, np.int64)
    away = np.empty(n_triangles)
    for i0 in range(0, len(x), _BLOCK):
        for j0 in range(0, len(y), _BLOCK):
            for k0 in range(0, len(z), _BLOCK):
                i1, j1, k1 = min(i0 + _BLOCK, len(x)), min(j0 + _BLOCK, len(y)), min(k0 + _BLOCK, len(z))
                mx, my, mz = 0.5 * (x[i0] + x[i1 - 1]), 0.5 * (y[j0] + y[j1 - 1]), 0.5 * (z[k0] + z[k1 - 1])
                reach = np.sqrt((x[i0] - mx) ** 2 + (y[j0] - my) ** 2 + (z[k0] - mz) ** 2)
                closest = np.inf
                for triangle in range(n_triangles):
                    centre = centres[triangle]
                    dx, dy, dz = mx - centre[0], my - centre[1], mz - centre[2]
                    away[triangle] = np.sqrt(dx * dx + dy * dy + dz * dz)
                    closest = min(closest, away[triangle])
                count = 0
                for triangle in range(n_triangles):
                    if away[triangle] - radii[triangle] <= closest + 2.0 * reach:
                        near[count] = triangle
                        count += 1
                for i in range(i0, i1):
                    for j in range(j0, j1):
                        for k in range(k0, k1):
                            values[i, j, k] = _distance(
                                corners, normals, centres, radii, near[:count], x[i], y[j], z[k]
                            )
    return values


@inner_kernel
def _distance(corners, normals, centres, radii, near, px, py, pz):
    """Signed distance of one point to the nearest of the listed triangles."""
    best, distance, sign = np.inf, np.inf, 1.0
    for triangle in near:
        dx, dy, dz = px - centres[triangle, 0], py - centres[triangle, 1], pz - centres[triangle, 2]
        limit = distance + radii[triangle]
        if dx * dx + dy * dy + dz * dz > limit * limit:
            continue
        qx, qy, qz, feature = _nearest_on_triangle(corners[triangle], px, py, pz)
        squared = qx * qx + qy * qy + qz * qz
        if squared < best:
            best, distance = squared, np.sqrt(squared)
            normal = normals[triangle, feature]
            sign = 1.0 if qx * normal[0] + qy * normal[1] + qz * normal[2] >= 0.0 else -1.0
    return sign * distance
