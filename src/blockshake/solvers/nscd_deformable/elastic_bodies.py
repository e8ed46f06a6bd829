"""All deformable bodies packed into flat arrays, and their elastic coordinates."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import Argument, InputError
from blockshake.jit import inline_kernel, kernel_without_allocation
from blockshake.solvers.nscd_deformable.shapes import elastic_shapes

# What fits into 2 GiB: constraint shapes of a mesh, and all modes of one
_MOST_NODES, _MOST_NODES_OF_FULL_MESH = 20_000, 3_000


class Elastic(NamedTuple):
    """Elastic shapes of all bodies, each with its own copy; driven bodies are rigid and have none.

    ``first_shape``, ``first_point``, ``first_entry``, ``first_cell`` int64 (n_bodies + 1,): where the shapes, the
    lattice's points, the entries of ``shape`` and the cells of ``table`` of each body begin.
    ``squared_frequency`` [1/s2] and ``damping`` [1/s] (n_shapes,). ``shape`` (n_entries,): displacements of the
    points, rows ``3 point + axis``, columns the body's shapes [kg^-0.5]. ``first_line`` int64 (3 n_bodies + 1,),
    ``lines`` (n_lines,): planes of the lattices across each body's x, y, z, from the mass centre [m]. ``table``
    int64 (n_cells,): point of the body at each crossing of its planes, -1 inside.
    """

    first_shape: np.ndarray
    first_point: np.ndarray
    first_entry: np.ndarray
    first_cell: np.ndarray
    squared_frequency: np.ndarray
    damping: np.ndarray
    shape: np.ndarray
    first_line: np.ndarray
    lines: np.ndarray
    table: np.ndarray


class Deformation(NamedTuple):
    """Elastic coordinates of all bodies at one instant, changed in place by kernels.

    ``amplitude`` (n_shapes,) [kg^0.5 m] and ``rate`` (n_shapes,) [kg^0.5 m/s]; ``lost`` (1,): energy that the
    scheme took so far [J].
    """

    amplitude: np.ndarray
    rate: np.ndarray
    lost: np.ndarray


def pack_elastic(structure, order, parameters, viscous):
    """Elastic shapes of a structure's bodies, in the order of the body indices ``order``, int64 (n_bodies,).

    ``parameters`` (DeformableParameters); ``viscous``: whether the viscous moduli act.

    Raises
    ------
    InputError
        A free body is not a box, or its mesh is too fine.

    Notes
    -----
    Kelvin and Voigt: the stress is ``C (strain + (eta / E) strain rate)``, so that a shape of angular frequency omega
    has the damping ``(eta / E) omega^2``. The mesh fills the box; its density is the body's mass over
    the box's volume, a chamfer being a small part of it.
    """
    check_boxes(structure, parameters)
    packed = [_packed_body(structure, body, parameters, viscous) for body in order]
    squared, damping, shape, lines, tables, n_points = zip(*packed, strict=True)
    lines = [part for three in lines for part in three]
    return Elastic(
        first_shape=_first(squared),
        first_point=np.concatenate([[0], np.cumsum(n_points)]).astype(np.int64),
        first_entry=_first(shape),
        first_cell=_first(tables),
        squared_frequency=np.concatenate(squared),
        damping=np.concatenate(damping),
        shape=np.concatenate(shape),
        first_line=_first(lines),
        lines=np.concatenate(lines),
        table=np.concatenate(tables),
    )


def _packed_body(structure, body, parameters, viscous):
    """Squared frequencies, damping, shapes, lines and table of one body, as in `Elastic`; number of its points."""
    entry = structure.file.bodies[body]
    if entry.driven:
        none = np.empty(0)
        return none, none, none, [none] * 3, np.empty(0, np.int64), 0
    box, material = structure.file.shapes[entry.shape].box, structure.file.materials[entry.material]
    shapes = elastic_shapes(
        box, material.poisson_ratio, parameters.mesh_size, parameters.contact_spacing, parameters.modes
    )
    lattice, density = shapes.lattice, structure.mass[body] / np.prod(box)
    squared = shapes.squared_frequency * material.youngs_modulus / density
    ratio = material.viscous_modulus / material.youngs_modulus if viscous else 0.0
    shape = (shapes.at_lattice() / np.sqrt(density)).ravel()
    lines = [part - offset for part, offset in zip(lattice.lines, entry.mass_offset, strict=True)]
    return squared, ratio * squared, shape, lines, lattice.table.ravel(), len(lattice.nodes)


def check_boxes(structure, parameters):
    """Refuse a free body that is no box, or a mesh that this program's dense matrices do not hold."""
    for body in structure.file.bodies:
        if not body.driven:
            box = structure.file.shapes[body.shape].box
            if box is None:
                raise InputError(
                    structure.source, f"shapes.{body.shape}", "expected a box: meshes deform in no model yet"
                )
            _check_size(box, parameters)


def _check_size(box, parameters):
    counts = [max(1, round(edge / parameters.mesh_size)) for edge in box]
    nodes = int(np.prod([count + 1 for count in counts]))
    limit = _MOST_NODES if parameters.modes < 3 * nodes - 6 else _MOST_NODES_OF_FULL_MESH
    if nodes > limit:
        raise InputError(
            Argument("parameters"),
            "nscd_deformable.mesh_size",
            f"expected at most {limit} nodes in a block, not {nodes}: a larger size",
        )


def _first(parts):
    """Where parts of an array begin when they are put one after another."""
    return np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.int64)


def undeformed(elastic):
    """Deformation at rest."""
    n_shapes = len(elastic.squared_frequency)
    return Deformation(np.zeros(n_shapes), np.zeros(n_shapes), np.zeros(1))


@inline_kernel
def shapes_of(elastic, body):
    """Displacements of one body's points: float64 array, shape (3 n_points, n_shapes), a view."""
    rows = 3 * (elastic.first_point[body + 1] - elastic.first_point[body])
    columns = elastic.first_shape[body + 1] - elastic.first_shape[body]
    return elastic.shape[elastic.first_entry[body] : elastic.first_entry[body + 1]].reshape(rows, columns)


@kernel_without_allocation
def _cell(elastic, body, axis, x):
    """Line below a coordinate, within the lattice, and how far the coordinate is from it to the next, 0 to 1."""
    first, last = elastic.first_line[3 * body + axis], elastic.first_line[3 * body + axis + 1]
    line = first
    while line + 2 < last and elastic.lines[line + 1] <= x:
        line += 1
    share = (x - elastic.lines[line]) / (elastic.lines[line + 1] - elastic.lines[line])
    return line - first, min(max(share, 0.0), 1.0)


@kernel_without_allocation
def anchor_into(elastic, body, x, outward, points, weights):
    """Four points of a body's lattice around a place on its surface, and their weights, overwritten.

    ``x``: the place, seen from the mass centre [m]; ``outward``: direction out of the body there, which states on which
    of the six faces the place is; body frame. ``points`` int64 (4,): indices among the points of all bodies;
    ``weights`` (4,): bilinear, of sum 1 [1], zero where the body is rigid.
    """
    for corner in range(4):
        points[corner], weights[corner] = 0, 0.0
    if elastic.first_point[body] == elastic.first_point[body + 1]:
        return
    across = 0
    for axis in range(1, 3):
        if abs(outward[axis]) > abs(outward[across]) + 1e-9:
            across = axis
    along, other = (across + 1) % 3, (across + 2) % 3
    first = elastic.first_line
    last = first[3 * body + across + 1] - first[3 * body + across] - 1 if outward[across] > 0.0 else 0
    n_y, n_z = first[3 * body + 2] - first[3 * body + 1], first[3 * body + 3] - first[3 * body + 2]
    u, share_u = _cell(elastic, body, along, x[along])
    v, share_v = _cell(elastic, body, other, x[other])
    for corner in range(4):
        step_u, step_v = corner & 1, corner >> 1
        u_here, v_here = u + step_u, v + step_v
        i, j, k = last, u_here, v_here
        if across == 1:
            i, j, k = v_here, last, u_here
        elif across == 2:
            i, j, k = u_here, v_here, last
        cell = (i * n_y + j) * n_z + k
        points[corner] = elastic.first_point[body] + elastic.table[elastic.first_cell[body] + cell]
        weights[corner] = (share_u if step_u else 1.0 - share_u) * (share_v if step_v else 1.0 - share_v)
