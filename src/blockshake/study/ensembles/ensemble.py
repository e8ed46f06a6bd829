"""Ensembles: the runs of one structure, motion and model, side by side along ``sample``."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import Status
from blockshake.errors import InputError
from blockshake.measurement.motion.compared_curves import SAME_TIME
from blockshake.simulation.joint_figures import JOINT_FIGURES
from blockshake.store import load_made
from blockshake.study.sampling.distributions import parameter_unit

RESIDUAL_WINDOW = 0.5  # s at the end of a run, averaged for the residual so that rocking on is evened out
FRAMES = ("inertial", "slab")
POSES = ("position", "orientation")
ALONG_X = {"axis": ["x"]}
_OF_ONE_RUN = ("status", "reason", "end_time", "sample", "parameters")


def gather_ensemble(runs, samples, parameters, slab_marker):
    """One Dataset of many runs.

    Parameters
    ----------
    runs : sequence of xarray.Dataset or path, length n_samples
        Run files or their content, of one structure, motion and model, at the same times, with `joint_figures` in
        place of the joints' histories. Files are read one after the other.
    samples : sequence of int, length n_samples
        Their rows in the design.
    parameters : pandas.DataFrame
        The design's values: index the samples (more than these may be there), columns dotted names.
    slab_marker : str
        Marker on the driven body that displacements are relative to in the frame ``slab``.

    Returns
    -------
    xarray.Dataset
        Along ``sample``: ``marker_displacement(sample, time, marker, axis)`` and ``position(sample, time, body, axis)``
        [m], inertial frame; ``orientation(sample, time, body, quaternion)``; ``status`` and ``reason``;
        ``end_time`` [s]; ``peak`` and ``residual(sample, frame, marker)`` [m], along x;
        ``peak_rotation(sample, body)`` [rad]; the runs' `joint_figures`, ``(sample, joint)``;
        ``parameter_value(sample, parameter)``; and the runs' figures of their computation, ``energy_residual`` and
        ``numerics_*``, NaN where a run has none. Attributes: the others that all runs share, and ``slab_marker``.

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
    pieces, attributes = [], []
    for run, sample in zip(runs, samples, strict=True):
        run = run if isinstance(run, xr.Dataset) else load_made(run)
        piece = _piece(run)
        if pieces:
            _check_alike(piece, pieces[0], sample)
        pieces.append(piece)
        attributes.append(run.attrs)
    if slab_marker not in pieces[0]["marker"].values:
        raise InputError("ensemble", slab_marker, "expected a marker of the runs")
    index = xr.DataArray(samples, dims="sample", attrs={"long_name": "row of the sample in its design"})
    ensemble = xr.concat(
        pieces, dim="sample", data_vars="all", coords="minimal", compat="override", join="override"
    ).assign_coords(sample=index)
    ensemble = ensemble.assign(_endings(attributes)).assign_coords(
        _parameter_coordinates(parameters.loc[samples])
    )
    ensemble.attrs = {
        **_common(attributes),
        "Conventions": "CF-1.11",
        "title": "ensemble of simulated runs",
        "slab_marker": slab_marker,
    }
    return ensemble.assign(_extremes(ensemble))


def join_batches(batches, without=(), chosen=None):
    """Ensemble whose samples were gathered in several batches.

    Parameters
    ----------
    batches : sequence of xarray.Dataset or path
        From `gather_ensemble`, of one structure, motion, model and design.
    without : sequence of str
        Variables that are not read from files, such as `POSES`: half of what an ensemble holds.
    chosen : dict of str to list, optional
        Labels by dimension that alone are read from files, such as `ALONG_X` or some markers.

    Returns
    -------
    xarray.Dataset
        As from `gather_ensemble`, samples rising.

    Raises
    ------
    InputError
        No batches, a sample in two of them, or times, markers, bodies or parameters that differ.
    """
    parts = [
        batch if isinstance(batch, xr.Dataset) else load_made(batch, without, chosen) for batch in batches
    ]
    samples = [int(sample) for part in parts for sample in part["sample"].values]
    if not samples or len(set(samples)) < len(samples):
        raise InputError("ensemble", "samples", "expected at least one batch, and every sample in one only")
    for part in parts[1:]:
        _check_alike(part, parts[0], int(part["sample"][0]), ("time", "marker", "body", "joint", "parameter"))
    joined = xr.concat(
        parts, dim="sample", data_vars="all", coords="minimal", compat="override", join="override"
    ).sortby("sample")
    joined.attrs = _common([part.attrs for part in parts])
    return joined


def sample_figures(ensemble):
    """Outcome of each sample without the histories: status, peaks, residuals, parameters, figures."""
    figures = ensemble.drop_dims(["time", "axis", "quaternion"], errors="ignore")
    figures.attrs = {**ensemble.attrs, "title": "samples of an ensemble of simulated runs"}
    return figures


def _piece(run):
    """The variables of a run that an ensemble keeps, and the largest rotation of its bodies."""
    piece = run[["marker_displacement", "position", "orientation", *JOINT_FIGURES]]
    piece = piece.assign(peak_rotation=_peak_rotation(run["orientation"]))
    piece.attrs = {}
    return piece.transpose("time", "marker", "body", "joint", "axis", "quaternion")


def _peak_rotation(orientation):
    """Largest angle between each body's orientation and that at the start."""
    turned = np.abs((orientation * orientation.isel(time=0, drop=True)).sum("quaternion", skipna=False))
    angle = (2.0 * np.arccos(np.minimum(turned, 1.0))).max("time")
    angle.attrs = {"long_name": "largest rotation since the start", "units": "rad"}
    return angle.reset_coords(drop=True)


def _check_alike(piece, first, sample, names=("time", "marker", "body", "joint")):
    for name in names:
        if not piece[name].equals(first[name]):
            raise InputError("ensemble", f"sample {sample}", f"expected the same '{name}' in all runs")


def _endings(attributes):
    """How each run ended and the figures of its computation, along ``sample``."""
    described = {"status": "how the run ended", "reason": "why the run ended so"}
    endings = {
        name: ("sample", [str(run.get(name, "")) for run in attributes], {"long_name": long_name})
        for name, long_name in described.items()
    }
    for name in sorted({name for run in attributes for name in run if _is_figure(name)}):
        values = [float(run.get(name, np.nan)) for run in attributes]
        endings[name] = ("sample", values, {"long_name": name.replace("_", " ")})
    endings["end_time"] = (
        "sample",
        [float(run["end_time"]) for run in attributes],
        {"long_name": "time reached", "units": "s"},
    )
    return endings


def _is_figure(name):
    return name == "energy_residual" or name.startswith("numerics_")


def _common(attributes):
    """Attributes that are the same in all runs and say nothing of one run only."""
    first, *rest = attributes
    return {
        name: value
        for name, value in first.items()
        if not _is_figure(name)
        and name not in _OF_ONE_RUN
        and all(np.array_equal(run.get(name), value) for run in rest)
    }


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


def peak_and_residual(along, since, skipna):
    """Largest magnitude of curves along x over ``time``, and their mean from ``since`` [s] on, xarray.DataArrays [m].

    ``skipna``: gaps are left out of the mean; otherwise the mean of a curve with a gap is NaN.
    """
    window = (along["time"] >= since).to_numpy()
    return np.abs(along).max("time"), along.isel(time=window).mean("time", skipna=skipna)


def _extremes(ensemble):
    """Peak and residual along x of every marker in both frames."""
    along = in_frames(ensemble["marker_displacement"].sel(axis="x", drop=True), ensemble.attrs["slab_marker"])
    # a run that stopped early has NaN in the window, and so no residual; nor has one that still falls
    peak, residual = peak_and_residual(along, along["time"][-1] - RESIDUAL_WINDOW, skipna=False)
    residual = residual.where(ensemble["status"] != Status.FALLING)
    peak.attrs = {"long_name": "largest absolute displacement along x until the end of the run", "units": "m"}
    residual.attrs = {
        "long_name": f"mean displacement along x in the last {RESIDUAL_WINDOW:g} s",
        "units": "m",
    }
    order = ("sample", "frame", "marker")
    return {"peak": peak.transpose(*order), "residual": residual.transpose(*order)}


def describe(dataset, described):
    """Give variables and coordinates of a Dataset their attributes, in place of any that they have.

    Parameters
    ----------
    dataset : xarray.Dataset
    described : dict of str to (str, str)
        Long name and unit, by variable.
    """
    for name, (long_name, units) in described.items():
        dataset[name].attrs = {"long_name": long_name, "units": units}


def measured_curves(test, slab_marker, duration):
    """Measured displacement along x over the simulated window, ``displacement(frame, time, marker)`` [m].

    And by the definitions of `gather_ensemble` ``peak`` and ``residual(frame, marker)`` [m]. ``test`` has
    ``marker_displacement(time, marker, axis)`` [m], inertial frame; the frame ``slab`` moves with ``slab_marker``;
    ``duration`` of the window [s].
    """
    along = test["marker_displacement"].sel(axis="x", drop=True)
    along = in_frames(along.isel(time=(along["time"] <= duration + SAME_TIME).to_numpy()), slab_marker)
    peak, residual = peak_and_residual(along, duration - RESIDUAL_WINDOW, skipna=True)
    return xr.Dataset({"displacement": along, "peak": peak, "residual": residual})
