"""Surface nodes of any closed triangulated mesh: evenly spread, with nodes just inside its sharp edges."""

from functools import lru_cache

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from blockshake.geometry.meshes.patch_perimeter import SHARP, boundaries, edge_pairs, perimeter_points

# The surface is cut into triangles this much smaller than the spacing; each goes to its nearest node.
_FINENESS = 6
# Seeds at least this many spacings apart come out, spread, at about one a spacing squared.
_APART = 0.8
_ROUNDS = 20  # of moving nodes to the centroids of their areas (Lloyd 1982)
_FLAT = 1e-3  # depth of a face that counts as flat, over the side of the cube of the mesh's area
_ON_CURVED = 20  # nodes along that side; on a curved face a body stands on its nodes


def mesh_nodes(vertices, faces, spacing, inset):
    """Nodes and the area each stands for.

    Parameters
    ----------
    vertices : float64 array, shape (n_vertices, 3)
        Body frame [m].
    faces : int array, shape (n_triangles, 3)
        Outward triangles of a closed surface.
    spacing : float
        Aimed distance of nodes [m]; on a face that is not flat at most a 20th of the side of the cube that has the
        mesh's area.
    inset : float
        Distance from sharp convex edges of the nodes that stand along them, on both sides, over the breadth of the
        face, which is twice its area over its perimeter [1]. A body sinks by at most that distance onto an
        edge before a node touches, and by 1.15 times that much onto the corner of a cube.

    Returns
    -------
    points : float64 array, shape (n_nodes, 3)
        [m]; on the surface, on a curved one within the square of its facets' size over its radius.
    areas : float64 array, shape (n_nodes,)
        Area that each node stands for [m2]. Over every face of the body they sum to its area,
        have its centroid and, where it has nodes enough, its second moments, so that node
        spacing changes no stiffness of an interface in compression or in rocking.

    Notes
    -----
    Triangles that meet at an angle above `SHARP` belong to different faces; below it the surface counts as curved.
    Seeds a little less than a spacing apart are taken in the order of the triangles, then moved
    to the centroids of the parts of the face that are nearest to them (Lloyd 1982, IEEE
    Transactions on Information Theory 28(2)); those along edges stay. No random number is drawn.
    """
    vertices, faces = np.ascontiguousarray(vertices, dtype=float), np.ascontiguousarray(faces, dtype=np.int64)
    return _kept_nodes(vertices.tobytes(), faces.tobytes(), spacing, inset)


@lru_cache(maxsize=16)
def _kept_nodes(vertices, faces, spacing, inset):
    """`mesh_nodes` of the bytes of a mesh; kept, for those of a scan take as long as a run."""
    vertices, faces = np.frombuffer(vertices).reshape(-1, 3), np.frombuffer(faces, np.int64).reshape(-1, 3)
    corners = vertices[faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(cross, axis=1)
    normals = cross / np.where(doubled > 0.0, doubled, 1.0)[:, None]
    pairs = edge_pairs(faces, len(vertices))
    smooth = (normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(axis=1) >= np.cos(SHARP)
    links = coo_matrix((np.ones(smooth.sum()), tuple(pairs[smooth].T)), shape=(len(faces), len(faces)))
    n_patches, patch = connected_components(links, directed=False)
    sides = boundaries(vertices, faces, normals, patch)
    side = np.sqrt(0.5 * doubled.sum() / 6.0)
    points, areas = [], []
    for label in range(n_patches):
        members = np.flatnonzero((patch == label) & (doubled > 0.0))
        if len(members) == 0:
            continue
        height = corners[members] @ normals[members[np.argmax(doubled[members])]]
        own = spacing if np.ptp(height) < _FLAT * side else min(spacing, side / _ON_CURVED)
        edge = perimeter_points(
            vertices, normals, sides.get(label, []), 0.5 * doubled[members].sum(), own, inset
        )
        nodes, weights = _patch_nodes(corners[members], normals[members], own, edge)
        points.append(nodes)
        areas.append(weights)
    points, areas = np.vstack(points), np.concatenate(areas)
    points.flags.writeable = areas.flags.writeable = False
    return points, areas


def _patch_nodes(corners, normals, spacing, edge):
    """Nodes and areas of one smooth part of the surface, the first at ``edge``."""
    samples, sample_areas, triangle = _samples(corners, spacing / _FINENESS)
    nodes = np.vstack([edge, samples[_apart(samples, edge, _APART * spacing)]])
    for _ in range(_ROUNDS):
        _, nearest = cKDTree(nodes).query(samples)
        weights = np.bincount(nearest, sample_areas, len(nodes))
        held = weights > 0.0
        held[: len(edge)] = False
        for axis in range(3):
            moments = np.bincount(nearest, sample_areas * samples[:, axis], len(nodes))
            nodes[held, axis] = moments[held] / weights[held]
    _, near = cKDTree(samples).query(nodes)
    normal = normals[triangle[near]]
    nodes -= ((nodes - samples[near]) * normal).sum(axis=1)[:, None] * normal
    _, nearest = cKDTree(nodes).query(samples)
    weights = np.bincount(nearest, sample_areas, len(nodes))
    nodes, weights = nodes[weights > 0.0], weights[weights > 0.0]
    return nodes, _fitted(nodes, weights, corners)


def _samples(corners, size):
    """Centres and areas of equal small triangles that fill the given ones, and which one each is from."""
    along = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    pieces = np.maximum(1, np.ceil(along / size).astype(int))
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    points, areas, triangle = [], [], []
    for n in np.unique(pieces):
        which = np.flatnonzero(pieces == n)
        i, j = np.divmod(np.arange(n * n), n)
        upright, turned = i + j < n, i + j < n - 1
        s = np.concatenate([i[upright] + 1 / 3, i[turned] + 2 / 3]) / n
        t = np.concatenate([j[upright] + 1 / 3, j[turned] + 2 / 3]) / n
        weights = np.stack([1.0 - s - t, s, t], axis=1)
        points.append(np.einsum("kc,tcx->tkx", weights, corners[which]).reshape(-1, 3))
        areas.append(np.repeat(area[which] / n**2, n * n))
        triangle.append(np.repeat(which, n * n))
    return np.vstack(points), np.concatenate(areas), np.concatenate(triangle)


def _apart(samples, taken, distance):
    """Samples, first come first served, that lie ``distance`` from each other and from points taken already."""
    free = np.ones(len(samples), dtype=bool)
    tree = cKDTree(samples)
    for point in taken:
        free[tree.query_ball_point(point, distance)] = False
    chosen = []
    for sample in range(len(samples)):
        if free[sample]:
            chosen.append(sample)
            free[tree.query_ball_point(samples[sample], distance)] = False
    return chosen


def _fitted(nodes, weights, corners):
    """Areas as near to ``weights`` as possible whose area, centroid and second moments are those of the triangles.

    Where this would take a negative area (few nodes), area and centroid alone, else the area alone.
    """
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    centre = (area[:, None] * corners.mean(axis=1)).sum(axis=0) / area.sum()
    size = np.sqrt(area.sum())
    local, ends = (nodes - centre) / size, (corners - centre) / size
    i, j = np.triu_indices(3)
    rows = np.vstack([np.ones(len(nodes)), local.T, (local[:, i] * local[:, j]).T])
    # integral of x_i x_j over a triangle: area / 12 times (sum of corners' products + product of sums)
    total = ends.sum(axis=1)
    second = (np.einsum("tci,tcj->tij", ends, ends) + total[:, :, None] * total[:, None, :]) / 12.0
    moments = np.concatenate([[1.0], np.zeros(3), (area[:, None] * second[:, i, j]).sum(axis=0) / area.sum()])
    moments *= area.sum()
    for n_rows in (10, 4):
        part = rows[:n_rows]
        change = np.linalg.lstsq(part * weights, moments[:n_rows] - part @ weights, rcond=1e-10)[0]
        fitted = weights * (1.0 + change)
        if fitted.min() > 0.0 and np.allclose(
            part @ fitted, moments[:n_rows], rtol=0.0, atol=1e-9 * area.sum()
        ):
            return fitted
    return weights
