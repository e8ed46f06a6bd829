"""Ensembles: the runs of one structure, motion and model, side by side along ``sample``."""

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.study.distributions import parameter_unit

RESIDUAL_WINDOW = 0.5  # s at the end of a run, averaged for the residual so that rocking on is evened out
FRAMES = ("inertial", "slab")


def gather_ensemble(runs, samples, parameters, slab_marker):
    """One Dataset of many runs.

    Parameters
    ----------
    runs : sequence of xarray.Dataset or path, length n_samples
        Run files or their content, of one structure, motion and model, at the same times. Files
        are read one after the other.
    samples : sequence of int, length n_samples
        Their rows in the design.
    parameters : pandas.DataFrame
        The design's values: index the samples (more than these may be there), columns dotted names.
    slab_marker : str
        Marker on the driven body that displacements are relative to in the frame ``slab``.

    Returns
    -------
    xarray.Dataset
        Along ``sample``: ``marker_displacement(sample, time, marker, axis)`` and
        ``position(sample, time, body, axis)`` [m], inertial frame; ``status`` and ``reason``;
        ``end_time`` [s]; ``peak`` and ``residual(sample, frame, marker)`` [m], along x;
        ``peak_rotation(sample, body)`` [rad]; ``parameter_value(sample, parameter)``. Attributes:
        those that all runs share, and ``slab_marker``.

    Raises
    ------
    InputError
        No runs, runs whose times, markers or bodies differ, or a sample that the design lacks.
    """
    samples = [int(sample) for sample in samples]
    if not samples or len(samples) != len(runs) or len(set(samples)) < len(samples):
        raise InputError("ensemble", "samples", "expected at least one run and a sample of its own for each")
    for sample in samples:
        if sample not in parameters.index:
            raise InputError("ensemble", f"sample {sample}", "expected a row of the design")
    shared, pieces, status, reason, end_time = None, [], [], [], []
    for run, sample in zip(runs, samples, strict=True):
        run = run if isinstance(run, xr.Dataset) else xr.load_dataset(run)
        piece = _piece(run)
        if pieces:
            _check_alike(piece, pieces[0], sample)
        pieces.append(piece)
        status.append(str(run.attrs["status"]))
        reason.append(str(run.attrs.get("reason", "")))
        end_time.append(float(run.attrs.get("end_time", np.nan)))
        shared = _common(shared, run.attrs)
    if slab_marker not in pieces[0]["marker"].values:
        raise InputError("ensemble", slab_marker, "expected a marker of the runs")
    index = xr.DataArray(samples, dims="sample", attrs={"long_name": "row of the sample in its design"})
    ensemble = xr.concat(pieces, dim="sample").assign_coords(sample=index)
    ensemble["status"] = ("sample", status, {"long_name": "how the run ended"})
    ensemble["reason"] = ("sample", reason, {"long_name": "why the run ended so"})
    ensemble["end_time"] = ("sample", end_time, {"long_name": "time reached", "units": "s"})
    ensemble = ensemble.assign_coords(_parameter_coordinates(parameters.loc[samples]))
    ensemble.attrs = {
        **{name: value for name, value in shared.items() if name not in ("status", "reason", "end_time")},
        "Conventions": "CF-1.11",
        "title": "ensemble of simulated runs",
        "slab_marker": slab_marker,
    }
    return ensemble.assign(_extremes(ensemble))


def _piece(run):
    """The variables of a run that an ensemble keeps, and the largest rotation of its bodies."""
    piece = run[["marker_displacement", "position"]].reset_coords(drop=True)
    piece = piece.assign(peak_rotation=_peak_rotation(run["orientation"]))
    piece.attrs = {}
    return piece.transpose("time", "marker", "body", "axis")


def _peak_rotation(orientation):
    """Largest angle between each body's orientation and that at the start."""
    turned = np.abs((orientation * orientation.isel(time=0, drop=True)).sum("quaternion", skipna=False))
    angle = (2.0 * np.arccos(np.minimum(turned, 1.0))).max("time")
    angle.attrs = {"long_name": "largest rotation since the start", "units": "rad"}
    return angle.reset_coords(drop=True)


def _check_alike(piece, first, sample):
    for name in ("time", "marker", "body"):
        if not piece[name].equals(first[name]):
            raise InputError("ensemble", f"sample {sample}", f"expected the same '{name}' in all runs")


def _common(shared, attributes):
    if shared is None:
        return dict(attributes)
    return {name: value for name, value in shared.items() if np.array_equal(attributes.get(name), value)}


def _parameter_coordinates(parameters):
    names = [str(name) for name in parameters.columns]
    values = parameters.to_numpy(dtype=float)
    return {
        "parameter": ("parameter", names, {"long_name": "dotted name of the parameter"}),
        "parameter_unit": ("parameter", [parameter_unit(name) for name in names], {"long_name": "its unit"}),
        "parameter_value": (
            ("sample", "parameter"),
            values,
            {"long_name": "sampled value, in parameter_unit"},
        ),
    }


def relative_to_slab(displacement, slab_marker):
    """Displacement of every marker minus that of the slab's marker, along the inertial axes [m]."""
    relative = displacement - displacement.sel(marker=slab_marker, drop=True)
    relative.attrs = {"long_name": "marker displacement relative to the slab's marker", "units": "m"}
    return relative


def in_frames(displacement, slab_marker):
    """Displacement with a first dimension ``frame``: ``inertial`` as given, ``slab`` relative to it."""
    frames = [displacement, relative_to_slab(displacement, slab_marker)]
    stacked = xr.concat(frames, dim=xr.Variable("frame", list(FRAMES)), combine_attrs="drop")
    stacked["frame"].attrs = {
        "long_name": "frame of the displacement: inertial, or moving with the slab's marker"
    }
    return stacked


def _extremes(ensemble):
    """Peak and residual along x of every marker in both frames."""
    along = in_frames(ensemble["marker_displacement"].sel(axis="x", drop=True), ensemble.attrs["slab_marker"])
    peak = np.abs(along).max("time")
    # a run that stopped early has NaN in the window, and so no residual
    window = along["time"] >= along["time"][-1] - RESIDUAL_WINDOW
    residual = along.isel(time=window.to_numpy()).mean("time", skipna=False)
    peak.attrs = {"long_name": "largest absolute displacement along x until the end of the run", "units": "m"}
    residual.attrs = {
        "long_name": f"mean displacement along x in the last {RESIDUAL_WINDOW:g} s",
        "units": "m",
    }
    order = ("sample", "frame", "marker")
    return {"peak": peak.transpose(*order), "residual": residual.transpose(*order)}
