"""A ground motion from a table of a user: any columns, units and decimal sign."""

from pathlib import Path

import numpy as np

from blockshake.dynamics.baseline import AUTO, settle
from blockshake.dynamics.motion import CHANNELS, check_finite, ground_motion
from blockshake.errors import InputError
from blockshake.tables.table_file import read_table
from blockshake.tables.units import kind_of_unit, unit_size


def load_motion_table(source, layout, time, columns, unit, time_unit="s", baseline=AUTO):
    """`GroundMotion` from columns of a text file or a workbook.

    Parameters
    ----------
    source : str or path
        A file; of a workbook with several sheets ``FILE#SHEET``.
    layout : TableLayout
    time : str
        Name of the column of times.
    columns : dict of str to str
        By channel (``x``, ``y``, ``z``) the name of a column.
    unit : str
        Of the columns; tells acceleration, velocity and displacement apart.
    time_unit : str
    baseline : str or float
        As of `settle`: a table is corrected with a corner frequency alone.

    Raises
    ------
    InputError
        A missing column, an unknown unit or channel, a cell that is no number, times that do not increase; a correction
        of other than evenly spaced accelerations.
    """
    kind = kind_of_unit(unit, ("acceleration", "velocity", "displacement"), "--unit", unit)
    table = read_table(source, layout)
    at = table.column(time, unit_size("time", time_unit, "--time-unit", time_unit))
    read = {}
    for channel, name in columns.items():
        if channel not in CHANNELS[:3]:
            raise InputError("--column", channel, f"expected {', '.join(CHANNELS[:3])}")
        read[channel] = table.column(name, unit_size(kind, unit, "--unit", unit))
    for name, values in ((time, at), *((columns[channel], values) for channel, values in read.items())):
        if not np.isfinite(values).all():
            line = table.lines[int(np.argmin(np.isfinite(values)))]
            raise InputError(table.source, f"line {line}, {name}", "expected a finite number")
    back = np.flatnonzero(np.diff(at) <= 0.0)
    if len(at) < 2 or len(back):
        line = table.lines[back[0] + 1] if len(back) else table.lines[0]
        raise InputError(table.source, f"line {line}, {time}", "expected times that increase from row to row")
    attributes = {"source": Path(source).name, "format": "table", "synthetic": False}
    if at[0] != 0.0:
        attributes["first_time"] = float(at[0])
    with np.errstate(over="ignore", invalid="ignore"):  # looked at below
        motion = ground_motion(Path(source).stem, at - at[0], read, kind, attributes)
    check_finite(motion, table.source)
    return settle(motion, baseline, table.source)
