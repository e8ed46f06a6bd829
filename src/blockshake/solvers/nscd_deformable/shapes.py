"""Elastic shapes of a free block, made orthogonal, and the lattice on its faces at which it can be touched."""

import functools
import itertools
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_matrix, kron
from scipy.sparse.linalg import eigsh, splu

from blockshake.solvers.nscd_deformable.box_mesh import BoxMesh, assemble, box_mesh, rigid_motions

# Shapes whose part that no other shape has is smaller than this, in mass, are the others' sum.
_DEPENDENT = 1e-9


@dataclass(frozen=True)
class Lattice:
    """Nodes of a box's faces that carry contact, and how the others follow them."""

    # of 3 float64 arrays; coordinates of the lattice's planes across x, y, z, the first and the last on the
    # faces [m]
    lines: tuple
    nodes: np.ndarray  # int64 (n_points,); nodes of the mesh
    # int64 (n_x, n_y, n_z); index in ``nodes`` of each crossing of the planes, -1 inside the box
    table: np.ndarray
    surface: np.ndarray  # int64 (n_surface,); all nodes of the faces
    # sparse float64 array, shape (n_surface, n_points); their displacements per displacement of the
    # lattice's, bilinear between these
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
    """Planes of the mesh across an edge that the lattice takes, their own mirror image: else a block leans."""
    parts = min(count, max(1, int(np.ceil(edge / spacing - 1e-9))))
    planes = np.round(np.linspace(0, count, parts + 1)).astype(np.int64)
    return np.union1d(planes, count - planes)


def _hats(planes, count):
    """For each plane of the mesh, the planes of the lattice around it and their weights; zero weights left out."""
    around = []
    for plane in range(count + 1):
        below = min(int(np.searchsorted(planes, plane, "right")) - 1, len(planes) - 2)
        share = (plane - planes[below]) / (planes[below + 1] - planes[below])
        around.append([pair for pair in ((below, 1.0 - share), (below + 1, share)) if pair[1] > 0.0])
    return around


@dataclass(frozen=True)
class Shapes:
    """Elastic displacements of a box of unit Young's modulus and density, in its mean axes."""

    mesh: BoxMesh
    lattice: Lattice
    # float64 (n_shapes,); increasing [1/m2]: times Young's modulus over density it is the square of an
    # angular frequency
    squared_frequency: np.ndarray
    # float64 (3 n_nodes, n_shapes); orthogonal in mass and stiffness and to all rigid motions, of unit mass
    # [m^-1.5]
    displacement: np.ndarray

    def at_lattice(self):
        """Displacement of the lattice's nodes: float64 array, shape (n_points, 3, n_shapes)."""
        return self.displacement.reshape(len(self.mesh.nodes), 3, -1)[self.lattice.nodes]


@functools.cache
def elastic_shapes(size, poisson_ratio, mesh_size, contact_spacing, free_modes):
    """`Shapes` of a box, elastic.

    Parameters
    ----------
    size : tuple of 3 float
        Edge lengths [m].
    poisson_ratio : float
    mesh_size, contact_spacing : float
        The bricks and of the lattice [m].
    free_modes : int
        Free modes of vibration, lowest first, that join the constraint shapes; as many as the mesh has or more give
        all modes and no constraint shapes: the full mesh.

    Notes
    -----
    Craig and Bampton (1968): a constraint shape is the static answer to a unit displacement of a node of the lattice,
    the nodes between following bilinearly and the others of the lattice at rest; free modes take the place of the
    fixed-interface ones (Rubin 1975). With the lattice on all nodes of the faces balanced forces on them are answered
    exactly in the static limit; on a coarser one a uniform stress still is. Rigid motions are taken out, so that the
    shapes are those of the mean axes. Young's modulus and density only rescale: ``omega^2 E / rho``, and displacements
    over the root of the density.
    """
    mesh = box_mesh(size, mesh_size)
    lattice = surface_lattice(mesh, contact_spacing)
    K, M = assemble(mesh, poisson_ratio)
    rigid = rigid_motions(mesh)
    count = K.shape[0] - 6
    if free_modes >= count:
        squared, displacement = eigh(K.toarray(), M.toarray())
        return Shapes(mesh, lattice, squared[6:], np.ascontiguousarray(displacement[:, 6:]))
    basis = _constraint_shapes(K, lattice)
    if free_modes:
        basis = np.hstack([_free_modes(K, M, free_modes), basis])
    # what rounding left of rigid motions
    basis -= rigid @ np.linalg.solve(rigid.T @ (M @ rigid), rigid.T @ (M @ basis))
    basis /= np.sqrt(np.einsum("ij,ij->j", basis, M @ basis))
    weight, vectors = eigh(basis.T @ (M @ basis))
    kept = weight > _DEPENDENT * weight[-1]
    basis = basis @ (vectors[:, kept] / np.sqrt(weight[kept]))
    squared, vectors = eigh(basis.T @ (K @ basis))
    return Shapes(mesh, lattice, squared, np.ascontiguousarray(basis @ vectors))


def _constraint_shapes(K, lattice):
    """Answers to unit displacements of the lattice's nodes: float64 array, shape (3 n_nodes, 3 n_points)."""
    held = (3 * lattice.surface[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(K.shape[0]), held)
    shapes = np.zeros((K.shape[0], 3 * len(lattice.nodes)))
    shapes[held] = kron(lattice.bilinear, np.eye(3)).toarray()
    if len(free):
        shapes[free] = -splu(K[free][:, free].tocsc()).solve(np.asarray(K[free][:, held] @ shapes[held]))
    return shapes


def _free_modes(K, M, count):
    """Lowest modes of the free block: float64 array, shape (3 n_nodes, count)."""
    # below all frequencies, near the lowest ones; fixed vectors to start and to restart from make the answer one
    shift = -1e-2 * K.diagonal().mean() / M.diagonal().mean()
    start = np.cos(np.arange(K.shape[0]) ** 2 % 97)
    squared, modes = eigsh(K, count + 6, M, sigma=shift, v0=start, rng=0)
    return modes[:, np.argsort(squared)[6:]]
