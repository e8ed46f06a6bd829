"""Files of tests, good and bad: one clear line for each, never a traceback."""

import numpy as np
import pytest
import xarray as xr
from resting_stack import CHANNELS, MARKERS, NOISE, STRUCTURE, resting_stack, write_campaign

from blockshake.errors import InputError
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.recorded_test import read_test


def _refused(path, message):
    with pytest.raises(InputError) as error:
        read_test(path, STRUCTURE)
    assert str(error.value).startswith(f"{path}: {message}"), error.value
    assert "\n" not in str(error.value)


def _displaced(change):
    def spoil(test):
        test["marker_displacement"][:] = change(test["marker_displacement"].to_numpy().copy())
        return test

    return spoil


def _set(name, place, value):
    def spoil(test):
        test[name].values[place] = value
        return test

    return spoil


def _stated(name, units):
    def spoil(test):
        test[name].attrs["units"] = units
        return test

    return spoil


def _timed(name, change):
    return lambda test: test.assign_coords({name: change(test[name].to_numpy().copy())})


def _back(time):
    time[100] = time[98]
    return time


def _offset(name, size, body="block-1"):
    def spoil(test):
        test[name] = (("body", "axis"), [[size, 0.0, 0.0]])
        return test.assign_coords(body=[body])

    return spoil


def _swap_places(test):
    test["marker_initial_position"][:] = test["marker_initial_position"].to_numpy()[:, [1, 0, 2]]
    return test


def _words(test):
    test["marker_displacement"] = test["marker_displacement"].astype(str)
    return test


ACCELEROMETER = "expected accelerometer channels of the structure: slab-acc-x"
BAD = {
    "swapped places": (_swap_places, "axis: expected x, y, z; the markers start where the structure has them"),
    "millimetres": (_displaced(lambda x: 1e3 * x), "marker_displacement: expected metres; a displacement of"),
    "stated millimetres": (_stated("marker_displacement", "mm"), "marker_displacement.units: expected m, not 'mm'"),
    "stated feet": (_stated("marker_initial_position", "ft"), "marker_initial_position.units: expected m, not"),
    "stated g": (_stated("accelerometer", "g"), "accelerometer.units: expected m s-2, not 'g'"),
    "stated ms": (_stated("time", "ms"), "time.units: expected s, not 'ms'"),
    "a calendar": (_stated("time", "seconds since 2020-01-01"), "time.units: expected s, not 'seconds since"),
    "infinite": (_set("marker_displacement", (7, 3, 1), np.inf), "marker_displacement: expected finite readings"),
    "a code": (_set("accelerometer", (7, 1), -999.0), "accelerometer: expected readings, and NaN in a gap; -999 looks"),
    "netCDF's code": (_set("accelerometer", (slice(7, 9), 0), 9.96921e36), "accelerometer: expected readings, and NaN"),
    "two records": (
        _timed("time", lambda t: t + 1e6 * (t > 5.0)), "time: expected one record; more rows are missing than there",
    ),
    "words": (_words, "marker_displacement: expected numbers, not"),
    "absolute": (_displaced(lambda x: x + 0.5), f"{MARKERS[0]}.x: expected displacements since the first reading"),
    "negative step": (_timed("time", _back), "time: expected times that increase; 0.49 s follows 0.495 s"),
    "milliseconds": (_timed("time", lambda t: 1e3 * t), "time: expected seconds, with 20 to 10000 readings"),
    "minutes": (_timed("time", lambda t: t / 60.0), "time: expected seconds, with 20 to 10000 readings"),
    "accelerometers' ms": (_timed("time_acc", lambda t: 1e3 * t), "time_acc: expected seconds, with 20 to"),
    "another clock": (_timed("time_acc", lambda t: t + 100.0), "time_acc: expected the clock of time, 0 to 10 s"),
    "silent marker": (
        _set("marker_displacement", (slice(None), 3), np.nan), f"{MARKERS[3]}: expected readings; all are",
    ),
    "no slab along x": (
        _set("marker_displacement", (slice(None), slice(0, 4), 0), np.nan),
        f"{MARKERS[0]}.x: expected readings of the driven body along x",
    ),
    "another axis": (lambda test: test.assign_coords(axis=["x", "y", "t"]), "axis: expected x, y, z, not x, y, t"),
    "unknown marker": (
        lambda test: test.assign_coords(marker=["mystery", *MARKERS[1:]]), "mystery: expected markers of the structure",
    ),
    "doubled marker": (
        lambda test: test.assign_coords(marker=[MARKERS[1], *MARKERS[1:]]), f"{MARKERS[1]}: expected every marker once",
    ),
    "unknown channel": (lambda test: test.assign_coords(channel=["slab-acc-x", "a-x"]), f"a-x: {ACCELEROMETER}"),
    "doubled channel": (
        lambda test: test.assign_coords(channel=["slab-acc-x"] * 2),
        "slab-acc-x: expected every accelerometer channel once",
    ),
    "no clock": (lambda test: test.drop_vars("time_acc"), "time_acc: expected this coordinate"),
    "no channels": (lambda test: test.drop_vars("channel"), "channel: expected this coordinate"),
    "unknown body": (_offset("initial_offset", 0.0, "mystery"), "mystery: expected bodies of the structure: slab,"),
    "no bodies": (
        lambda test: _offset("initial_offset", 0.0)(test).drop_vars("body"), "body: expected this coordinate",
    ),
    "far off": (_offset("initial_offset", 2.0), "initial_offset.block-1: expected at most 1 m, not 2"),
    "degrees": (_offset("initial_rotation", 2.0), "initial_rotation.block-1: expected at most 0.5 rad, not 2"),
    "no slab": (
        lambda test: test.isel(marker=slice(4, None)),
        f"marker: expected a marker of the driven body, which is the input: {MARKERS[0]} or",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", BAD)
def test_bad_files_get_one_clear_line(what, tmp_path):
    spoil, message = BAD[what]
    path = tmp_path / "t1.nc"
    spoil(resting_stack()).to_netcdf(path)
    _refused(path, message)


GOOD = {
    "as it is": lambda test: test,
    "other spellings": lambda test: _stated("accelerometer", "m/s^2")(_stated("time", "seconds")(test)),
    "whole milliseconds stored in seconds of float32": _timed("time", lambda t: t.astype(np.float32)),
    "a first reading with noise": _displaced(lambda x: x + 3.0 * NOISE),
    # it has moved by then, and states it rightly
    "a first half second that is lost": _set("marker_displacement", (slice(0, 500), 3), np.nan),
    "an inherited offset": _offset("initial_offset", 4e-3),
    "no accelerometers": lambda test: test.drop_dims("time_acc"),
    "x alone": lambda test: test.sel(axis=["x"]),
    "one marker without y": _set("marker_displacement", (slice(None), 3, 1), np.nan),
}


@pytest.mark.parametrize("what", GOOD)
def test_good_files_pass(what, tmp_path):
    path = tmp_path / "t1.nc"
    GOOD[what](resting_stack()).to_netcdf(path)
    assert read_test(path, STRUCTURE)["time"].dtype == np.float64


@pytest.mark.parametrize(
    ("share", "form"),
    # a classic file ends with two bytes that fill up the channels' names
    [(share, "NETCDF4") for share in (0, 7, 100, 0.5, -1)]
    + [(share, "NETCDF3_64BIT") for share in (7, 100, 0.5, -3)],
)
def test_a_cut_file_is_one_line(share, form, tmp_path):
    """The first so many bytes, half, or all but the last."""
    path = tmp_path / "t1.nc"
    resting_stack().to_netcdf(path, format=form)
    read_test(path, STRUCTURE)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2 if share == 0.5 else share])
    _refused(path, "expected a netCDF file; this is cut, damaged or something else")


def _write_tables(test, path, beside):
    """The test as a spreadsheet would save it."""
    displacement = test["marker_displacement"]
    names = [f"{marker}.{axis}" for marker in MARKERS for axis in "xyz"]
    table = displacement.to_numpy().reshape(displacement.sizes["time"], -1)
    for target, header, times, values in (
        (path, names, displacement["time"], table),
        (beside, CHANNELS, test["time_acc"], test["accelerometer"].to_numpy()),
    ):
        rows = [
            f"{time!r}," + ",".join("" if np.isnan(cell) else repr(cell) for cell in row)
            for time, row in zip(times.values.tolist(), values.tolist(), strict=True)
        ]
        target.write_text(f"time_s,{','.join(header)}\n" + "\n".join(rows) + "\n")


@pytest.mark.parametrize(
    "names", [("t1.csv", "t1-acc.csv"), ("T1.CSV", "T1-acc.CSV"), ("T1.CSV", "t1-acc.csv")]
)
def test_a_spreadsheet_of_readings_goes_in(names, tmp_path):
    """The same test as two tables gives the same readings, however the endings are spelt."""
    expected = load_test(load_campaign(write_campaign(tmp_path, resting_stack())), "t1")
    _write_tables(resting_stack(), *(tmp_path / name for name in names))
    read = load_test(load_campaign(write_campaign(tmp_path, None, file=names[0])), "t1")
    for name in ("marker_displacement", "accelerometer", "time", "time_acc", "marker"):
        xr.testing.assert_equal(read[name].drop_attrs(), expected[name].drop_attrs())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "header: expected names of columns in line 1, and rows; it is empty"),
        ("a,b\n1,2\n", "time_s: expected a header with time_s"),
        ("time_s\n0\n0.1\n", "time_s: expected a header with time_s, other columns"),
        (
            "time_s,slab-face.x\n\n0,0\n0.1,far\n",
            "line 4, slab-face.x: expected a number with a decimal point, or nothing, not 'far'",
        ),
        ("time_s,slab-face.x\n0,0\n0.1,0,0\n", "line 3: expected at most 2 cells as in line 1, found 3"),
        (
            'time_s,slab-face.x\n0,"0\n0.1,0\n',
            "line 3: expected cells between ','; unexpected end of data",
        ),
        ("time_s,slab-face\n0,0\n0.1,0\n", "slab-face: expected columns MARKER.x"),
        (
            "time_s,slab-face.x,slab-face.y\n0,0,\n0.01,0,\n",
            "slab-face.y: expected readings, or no such column",
        ),
        ("time_s,slab-face.z\n0,0\n0.01,0\n", "slab-face.x: expected readings of the driven body along x"),
    ],
)
def test_bad_tables_get_one_clear_line(text, message, tmp_path):
    path = tmp_path / "t1.csv"
    path.write_text(text)
    _refused(path, message)


def test_a_direction_without_a_column_is_missing_and_not_zero(tmp_path):
    path = tmp_path / "t1.csv"
    path.write_text("time_s,slab-face.x,block-1-face.x,block-1-face.z\n0,0,0,0\n0.01,0,0.001,0.002\n")
    read = read_test(path, STRUCTURE)["marker_displacement"]
    assert read.isel(time=1).values.tolist()[1] == [0.001, pytest.approx(np.nan, nan_ok=True), 0.002]
    assert read.sel(axis=["y", "z"], marker="slab-face").isnull().all()


def test_accelerometers_without_channels_are_refused(tmp_path):
    _write_tables(resting_stack(), tmp_path / "t1.csv", tmp_path / "t1-acc.csv")
    (tmp_path / "t1-acc.csv").write_text("time_s\n0\n0.1\n")
    with pytest.raises(
        InputError, match=r"t1-acc\.csv: time_s: expected a header with time_s, other columns"
    ):
        read_test(tmp_path / "t1.csv", STRUCTURE)
