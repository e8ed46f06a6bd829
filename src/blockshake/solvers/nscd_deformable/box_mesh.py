"""A box cut into equal bricks of eight nodes, its matrices and its rigid motions."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix

# Corners in the order of the mesh's nodes: x fastest, then y, then z
CORNERS = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
_GAUSS = 1.0 / np.sqrt(3.0)


def elasticity_matrix(poisson_ratio):
    """Isotropic stress per engineering strain for a Young's modulus of 1: float64 array, shape (6, 6).

    Order: xx, yy, zz, xy, yz, zx.
    """
    nu = poisson_ratio
    first, shear = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu)
    matrix = np.diag([2.0 * shear] * 3 + [shear] * 3)
    matrix[:3, :3] += first
    return matrix


def strain_matrix(gradients):
    """Engineering strains per nodal displacement: float64 array, shape (6, 3 n).

    ``gradients`` (n, 3): of the shape functions [1/m].
    """
    n = len(gradients)
    strain = np.zeros((6, 3 * n))
    x, y, z = gradients.T
    strain[0, 0::3], strain[1, 1::3], strain[2, 2::3] = x, y, z
    strain[3, 0::3], strain[3, 1::3] = y, x
    strain[4, 1::3], strain[4, 2::3] = z, y
    strain[5, 0::3], strain[5, 2::3] = z, x
    return strain


def corner_gradients(point, size):
    """Gradients of the eight trilinear shape functions at a place in [-1, 1]^3: float64 array, shape (8, 3) [1/m]."""
    factors = 0.5 * (1.0 + CORNERS * point)
    return np.stack(
        [
            CORNERS[:, axis] / size[axis] * factors[:, (axis + 1) % 3] * factors[:, (axis + 2) % 3]
            for axis in range(3)
        ],
        axis=1,
    )


def brick_matrices(size, poisson_ratio):
    """Stiffness for a Young's modulus of 1 [m] and consistent mass for a density of 1 [m3] of one brick, (24, 24) each.

    ``size`` (3,): edge lengths [m].

    Notes
    -----
    Trilinear displacements with the nine incompatible modes ``1 - xi^2`` of Wilson et al. (1973) and Taylor et al.
    (1976), condensed: without them a brick locks in bending, and a beam one brick deep would be twice too stiff. On
    rectangular bricks they pass the patch test as they stand. Gauss's rule of 2 x 2 x 2 points is exact for both.
    """
    size = np.asarray(size, dtype=float)
    C, weight = elasticity_matrix(poisson_ratio), size.prod() / 8.0
    K, M = np.zeros((33, 33)), np.zeros((8, 8))
    for point in _GAUSS * CORNERS:
        bubbles = np.diag(-4.0 * point / size)
        B = strain_matrix(np.vstack([corner_gradients(point, size), bubbles]))
        K += weight * B.T @ C @ B
        N = (0.5 * (1.0 + CORNERS * point)).prod(axis=1)
        M += weight * np.outer(N, N)
    condensed = K[:24, :24] - K[:24, 24:] @ np.linalg.solve(K[24:, 24:], K[24:, :24])
    return 0.5 * (condensed + condensed.T), np.kron(M, np.eye(3))


@dataclass(frozen=True)
class BoxMesh:
    """Regular mesh of a box about its centre."""

    counts: tuple  # of 3 int; bricks along x, y, z
    size: np.ndarray  # float64 (3,); edge lengths of the box [m]
    # float64 (n_nodes, 3); x fastest, then y, then z [m]. Displacement ``3 n + axis`` is that of node n
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
