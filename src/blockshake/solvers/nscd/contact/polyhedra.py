"""Convex polyhedra packed into flat arrays, and placed in the world."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_rows
from blockshake.geometry.vectors import put_into, rows_product
from blockshake.jit import inner_kernel, kernel_without_allocation

# Edge directions closer than this are one separating axis: only rounding tells them apart.
_SAME_DIRECTION = 1e-9


class Outline(NamedTuple):
    """Where two faces overlap: ``corners``, ``other`` (n, 3) [m], ``gaps`` (n,) [m]; ``chosen`` int64 (4,).

    ``middle``, ``axis`` (3,): centroid of the overlap [m] and normal to two edges. Room for all corners of two faces.
    """

    corners: np.ndarray
    other: np.ndarray
    gaps: np.ndarray
    chosen: np.ndarray
    middle: np.ndarray
    axis: np.ndarray


class Polyhedra(NamedTuple):
    """Shapes of all bodies, each body with its own copy, body frames.

    ``first_vertex`` int64 (n_bodies + 1,), ``vertices`` (n_vertices, 3) [m]; ``first_face`` (n_bodies + 1,),
    ``normals`` (n_faces, 3) outward, ``offsets`` (n_faces,) [m]; ``first_corner`` (n_faces + 1,), ``corners``
    (n_corners,): rows of ``vertices``, counter-clockwise seen from outside; ``first_direction`` (n_bodies + 1,),
    ``directions`` (n_directions, 3): distinct unit directions of edges; ``first_edge`` (n_bodies + 1,), ``edges``
    (n_edges, 2): rows of ``vertices``; ``radius`` and ``inradius`` (n_bodies,) about the mass centre [m].
    """

    first_vertex: np.ndarray
    vertices: np.ndarray
    first_face: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    first_corner: np.ndarray
    corners: np.ndarray
    first_direction: np.ndarray
    directions: np.ndarray
    first_edge: np.ndarray
    edges: np.ndarray
    radius: np.ndarray
    inradius: np.ndarray


class Placed(NamedTuple):
    """The polyhedra in the world: rows as in `Polyhedra`, bounding boxes by body.

    ``center`` (n_bodies, 3) [m], mass centres; ``vertices``, ``normals``, ``directions``;
    ``offsets`` of the world planes; ``low`` and ``high`` (n_bodies, 3), corners of the axis-aligned boxes [m];
    ``outline``: workspace of `detect_pair_into`.
    """

    center: np.ndarray
    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    directions: np.ndarray
    low: np.ndarray
    high: np.ndarray
    outline: Outline


def check_convex(structure, _=None):
    """Refuse a body whose shape is not convex, with `InputError`."""
    for body in structure.file.bodies:
        if structure.solids[body.shape].polyhedron is None:
            raise InputError(
                structure.source,
                f"shapes.{body.shape}",
                "expected a convex shape: nonsmooth contact dynamics needs convex meshes",
            )


def pack_polyhedra(structure, order):
    """Polyhedra of a structure's bodies, in the order of the body indices ``order``.

    Raises
    ------
    InputError
        A body's shape is not convex.
    """
    check_convex(structure)
    solids = [structure.solid(body).polyhedron for body in order]
    edges = [_edges(solid) for solid in solids]
    directions = [_directions(solid, pairs) for solid, pairs in zip(solids, edges, strict=True)]
    first_vertex = _first([len(solid.vertices) for solid in solids])
    corners = [
        face + start for solid, start in zip(solids, first_vertex, strict=False) for face in solid.faces
    ]
    return Polyhedra(
        first_vertex=first_vertex,
        vertices=np.concatenate([solid.vertices for solid in solids]),
        first_face=_first([len(solid.faces) for solid in solids]),
        normals=np.concatenate([solid.normals for solid in solids]),
        offsets=np.concatenate([solid.offsets for solid in solids]),
        first_corner=_first([len(face) for face in corners]),
        corners=np.concatenate(corners).astype(np.int64),
        first_direction=_first([len(rows) for rows in directions]),
        directions=np.concatenate(directions),
        first_edge=_first([len(rows) for rows in edges]),
        edges=np.concatenate([rows + start for rows, start in zip(edges, first_vertex, strict=False)]),
        radius=np.array([np.linalg.norm(solid.vertices, axis=1).max() for solid in solids]),
        inradius=np.array([solid.offsets.min() for solid in solids]),
    )


def _first(lengths):
    return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)


def _edges(solid):
    pairs = {
        tuple(sorted(pair)) for face in solid.faces for pair in zip(face, np.roll(face, -1), strict=True)
    }
    return np.array(sorted(pairs), dtype=np.int64)


def _directions(solid, edges):
    kept = np.empty((0, 3))
    for start, end in edges:
        direction = solid.vertices[end] - solid.vertices[start]
        direction = direction / np.linalg.norm(direction)
        if (np.linalg.norm(np.cross(direction, kept), axis=1) > _SAME_DIRECTION).all():
            kept = np.vstack([kept, direction])
    return kept


@inner_kernel
def empty_placed(polyhedra):
    """Arrays for `place_into`."""
    n_bodies = polyhedra.radius.size
    most = 0
    for face in range(polyhedra.normals.shape[0]):
        most = max(most, polyhedra.first_corner[face + 1] - polyhedra.first_corner[face])
    room = 2 * most + 2
    outline = Outline(
        np.empty((room, 3)),
        np.empty((room, 3)),
        np.empty(room),
        np.empty(4, np.int64),
        np.empty(3),
        np.empty(3),
    )
    return Placed(
        np.empty((n_bodies, 3)), np.empty(polyhedra.vertices.shape), np.empty(polyhedra.normals.shape),
        np.empty(polyhedra.offsets.shape), np.empty(polyhedra.directions.shape), np.empty((n_bodies, 3)),
        np.empty((n_bodies, 3)), outline,
    )  # fmt: skip


@kernel_without_allocation
def _turn_into(R, vectors, first, last, out):
    for row in range(first, last):
        put_into(rows_product(R, vectors[row]), out[row])


@kernel_without_allocation
def place_into(polyhedra, position, orientation, placed):
    """Write the polyhedra at these poses, shapes as in `State`, into ``placed``."""
    for body in range(polyhedra.radius.size):
        R = rotation_rows(orientation[body])
        center = position[body]
        first, last = polyhedra.first_vertex[body], polyhedra.first_vertex[body + 1]
        _turn_into(R, polyhedra.vertices, first, last, placed.vertices)
        for axis in range(3):
            placed.center[body, axis] = center[axis]
            low, high = np.inf, -np.inf
            for row in range(first, last):
                value = placed.vertices[row, axis] + center[axis]
                placed.vertices[row, axis] = value
                low, high = min(low, value), max(high, value)
            placed.low[body, axis], placed.high[body, axis] = low, high
        first, last = polyhedra.first_face[body], polyhedra.first_face[body + 1]
        _turn_into(R, polyhedra.normals, first, last, placed.normals)
        for face in range(first, last):
            n = placed.normals[face]
            placed.offsets[face] = (
                polyhedra.offsets[face] + n[0] * center[0] + n[1] * center[1] + n[2] * center[2]
            )
        first, last = polyhedra.first_direction[body], polyhedra.first_direction[body + 1]
        _turn_into(R, polyhedra.directions, first, last, placed.directions)
