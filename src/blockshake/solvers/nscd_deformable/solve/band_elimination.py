"""Linear systems with a band of varying width, eliminated without exchange of rows."""

from blockshake.jit import kernel


@kernel
def factor_into(A, last):
    """Replace a matrix by its two triangular factors; False where a pivot is zero.

    Parameters
    ----------
    A : float64 array, shape (n, n)
        Overwritten: multipliers below the diagonal, the upper factor on and above it.
    last : int64 array, shape (n,)
        Last row and column that is not zero beyond the diagonal of each, not decreasing.
    """
    for k in range(A.shape[0]):
        pivot = A[k, k]
        if not abs(pivot) > 0.0:
            return False
        end = last[k] + 1
        for i in range(k + 1, end):
            factor = A[i, k] / pivot
            A[i, k] = factor
            if factor != 0.0:
                row, above = A[i, k + 1 : end], A[k, k + 1 : end]
                for j in range(row.size):
                    row[j] -= factor * above[j]
    return True


@kernel
def solve_into(A, last, x):
    """Replace the right side ``x`` by the answer; arguments as in `factor_into`, after it."""
    n = A.shape[0]
    for k in range(n):
        value = x[k]
        if value != 0.0:
            for i in range(k + 1, last[k] + 1):
                x[i] -= A[i, k] * value
    for k in range(n - 1, -1, -1):
        value = x[k]
        for j in range(k + 1, last[k] + 1):
            value -= A[k, j] * x[j]
        x[k] = value / A[k, k]
