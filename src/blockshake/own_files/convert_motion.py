"""A record, or a table in any columns and units, to the project's CSV."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from blockshake.dynamics.baseline import AUTO
from blockshake.dynamics.load_motion import load_motion, provenance
from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.records.contract_csv import write_motion_csv
from blockshake.dynamics.records.motion_table import load_motion_table
from blockshake.dynamics.records.record import positive_number
from blockshake.errors import Argument, InputError
from blockshake.files import AnyPath, check_output, file_digest, history
from blockshake.tables.table_file import TableLayout
from blockshake.validation import validated


def convert_motion(
    source: AnyPath,
    output: AnyPath,
    baseline: str | float = AUTO,
    columns: Mapping[str, str] | None = None,
    components: Mapping[str, AnyPath] | None = None,
    unit: str | None = None,
    time: str | None = None,
    time_unit: str | None = None,
    step: float | str | None = None,
    layout: Mapping[str, Any] | None = None,
) -> GroundMotion:
    """Write a record, or a table in any columns and units, as the CSV of the project.

    Parameters
    ----------
    source : str or path
        A record as `load_motion` reads it. A table where ``unit`` is given: a text file, or a workbook, one sheet of
        which is ``FILE#SHEET``.
    output : str or path
        CSV to write.
    baseline : str or float
        ``auto``, ``none`` or a corner frequency [Hz], as of `load_motion`. A table is corrected with a frequency alone.
    columns : dict of str to str, optional
        By axis (``x``, ``y``, ``z``) the column of a table, or the channel of a record; a minus before it reverses.
        With ``step``, ``values`` is all values in order.
    components : dict of str to path, optional
        By axis the files of the other components, as of `load_motion`; those of a table have its form.
    unit : str, optional
        Unit of a table's values, such as ``g`` or ``cm/s2``: accelerations, velocities or displacements.
    time, time_unit : str, optional
        Column of a table's times, by default ``time_s``, and their unit, by default s.
    step : float, optional
        Between the rows of a table without times [s]; without ``columns`` all values in order are x.
    layout : dict of str to value, optional
        Layout of a table: ``separator``, ``decimal`` sign, line of the ``header`` and first line of ``data``.

    Returns
    -------
    GroundMotion
        What was written, in SI.

    Raises
    ------
    InputError
        As `load_motion`; of a table a missing unit or column, a cell that is no number, or times that do not increase.

    Examples
    --------
    >>> import blockshake, numpy as np, pandas as pd
    >>> time = np.arange(500)
    >>> pd.DataFrame({"t": time, "a": np.sin(0.02 * time)}).to_csv("logger.csv", sep=";", index=False)
    >>> blockshake.convert_motion(
    ...     "logger.csv", "motion.csv", columns={"x": "a"}, unit="cm/s2", time="t", time_unit="ms"
    ... )
    <GroundMotion logger: 0.499 s, given as acceleration>
    """
    output = check_output(output)
    given = {"unit": unit, "step": step, "time": time, "time_unit": time_unit, **(layout or {})}
    if any(value is not None for value in given.values()):
        motion = _of_table(source, baseline, columns or {}, components, given, layout or {})
    else:
        motion = load_motion(source, baseline=baseline, channels=columns or None, components=components)
    done = f"convert-motion: {provenance(motion.attributes)}"
    if Path(source).is_file():
        done += f"; digest of {motion.attributes['source']}: {file_digest(source)}"
    attributes = motion.attributes | {"history": history(motion.attributes.get("history"), done)}
    motion = replace(motion, attributes=attributes)
    write_motion_csv(motion, output)
    return motion


def _of_table(source, baseline, columns, components, given, layout):
    unit, step, time, time_unit = (given[name] for name in ("unit", "step", "time", "time_unit"))
    if not unit:
        wrong = "expected for a table; the unit and the columns are never guessed"
        raise InputError(Argument("unit"), "", wrong)
    if step is not None and (time or time_unit):
        raise InputError(Argument("step"), "", "expected where there are no times")
    if not columns and step is None:
        raise InputError(Argument("columns"), "", "expected for a table, or a step for values without times")
    step = None if step is None else positive_number(str(step), Argument("step"), step)
    table = validated(TableLayout, layout, Argument("layout"))
    return load_motion_table(
        source, table, time or "time_s", columns, unit, time_unit or "s", baseline, step, components
    )
