"""Spreadsheets of a laboratory to a campaign's folder, whole or not at all."""

import contextlib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.records.times import check_increase
from blockshake.errors import Argument, InputError
from blockshake.files import AnyPath, history, replacing_folder, write_dataset, write_text
from blockshake.geometry.schema import AXES
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Campaign, load_campaign
from blockshake.measurement.campaigns.campaign_folder import (
    motion_in_folder,
    structure_in_folder,
    write_campaign_file,
)
from blockshake.measurement.campaigns.clocks import missing_rows
from blockshake.measurement.campaigns.faulty_readings import stuck
from blockshake.measurement.campaigns.lost_markers import lost_words
from blockshake.measurement.campaigns.recorded_test import checked_test
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.measurement.motion.pose_columns import ANGLE, QUATERNION, free_body, poses_of_columns
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.transducers import transducer_names
from blockshake.own_files.import_map import ImportMap, load_map
from blockshake.tables.table_file import TableLayout, read_table
from blockshake.tables.units import unit_size
from blockshake.validation import validated

_TURNS = tuple(f"q{part}" for part in QUATERNION)


def import_campaign(source: AnyPath | Mapping[str, Any], output: AnyPath) -> Campaign:
    """Make the folder of a campaign from spreadsheets or CSV files, whole or not at all.

    Parameters
    ----------
    source : str, path or mapping
        Map of the columns, a YAML file with the keys of ``blockshake keys import``, or its content; files that a
        mapping names count from the current folder.
    output : str or path
        Folder of the campaign, not there yet or empty.

    Returns
    -------
    Campaign

    Raises
    ------
    InputError
        A folder with content; faults of the map, of a table, or of the readings. Then nothing is left.

    Examples
    --------
    >>> import blockshake, numpy as np, pandas as pd
    >>> time = np.arange(300) / 100.0
    >>> moved = np.sin(4.0 * time) * (time > 1.0)
    >>> pd.DataFrame({"time_s": time, "table": moved, "LVDT3": 1.1 * moved}).to_csv("test.csv", index=False)
    >>> campaign = blockshake.import_campaign(
    ...     {
    ...         "name": "mine", "structure": "my.yaml", "displacement_unit": "mm", "time": "time_s",
    ...         "columns": {"slab-lvdt.x": "table", "block-1-lvdt.x": "LVDT3"},
    ...         "tests": [{"name": "t1", "file": "test.csv", "motion": "alkion", "scale": 0.1, "role": "fit"}],
    ...     },
    ...     "mine",
    ... )
    >>> campaign.tests["t1"].file
    't1.nc'
    """
    if isinstance(source, Mapping):
        where: str = Argument("source")
        import_map = validated(ImportMap, dict(source), where)
    else:
        import_map, where = load_map(source), str(source)
    make_campaign(import_map, output, where)
    return load_campaign(output)


def make_campaign(import_map, folder, where):
    """Make the folder of a campaign from an `ImportMap`.

    Parameters
    ----------
    import_map : ImportMap
    folder : str or path
        That is not there yet, or empty.
    where : str
        Map that an error names.

    Returns
    -------
    list of str
        What `campaign_lines` states of the campaign.

    Raises
    ------
    InputError
        A folder with content; faults of the map, of a table, or of the readings as `read_test` and `campaign_lines`
        find them. Then nothing is left.
    """
    folder = Path(folder)
    with replacing_folder(folder) as made:
        try:
            _fill(import_map, made, where)
            lines = campaign_lines(made)
        except InputError as error:
            said = type(error.where)(error.where.replace(str(made), str(folder)))
            raise InputError(said, error.key, error.expected) from None
    return [line.replace(str(made), str(folder)) for line in lines]


def _fill(import_map, folder, where):
    """Write all files of the campaign."""
    structure = load_structure(import_map.structure)
    tests, motions = [], {}
    for test in import_map.tests:
        name = re.sub(r"[^\w.-]+", "-", test.name)
        if test.motion is None:
            write_text(folder / f"{name}.csv", _posed_table(test, import_map, structure, where))
            tests.append({**test.model_dump(exclude={"motion", "scale"}), "file": f"{name}.csv"})
            continue
        load_motion(test.motion, test.scale, test.baseline)
        if motions.setdefault(Path(test.motion).name, test.motion) != test.motion:
            key = f"tests.{test.name}.motion"
            raise InputError(where, key, "expected motions in files of different names")
        readings = _read_readings(test, import_map, structure, where)
        with _by_key(import_map, where):
            readings = checked_test(readings, structure, test.file)
        title = f"measured test {test.name}"
        sources = ", ".join(Path(one).name for one in (test.file, test.accelerometers) if one)
        readings.attrs |= {"Conventions": "CF-1.11", "title": title, "source": Path(test.file).name,
                          "history": history(None, f"import-campaign: {sources}")}  # fmt: skip
        write_dataset(folder / f"{name}.nc", readings)
        motion = motion_in_folder(test.motion, folder)
        tests.append({**test.model_dump(), "file": f"{name}.nc", "motion": motion})
    header = (
        f"# imported from {', '.join(dict.fromkeys(Path(test.file).name for test in import_map.tests))}\n"
    )
    inside = structure_in_folder(import_map.structure, structure, folder)
    write_campaign_file(folder, header, import_map.name, inside, import_map.sensors.model_dump(), tests)


@contextlib.contextmanager
def _by_key(import_map, where, key=None):
    """Name the key of the map, ``key`` or what the fault names, of all faults but those of a line or a whole file."""
    try:
        yield
    except InputError as error:
        if error.where == str(where) or not error.key or error.key.startswith("line "):
            raise
        if error.key in TableLayout.model_fields:
            wrong = f"{error.where}: {error.expected}"
            raise InputError(where, f"layout.{error.key}", wrong) from None
        if key is None:
            mapped = [f"columns.{one}" for one in import_map.columns if f"{one}.".startswith(f"{error.key}.")]
            mapped += ["time"] * error.key.startswith("time")
            mapped += ["displacement_unit"] * error.key.endswith("_displacement")
            key = (*mapped, "columns")[0]
        elif not error.key.startswith("column "):
            raise
        raise InputError(where, key, str(error)) from None


def _read_readings(test, import_map, structure, where):
    """Readings of one test, as a campaign's file has them; NaN along directions without a column."""
    channels = [name for name in import_map.columns if name in accelerometer_channels(structure)]
    transducers = [name for name in import_map.columns if name in transducer_names(structure)]
    markers = [name for name in import_map.columns if name not in (*channels, *transducers)]
    if not markers:
        raise InputError(where, "columns", "expected a column of a marker, MARKER.x, or of a pose, BODY.x")
    posed = [key for key in markers if _is_pose(key, structure)]
    markers = [key for key in markers if key not in posed]
    source = test.accelerometers or test.file
    for names in (
        ([*markers, *posed], [*channels, *transducers]) if source != test.file else (import_map.columns,)
    ):
        _check_once(names, import_map, where)
    time, read, lost = _displacements(test.file, markers, import_map, where) if markers else (None, {}, "")
    for body in dict.fromkeys(key.rpartition(".")[0] for key in posed):
        time, filmed = _markers_of_poses(test.file, body, posed, import_map, structure, where)
        for name in filmed.keys() & read.keys():
            wrong = f"expected none; {name} is read from the poses of {body}"
            raise InputError(where, f"columns.{name}.x", wrong)
        read |= filmed
    read = {name: values for name, values in read.items() if np.isfinite(values).any()}
    if not read:
        raise InputError(where, "columns", f"expected readings of a marker in {test.file}; all are missing")
    names, values = list(read), np.stack([*read.values()], axis=1)
    variables = {"marker_displacement": (("time", "marker", "axis"), values, {"units": "m"})}
    coordinates = {"time": ("time", time, {"units": "s"}), "marker": names, "axis": list(AXES)}
    for variable, dimension, sensors, kind, unit in (
        ("accelerometer", "channel", channels, "acceleration", "m s-2"),
        ("transducer_displacement", "transducer", transducers, "displacement", "m"),
    ):
        if not sensors:
            continue
        time_acc, read = _columns_of(source, sensors, import_map, kind, where)
        if kind == "displacement":
            for column, key in zip(read.T, sensors, strict=True):
                column -= _rest(time_acc, column, import_map, where, f"{source}: {key}")
        known = np.isfinite(read).any(axis=0)
        if known.any():
            variables[variable] = (("time_acc", dimension), read[:, known], {"units": unit})
            coordinates["time_acc"] = ("time_acc", time_acc, {"units": "s"})
            coordinates[dimension] = np.array(sensors)[known]
    return xr.Dataset(variables, coordinates, {"lost_markers": lost} if lost else {})


def _displacements(source, keys, import_map, where):
    """Times, displacements (n_times, 3) [m] by marker, from its own columns, and a line on each marker that was lost.

    Displacements are NaN along axes without a column, and where a marker was lost.
    """
    time, readings = _columns_of(source, keys, import_map, "displacement", where)
    zeros, found = _zeros_of_lost(keys, readings), {}
    readings[zeros] = np.nan
    lost = {key.rpartition(".")[0]: rows for key, rows in zip(keys, zeros.T, strict=True) if rows.any()}
    for key, column in zip(keys, readings.T, strict=True):
        name, _, axis = key.rpartition(".")
        if axis not in AXES or not name:
            known = "MARKER.x, MARKER.y, MARKER.z, an accelerometer channel or a displacement transducer"
            raise InputError(where, f"columns.{key}", f"expected {known}")
        values = found.setdefault(name, np.full((len(time), len(AXES)), np.nan))
        values[:, AXES.index(axis)] = column - _rest(time, column, import_map, where, f"{source}: {key}")
    return (
        time,
        found,
        "\n".join(f"{name}: {lost_words(rows, time - time[0])}" for name, rows in lost.items()),
    )


def _zeros_of_lost(keys, readings):
    """Readings (n_times, n_keys), a mask, of markers all of whose coordinates are exactly 0 while they stand elsewhere.

    Exports write a lost marker so. A displacement that begins at 0 is as near to 0 as to its next readings.
    """
    lost, names = np.zeros(readings.shape, dtype=bool), np.array([key.rpartition(".")[0] for key in keys])
    for name in dict.fromkeys(names):
        own = readings[:, names == name]
        zero = (own == 0.0).all(axis=1)
        if own.shape[1] < len(AXES) or zero.all() or not zero.any():
            continue
        known = own[~zero & np.isfinite(own).all(axis=1)]
        nearest, step = (
            np.linalg.norm(known, axis=1).min(),
            np.linalg.norm(np.diff(known, axis=0), axis=1).max(),
        )
        lost[np.ix_(zero, names == name)] = nearest > 3.0 * step
    return lost


def _is_pose(key, structure):
    name, _, part = key.rpartition(".")
    markers = {marker.name for marker in structure.file.markers}
    return name in structure.body_names and name not in markers and part in (*AXES, ANGLE, *_TURNS)


def _markers_of_poses(source, body, posed, import_map, structure, where):
    """Times, and displacements (n_times, 3) [m] of all markers of a body, from its poses."""
    own = [marker for marker in structure.file.markers if marker.body == body]
    if not own:
        raise InputError(where, f"columns.{body}.x", f"expected markers of {body} in the structure")
    keys = [key for key in posed if key.startswith(f"{body}.")]
    time, columns = _pose_columns(source, body, keys, import_map, where)
    with _by_key(import_map, where):
        position, rotation, _ = poses_of_columns(columns, source, body)
    found = {}
    for marker in own:
        place = position + rotation @ np.array(marker.position)
        start = place[np.isfinite(place[:, 0]).argmax()]
        if import_map.rest:
            start = [_rest(time, column, import_map, where, f"{source}: {body}.x") for column in place.T]
        found[marker.name] = place - start
    return time, found


def _pose_columns(source, body, keys, import_map, where):
    """Times, and columns by key of a body's pose, in m and rad."""
    places = [f"{body}.{axis}" for axis in AXES]
    turns = [f"{body}.{ANGLE}", *(f"{body}.{part}" for part in _TURNS)]
    for key in keys:
        if key in turns[1:] and (import_map.columns[key].unit or import_map.rotation_unit != "rad"):
            raise InputError(where, f"columns.{key}", "expected a quaternion's column without unit")
    _check_frame(body, keys, import_map, where)
    columns = {}
    for names, kind in ((places, "displacement"), (turns, "rotation")):
        mapped = [name for name in names if name in keys]
        if not mapped:
            raise InputError(where, "columns", f"expected a column of {body} among {', '.join(names)}")
        time, values = _columns_of(source, mapped, import_map, kind, where)
        columns |= dict(zip(mapped, values.T, strict=True))
    return time, columns


def _check_frame(body, keys, import_map, where):
    """Refuse a map whose places and quaternions do not turn together from the file's frame into x, y, z.

    A map of places is a signed permutation of the file's axes, which the last letters of the columns name. The map is
    a frame where its determinant is 1, and the vector part of a quaternion then has the same map.
    """
    places, turns = ([f"{body}.{part}{axis}" for axis in AXES] for part in ("", "q"))
    if not {*places, *turns, f"{body}.qw"} <= set(keys):
        return
    place, turn = (_signed_axes([import_map.columns[key] for key in names]) for names in (places, turns))
    conjugate = 1 - 2 * import_map.columns[f"{body}.qw"].reversed
    if not place.any() or not turn.any():  # letters that are no axes: signs alone
        place, turn = (
            np.diag([1 - 2 * import_map.columns[key].reversed for key in names]) for names in (places, turns)
        )
        place = (
            conjugate * turn if np.array_equal(place, -conjugate * turn) else place
        )  # an odd exchange of axes, perhaps
    elif np.linalg.det(place) < 0.0:
        wrong = "expected axes that make a right-handed frame; the map mirrors: reverse one of them"
        raise InputError(where, f"columns.{body}.y", wrong)
    differs = np.flatnonzero((place != conjugate * turn).any(axis=1))
    if len(differs):
        axis = AXES[differs[0]]
        wrong = f"expected the axis and the sign of {body}.{axis}: places and rotations turn together"
        raise InputError(where, f"columns.{body}.q{axis}", wrong)


def _signed_axes(columns):
    """Signed permutation (3, 3) by the last letters of three columns; zeros where these are not x, y and z."""
    letters = [column.column.strip()[-1:].lower() for column in columns]
    if sorted(letters) != list(AXES):
        return np.zeros((3, 3))
    signs = [1 - 2 * column.reversed for column in columns]
    return np.diag(signs) @ np.eye(3)[[AXES.index(letter) for letter in letters]]


def _check_once(names, import_map, where):
    """Refuse a column of one table that is mapped twice."""
    taken = {import_map.time.column: "time"}
    for name in names:
        column = import_map.columns[name].column
        other = taken.setdefault(column, name)
        if other != name:
            raise InputError(where, f"columns.{name}", f"expected a column of its own; '{column}' is {other}")


def _columns_of(source, names, import_map, kind, where):
    """Times (n_times,) and readings (n_times, n_names) of a table, in SI."""
    with _by_key(import_map, where, "time"):
        table = read_table(source, import_map.layout)
        time = _clock(table, import_map, where)
    columns = []
    for name in names:
        column = import_map.columns[name]
        unit, key = column.unit or getattr(import_map, f"{kind}_unit"), f"columns.{name}"
        if unit is None:
            raise InputError(where, f"{kind}_unit", f"missing key; {name} needs it")
        size = unit_size(kind, unit, where, f"{key}.unit" if column.unit else f"{kind}_unit")
        with _by_key(import_map, where, key):
            read = table.column(column.column, -size if column.reversed else size, kind)
        if np.isnan(read).all() and len(import_map.tests) == 1:
            wrong = f"expected readings in '{column.column}' of {table.source}; all are missing"
            raise InputError(where, key, wrong)
        columns.append(read + 0.0)  # no minus zero
    return time, np.column_stack(columns)


def _clock(table, import_map, where):
    """Times that increase [s]."""
    name = import_map.time.column
    time = table.times(name, unit_size("time", import_map.time.unit or "s", where, "time.unit"))
    if np.isnan(time).any():
        raise table.fault(table.lines[int(np.argmax(np.isnan(time)))], name, "expected a time")
    check_increase(time, table.lines, table.source, name)
    missing = missing_rows(time) if len(time) > 1 else np.zeros(0)
    if missing.any() and not import_map.fill_gaps:
        row, steps = int(np.argmax(missing > 0)), np.diff(time)
        raise InputError(
            where, "fill_gaps",
            f"{table.source}: line {table.lines[row + 1]}, {name}: expected an even clock; {steps[row]:.4g} s after "
            f"{time[row]:.13g} s lie between two rows {np.median(steps):.4g} s apart elsewhere, "
            f"{np.count_nonzero(missing)} such gaps in all: fill_gaps makes them gaps of the readings",
        )  # fmt: skip
    return time


def _rest(time, column, import_map, where, name):
    """Mean reading of the quiet start; zero of a column without readings, which the check of a test finds so."""
    if import_map.rest == 0.0 or np.isnan(column).all() or stuck(column):
        return 0.0
    resting = column[(time <= time[0] + import_map.rest) & np.isfinite(column)]
    if not len(resting):
        raise InputError(
            where, "rest", f"{name}: expected a reading in the first {import_map.rest:g} s of rest"
        )
    return resting.mean()


def _posed_table(test, import_map, structure, where):
    """Text of a CSV table with ``time_s`` and the columns of the free body; see `read_poses`."""
    body = structure.body_names[free_body(structure)[0]]
    known = [f"{body}.{part}" for part in (*AXES, ANGLE, *_TURNS)]
    for key in import_map.columns:
        if key not in known:
            raise InputError(where, f"columns.{key}", f"expected one of {', '.join(known)}")
    _check_once(import_map.columns, import_map, where)
    time, columns = _pose_columns(test.file, body, list(import_map.columns), import_map, where)
    return pd.DataFrame({"time_s": time, **columns}).to_csv(index=False)
