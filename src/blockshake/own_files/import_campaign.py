"""Spreadsheets of a laboratory to a campaign's folder, whole or not at all."""

import contextlib
import re
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
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
from blockshake.measurement.campaigns.faulty_readings import dropouts, dropped_words
from blockshake.measurement.campaigns.lost_markers import lost_words
from blockshake.measurement.campaigns.recorded_test import FIRST_READINGS, ClockApartError, checked_test
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.measurement.checks.places import place_remarks
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.markers import marker_position, mean_read, on_driven
from blockshake.measurement.sensors.transducers import transducer_names
from blockshake.own_files.import_columns import (
    at_times,
    by_key,
    check_once,
    columns_of,
    recorder_map,
    rest_of,
)
from blockshake.own_files.import_map import ImportMap, load_map
from blockshake.own_files.import_poses import check_poses, filmed_body, is_pose, markers_of_poses, posed_table
from blockshake.validation import validated


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
            remarks = _fill(import_map, made, where)
            lines = campaign_lines(made)
        except InputError as error:
            said = type(error.where)(error.where.replace(str(made), str(folder)))
            raise InputError(said, error.key, error.expected) from None
    lines = [line.replace(str(made), str(folder)) for line in lines]
    if remarks:
        heads = {"no inconsistency found": "remarks:"}
        lines = [heads.get(line, line) for line in lines] + remarks
    return lines


def _fill(import_map, folder, where):
    """Write all files of the campaign; remarks on what they do not hold."""
    structure = load_structure(import_map.structure)
    tests, motions, remarks = [], {}, []
    for test in import_map.tests:
        name = re.sub(r"[^\w.-]+", "-", test.name)
        if test.motion is None:
            write_text(folder / f"{name}.csv", posed_table(test, import_map, structure, where))
            tests.append({**test.model_dump(exclude={"motion", "scale"}), "file": f"{name}.csv"})
            continue
        load_motion(test.motion, test.scale, test.baseline)
        if motions.setdefault(Path(test.motion).name, test.motion) != test.motion:
            key = f"tests.{test.name}.motion"
            raise InputError(where, key, "expected motions in files of different names")
        readings, more = _read_readings(test, import_map, structure, where)
        remarks += [f"  {test.name}: {remark}" for remark in more]
        with by_key(import_map, where), _offset_named(test, where):
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
    return remarks


@contextlib.contextmanager
def _offset_named(test, where):
    """Name the key that puts the file accelerometers on the clock of the others, of a test that has one."""
    try:
        yield
    except ClockApartError as error:
        if test.accelerometers is None:
            raise
        raise InputError(where, f"tests.{test.name}.accelerometers_offset", str(error)) from None


def _read_readings(test, import_map, structure, where):
    """Readings of one test, as a campaign's file has them, and remarks; NaN along directions without a column."""
    channels = [name for name in import_map.columns if name in accelerometer_channels(structure)]
    transducers = [name for name in import_map.columns if name in transducer_names(structure)]
    markers = [name for name in import_map.columns if name not in (*channels, *transducers)]
    if not markers:
        raise InputError(where, "columns", "expected a column of a marker, MARKER.x, or of a pose, BODY.x")
    posed = [key for key in markers if is_pose(key, structure)]
    markers = [key for key in markers if key not in posed]
    source = test.accelerometers or test.file
    apart = [key for key in markers if import_map.columns[key].recorder]
    if len(apart) == len(markers) + len(posed) or (apart and not test.accelerometers):
        wrong = "expected a file accelerometers, and other markers in the file of the test"
        raise InputError(where, f"columns.{apart[0]}.recorder", wrong)
    if source == test.file:
        check_once(import_map.columns, import_map, where)
    else:
        check_once([key for key in (*markers, *posed) if key not in apart], import_map, where)
        check_once([*apart, *channels, *transducers], recorder_map(import_map), where)
    time, read, lost, starts, filmed, remarks = None, {}, [], {}, {}, []
    if markers:
        time, read, lost, starts, remarks = _displacements(test, markers, posed, import_map, where)
    for body in dict.fromkeys(key.rpartition(".")[0] for key in posed):
        filmed[body] = poses = filmed_body(test.file, body, posed, import_map, structure, where)
        time, own = poses.time, markers_of_poses(poses, test.file, body, import_map, structure, where)
        for name in own.keys() & read.keys():
            wrong = f"expected none; {name} is read from the poses of {body}"
            raise InputError(where, f"columns.{name}.x", wrong)
        read |= own
        remarks += poses.remarks
    read = {name: values for name, values in read.items() if np.isfinite(values).any()}
    if not read:
        raise InputError(where, "columns", f"expected readings of a marker in {test.file}; all are missing")
    names, values = list(read), np.stack([*read.values()], axis=1)
    if filmed and test.role != "sealed":
        slab = mean_read(values[:, on_driven(structure, names)])
        check_poses(filmed, slab, import_map, structure, where)
    places = marker_position(structure, structure.position, structure.orientation)
    nominal = {marker.name: place for marker, place in zip(structure.file.markers, places, strict=True)}
    remarks += _places(starts, nominal)
    centroids = dict(zip(structure.body_names, structure.centroid, strict=True))
    remarks += _places({body: poses.position[:FIRST_READINGS] for body, poses in filmed.items()}, centroids)
    variables = {"marker_displacement": (("time", "marker", "axis"), values, {"units": "m"})}
    coordinates = {"time": ("time", time, {"units": "s"}), "marker": names, "axis": list(AXES)}
    for variable, dimension, sensors, kind, unit in (
        ("accelerometer", "channel", channels, "acceleration", "m s-2"),
        ("transducer_displacement", "transducer", transducers, "displacement", "m"),
    ):
        if not sensors:
            continue
        time_acc, read, more = columns_of(source, sensors, import_map, kind, where, source != test.file)
        remarks += more
        time_acc = time_acc + test.accelerometers_offset
        dropped = dropouts(read)
        read[dropped] = np.nan
        lost += _dropped_lines(sensors, dropped, time_acc - time[0])
        if kind == "displacement":
            for column, key in zip(read.T, sensors, strict=True):
                noise = import_map.sensors.transducer_noise
                column -= rest_of(time_acc, column, import_map, where, f"{source}: {key}", noise)
        known = np.isfinite(read).any(axis=0)
        if known.any():
            variables[variable] = (("time_acc", dimension), read[:, known], {"units": unit})
            coordinates["time_acc"] = ("time_acc", time_acc, {"units": "s"})
            coordinates[dimension] = np.array(sensors)[known]
    return xr.Dataset(variables, coordinates, {"lost_markers": "\n".join(lost)} if lost else {}), remarks


def _displacements(test, keys, posed, import_map, where):
    """Times, displacements (n_times, 3) [m] by marker, from its own columns, lines on what was lost,
    the first readings (n, 3) by marker, and remarks.

    Displacements are NaN along axes without a column, and where a marker was lost.
    """
    source, starts = test.file, {}
    own = [key for key in keys if not import_map.columns[key].recorder]
    time, readings, remarks = columns_of(source, own or posed[:1], import_map, "displacement", where)
    columns = dict(zip(own, readings.T, strict=False))
    if apart := [key for key in keys if key not in own]:
        at, more, said = columns_of(
            test.accelerometers, apart, import_map, "displacement", where, recorder=True
        )
        at = at + test.accelerometers_offset
        columns |= {key: at_times(time, at, values)[0] for key, values in zip(apart, more.T, strict=True)}
        if not any(np.isfinite(columns[key]).any() for key in apart):
            theirs, own = (f"{clock[0]:.6g} to {clock[-1]:.6g} s" for clock in (time, at))
            wrong = f"expected the clock of the others, {theirs}, not {own}: tests.{test.name}.accelerometers_offset"
            raise InputError(where, f"columns.{apart[0]}.recorder", wrong)
        remarks += [*said, f"{', '.join(apart)} of the recorder: both clocks are taken to have the same zero"]
    readings = np.column_stack([columns[key] for key in keys])
    zeros, found = _zeros_of_lost(keys, readings), {}
    dropped = dropouts(np.where(zeros, np.nan, readings))
    readings[zeros | dropped] = np.nan
    lost = {key.rpartition(".")[0]: rows for key, rows in zip(keys, zeros.T, strict=True) if rows.any()}
    for key, column in zip(keys, readings.T, strict=True):
        name, _, axis = key.rpartition(".")
        if axis not in AXES or not name:
            known = "MARKER.x, MARKER.y, MARKER.z, an accelerometer channel or a displacement transducer"
            raise InputError(where, f"columns.{key}", f"expected {known}")
        values = found.setdefault(name, np.full((len(time), len(AXES)), np.nan))
        starts.setdefault(name, np.full((FIRST_READINGS, len(AXES)), np.nan))[
            : len(time), AXES.index(axis)
        ] = column[:FIRST_READINGS]
        noise = import_map.sensors.marker_noise
        rest = rest_of(time, column, import_map, where, f"{source}: {key}", noise)
        values[:, AXES.index(axis)] = column - rest
    return (
        time,
        found,
        [f"{name}: {lost_words(rows, time - time[0])}" for name, rows in lost.items()]
        + _dropped_lines(keys, dropped, time - time[0]),
        starts,
        remarks,
    )


def _places(starts, nominal):
    """`place_remarks` of the first places (n_times, 3) by name, as far as the structure has them."""
    names = [name for name in starts if name in nominal]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of places that are lost at first
        first = [np.nanmedian(starts[name], axis=0) for name in names]
    return place_remarks(names, np.array(first), np.array([nominal[name] for name in names])) if names else []


def _dropped_lines(names, dropped, time):
    """A line on each column that read 0 for moments, by the mask (n_times, n_columns); times from the first reading."""
    columns = zip(names, dropped.T, strict=True)
    return [f"{name}: {dropped_words(rows, time)}" for name, rows in columns if rows.any()]


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
