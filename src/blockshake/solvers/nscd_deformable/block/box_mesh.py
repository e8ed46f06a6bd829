"""A box cut into equal bricks, its matrices and its rigid motions."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix

from blockshake.solvers.nscd_deformable.block.brick import brick_matrices


@dataclass(frozen=True)
class BoxMesh:
    """Regular mesh of a box about its centre.

    Attributes
    ----------
    counts : tuple of 3 int
        Bricks along x, y, z.
    size : float64 array, shape (3,)
        Edge lengths of the box [m].
    nodes : float64 array, shape (n_nodes, 3)
        x fastest, then y, then z [m]. Displacement ``3 n + axis`` is that of node n.
    """

    counts: tuple
    size: np.ndarray
    nodes: np.ndarray

    def lines(self, axis):
        """Coordinates of the mesh's planes across an axis [m]."""
        return self.size[axis] * (np.arange(self.counts[axis] + 1) / self.counts[axis] - 0.5)

    def node(self, i, j, k):
        """Index of a node by its place on the three axes."""
        nx, ny, _ = self.counts
        return i + (nx + 1) * (j + (ny + 1) * k)

    def bricks(self):
        """Nodes of the bricks, in the order of `CORNERS`: int64 array, shape (n_bricks, 8)."""
        nx, ny, nz = self.counts
        k, j, i = (part.ravel() for part in np.mgrid[:nz, :ny, :nx])
        corners = [self.node(i + x, j + y, k + z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        return np.stack(corners, axis=1)


def box_mesh(size, mesh_size):
    """Mesh of a box with bricks of about ``mesh_size`` [m], at least one along each edge."""
    size = np.asarray(size, dtype=float)
    counts = tuple(max(1, round(float(edge) / mesh_size)) for edge in size)
    axes = [edge * (np.arange(n + 1) / n - 0.5) for edge, n in zip(size, counts, strict=True)]
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    return BoxMesh(counts, size, np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1))


def assemble(mesh, poisson_ratio):
    """Stiffness for a Young's modulus of 1 [m] and mass for a density of 1 [m3]: sparse, shape (3 n_nodes,) * 2."""
    stiffness, mass = brick_matrices(mesh.size / mesh.counts, poisson_ratio)
    dofs = (3 * mesh.bricks()[:, :, None] + np.arange(3)).reshape(-1, 24)
    rows, columns = np.repeat(dofs, 24, axis=1).ravel(), np.tile(dofs, 24).ravel()
    shape = (3 * len(mesh.nodes),) * 2
    return tuple(
        coo_matrix((np.tile(part.ravel(), len(dofs)), (rows, columns)), shape).tocsc()
        for part in (stiffness, mass)
    )


def rigid_motions(mesh):
    """Three translations and three turns about the centre, as displacements: float64 array, shape (3 n_nodes, 6)."""
    x, y, z = mesh.nodes.T
    motions = np.zeros((len(mesh.nodes), 3, 6))
    motions[:, [0, 1, 2], [0, 1, 2]] = 1.0
    motions[:, 1, 3], motions[:, 2, 3] = -z, y
    motions[:, 2, 4], motions[:, 0, 4] = -x, z
    motions[:, 0, 5], motions[:, 1, 5] = -y, x
    return motions.reshape(-1, 6)
