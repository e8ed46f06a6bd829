"""Linear systems with a band of varying width, eliminated without exchange of rows."""

from blockshake.jit import kernel_without_allocation

_PANEL = 8  # pivots eliminated at a time; `_eliminate_below_into` names each


@kernel_without_allocation
def factor_into(A, last):
    """Replace a matrix ``A`` (n, n) by its two triangular factors; False where a pivot is zero.

    The multipliers stand below the diagonal, the upper factor on and above it. ``last`` int64 (n,): last row and column
    that is not zero beyond the diagonal of each, not decreasing.

    Notes
    -----
    Pivots are taken in panels, so that the rows below are read once a panel. Each entry is changed in the order of the
    pivots, as without panels: to the same bits.
    """
    n = A.shape[0]
    for first in range(0, n, _PANEL):
        after = min(first + _PANEL, n)
        end = last[after - 1] + 1
        for k in range(first, after):
            pivot = A[k, k]
            if not abs(pivot) > 0.0:
                return False
            for i in range(k + 1, end):
                factor = A[i, k] / pivot
                A[i, k] = factor
                row, above = A[i], A[k]
                for j in range(k + 1, end if i < after else after):
                    row[j] -= factor * above[j]
        if after < end:
            _eliminate_below_into(A, first, end)
    return True


@kernel_without_allocation
def _eliminate_below_into(A, first, end):
    """Take a panel's pivots, from ``first`` on, out of the columns behind them in the rows below them."""
    after = first + _PANEL
    a0, a1 = A[first, after:end], A[first + 1, after:end]
    a2, a3 = A[first + 2, after:end], A[first + 3, after:end]
    a4, a5 = A[first + 4, after:end], A[first + 5, after:end]
    a6, a7 = A[first + 6, after:end], A[first + 7, after:end]
    for i in range(after, end):
        f0, f1, f2, f3 = A[i, first], A[i, first + 1], A[i, first + 2], A[i, first + 3]
        f4, f5, f6, f7 = A[i, first + 4], A[i, first + 5], A[i, first + 6], A[i, first + 7]
        row = A[i, after:end]
        for j in range(row.size):
            row[j] = (
                row[j] - f0 * a0[j] - f1 * a1[j] - f2 * a2[j] - f3 * a3[j]
                - f4 * a4[j] - f5 * a5[j] - f6 * a6[j] - f7 * a7[j]
            )  # fmt: skip


@kernel_without_allocation
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
