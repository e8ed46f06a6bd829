"""Samples as a CSV table: a row each, columns the dotted names of the variables."""

import numpy as np
import pandas as pd

from blockshake.errors import InputError
from blockshake.files import write_text
from blockshake.tables.numbers import plain_number
from blockshake.tables.table_file import csv_records


def write_design(path, values):
    """Write a design as CSV: one row a sample, columns the dotted names, every digit, atomically."""
    write_text(path, values.to_csv(index=False, lineterminator="\n"))


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
    rows = csv_records(path)
    if not rows:
        raise InputError(path, "", "expected a header of parameter names and one row a sample")
    values = [
        {name: _finite(cell, path, f"row {number}, {name}") for name, cell in row.items()}
        for number, row in enumerate(rows, start=1)
    ]
    return pd.DataFrame(values, index=pd.RangeIndex(len(rows), name="sample"))


def _finite(cell, path, key):
    value = float(plain_number(cell) or "nan")
    if not np.isfinite(value):
        raise InputError(path, key, f"expected a finite number, not '{cell}'")
    return value
