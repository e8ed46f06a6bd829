"""Histories of the joints in a test. Measured and simulated tests are read by the same function."""

import numpy as np
import xarray as xr

from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.compared_curves import at_times
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.motion.joint_histories import joint_histories
from blockshake.measurement.sensors.quiet_start import counted_from_rest

_RATE = 50.0  # Hz, of what is kept
_LONGEST_GAP = 0.2  # s, that is bridged by a straight line: dropouts of markers
_OF_JOINTS = ("rotation", "slip")


def read_histories(test, structure, sensors):
    """Histories of a test until a block falls or its readings end, some 50 a second; short gaps are bridged.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file, faults of sensors taken out.
    structure : Structure
        The campaign's, for a simulated test too, whatever was varied in it.
    sensors : Sensors
        The campaign.

    Returns
    -------
    xarray.Dataset
        Those of `joint_histories` in single precision. Attribute ``top``: the highest body.
    """
    test = until_fall(test, find_fall(test, structure, sensors))
    known = np.flatnonzero(test["marker_displacement"].notnull().any(("marker", "axis")).to_numpy())
    test = without_outliers(test.isel(time=slice(known[-1] + 1 if len(known) else 0)), structure)
    read = joint_histories(counted_from_rest(test, structure, sensors)[0], structure, sensors)
    step = float(np.median(np.diff(test["time"].to_numpy())))
    stride = max(round(1.0 / (_RATE * step)), 1)
    number = np.rint(read["time"].to_numpy() / step).astype(int)
    kept = np.flatnonzero(number % stride == 0)
    for name in (*_OF_JOINTS, "drift"):
        bridged = np.apply_along_axis(_bridged, 0, read[name].to_numpy(), round(_LONGEST_GAP / step))
        read[name] = read[name].copy(data=bridged)
    top = structure.body_names[int(np.argmax(structure.position[:, 2]))]
    return read.isel(time=kept).astype(np.float32).assign_attrs(top=top)


def as_cells(histories, of=""):
    """The histories that ensembles are judged by, side by side.

    Parameters
    ----------
    histories : xarray.Dataset
        From `read_histories`, perhaps of several runs.
    of : str
        Ending of the variables' names: ``_noise`` for the standard deviations.

    Returns
    -------
    xarray.DataArray
        ``(..., cell)``: rotation [rad] and slip [m] of every joint, then the drift of the top [m]; where no joint is
        known, as with one marker a block, the drift of every block. Coordinates ``quantity``, ``where``, ``unit``.
    """
    chosen = [(name, "joint", str(joint)) for name in _OF_JOINTS for joint in histories["joint"].values]
    chosen = [
        (name, dim, where) for name, dim, where in chosen if histories[name].sel(joint=where).notnull().any()
    ]
    if chosen:
        chosen.append(("drift", "body", histories.attrs["top"]))
    else:
        moved = np.abs(histories["drift"]).max([dim for dim in histories["drift"].dims if dim != "body"])
        chosen = [("drift", "body", str(name)) for name in histories["body"].values[moved.to_numpy() > 0.0]]
    parts = [histories[name + of].sel({dim: where}, drop=True) for name, dim, where in chosen]
    cells = xr.concat(parts, dim="cell", coords="minimal", compat="override").transpose(..., "cell")
    names, _, places = zip(*chosen, strict=True)
    return cells.astype(float).assign_coords(
        cell=[f"{name} {where}" for name, where in zip(names, places, strict=True)],
        quantity=("cell", list(names)),
        where=("cell", list(places)),
        unit=("cell", ["rad" if name == "rotation" else "m" for name in names]),
    )


def at_readings(cells, time):
    """Cells of simulated tests, in seconds since their start, at times of a measured one that they span."""
    both = [["time", "cell"]]
    clocks = {"time": cells["time"].to_numpy(), "instants": time}
    read = xr.apply_ufunc(
        at_times, cells, kwargs=clocks, input_core_dims=both, output_core_dims=both, exclude_dims={"time"}
    )
    return read.assign_coords(time=time)


def common_times(measured, *simulated):
    """Times of a measured test's cells that all simulated ones span."""
    time = measured["time"].to_numpy()
    ends = [cells["time"].to_numpy()[[0, -1]] for cells in simulated]
    first, last = max(start for start, _ in ends), min(end for _, end in ends)
    return time[(time >= first - 1e-6) & (time <= last + 1e-6)]


def _bridged(values, most):
    """A curve with straight lines over gaps of so many readings at most, none at its ends."""
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < 2:
        return values
    places = np.arange(len(values))
    after = np.clip(np.searchsorted(known, places), 1, len(known) - 1)
    short = known[after] - known[after - 1] <= most + 1
    inside = (places >= known[0]) & (places <= known[-1])
    return np.where(short & inside, np.interp(places, known, values[known]), values)
