"""Samples as a CSV table: a row each, columns the dotted names of the variables."""

import numpy as np
import pandas as pd

from blockshake.errors import InputError
from blockshake.files import write_text
from blockshake.tables.numbers import plain_number
from blockshake.tables.table_file import csv_rows


def write_design(path, values):
    """Write a design as CSV: one row a sample, columns the dotted names, every digit, atomically."""
    lines = [",".join(values.columns)]
    lines += [",".join(repr(float(value)) for value in row) for row in values.to_numpy()]
    write_text(path, "\n".join(lines) + "\n")


def load_design(path):
    """Values of a design from CSV.

    Parameters
    ----------
    path : str or path
        One row a sample, columns the dotted names.

    Returns
    -------
    pandas.DataFrame, shape (size, n_variables)
        Index ``sample`` from 0, SI.

    Raises
    ------
    InputError
        Missing file, no rows, a name twice, a row of another length, or an entry that is no finite number.
    """
    rows = csv_rows(path)
    if len(rows) < 2:
        raise InputError(path, "", "expected a header of parameter names and one row a sample")
    names = rows[0]
    for name in names:
        if not name or names.count(name) > 1:
            raise InputError(path, name, "expected every column to have a name of its own")
    values = np.empty((len(rows) - 1, len(names)))
    for sample, row in enumerate(rows[1:]):
        if len(row) != len(names):
            raise InputError(path, f"sample {sample}", f"expected {len(names)} values, not {len(row)}")
        for column, cell in enumerate(row):
            values[sample, column] = _finite(cell, path, f"sample {sample}, {names[column]}")
    return pd.DataFrame(values, columns=names, index=pd.RangeIndex(len(values), name="sample"))


def _finite(cell, path, key):
    value = float(plain_number(cell) or "nan")
    if not np.isfinite(value):
        raise InputError(path, key, f"expected a finite number, not '{cell}'")
    return value
