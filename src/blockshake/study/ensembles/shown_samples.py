"""Samples whose motion a report shows, of all runs of a case by a model the usual one and the farthest, and markers."""

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.dynamics.system import FALLEN
from blockshake.measurement.sensors.markers import unread_directions
from blockshake.store import load_made
from blockshake.study.ensembles.ensemble import POSES, join_batches
from blockshake.study.ensembles.envelope import counted_samples

FRAME_RATE = 25.0  # Hz


def shown_of_case(batches):
    """`shown_samples` of the samples in these files, whose histories are read of the samples shown alone."""
    figures = join_batches(batches, (*POSES, "marker_displacement"))
    counted = counted_samples(figures)
    wanted = counted["sample"].values[list(_words(counted))]
    if not wanted.size:  # of any sample it comes out that none is shown
        wanted = figures["sample"].values[:1]
    parts = []
    for batch in batches:
        inside = np.intersect1d(load_made(batch, (*POSES, "marker_displacement"))["sample"], wanted)
        if inside.size:
            parts.append(load_made(batch, chosen={"sample": inside}))
    ensemble = join_batches(parts)
    ensemble.attrs = figures.attrs
    return shown_samples(ensemble)


def shown_samples(ensemble):
    """Motion of the median sample and of the worst one, relative to the slab.

    Parameters
    ----------
    ensemble : xarray.Dataset
        From `join_batches`; only completed and collapsed samples count.

    Returns
    -------
    xarray.Dataset
        Along ``sample``, one and the same once, and none of none, at about `FRAME_RATE`:
        ``shift(sample, time, body, axis)``, displacement of the mass centres since the start less that of the slab's
        marker, inertial axes [m]; ``turn(sample, time, body, axis)``, rotation vector since the start [rad];
        ``peak(sample)``, the largest displacement of any marker along x relative to the slab [m];
        ``chosen(sample)``, why the sample is shown; ``status`` and ``end_time`` [s]. A run that ended early stands
        still after its end.

    Notes
    -----
    Samples are ranked by their peak, those that fell above all others; of an even number the median one is that below
    the middle.
    """
    counted = counted_samples(ensemble)
    peak, words = _peaks(counted), _words(counted)
    rows = list(words)
    chosen = counted.isel(sample=rows)
    moved = [_motion(chosen.isel(sample=place), ensemble.attrs["slab_marker"]) for place in range(len(rows))]
    time = ensemble["time"].isel(time=_frames(ensemble["time"].to_numpy()))
    shape = (len(rows), len(time), ensemble.sizes["body"], 3)
    shift, turn = (np.reshape([one[part] for one in moved], shape) for part in (0, 1))
    dims = ("sample", "time", "body", "axis")
    return xr.Dataset(
        {
            "shift": (dims, shift, {"long_name": "displacement relative to the slab's marker", "units": "m"}),
            "turn": (dims, turn, {"long_name": "rotation vector since the start", "units": "rad"}),
            "peak": ("sample", peak.to_numpy()[rows], {"long_name": "largest displacement", "units": "m"}),
            "chosen": ("sample", [words[row] for row in rows], {"long_name": "why the sample is shown"}),
            "status": chosen["status"].variable,
            "end_time": chosen["end_time"].variable,
        },
        coords={"sample": chosen["sample"], "time": time, "body": ensemble["body"], "axis": ensemble["axis"]},
        attrs={**ensemble.attrs, "title": "samples of an ensemble that a report shows moving"},
    )


def _peaks(counted):
    """Largest displacement of any marker along x relative to the slab, by sample [m]."""
    return counted["peak"].sel(frame="slab", drop=True).max("marker")


def _words(counted):
    """Why samples are shown, by their place: the median one first."""
    order = np.lexsort((_peaks(counted).to_numpy(), np.isin(counted["status"].values, FALLEN)))
    if len(order) < 2:
        return dict.fromkeys(order, "the only sample")
    return {order[(len(order) - 1) // 2]: "median", order[-1]: "worst"}


def shown_markers(test, times):
    """Displacement of measured markers relative to the slab's marker at these times, as a picture shows it.

    Parameters
    ----------
    test : xarray.Dataset
        From `measured_on_clock`.
    times : float64 array
        [s]

    Returns
    -------
    xarray.DataArray, (time, marker, axis)
        [m], inertial axes; NaN in a gap and beyond the record, whose first and last readings count for half a frame
        outside of it. A direction that a marker does not measure counts as still.
    """
    displacement = test["marker_displacement"].transpose("time", "marker", "axis").copy()
    for marker, axis in unread_directions(test):
        displacement.loc[{"marker": marker, "axis": axis}] = 0.0
    relative = displacement - displacement.sel(marker=test.attrs["slab_marker"], drop=True)
    known = np.clip(times, *relative["time"].to_numpy()[[0, -1]])
    read = relative.interp(time=known).assign_coords(time=times)
    return read.where(xr.DataArray(np.abs(known - times) < 0.5 / FRAME_RATE, dims="time"))


def _frames(times):
    """Slice of evenly spaced times at about `FRAME_RATE`."""
    return slice(None, None, max(1, round((len(times) - 1) / FRAME_RATE / (times[-1] - times[0]))))


def _motion(run, slab_marker):
    """Shift and turn of a sample at the frames, float64 arrays (n_times, n_bodies, 3)."""
    run = run.transpose("time", "body", "marker", "axis", "quaternion", ...)
    place = (run["position"] - run["marker_displacement"].sel(marker=slab_marker, drop=True)).to_numpy()
    last = int(np.isfinite(place).all(axis=(1, 2)).sum()) - 1
    rows = np.minimum(np.arange(len(place))[_frames(run["time"].to_numpy())], last)
    orientation = run["orientation"].to_numpy()
    now, start = (
        Rotation.from_quat(one.reshape(-1, 4), scalar_first=True)
        for one in (orientation[rows], np.repeat(orientation[:1], len(rows), axis=0))
    )
    turn = (now * start.inv()).as_rotvec()
    return place[rows] - place[0], turn.reshape(len(rows), -1, 3)
