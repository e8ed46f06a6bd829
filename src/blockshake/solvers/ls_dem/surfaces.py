"""Shapes as LS-DEM reads them: a level set to be inside of, and nodes that look for others' level sets."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.level_set import box_distance, hollow_box_distance
from blockshake.geometry.level_set_grid import box_grid, grid_table, mesh_grid
from blockshake.geometry.mesh_nodes import mesh_nodes
from blockshake.geometry.surface_nodes import box_nodes, chamfer_nodes
from blockshake.geometry.trilinear import grid_distance
from blockshake.jit import kernel

# Columns of ``Surfaces.lattice``
FIRST, ORIGIN_X, ORIGIN_Y, ORIGIN_Z, COUNT_X, COUNT_Y, COUNT_Z, INVERSE_SPACING, N_LATTICE = range(9)
_MOST_POINTS = 5e7  # of a lattice: 400 MB


class Surfaces(NamedTuple):
    """Level sets and nodes of the shapes.

    ``shape`` int64 (n_bodies,): shape of each body; ``offset`` (n_bodies, 3): its mass centre in the frame of the
    shape, whose origin is the centroid; ``radius`` (n_bodies,) about the mass centre [m]. ``half``, ``middle``
    (n_shapes, 3): half edges and middle of the bounding box; ``wide`` (n_shapes,): radius of the largest
    bodies that stand on a box without a look at its edges, see `_wide` [m]; ``chamfer``, ``hollow`` (n_shapes,) [m].
    ``lattice`` (n_shapes, N_LATTICE): that of a sampled level set, its spacing zero where the distance of
    the box is exact, first value, origin [m], counts and cells per metre; ``values`` (n_values,)
    [m]. ``steepest`` (n_shapes,): most that the level set changes per distance [1]. ``first_node`` int64
    (n_shapes + 1,), ``points`` (n_nodes, 3), ``areas`` (n_nodes,): surface nodes in the frame of the shape
    [m, m2]; ``damping_weight`` (n_nodes,): what a node's dashpot goes with.
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
    first_node: np.ndarray
    points: np.ndarray
    areas: np.ndarray
    damping_weight: np.ndarray


def assemble_surfaces(structure, parameters):
    """Level sets and surface nodes of a structure's shapes.

    Raises
    ------
    InputError
        A flat too narrow for the perimeter inset, or a lattice too fine to hold.
    """
    names = list(structure.file.shapes)
    shapes = structure.file.shapes
    nodes = [_nodes(structure, name, parameters) for name in names]
    table = grid_table([_grid(structure, name, parameters) for name in names])
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
            [np.zeros(3) if shapes[name].box else place for name, place in zip(names, (low + high) / 2.0, strict=True)]
        ),
        wide=np.array([_wide(shapes[name]) for name in names]),
        chamfer=np.array([shapes[name].chamfer for name in names]),
        hollow=np.array([shapes[name].hollow for name in names]),
        lattice=np.column_stack(
            [table.first[:-1], table.origin, table.counts, np.where(sampled, 1.0 / table.spacing, 0.0)]
        ),
        values=table.values,
        steepest=table.steepest * np.array([_hollow_slope(shapes[name]) for name in names]),
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
    shape, inset = structure.file.shapes[name], parameters.perimeter_inset
    if shape.box is None:
        solid = structure.solids[name]
        return mesh_nodes(solid.vertices, solid.triangles, parameters.node_spacing, inset)
    flat = min(shape.box) - 2.0 * shape.chamfer
    if 2.0 * inset >= flat:
        raise InputError(
            structure.source,
            f"shapes.{name}",
            f"expected flats wider than twice ls_dem.perimeter_inset, not {flat} m",
        )
    points, areas = box_nodes(shape.box, shape.chamfer, shape.hollow, parameters.node_spacing, inset)
    if areas.min() <= 0.0:
        raise InputError(
            structure.source,
            f"shapes.{name}",
            "expected flats much wider than ls_dem.perimeter_inset, and for long ones a wider ls_dem.node_spacing",
        )
    if parameters.edge_spacing == 0.0:
        return points, areas
    more_points, more_areas = chamfer_nodes(shape.box, shape.chamfer, parameters.edge_spacing)
    return np.vstack([points, more_points]), np.concatenate([areas, more_areas])


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


def _check_grid(structure, name, parameters):
    """Refuse a hollow face, and a lattice of too many points."""
    spacing = parameters.grid_spacing
    if structure.file.shapes[name].hollow:
        raise InputError(
            structure.source,
            f"shapes.{name}.hollow",
            f"expected the exact distance with hollow faces: ls_dem.level_set is {parameters.level_set}",
        )
    if np.prod(np.ptp(structure.solids[name].vertices, axis=0) / spacing + 4.0) > _MOST_POINTS:
        raise InputError(
            structure.source,
            f"shapes.{name}",
            f"expected fewer lattice points: ls_dem.grid_spacing is {spacing} m",
        )


@kernel
def level_set(surfaces, shape, x, y, z):
    """Level-set value of a shape at one place in its frame [m]."""
    lattice = surfaces.lattice[shape]
    if lattice[INVERSE_SPACING] == 0.0:
        half = surfaces.half[shape]
        chamfer, hollow = surfaces.chamfer[shape], surfaces.hollow[shape]
        if hollow > 0.0:
            return hollow_box_distance(x, y, z, half[0], half[1], half[2], chamfer, hollow)[0]
        return box_distance(x, y, z, half[0], half[1], half[2], chamfer)[0]
    return grid_distance(
        x, y, z, surfaces.values, lattice[FIRST], lattice[ORIGIN_X], lattice[ORIGIN_Y], lattice[ORIGIN_Z],
        lattice[COUNT_X], lattice[COUNT_Y], lattice[COUNT_Z], lattice[INVERSE_SPACING],
    )[0]  # fmt: skip
