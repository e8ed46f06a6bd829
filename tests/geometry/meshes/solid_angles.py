"""Mass properties by the generalised winding number at points, and made surfaces: nothing of the program's is used.

The winding number of a closed surface at a point is the sum of its triangles' solid angles over 4 pi: Van Oosterom and
Strackee (1983), IEEE Transactions on Biomedical Engineering 30(2); Jacobson et al. (2013), ACM TOG 32(4).
"""

import numpy as np


def winding_numbers(corners, points):
    """Winding numbers of triangles, shape (n, 3, 3), at points, shape (m, 3)."""
    a, b, c = (corners[None, :, place] - points[:, None] for place in range(3))
    la, lb, lc = (np.linalg.norm(arm, axis=2) for arm in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=2)
    flat = (
        la * lb * lc
        + (a * b).sum(axis=2) * lc
        + (b * c).sum(axis=2) * la
        + (c * a).sum(axis=2) * lb
    )  # fmt: skip
    return np.arctan2(volume, flat).sum(axis=1) / (2.0 * np.pi)


def points_in_box(corners, count, seed=0):
    """Random points of the box around triangles, and the box's volume."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    return np.random.default_rng(seed).uniform(low, high, (count, 3)), np.prod(high - low)


def sampled_properties(corners, count=20_000):
    """Volume, centroid, inertia about it, and the standard error of the volume, by random points."""
    points, box = points_in_box(corners, count)
    inside = np.concatenate([winding_numbers(corners, part) for part in np.array_split(points, 20)]) > 0.5
    share = inside.mean()
    kept = points[inside]
    arms = kept - kept.mean(axis=0)
    squares = (arms**2).sum(axis=1)
    inertia = (squares[:, None, None] * np.eye(3) - arms[:, :, None] * arms[:, None, :]).mean(axis=0)
    error = box * np.sqrt(share * (1.0 - share) / count)
    return box * share, kept.mean(axis=0), inertia * box * share, error


def box(size=(1.0, 1.0, 1.0), at=(0.0, 0.0, 0.0), inwards=False):
    """Triangles of a box, shape (12, 3, 3), by its full edge lengths and its middle."""
    corner = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])
    triangles = (corner * size + at)[faces]
    return triangles[:, ::-1] if inwards else triangles


def prism(outline, height, cap):
    """Triangles of a prism: a counter-clockwise outline, shape (n, 2), and the triangles of its top face."""
    outline, count = np.asarray(outline, dtype=float), len(outline)
    low, high = (np.column_stack([outline, np.full(count, z)]) for z in (0.0, height))
    after = np.roll(np.arange(count), -1)
    cap = np.asarray(cap)
    walls = [
        np.stack([low, low[after], high[after]], axis=1),
        np.stack([low, high[after], high], axis=1),
    ]
    return np.concatenate([low[cap[:, ::-1]], high[cap], *walls])


def l_shape():
    """An L of two boxes, 1 x 1 x 1 with a quarter taken out: vertices and outward triangles."""
    outline = np.array([[0, 0], [1, 0], [1, 0.5], [0.5, 0.5], [0.5, 1], [0, 1]])
    vertices = np.vstack([np.column_stack([outline, np.full(6, z)]) for z in (0.0, 1.0)])
    cap = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]])
    walls = [[k, (k + 1) % 6, 6 + (k + 1) % 6] for k in range(6)] + [
        [k, 6 + (k + 1) % 6, 6 + k] for k in range(6)
    ]
    return vertices, np.vstack([cap[:, ::-1], cap + 6, walls])
