"""A small campaign: structure, motion, a test as CSV and one as netCDF; and the tables of an import."""

import io
import tempfile
from pathlib import Path

import numpy as np
import openpyxl
import xarray as xr
import yaml
from test_fuzz_structures import GOOD as STRUCTURE

_RATE, _LENGTH = 50.0, 3.0  # Hz, s
_TIME = np.arange(round(_RATE * _LENGTH)) / _RATE
_MOVED = 0.01 * np.sin(2.0 * np.pi * 1.5 * np.clip(_TIME - 0.5, 0.0, None)) ** 3
_NOISE = 1e-4 * np.random.default_rng(1).standard_normal((len(_TIME), 2))
_FELT = 0.02 * np.random.default_rng(2).standard_normal((len(_TIME), 2)) + [0.0, 9.81]

CAMPAIGN = {
    "name": "tests", "structure": "structure.yaml", "sensors": {"marker_noise": 1e-4, "accelerometer_noise": 0.02},
    "tests": [
        {"name": "t1", "file": "t1.csv", "motion": "m.csv", "scale": 1.0, "role": "fit"},
        {"name": "t2", "file": "t2.nc", "motion": "m.csv", "scale": -0.5, "role": "sealed"},
    ],
}  # fmt: skip
MOTION = "time_s,displacement_x\n" + "".join(
    f"{at:.2f},{moved:.6f}\n" for at, moved in zip(_TIME, _MOVED, strict=True)
)
MARKERS = "time_s,s.x,m.x\n" + "".join(
    f"{at:.2f},{moved + one:.6f},{moved + other:.6f}\n"
    for at, moved, (one, other) in zip(_TIME, _MOVED, _NOISE, strict=True)
)
CHANNELS = "time_s,a-x,a-z\n" + "".join(
    f"{at:.2f},{one:.4f},{other:.4f}\n" for at, (one, other) in zip(_TIME, _FELT, strict=True)
)
_SHOWN = np.full((len(_TIME), 2, 3), np.nan)
_SHOWN[:, :, 0] = -0.5 * _MOVED[:, None] + _NOISE
_SHOWN[:, :, 2] = _NOISE
READINGS = xr.Dataset(
    {
        "marker_displacement": (("time", "marker", "axis"), _SHOWN, {"units": "m"}),
        "accelerometer": (("time_acc", "channel"), _FELT, {"units": "m s-2"}),
        "initial_offset": (("body", "axis"), np.zeros((2, 3)), {"units": "m"}),
    },
    {"time": ("time", _TIME, {"units": "s"}), "marker": ["s", "m"], "axis": ["x", "y", "z"], "time_acc": _TIME,
     "channel": ["a-x", "a-z"], "body": ["low", "high"]},
)  # fmt: skip


def netcdf(dataset, version="NETCDF4"):
    """Bytes of a Dataset as a netCDF file."""
    if version != "NETCDF4":
        return bytes(dataset.to_netcdf(None, engine="scipy", format=version))
    with tempfile.TemporaryDirectory() as folder:
        dataset.to_netcdf(Path(folder) / "x.nc", engine="netcdf4", format=version)
        return (Path(folder) / "x.nc").read_bytes()


def files(**changed):
    """Content by name of all files, some of them changed."""
    return {
        "campaign.yaml": yaml.safe_dump(CAMPAIGN), "structure.yaml": yaml.safe_dump(STRUCTURE), "m.csv": MOTION,
        "t1.csv": MARKERS, "t1-acc.csv": CHANNELS, "t2.nc": netcdf(READINGS),
    } | changed  # fmt: skip


IMPORT = {
    "name": "imported", "structure": "structure.yaml",
    "layout": {"separator": ",", "decimal": ".", "header": 1},
    "time": "time_s", "displacement_unit": "m", "acceleration_unit": "m/s2", "rest": 0.4, "fill_gaps": False,
    "columns": {"s.x": "s.x", "m.x": {"column": "m.x", "unit": "m", "reversed": False}, "a-x": "a-x"},
    "tests": [{"name": "t 1", "file": "t1.csv", "accelerometers": "t1-acc.csv", "motion": "m.csv", "scale": 1.0,
               "role": "fit"}],
}  # fmt: skip


def workbook():
    """Bytes of a workbook with the markers' table."""
    book = openpyxl.Workbook()
    for row, line in enumerate(MARKERS.splitlines()):
        book.active.append([cell if row == 0 else float(cell) for cell in line.split(",")])
    content = io.BytesIO()
    book.save(content)
    return content.getvalue()
