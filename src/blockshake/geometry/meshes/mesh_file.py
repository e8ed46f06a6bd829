"""A mesh file as a closed surface that encloses a solid, or a refusal in one line.

A surface encloses a solid where it winds around the points of its box once inside and not at all outside, which rays
through a lattice in three directions count. The winding number is 2 where parts of the surface overlap or lie within
each other, and negative where a part is turned inwards; a cavity turned inwards gives 0. Where a surface crosses
itself, one of the four sides of the crossing is always wrong.
"""

import io
from typing import NamedTuple

import numpy as np
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from blockshake.errors import InputError
from blockshake.files import read_bytes
from blockshake.paths import file_below

MESHES = (".stl", ".ply", ".obj", ".off")  # suffixes of mesh files
_OF_32_BITS = (".stl", ".ply")  # those that may hold coordinates of 32 bits
_FARTHEST = 1e8  # m, from the origin: beyond any survey
_COARSEST = 1e-4  # of the shortest edge of the box: steps of coordinates that still give the shape
_RAYS = 400  # along each edge of the box
_NOTHING = 1e-6  # of its longest edge: what 32-bit coordinates round to is no overlap
_SHIFT = 0.5 * np.array(
    [np.sqrt(5.0) - 1.0, np.sqrt(2.0)]
)  # of a cell: a plain shape's corners lie on no ray
_OPPOSITE = -1.0 + 1e-9  # cosine of the angle between triangles that lie on each other


def read_mesh(folder, name, source, key):
    """Vertices and triangles of a mesh file.

    Parameters
    ----------
    folder : str or path
        The file lies below it.
    name : str
        Relative path of an STL, PLY, OBJ or OFF file with coordinates in m.
    source, key : str
        File and key that an error names.

    Returns
    -------
    vertices : float64 array, shape (n_vertices, 3)
        Axes of the file, from the middle of the surface's box [m].
    faces : int64 array, shape (n_triangles, 3)
        Outward triangles.

    Raises
    ------
    InputError
        The file is missing or no mesh; the surface is not closed, is turned inwards, crosses or touches itself, or
        has parts that overlap; or its coordinates are too coarse where they lie. Separate parts are allowed, and so
        are cavities whose surface is turned inwards.
    """
    path = file_below(folder, name, source, key)
    if path.suffix.lower() not in MESHES:
        raise InputError(source, key, f"expected a mesh file {', '.join(MESHES)}, not '{path}'")
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # of corners that are refused below
            # from its bytes, so that it cannot name further files
            mesh = trimesh.load_mesh(io.BytesIO(read_bytes(path)), file_type=path.suffix.lower()[1:])
            # textures part the corners of a closed surface; some files hold edges as triangles
            mesh.merge_vertices(merge_tex=True, merge_norm=True)
            mesh.update_faces((mesh.faces != np.roll(mesh.faces, 1, axis=1)).all(axis=1))
            mesh.remove_unreferenced_vertices()
        given, faces = np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)
    except Exception as error:  # trimesh raises whatever its many readers raise
        raise InputError(source, key, f"expected a readable mesh file {path}; {error}") from None
    if fault := _surface_fault(given, faces, path.suffix.lower()):
        raise InputError(
            source, key, f"expected a closed surface with outward triangles; {path.name}: {fault}"
        )
    # about its middle, so that sums keep their digits in a surveyor's coordinates
    return given - 0.5 * (given.min(axis=0) + given.max(axis=0)), faces


def _surface_fault(vertices, faces, suffix):
    """Reason in words why a surface is no block's; None where it is one."""
    if not len(faces) or not (np.abs(vertices) < _FARTHEST).all():
        return f"it has no triangles, or corners that are no numbers below {_FARTHEST:.0e} m"
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    forward, backward = start * len(vertices) + end, end * len(vertices) + start
    known, uses = np.unique(forward, return_counts=True)
    alone = ~np.isin(backward, known[uses == 1]) | ~np.isin(forward, known[uses == 1])
    if alone.any():
        point = 0.5 * (vertices[start] + vertices[end])[alone.argmax()]
        return f"at {shown(point)} m an edge does not join just two triangles that agree on the outside"
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    step = float(np.spacing(np.float32(max(abs(low).max(), abs(high).max()))))
    rounded = suffix in _OF_32_BITS and np.array_equal(vertices.astype(np.float32), vertices)
    if rounded and step > _COARSEST * (high - low).min():
        return f"so far from its origin its 32-bit coordinates are {step:.2g} m apart"
    if np.linalg.det((vertices - 0.5 * (low + high))[faces]).sum() <= 0.0:
        return "it is flat, or turned inwards"
    return solid_fault(vertices, faces)


class Crossings(NamedTuple):
    """Crossings of rays with a surface, in the order of the rays and along each of them."""

    ray: np.ndarray  # int64 (n_crossings,); number of the ray
    height: np.ndarray  # float64 (n_crossings,); along the ray [m]
    step: np.ndarray  # int64 (n_crossings,); 1 where the ray enters, -1 where it leaves
    triangle: np.ndarray  # int64 (n_crossings,)
    point: np.ndarray  # float64 (n_crossings, 3) [m]


def crossings(vertices, faces, axis, count):
    """Crossings of a closed surface with rays along an axis, which a lattice across it spreads over the surface's box.

    Parameters
    ----------
    vertices : float64 array, shape (n_vertices, 3)
        [m]
    faces : int64 array, shape (n_triangles, 3)
        Outward triangles of a closed surface.
    axis : int
        0, 1 or 2.
    count : int
        Rays along each edge of the lattice.

    Notes
    -----
    Triangles are filled row by row. Neighbours compute the ends of a row on their common edge from the same two
    corners in the same order, to the bit: no ray slips through an edge, or crosses it twice.
    """
    turned = np.roll(vertices, -1 - axis, axis=1)
    across, height = turned[:, :2], turned[:, 2]
    low, size = across.min(axis=0), np.ptp(across, axis=0) / count
    u, v = ((across - low) / size - _SHIFT).T  # rays are at whole numbers
    order = np.lexsort((faces, v[faces]), axis=-1)
    bottom, middle, top = np.take_along_axis(faces, order, axis=1).T
    rows, triangle = _whole(v[bottom], v[top])
    upper = rows >= v[middle][triangle]
    ends = []
    for first, last in (
        (bottom[triangle], top[triangle]),
        (
            np.where(upper, middle[triangle], bottom[triangle]),
            np.where(upper, top[triangle], middle[triangle]),
        ),
    ):
        share = (rows - v[first]) / (v[last] - v[first])
        ends.append([part[first] + share * (part[last] - part[first]) for part in (u, height)])
    (u_long, height_long), (u_short, height_short) = ends
    columns, row = _whole(np.minimum(u_long, u_short), np.maximum(u_long, u_short))
    share = (columns - u_long[row]) / (u_short[row] - u_long[row])
    heights = height_long[row] + share * (height_short[row] - height_long[row])
    even = (order[:, 1] - order[:, 0]) % 3 == 1
    step = np.where(even[triangle] == (u_short > u_long), -1, 1)[row]
    triangle, rows = triangle[row], rows[row]
    ray = rows * (count + 1) + columns
    plane = (np.column_stack([columns, rows]) + _SHIFT) * size + low
    point = np.roll(np.column_stack([plane, heights]), 1 + axis, axis=1)
    order = np.lexsort((heights, ray))
    return Crossings(*(values[order] for values in (ray, heights, step, triangle, point)))


def _whole(low, high):
    """Whole numbers from ``low`` up to and without ``high``, of all pairs, and the number of each one's pair."""
    first = np.ceil(low).astype(np.int64)
    count = np.maximum(np.ceil(high).astype(np.int64) - first, 0)
    pair = np.repeat(np.arange(len(count)), count)
    return first[pair] + np.arange(count.sum()) - (np.cumsum(count) - count)[pair], pair


def solid_fault(vertices, faces):
    """Reason in words why a closed surface encloses no solid; None where it does.

    Parameters
    ----------
    vertices, faces
        As in `crossings`.
    """
    longest = np.ptp(vertices, axis=0).max()
    part = parts_of(faces)
    for axis in range(3):
        hits = crossings(vertices, faces, axis, _RAYS)
        if fault := _winding_fault(hits, part, longest) or _fold(hits, vertices, faces, part, longest):
            return fault
    return None


def parts_of(faces):
    """Part of each triangle, numbered in the order of the triangles; common corners join: int32 (n_triangles,)."""
    triangle = np.repeat(np.arange(len(faces)), 3)
    corner = faces.ravel() + len(faces)
    size = corner.max() + 1
    joined = coo_matrix((np.ones(len(corner), bool), (triangle, corner)), shape=(size, size))
    return connected_components(joined, directed=False)[1][: len(faces)]


def _winding_fault(hits, part, longest):
    """Reason where a ray runs a way through a region of another winding number than 0 and 1."""
    length = np.where(hits.ray[1:] == hits.ray[:-1], np.diff(hits.height), 0.0)
    # every ray ends outside, so that the sum starts each at 0
    around = np.cumsum(hits.step)[:-1]
    wrong = np.where((around < 0) | (around > 1), length, 0.0)
    if wrong.max(initial=0.0) <= _NOTHING * longest:
        return None
    worst = int(wrong.argmax())
    before = np.flatnonzero(hits.ray[: worst + 1] == hits.ray[worst])
    winding = np.bincount(part[hits.triangle[before]], hits.step[before])
    numbers = [str(number + 1) for number in np.flatnonzero(winding)]
    named = f"part {' and '.join(numbers)} of {part.max() + 1}" if part.max() else "the surface"
    where = f"at {shown(0.5 * (hits.point[worst] + hits.point[worst + 1]))} m"
    if around[worst] < 0:
        return f"{named} is turned inwards or crosses itself {where}"
    if len(numbers) == 1:
        return f"{named} crosses itself {where}"
    return f"{named} overlap or lie within each other over {wrong[worst]:.3g} m {where}"


def _fold(hits, vertices, faces, part, longest):
    """Reason where two triangles of a part lie on each other, as those of a concave polygon cut into a fan do."""
    close = np.flatnonzero((np.diff(hits.height) <= _NOTHING * longest) & (hits.ray[1:] == hits.ray[:-1]))
    first, second = hits.triangle[close], hits.triangle[close + 1]
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    opposite = (normals[first] * normals[second]).sum(axis=1) < _OPPOSITE * lengths[first] * lengths[second]
    folded = close[opposite & (part[first] == part[second])]
    if not len(folded):
        return None
    return f"two triangles lie on each other at {shown(hits.point[folded[0]])} m; is a polygon of the file concave?"


def shown(point):
    """A point in words."""
    return "[" + ", ".join(f"{value:.3g}" for value in point) + "]"
