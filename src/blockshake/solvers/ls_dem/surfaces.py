"""Shapes as LS-DEM reads them: a level set to be inside of, and nodes that look for others' level sets."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.level_set import box_distance, hollow_box_distance
from blockshake.geometry.level_set_grid import box_grid, grid_distance, grid_table, mesh_grid
from blockshake.geometry.meshes.mesh_nodes import mesh_nodes
from blockshake.geometry.surface_nodes import box_nodes
from blockshake.jit import kernel_without_allocation

INVERSE_SPACING = 7  # column of ``Surfaces.lattice``
_COARSEST = 4.0 / 3.0  # cell of a lattice over volume per surface: two thirds of a plate's thickness
_MOST_POINTS = 5e7  # of a lattice: 400 MB
_MOST_NODES = 1e6  # of a shape: a step then takes a second
_MOST_PLANES = 64  # of a convex mesh whose distance is found by them
_BROAD = 1.0  # m; nodes of a shape that is broader are farther apart, in proportion


class Surfaces(NamedTuple):
    """Level sets and nodes of the shapes.

    ``shape`` int64 (n_bodies,): shape of each body; ``offset`` (n_bodies, 3): its mass centre in the frame of the
    shape, whose origin is the centroid; ``radius`` (n_bodies,) about the mass centre [m]. ``half``, ``middle``
    (n_shapes, 3): half edges and middle of the bounding box; ``wide`` (n_shapes,): radius of the largest
    bodies that stand on a box without a look at its edges, see `_wide` [m]; ``chamfer``, ``hollow`` (n_shapes,) [m].
    ``lattice`` (n_shapes, 8): that of a sampled level set, its spacing zero where the distance of
    the box is exact, first value, origin [m], counts and cells per metre; ``values`` (n_values,)
    [m]. ``steepest`` (n_shapes,): most that the level set changes per distance [1]. ``first_plane`` int64
    (n_shapes + 1,), ``planes`` (n_planes, 4): outward normals and distances of the faces of a convex mesh [1, m].
    ``first_node`` int64 (n_shapes + 1,), ``points`` (n_nodes, 3), ``areas`` (n_nodes,): surface nodes in the frame of
    the shape [m, m2]; ``damping_weight`` (n_nodes,): what a node's dashpot goes with.
    """

    shape: np.ndarray
    offset: np.ndarray
    radius: np.ndarray
    half: np.ndarray
    middle: np.ndarray
    wide: np.ndarray
    chamfer: np.ndarray
    hollow: np.ndarray
    lattice: np.ndarray
    values: np.ndarray
    steepest: np.ndarray
    first_plane: np.ndarray
    planes: np.ndarray
    first_node: np.ndarray
    points: np.ndarray
    areas: np.ndarray
    damping_weight: np.ndarray


def assemble_surfaces(structure, parameters):
    """Level sets and surface nodes of a structure's shapes.

    Raises
    ------
    InputError
        A lattice too fine to hold.
    """
    names = list(structure.file.shapes)
    shapes = structure.file.shapes
    nodes = [_nodes(structure, name, parameters) for name in names]
    planes = [_planes(structure, name, parameters) for name in names]
    by_shape = zip(names, planes, strict=True)
    table = grid_table([None if len(rows) else _grid(structure, name, parameters) for name, rows in by_shape])
    solids = [structure.solids[name] for name in names]
    low = np.array([solid.vertices.min(axis=0) for solid in solids])
    high = np.array([solid.vertices.max(axis=0) for solid in solids])
    sampled = np.diff(table.first) > 0
    areas = np.concatenate([areas for _, areas in nodes])
    return Surfaces(
        shape=np.array([names.index(body.shape) for body in structure.file.bodies]),
        offset=structure.mass_offset,
        radius=np.array(
            [np.linalg.norm(structure.solid(body).vertices, axis=1).max() for body in range(len(structure.mass))]
        ),
        half=np.array(
            [shapes[name].box or size for name, size in zip(names, high - low, strict=True)]
        ) / 2.0,
        middle=np.array(
            [np.zeros(3) if shapes[name].box else mid for name, mid in zip(names, (low + high) / 2.0, strict=True)]
        ),
        wide=np.array([_wide(shapes[name]) for name in names]),
        chamfer=np.array([shapes[name].chamfer for name in names]),
        hollow=np.array([shapes[name].hollow for name in names]),
        lattice=np.column_stack(
            [table.first[:-1], table.origin, table.counts, np.where(sampled, 1.0 / table.spacing, 0.0)]
        ),
        values=table.values,
        steepest=table.steepest * np.array([_hollow_slope(shapes[name]) for name in names]),
        first_plane=np.concatenate([[0], np.cumsum([len(rows) for rows in planes])]),
        planes=np.vstack(planes),
        first_node=np.concatenate([[0], np.cumsum([len(areas) for _, areas in nodes])]),
        points=np.vstack([points for points, _ in nodes]),
        areas=areas,
        damping_weight=np.sqrt(areas) if parameters.damping == "node" else areas.copy(),
    )  # fmt: skip


def _wide(shape):
    """Half of the width that a box offers: of a plate its broad face's, of another box its narrowest; 0 for a mesh."""
    if shape.box is None:
        return 0.0
    thin, narrow, _ = sorted(shape.box)
    return 0.5 * (narrow if thin < 0.5 * narrow else thin)


def _hollow_slope(shape):
    """Most that the level set of a hollow face changes per distance [1]: 1 for a flat one.

    By its place over the half width u, the depth ``h (1 - u^2)^2`` changes by at most ``8 h / (3 sqrt(3))``.
    """
    if shape.box is None:
        return 1.0
    steepest = 8.0 / (3.0 * np.sqrt(3.0)) * shape.hollow / (0.5 * min(shape.box) - shape.chamfer)
    return np.hypot(1.0, np.sqrt(2.0) * steepest)


def _nodes(structure, name, parameters):
    """Points and areas of a shape's nodes."""
    shape, solid = structure.file.shapes[name], structure.solids[name]
    breadth = min(shape.box or np.ptp(solid.vertices, axis=0)) - 2.0 * shape.chamfer
    spacing = parameters.node_spacing * max(1.0, breadth / _BROAD)
    count = solid.properties.area / spacing**2
    if count > _MOST_NODES:
        expected = f"expected at most {_MOST_NODES:.0e} nodes, not {count:.1g}: a wider ls_dem.node_spacing"
        raise _refusal(structure, name, expected)
    if shape.box is None:
        return mesh_nodes(solid.vertices, solid.triangles, spacing, parameters.perimeter_inset)
    return box_nodes(shape.box, shape.chamfer, shape.hollow, spacing, parameters.perimeter_inset)


def _planes(structure, name, parameters):
    """Normals and distances of the faces of a convex mesh, shape (n, 4); none of another shape or of too many faces."""
    polyhedron = structure.solids[name].polyhedron
    sampled = structure.file.shapes[name].box is not None or parameters.level_set == "grid"
    if sampled or polyhedron is None or len(polyhedron.offsets) > _MOST_PLANES:
        return np.empty((0, 4))
    return np.column_stack([polyhedron.normals, polyhedron.offsets])


def _grid(structure, name, parameters):
    """Sampled level set of a shape, None for a box whose distance is exact."""
    shape, solid = structure.file.shapes[name], structure.solids[name]
    spacing = parameters.grid_spacing
    if shape.box is not None and parameters.level_set == "exact":
        return None
    _check_grid(structure, name, parameters)
    if shape.box is not None:
        return box_grid(shape.box, shape.chamfer, spacing)
    return mesh_grid(solid.vertices, solid.triangles, spacing)


def check_shapes(structure, parameters):
    """Refuse shapes on which no nodes fit, or whose distance cannot be sampled, with `InputError`."""
    for name, shape in structure.file.shapes.items():
        if shape.box is not None:
            _nodes(structure, name, parameters)
        if shape.box is None or parameters.level_set != "exact":
            _check_grid(structure, name, parameters)


def _refusal(structure, name, expected):
    return InputError(structure.source, f"shapes.{name}", expected)


def _check_grid(structure, name, parameters):
    """Refuse a hollow face, and a lattice that is too coarse or of too many points."""
    spacing = parameters.grid_spacing
    if structure.file.shapes[name].hollow:
        given = f"ls_dem.level_set is {parameters.level_set}"
        raise _refusal(structure, f"{name}.hollow", f"expected the exact distance with hollow faces: {given}")
    properties = structure.solids[name].properties
    widest = _COARSEST * properties.volume / properties.area
    if spacing > widest:
        expected = f"a ls_dem.grid_spacing of at most {widest:.2g} m, not {spacing:g} m: others fall through"
        raise _refusal(structure, name, f"expected {expected}")
    if np.prod(np.ptp(structure.solids[name].vertices, axis=0) / spacing + 4.0) > _MOST_POINTS:
        raise _refusal(structure, name, f"expected fewer lattice points: ls_dem.grid_spacing is {spacing} m")


@kernel_without_allocation
def level_set(surfaces, shape, x, y, z):
    """Level-set value of a shape at one place in its frame [m]."""
    if surfaces.first_plane[shape] < surfaces.first_plane[shape + 1]:
        farthest = -np.inf
        for plane in surfaces.planes[surfaces.first_plane[shape] : surfaces.first_plane[shape + 1]]:
            farthest = max(farthest, plane[0] * x + plane[1] * y + plane[2] * z - plane[3])
        return farthest
    if surfaces.lattice[shape, INVERSE_SPACING] == 0.0:
        half = surfaces.half[shape]
        chamfer, hollow = surfaces.chamfer[shape], surfaces.hollow[shape]
        if hollow > 0.0:
            return hollow_box_distance(x, y, z, half[0], half[1], half[2], chamfer, hollow)[0]
        return box_distance(x, y, z, half[0], half[1], half[2], chamfer)[0]
    at_first, ox, oy, oz, n_x, n_y, n_z, inverse = lattice_of(surfaces.lattice, shape)
    return grid_distance(x, y, z, surfaces.values, at_first, ox, oy, oz, n_x, n_y, n_z, inverse)[0]


@kernel_without_allocation
def lattice_of(lattice, shape):
    """First value, origin, counts and cells per metre of a shape's lattice, as eight numbers."""
    row = lattice[shape]
    return row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]
