"""Linear systems with a band of varying width, eliminated without exchange of rows."""

from blockshake.jit import kernel_without_aliasing, kernel_without_allocation

_PANEL = 8  # pivots eliminated at a time; `_multipliers_into` and `_take_into` name each


@kernel_without_allocation
def factor_into(A, last):
    """Replace a matrix ``A`` (n, n) by its two triangular factors; False where a pivot is zero.

    The multipliers stand below the diagonal, the upper factor on and above it. ``last`` int64 (n,): last row and column
    that is not zero beyond the diagonal of each, not decreasing.

    Notes
    -----
    Pivots are taken in panels, so that the rows below are read once a panel, two at a time. Each entry is changed in
    the order of the pivots, as without panels: to the same bits.
    """
    n = A.shape[0]
    for first in range(0, n, _PANEL):
        after = min(first + _PANEL, n)
        end = last[after - 1] + 1
        for k in range(first, after):
            if not abs(A[k, k]) > 0.0:
                return False
            for i in range(k + 1, after):
                factor = A[i, k] / A[k, k]
                A[i, k] = factor
                row, above = A[i, k + 1 : end], A[k, k + 1 : end]
                for j in range(row.size):
                    row[j] -= factor * above[j]
        if after < end:
            _eliminate_below_into(A, first, end)
    return True


@kernel_without_allocation
def _eliminate_below_into(A, first, end):
    """Take a whole panel's pivots, from ``first`` on, out of the rows below it, two at a time; a last one by itself."""
    after = first + _PANEL
    panel = A[first:after, first:after]
    u0, u1 = A[first, after:end], A[first + 1, after:end]
    u2, u3 = A[first + 2, after:end], A[first + 3, after:end]
    u4, u5 = A[first + 4, after:end], A[first + 5, after:end]
    u6, u7 = A[first + 6, after:end], A[first + 7, after:end]
    for i in range(after, end, 2):
        other = min(i + 1, end - 1)
        some = _multipliers_into(panel, A[i, first:after])
        if other > i:
            some |= _multipliers_into(panel, A[other, first:after])
        if some:
            f, x = A[i, first:after], A[i, after:end]
            if other > i:
                g, y = A[other, first:after], A[other, after:end]
                _take_into(f, g, u0, u1, u2, u3, u4, u5, u6, u7, x, y)
            else:
                _take_one_into(f, u0, u1, u2, u3, u4, u5, u6, u7, x)


@kernel_without_allocation
def _multipliers_into(U, row):
    """Replace a row's entries in the columns of a panel by its multipliers; whether any is not zero.

    ``U`` (_PANEL, _PANEL): the panel's own rows, whose upper triangle counts; ``row`` (_PANEL,).
    """
    a = row[0] / U[0, 0]
    b = (row[1] - a * U[0, 1]) / U[1, 1]
    c = (row[2] - a * U[0, 2] - b * U[1, 2]) / U[2, 2]
    d = (row[3] - a * U[0, 3] - b * U[1, 3] - c * U[2, 3]) / U[3, 3]
    e = (row[4] - a * U[0, 4] - b * U[1, 4] - c * U[2, 4] - d * U[3, 4]) / U[4, 4]
    f = (row[5] - a * U[0, 5] - b * U[1, 5] - c * U[2, 5] - d * U[3, 5] - e * U[4, 5]) / U[5, 5]
    g = row[6] - a * U[0, 6] - b * U[1, 6] - c * U[2, 6] - d * U[3, 6] - e * U[4, 6] - f * U[5, 6]
    g = g / U[6, 6]
    h = row[7] - a * U[0, 7] - b * U[1, 7] - c * U[2, 7] - d * U[3, 7] - e * U[4, 7] - f * U[5, 7]
    h = (h - g * U[6, 7]) / U[7, 7]
    row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7] = a, b, c, d, e, f, g, h
    return (
        (a != 0.0) | (b != 0.0) | (c != 0.0) | (d != 0.0) | (e != 0.0) | (f != 0.0) | (g != 0.0) | (h != 0.0)
    )


@kernel_without_aliasing
def _take_into(f, g, u0, u1, u2, u3, u4, u5, u6, u7, x, y):
    """Take a panel's rows times the multipliers ``f`` and ``g`` (_PANEL,) out of two rows, ``x`` and ``y``."""
    f0, f1, f2, f3, f4, f5, f6, f7 = f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7]
    g0, g1, g2, g3, g4, g5, g6, g7 = g[0], g[1], g[2], g[3], g[4], g[5], g[6], g[7]
    for j in range(x.size):
        a, b, c, d, p, q, r, s = u0[j], u1[j], u2[j], u3[j], u4[j], u5[j], u6[j], u7[j]
        x[j] = x[j] - f0 * a - f1 * b - f2 * c - f3 * d - f4 * p - f5 * q - f6 * r - f7 * s
        y[j] = y[j] - g0 * a - g1 * b - g2 * c - g3 * d - g4 * p - g5 * q - g6 * r - g7 * s


@kernel_without_aliasing
def _take_one_into(f, u0, u1, u2, u3, u4, u5, u6, u7, x):
    f0, f1, f2, f3, f4, f5, f6, f7 = f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7]
    for j in range(x.size):
        x[j] = (
            x[j] - f0 * u0[j] - f1 * u1[j] - f2 * u2[j] - f3 * u3[j]
            - f4 * u4[j] - f5 * u5[j] - f6 * u6[j] - f7 * u7[j]
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
