"""Target correlation matrices: reading, checking, and the nearest valid one to an invalid one."""

import numpy as np
import pandas as pd

from blockshake.errors import InputError
from blockshake.tables.numbers import plain_number
from blockshake.tables.table_file import csv_rows

_ROUNDING = 1e-6  # of entries typed with six digits
_SMALLEST_EIGENVALUE = 1e-6  # below it Cholesky's factor is noise
_SAFE_EIGENVALUE = 1e-3  # of the matrix suggested, so that it stays valid when typed with four digits
_MOST_WORDS = 10


def load_correlation(path):
    """Target correlation of some or all variables from a square CSV.

    Parameters
    ----------
    path : str or path
        Names in the header (its first cell is free) and in the first column, in the same order.
        Variables that it does not name stay uncorrelated with all others.

    Returns
    -------
    pandas.DataFrame
        Square, float64, names as index and columns; ``attrs["source"]`` is the path.

    Raises
    ------
    InputError
        Missing file, not square, names that differ, an entry that is no number, or no correlation
        matrix (see `check_correlation`).
    """
    rows = csv_rows(path)
    if len(rows) < 2:
        raise InputError(path, "", "expected a square table with names in the header and in the first column")
    names = rows[0][1:]
    for name in names:
        if names.count(name) > 1:
            raise InputError(path, name, "expected every name once in the header")
    if [row[0] for row in rows[1:]] != names:
        raise InputError(
            path, "", f"expected the names of the header down the first column: {', '.join(names)}"
        )
    values = np.empty((len(names), len(names)))
    for i, row in enumerate(rows[1:]):
        if len(row) != len(names) + 1:
            raise InputError(path, names[i], f"expected {len(names)} numbers in its row, not {len(row) - 1}")
        for j, cell in enumerate(row[1:]):
            if (number := plain_number(cell)) is None:
                raise InputError(path, f"{names[i]}, {names[j]}", f"expected a number, not '{cell}'")
            values[i, j] = float(number)
    check_correlation(values, names, path)
    frame = pd.DataFrame(values, index=names, columns=names)
    frame.attrs["source"] = str(path)
    return frame


def check_correlation(matrix, names, where):
    """Refuse what is no positive definite correlation matrix.

    Parameters
    ----------
    matrix : float64 array, shape (n, n)
    names : sequence of str, length n
        Names of the variables, for the error.
    where : str
        File or option to name in the error.

    Raises
    ------
    InputError
        Entries that are not finite or beyond 1, a diagonal other than 1, not symmetric, or not
        positive definite: the line then gives the entries of the nearest valid matrix.
    """
    if not np.isfinite(matrix).all() or np.abs(matrix).max() > 1.0 + _ROUNDING:
        i, j = np.argwhere(~(np.abs(matrix) <= 1.0 + _ROUNDING))[0]
        raise InputError(
            where, f"{names[i]}, {names[j]}", f"expected a correlation in [-1, 1], not {matrix[i, j]:g}"
        )
    for i, name in enumerate(names):
        if abs(matrix[i, i] - 1.0) > _ROUNDING:
            raise InputError(where, f"{name}, {name}", f"expected 1 on the diagonal, not {matrix[i, i]:g}")
        for j in np.flatnonzero(np.abs(matrix[i, :i] - matrix[:i, i]) > _ROUNDING):
            wrong = f"expected a symmetric matrix; {matrix[i, j]:g} is {matrix[j, i]:g} across the diagonal"
            raise InputError(where, f"{name}, {names[j]}", wrong)
    smallest = np.linalg.eigvalsh(matrix)[0]
    if smallest < _SMALLEST_EIGENVALUE:
        raise InputError(
            where,
            "",
            f"expected a positive definite matrix; its smallest eigenvalue is {smallest:.3g}. The nearest "
            f"valid one has {_differences(matrix, nearest_correlation(matrix), names)}",
        )


def _differences(matrix, nearest, names):
    """Entries of the nearest matrix that differ in the fourth digit, largest change first."""
    pairs = [(i, j) for i in range(len(names)) for j in range(i) if abs(nearest[i, j] - matrix[i, j]) > 5e-5]
    pairs.sort(key=lambda pair: -abs(nearest[pair] - matrix[pair]))
    words = [f"{names[j]}, {names[i]}: {nearest[i, j]:.4f}" for i, j in pairs[:_MOST_WORDS]]
    if len(pairs) > _MOST_WORDS:
        rest = max(abs(nearest[pair] - matrix[pair]) for pair in pairs[_MOST_WORDS:])
        words.append(f"and {len(pairs) - _MOST_WORDS} more entries changed by at most {rest:.4f}")
    return "; ".join(words)


def nearest_correlation(matrix):
    """Nearest correlation matrix in the Frobenius norm whose eigenvalues are at least 0.001.

    Parameters
    ----------
    matrix : float64 array, shape (n, n)
        Symmetric.

    Returns
    -------
    float64 array, shape (n, n)
        Symmetric, unit diagonal, positive definite.

    Notes
    -----
    Alternating projections with Dykstra's correction, Higham (2002), Algorithm 3.3, onto the matrices with eigenvalues
    of at least 0.001 instead of 0, so that the answer stays valid when rounded to four digits.
    """
    unit = (matrix + matrix.T) / 2.0
    correction = np.zeros_like(unit)
    for _ in range(10_000):
        shifted = unit - correction
        raised = _raise_eigenvalues(shifted)
        correction = raised - shifted
        last, unit = unit, raised.copy()
        np.fill_diagonal(unit, 1.0)
        if np.abs(unit - last).max() < 1e-10:
            break
    valid = _raise_eigenvalues(unit)
    scale = np.sqrt(np.diag(valid))
    valid = valid / scale[:, None] / scale
    np.fill_diagonal(valid, 1.0)
    return valid


def _raise_eigenvalues(matrix):
    values, vectors = np.linalg.eigh(matrix)
    raised = (vectors * np.maximum(values, _SAFE_EIGENVALUE)) @ vectors.T
    return (raised + raised.T) / 2.0
