"""Convex polyhedra with polygonal faces, and mass properties of closed surfaces."""

from dataclasses import dataclass

import numpy as np
import trimesh
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

# Two facets of a hull belong to one face when their unit normals and offsets agree to this much,
# relative to the size of the body: far above rounding, far below any intended edge.
_SAME_PLANE = 1e-7


@dataclass(frozen=True)
class MassProperties:
    """Volume, centroid, unit-density inertia and area of a closed surface."""

    volume: float  # enclosed volume [m3]
    centroid: np.ndarray  # float64 (3,); in the frame of the vertices [m]
    # float64 (3, 3); about the centroid for a density of 1 kg/m3 [m5], axes of the vertices' frame
    inertia: np.ndarray
    area: float  # [m2]


@dataclass(frozen=True)
class Polyhedron:
    """A convex body by its vertices and polygonal faces."""

    vertices: np.ndarray  # float64 (n_vertices, 3); body frame [m]
    faces: tuple  # of int64 arrays; vertex indices of each face, counter-clockwise seen from outside
    normals: np.ndarray  # float64 (n_faces, 3); unit outward normals
    offsets: np.ndarray  # float64 (n_faces,); a point p lies inside where ``normals @ p <= offsets`` [m]


def box_vertices(size, chamfer):
    """Vertices of a box whose twelve edges are cut at 45 degrees: float64 array, shape (8, 3) or (32, 3).

    ``size``: full edge lengths along body x, y, z [m]; ``chamfer``: leg of the chamfer on each adjacent face, 0 for the
    sharp box [m]. With a chamfer: the 24 corners of the six flats, then the 8 points where three chamfers meet.
    """
    half = np.asarray(size, dtype=float) / 2.0
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    if chamfer == 0.0:
        return signs * half
    flats = []
    for axis in range(3):
        inset = np.full(3, chamfer)
        inset[axis] = 0.0
        flats.append(signs * (half - inset))
    return np.vstack([*flats, signs * (half - chamfer / 2.0)])


def convex_polyhedron(vertices):
    """Convex hull of points, coplanar facets merged into polygons, faces in a fixed order.

    Parameters
    ----------
    vertices : float64 array, shape (n, 3)
        Points [m]; those inside the hull or inside a face are dropped.
    """
    vertices = np.asarray(vertices, dtype=float)
    hull = ConvexHull(vertices)
    scale = np.ptp(vertices, axis=0).max()
    planes = np.column_stack([hull.equations[:, :3], -hull.equations[:, 3] / scale])
    # neighbours in the same plane are one face, so that every edge has a face on either side
    facet, side = np.nonzero(np.abs(planes[hull.neighbors] - planes[:, None]).max(axis=2) < _SAME_PLANE)
    links = coo_array((np.ones(len(facet)), (facet, hull.neighbors[facet, side])), (len(planes),) * 2)
    _, face_of = connected_components(links, directed=False)
    order = np.lexsort(np.round(planes, 6).T)
    _, first = np.unique(face_of[order], return_index=True)
    distinct = order[np.sort(first)]
    normals = planes[distinct, :3]
    offsets = planes[distinct, 3] * scale
    faces = []
    for face, normal in zip(face_of[distinct], normals, strict=True):
        facets = np.flatnonzero(face_of == face)
        facet, opposite = np.nonzero(face_of[hull.neighbors[facets]] != face)
        faces.append(_counter_clockwise(vertices, hull.simplices[facets][facet], opposite, normal))
    used = np.unique(np.concatenate(faces))
    renumbered = np.full(len(vertices), -1)
    renumbered[used] = np.arange(len(used))
    return Polyhedron(vertices[used], tuple(renumbered[face] for face in faces), normals, offsets)


def _counter_clockwise(vertices, corners, opposite, normal):
    """Corners of a face in order, from its facets on the rim: ``corners`` (n, 3), ``opposite`` (n,) off the rim."""
    off, start, end = (corners[np.arange(len(corners)), (opposite + turn) % 3] for turn in range(3))
    turned = np.cross(vertices[start] - vertices[off], vertices[end] - vertices[off]) @ normal < 0.0
    following = dict(zip(np.where(turned, end, start), np.where(turned, start, end), strict=True))
    indices = np.array(sorted(following))
    points = vertices[indices] - vertices[indices].mean(axis=0)
    first = points[0] / np.linalg.norm(points[0])
    face = [indices[np.arctan2(points @ np.cross(normal, first), points @ first).argmin()]]
    for _ in following.keys() - face:
        face.append(following[face[-1]])
    return np.array(face)


def triangles(polyhedron):
    """Triangle fan of every face: int64 array, shape (n_triangles, 3), outward."""
    return np.array(
        [
            (face[0], face[corner], face[corner + 1])
            for face in polyhedron.faces
            for corner in range(1, len(face) - 1)
        ]
    )


def mass_properties(vertices, faces):
    """Mass properties of the solid inside a closed triangulated surface.

    Parameters
    ----------
    vertices : float64 array, shape (n_vertices, 3)
        Corners [m].
    faces : int array, shape (n_triangles, 3)
        Outward triangles.
    """
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    inertia = np.array(mesh.moment_inertia)
    # a symmetric body must not start to yaw from the rounding of its own inertia
    inertia[np.abs(inertia) < 1e-12 * np.trace(inertia)] = 0.0
    return MassProperties(float(mesh.volume), np.array(mesh.center_mass), inertia, float(mesh.area))
