"""Free vibration of an elastic box by Rayleigh and Ritz with Legendre polynomials: no mesh, no element."""

import itertools

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh


def ritz_frequencies(size, poisson_ratio, order, count, clamped=False):
    """Lowest angular frequencies of a box of unit Young's modulus and density, free or ``clamped`` at its foot [1/s].

    Demarest (1971), JASA 49, 768, in products of Legendre polynomials; Visscher et al. (1991), JASA 90, 2154.
    ``order``: highest total degree.
    """
    points, weights = legendre.leggauss(order + 3)
    degrees = [d for d in itertools.product(range(order + 1), repeat=3) if sum(d) <= order]
    values = np.array([legendre.legval(points, np.eye(order + 1)[n]) for n in range(order + 1)])
    slopes = np.array(
        [legendre.legval(points, legendre.legder(np.eye(order + 1)[n])) for n in range(order + 1)]
    )
    by_axis = [(values, slopes)] * 3
    if clamped:
        by_axis[2] = ((1.0 + points) * values, values + (1.0 + points) * slopes)
    # integrals over [-1, 1] of products of polynomials (0) and derivatives (1)
    one = {
        (axis, p, q): np.einsum("ik,jk,k->ij", by_axis[axis][p], by_axis[axis][q], weights)
        for axis in range(3)
        for p in (0, 1)
        for q in (0, 1)
    }
    d = np.array(degrees)
    half = np.asarray(size) / 2.0

    def integral(first, second):
        """Integral of the derivatives along axes ``first`` and ``second`` (None: no derivative)."""
        product = np.full((len(d), len(d)), half.prod())
        for axis in range(3):
            p, q = int(first == axis), int(second == axis)
            product = product * one[axis, p, q][np.ix_(d[:, axis], d[:, axis])] / half[axis] ** (p + q)
        return product

    nu = poisson_ratio
    lame, shear = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu)
    n = len(d)
    K, M = np.zeros((3 * n, 3 * n)), np.kron(np.eye(3), integral(None, None))
    for i in range(3):
        for j in range(3):
            block = lame * integral(i, j) + shear * integral(j, i)
            if i == j:
                block = block + shear * sum(integral(axis, axis) for axis in range(3))
            K[i * n : (i + 1) * n, j * n : (j + 1) * n] = block
    first = 0 if clamped else 6
    squared = eigh(0.5 * (K + K.T), M, eigvals_only=True, subset_by_index=[first, first + count - 1])
    return np.sqrt(squared)
