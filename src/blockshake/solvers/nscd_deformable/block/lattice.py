"""Where a block can be touched: a lattice on each of its six faces, a part of the mesh's nodes."""

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix


@dataclass(frozen=True)
class Lattice:
    """Nodes of a box's faces that carry contact, and how the others follow them.

    Attributes
    ----------
    lines : tuple of 3 float64 arrays
        Coordinates of the lattice's planes across x, y, z, the first and the last on the faces [m].
    nodes : int64 array, shape (n_points,)
        Nodes of the mesh.
    table : int64 array, shape (n_x, n_y, n_z)
        Index in ``nodes`` of each crossing of the planes, -1 inside the box.
    surface : int64 array, shape (n_surface,)
        All nodes of the faces.
    bilinear : sparse float64 array, shape (n_surface, n_points)
        Their displacements per displacement of the lattice's, bilinear between these.
    """

    lines: tuple
    nodes: np.ndarray
    table: np.ndarray
    surface: np.ndarray
    bilinear: csr_matrix


def surface_lattice(mesh, spacing):
    """Lattice on the planes of a mesh, as evenly spaced as these allow, at most about ``spacing`` apart [m]."""
    picked = [_planes(edge, count, spacing) for edge, count in zip(mesh.size, mesh.counts, strict=True)]
    table, nodes = np.full([len(planes) for planes in picked], -1), []
    for crossing in itertools.product(*(range(len(planes)) for planes in picked)):
        if any(place in (0, len(planes) - 1) for place, planes in zip(crossing, picked, strict=True)):
            table[crossing] = len(nodes)
            nodes.append(mesh.node(*(planes[place] for place, planes in zip(crossing, picked, strict=True))))
    hats = [_hats(planes, count) for planes, count in zip(picked, mesh.counts, strict=True)]
    surface, rows, columns, values = [], [], [], []
    for place in itertools.product(*(range(count + 1) for count in mesh.counts)):
        if not any(index in (0, count) for index, count in zip(place, mesh.counts, strict=True)):
            continue
        for (i, x), (j, y), (k, z) in itertools.product(*(hats[axis][place[axis]] for axis in range(3))):
            rows.append(len(surface))
            columns.append(table[i, j, k])
            values.append(x * y * z)
        surface.append(mesh.node(*place))
    bilinear = csr_matrix((values, (rows, columns)), (len(surface), len(nodes)))
    lines = tuple(mesh.lines(axis)[planes] for axis, planes in enumerate(picked))
    return Lattice(lines, np.array(nodes), table, np.array(surface), bilinear)


def _planes(edge, count, spacing):
    """Planes of the mesh across an edge that the lattice takes."""
    parts = min(count, max(1, int(np.ceil(edge / spacing - 1e-9))))
    return np.unique(np.round(np.linspace(0, count, parts + 1)).astype(np.int64))


def _hats(planes, count):
    """For each plane of the mesh, the planes of the lattice around it and their weights; zero weights left out."""
    around = []
    for plane in range(count + 1):
        below = min(int(np.searchsorted(planes, plane, "right")) - 1, len(planes) - 2)
        share = (plane - planes[below]) / (planes[below + 1] - planes[below])
        around.append([pair for pair in ((below, 1.0 - share), (below + 1, share)) if pair[1] > 0.0])
    return around
