"""The file of one measured test, checked against the structure."""

from pathlib import Path

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.campaigns.clocks import agreement_words, from_first_reading, missing_rows
from blockshake.measurement.campaigns.faulty_readings import faulty_lines, instruments, stuck, without_faulty
from blockshake.measurement.campaigns.initial_poses import initial_poses, with_initial_poses
from blockshake.measurement.campaigns.lost_markers import without_lost
from blockshake.measurement.campaigns.reading_files import SURVEY, read_netcdf, read_tables, read_variables
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.markers import driven_names, marker_position
from blockshake.measurement.sensors.transducers import transducer_names
from blockshake.tables.numbers import missing_code

FARTHEST = 20.0  # m; no table moves so far, a file in millimetres does
# Readings a second. Shaking has 0.5 to 50 Hz, most of it below 10 Hz, which takes 20 readings a second. 10 kHz are
# 200 readings in the shortest period; times in milliseconds (200 Hz become 0.2) and in minutes (12 000) lie outside.
_RATES = (20.0, 1e4)
_START = 0.1  # s
# readings, whose median is the start; shaking with 10 m/s2 from the first has moved by 0.5 mm in 10 ms
FIRST_READINGS = 5
_START_LIMIT = 0.01  # m; far beyond noise, far less than a marker's distance from the origin
_START_NOISE = 5.0  # times the channel's own noise
_OVERLAP = 0.5  # of the shorter record, that both clocks must share
# by dimension: what its names are names of, in singular and plural, and those of a structure
_NAMES = {
    "marker": ("marker", "markers", lambda structure: [marker.name for marker in structure.file.markers]),
    "channel": ("accelerometer channel", "accelerometer channels", accelerometer_channels),
    "transducer": ("displacement transducer", "displacement transducers", transducer_names),
    "body": ("body", "bodies", lambda structure: structure.body_names),
}
_PLACE = 0.1  # m, of a marker off the structure's
# A block more than some 1 m off hangs over the edge of a slab 3 m wide; one twice as high as thick falls when it is
# tilted by atan(1/2) = 0.46 rad. Degrees lie beyond in all but small cases.
FARTHEST_TURN = 0.5  # rad
_LIMITS = {"initial_offset": (1.0, "m"), "initial_rotation": (FARTHEST_TURN, "rad")}


def read_test(path, structure):
    """Readings of one test.

    Parameters
    ----------
    path : str or path
        A netCDF file, or ``NAME.csv`` with columns ``time_s`` and ``MARKER.AXIS`` [m]; with it may lie
        ``NAME-acc.csv`` with ``time_s`` and one column a channel [m/s2] or displacement transducer [m]. An empty cell
        is a gap. A direction without a column, or without any reading in a netCDF file, was not measured.
    structure : Structure
        Whose markers, accelerometers and displacement transducers are read.

    Returns
    -------
    xarray.Dataset
        Variables of docs/guide/campaigns.md, float64; NaN along a direction that was not measured, and where a column
        holds no readings, see `without_faulty`; ``starting_place`` with them, see `with_initial_poses`. All times
        count from the markers' first reading. The file is never changed.

    Raises
    ------
    InputError
        Not readable; times that do not increase or are not in seconds; unknown or doubled markers, channels,
        transducers or bodies; no marker on the driven body that measures x; a sensor without any reading; axes that are
        swapped; another unit; readings that are infinite or not since the first.
    """
    path = Path(path)
    table = path.suffix.lower() == ".csv"
    test = read_tables(path, transducer_names(structure)) if table else read_netcdf(path)
    test = without_faulty(without_lost(checked_test(test, structure, path), structure), structure)
    _check_driven(test, structure, path)  # whose readings may have been faulty
    return from_first_reading(with_initial_poses(test, structure, path))


def structure_at_start(path, structure):
    """The structure with its blocks where a test found them, by its survey: no reading of the test is looked at."""
    if path.suffix.lower() == ".csv":
        return structure
    return initial_poses(structure, with_initial_poses(read_variables(path, SURVEY), structure, path))


def checked_test(test, structure, path):
    """Readings of one test as a file has them, checked as by `read_test`; an error names ``path``."""
    for name in ("time", "time_acc"):
        if name in test.coords:
            check_times(test[name].to_numpy(), path, name)
    if tuple(test["axis"].values) != AXES:
        test = _ordered_axes(test, path)
    _check_names(test, structure, path)
    _check_driven(test, structure, path)
    _check_clocks(test, structure, path)
    _check_readings(test, path)
    _check_start(test, path)
    check_initial_places(test, structure, path)
    return test


def check_times(time, path, name):
    """Refuse times that do not increase, are not in seconds, or lack more rows than there are."""
    if len(time) < 2 or not np.isfinite(time).all():
        raise InputError(path, name, "expected at least two times, all finite")
    steps = np.diff(time)
    if not (steps > 0.0).all():
        row = int(np.argmin(steps > 0.0))
        wrong = f"expected times that increase; {time[row + 1]:.13g} s follows {time[row]:.13g} s"
        raise InputError(path, name, wrong)
    rate = 1.0 / np.median(steps)
    if not _RATES[0] <= rate <= _RATES[1]:
        wrong = f"expected seconds, with {_RATES[0]:g} to {_RATES[1]:g} readings in each, not {rate:.3g}"
        raise InputError(path, name, wrong)
    if missing_rows(time).sum() > len(time):
        row = int(steps.argmax())
        lost = f"more rows are missing than there are, {steps[row]:.4g} s after {time[row]:.13g} s"
        raise InputError(path, name, f"expected one record; {lost}")


def _ordered_axes(test, path):
    read = [str(name) for name in test["axis"].values]
    if not set(read) <= set(AXES) or len(set(read)) < len(read):
        raise InputError(path, "axis", f"expected x, y, z, not {', '.join(read)}")
    return test.reindex(axis=list(AXES))


def _check_names(test, structure, path):
    """Markers, channels, transducers and bodies are the structure's, once each."""
    for dimension, (singular, plural, names_of) in _NAMES.items():
        known = names_of(structure)
        read = [str(name) for name in test[dimension].values] if dimension in test.coords else []
        for name in read:
            if name not in known:
                wrong = f"expected {plural} of the structure: {', '.join(known) or 'none'}"
                raise InputError(path, name, wrong)
            if read.count(name) > 1:
                raise InputError(path, name, f"expected every {singular} once")


def _check_driven(test, structure, path):
    """A marker of the driven body reads it along x."""
    driven = driven_names(structure)
    wanted = [marker.name for marker in structure.file.markers if marker.body in driven]
    read = [name for name in map(str, test["marker"].values) if name in wanted]
    if not read:
        wrong = f"expected a marker of the driven body, which is the input: {' or '.join(wanted)}"
        raise InputError(path, "marker", "; ".join([wrong, *faulty_lines(test)]))
    if not test["marker_displacement"].sel(marker=read, axis="x").notnull().any():
        wrong = "expected readings of the driven body along x, the direction of shaking"
        raise InputError(path, f"{read[0]}.x", wrong)


class ClockApartError(InputError):
    """A recorder whose clock does not run next to the markers'."""


def _check_clocks(test, structure, path):
    """The recorder's clock runs next to the markers': `ClockApartError`, with what the slab's sensors tell of it."""
    if "time_acc" not in test.coords:
        return
    clocks = [(time[0], time[-1]) for time in (test["time"].to_numpy(), test["time_acc"].to_numpy())]
    shared = min(end for _, end in clocks) - max(begin for begin, _ in clocks)
    if shared < _OVERLAP * min(end - begin for begin, end in clocks):
        (begin, end), (begin_acc, end_acc) = clocks
        wrong = f"expected the clock of time, {begin:.13g} to {end:.13g} s, not {begin_acc:.13g} to {end_acc:.13g} s"
        raise ClockApartError(path, "time_acc", wrong + agreement_words(test, structure))


def _check_readings(test, path):
    for name, variable in test.data_vars.items():
        values = variable.to_numpy()
        if np.isinf(values).any():
            raise InputError(path, name, "expected finite readings, and nothing or NaN in a gap")
        for column in values.reshape(len(values), -1).T if variable.dims[0] in ("time", "time_acc") else ():
            coded = missing_code(column)
            if coded is not None:
                wrong = f"expected readings, and NaN in a gap; {column[coded]:g} looks like a code for none"
                raise InputError(path, name, wrong)
    for readings, *_ in instruments(test):
        for name in readings[readings.dims[1]].values:
            if readings.sel({readings.dims[1]: name}).isnull().all():
                raise InputError(path, str(name), "expected readings; all are missing")


def _check_start(test, path):
    """Displacements are in metres and count from the first reading.

    Columns that are `stuck` are left out, and those whose first readings are lost.
    """
    for readings, unit, columns, values in instruments(test):
        if unit != "m":
            continue
        values = np.where(stuck(values), np.nan, values)
        farthest = float(np.nanmax(np.abs(values), initial=0.0))
        if farthest > FARTHEST:
            wrong = f"expected metres; a displacement of {farthest:g} looks like millimetres"
            raise InputError(path, readings.name, wrong)
        time = readings[readings.dims[0]].to_numpy()
        for name, column in zip(columns, values.T, strict=True):
            channel = column[(time <= time[0] + _START) & np.isfinite(column)]
            if len(channel) < 2:
                continue
            start = float(np.median(channel[:FIRST_READINGS]))
            noise = np.sqrt(np.mean(np.diff(channel) ** 2) / 2.0)  # large where the unit is another
            if abs(start) > max(_START_LIMIT, _START_NOISE * noise):
                wrong = f"expected displacements since the first reading; it starts at {start:.3g} m"
                raise InputError(path, name, wrong)


def check_initial_places(test, structure, path):
    """Refuse markers that start elsewhere than in the structure, and offsets that no standing body has.

    Raises
    ------
    InputError
        Places off by more than 0.1 m, or in another order of the axes; an offset beyond 1 m; a rotation beyond
        0.5 rad.
    """
    _check_marker_places(test, structure, path)
    for name, (limit, unit) in _LIMITS.items():
        if name in test:
            size = np.abs(test[name].transpose("body", "axis").to_numpy())
            size = np.where(np.isfinite(size), size, 0.0).max(axis=1, initial=0.0)
            if size.max(initial=0.0) > limit:
                body, wrong = (
                    test["body"].values[int(size.argmax())],
                    f"{limit:g} {unit}, not {size.max():.3g}",
                )
                raise InputError(path, f"{name}.{body}", f"expected at most {wrong}")


def _check_marker_places(test, structure, path):
    if "marker_initial_position" not in test:
        return
    places = marker_position(structure, structure.position, structure.orientation)
    by_name = {marker.name: position for marker, position in zip(structure.file.markers, places, strict=True)}
    nominal = np.array([by_name[str(name)] for name in test["marker"].values])
    read = test["marker_initial_position"].transpose("marker", "axis").to_numpy()
    known = np.isfinite(read).any(axis=1)
    away = np.linalg.norm(np.nan_to_num(read - nominal), axis=1)[known]
    if not len(away) or away.max() < _PLACE:
        return
    for order in ((1, 0, 2), (2, 1, 0), (0, 2, 1), (1, 2, 0), (2, 0, 1)):
        if np.linalg.norm(read[:, order] - nominal, axis=1)[known].max() < _PLACE:
            swapped = ", ".join(AXES[axis] for axis in order)
            wrong = f"expected x, y, z; the markers start where the structure has them in the order {swapped}"
            raise InputError(path, "axis", wrong)
    name = test["marker"].values[known][int(away.argmax())]
    wrong = f"expected it within {_PLACE:g} m of the structure's, not {away.max():.3g} m off"
    raise InputError(path, f"marker_initial_position.{name}", wrong)
