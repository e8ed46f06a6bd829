"""Elimination in a band of varying width: the answer, and the bits of plain elimination."""

import numpy as np
import pytest

from blockshake.solvers.nscd_deformable.solve.band_elimination import factor_into, solve_into

# widths of blocks that each couple with the next one; of even and odd sums, within a panel of 8 and beyond
BANDS = [(3,), (5, 4), (8, 8), (6, 9, 12), (21, 3, 18, 7)]


def _system(widths):
    """A matrix of coupled blocks, (n, n), and ``last`` of `factor_into`; some couplings are zero."""
    ends = np.cumsum(widths)
    block = np.repeat(np.arange(len(widths)), widths)
    coupled = np.abs(block[:, None] - block) <= 1
    generator = np.random.default_rng(sum(widths))
    A = np.where(coupled, generator.normal(size=coupled.shape), 0.0)
    A[::3, ::2] = 0.0
    A += 4.0 * len(A) ** 0.5 * np.eye(len(A))
    return A, ends[np.minimum(block + 1, len(widths) - 1)] - 1


def _plainly_factored(A):
    A = A.copy()
    for k in range(len(A)):
        for i in range(k + 1, len(A)):
            A[i, k] = A[i, k] / A[k, k]
            for j in range(k + 1, len(A)):
                A[i, j] = A[i, j] - A[i, k] * A[k, j]
    return A


@pytest.mark.parametrize("widths", BANDS)
def test_factors_are_those_of_plain_elimination_and_solve(widths):
    A, last = _system(widths)
    factors, x = A.copy(), np.arange(1.0, len(A) + 1.0)
    assert factor_into(factors, last)
    np.testing.assert_array_equal(factors, _plainly_factored(A))
    solve_into(factors, last, x)
    np.testing.assert_allclose(A @ x, np.arange(1.0, len(A) + 1.0), rtol=1e-10)


@pytest.mark.parametrize("row", [0, 12])
def test_a_pivot_of_zero_is_told(row):
    A, last = _system((6, 9, 12))
    A[row] = 0.0
    assert not factor_into(A, last)
