"""Stiffness and mass of one rectangular hexahedron of eight nodes, for unit Young's modulus and density."""

import numpy as np

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


def corner_gradients(place, size):
    """Gradients of the eight trilinear shape functions at a place in [-1, 1]^3: float64 array, shape (8, 3) [1/m]."""
    factors = 0.5 * (1.0 + CORNERS * place)
    return np.stack(
        [
            CORNERS[:, axis] / size[axis] * factors[:, (axis + 1) % 3] * factors[:, (axis + 2) % 3]
            for axis in range(3)
        ],
        axis=1,
    )


def brick_matrices(size, poisson_ratio):
    """Stiffness and consistent mass of one brick.

    Parameters
    ----------
    size : float64 array, shape (3,)
        Edge lengths [m].
    poisson_ratio : float

    Returns
    -------
    stiffness : float64 array, shape (24, 24)
        For a Young's modulus of 1 [m].
    mass : float64 array, shape (24, 24)
        For a density of 1 [m3].

    Notes
    -----
    Trilinear displacements with the nine incompatible modes ``1 - xi^2`` of Wilson et al. (1973) and Taylor et al.
    (1976), condensed: without them a brick locks in bending, and a beam one brick deep would be twice too stiff. On
    rectangular bricks they pass the patch test as they stand. Gauss's rule of 2 x 2 x 2 points is exact for both.
    """
    size = np.asarray(size, dtype=float)
    C, weight = elasticity_matrix(poisson_ratio), size.prod() / 8.0
    K, M = np.zeros((33, 33)), np.zeros((8, 8))
    for place in _GAUSS * CORNERS:
        bubbles = np.diag(-4.0 * place / size)
        B = strain_matrix(np.vstack([corner_gradients(place, size), bubbles]))
        K += weight * B.T @ C @ B
        N = (0.5 * (1.0 + CORNERS * place)).prod(axis=1)
        M += weight * np.outer(N, N)
    condensed = K[:24, :24] - K[:24, 24:] @ np.linalg.solve(K[24:, 24:], K[24:, :24])
    return 0.5 * (condensed + condensed.T), np.kron(M, np.eye(3))
