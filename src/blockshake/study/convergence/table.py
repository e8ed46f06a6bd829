"""The table of a convergence study: its columns, what is observed, its CSV form."""

import io

import pandas as pd

from blockshake.errors import InputError
from blockshake.files import read_text, write_text

EXACT = 0.0  # setting of the grid's spacing that stands for the exact distance
OBSERVABLES = {
    "sink": "m",
    "swing_time": "s",
    "impact_ratio": "1",
    "peak_drift": "m",
    "peak_rotation": "rad",
    "upright_time": "s",
    "end_drift": "m",
    "energy_residual": "1",
}
"""Observables of the runs with their units; `rocking_block` and `shaken_stack` define it."""
_TYPES = {
    "parameter": str,
    "setting": float,
    "usual": bool,
    "observable": str,
    "unit": str,
    "value": float,
    "difference": float,
    "floor": float,
}
COLUMNS = tuple(_TYPES)


def write_convergence(path, table):
    """Write the table of `study_convergence` as CSV, every digit, atomically."""
    text = table.to_csv(index=False, float_format="%.17g", lineterminator="\n", na_rep="nan")
    write_text(path, text)


def load_convergence(path):
    """The table of `study_convergence` from CSV.

    Raises
    ------
    InputError
        Missing file, other columns, or no numbers in them.
    """
    try:
        table = pd.read_csv(io.StringIO(read_text(path)), dtype=_TYPES)
    except ValueError as error:
        raise InputError(path, "", f"expected a CSV table; {' '.join(str(error).split())}") from None
    if tuple(table.columns) != COLUMNS:
        raise InputError(path, "", f"expected the columns {', '.join(COLUMNS)}")
    return table
