"""Ensembles: the runs of one structure, motion and model, side by side along ``sample``."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import Status
from blockshake.errors import InputError
from blockshake.measurement.motion.compared_curves import SAME_TIME
from blockshake.simulation.run_histories import BLOW_FIGURES, JOINT_FIGURES
from blockshake.store import load_made
from blockshake.study.sampling.distributions import parameter_unit

RESIDUAL_WINDOW = 0.5  # s at the end of a run, averaged for the residual so that rocking on is evened out
FRAMES = ("inertial", "slab")
POSES = ("position", "orientation")
ALONG_X = {"axis": ["x"]}
# digits kept in histories: 0.1 um, a thousandth of a marker's noise, and of a quaternion as much at a block's length
DECIMALS = {"m": 7, "1": 8}
_OF_ONE_RUN = ("status", "reason", "settled", "end_time", "sample", "parameters")


def run_alone(run, slab_marker):
    """Histories and figures that an ensemble keeps of a run, whatever sample it stands for.

    Parameters
    ----------
    run : xarray.Dataset
        Content of a run file, with `joint_figures` in place of the joints' histories.
    slab_marker : str
        Marker on the driven body that displacements are relative to in the frame ``slab``.

    Returns
    -------
    xarray.Dataset
        Along ``sample``, of size 1: ``marker_displacement(sample, time, marker, axis)`` and ``position(sample, time,
        body, axis)`` [m], inertial frame; ``orientation(sample, time, body, quaternion)``; ``status`` and ``reason``;
        ``end_time`` [s]; ``peak`` and ``residual(sample, frame, marker)`` [m], along x; ``peak_rotation(sample, body)``
        [rad]; the run's `joint_figures`, ``(sample, joint)`` or ``(sample)``; and the run's figures of its computation,
        ``energy_residual`` and ``numerics_*``. Attributes: the others of the run, and ``slab_marker``.
    """
    kept = run[["marker_displacement", "position", "orientation", *JOINT_FIGURES, *BLOW_FIGURES]]
    kept = kept.assign(peak_rotation=_peak_rotation(run["orientation"]))
    kept = kept.transpose("time", "marker", "body", "joint", "axis", "quaternion")
    ensemble = kept.expand_dims(sample=1).assign(_endings(run.attrs))
    ensemble.attrs = {
        **_common([run.attrs]),
        "Conventions": "CF-1.11",
        "title": "ensemble of simulated runs",
        "slab_marker": slab_marker,
    }
    return ensemble.assign(_extremes(ensemble))


def as_sample(alone, sample, values):
    """Ensemble of a `run_alone` as a sample: its row in the design, and its sampled values by dotted name, a Series.

    It has ``parameter_value(sample, parameter)``, in ``parameter_unit``.
    """
    names = [str(name) for name in values.index]
    index = xr.DataArray([sample], dims="sample", attrs={"long_name": "row of the sample in its design"})
    return alone.assign_coords(
        sample=index,
        parameter=("parameter", names, {"long_name": "dotted name of the parameter"}),
        parameter_unit=("parameter", [parameter_unit(name) for name in names], {"long_name": "its unit"}),
        parameter_value=(
            ("sample", "parameter"),
            values.to_numpy(dtype=float)[None],
            {"long_name": "sampled value, in parameter_unit"},
        ),
    )


def join_batches(batches, without=(), chosen=None):
    """Ensemble whose samples were gathered in several batches.

    Parameters
    ----------
    batches : sequence of xarray.Dataset or path
        From here or from `as_sample`, of one structure, motion, model and design.
    without : sequence of str
        Variables that are not read from files, such as `POSES`: half of what an ensemble holds.
    chosen : dict of str to list, optional
        Labels by dimension that alone are read from files, such as `ALONG_X` or some markers.

    Returns
    -------
    xarray.Dataset
        As from `as_sample`, samples rising; figures of the computation are NaN where a run has none. Attributes:
        those that all runs share.

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
        for name in ("time", "marker", "body", "joint", "parameter"):
            if not part[name].equals(parts[0][name]):
                sample = f"sample {int(part['sample'][0])}"
                raise InputError("ensemble", sample, f"expected the same '{name}' in all runs")
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


def figures_of_case(batches):
    """`sample_figures` of the samples in these files, whose histories are not read."""
    return sample_figures(join_batches(batches, (*POSES, "marker_displacement")))


def _peak_rotation(orientation):
    """Largest angle between each body's orientation and that at the start."""
    turned = np.abs((orientation * orientation.isel(time=0, drop=True)).sum("quaternion", skipna=False))
    angle = (2.0 * np.arccos(np.minimum(turned, 1.0))).max("time")
    angle.attrs = {"long_name": "largest rotation since the start", "units": "rad"}
    return angle.reset_coords(drop=True)


def _endings(attributes):
    """How a run ended and the figures of its computation, along ``sample``."""
    endings = {
        name: ("sample", [str(attributes.get(name, ""))], {"long_name": long_name})
        for name, long_name in (("status", "how the run ended"), ("reason", "why the run ended so"))
    }
    for name in sorted(filter(_is_figure, attributes)):
        endings[name] = ("sample", [float(attributes[name])], {"long_name": name.replace("_", " ")})
    end = float(attributes["end_time"])
    return endings | {"end_time": ("sample", [end], {"long_name": "time reached", "units": "s"})}


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


def relative_to_slab(displacement, slab_marker):
    """Displacement of every marker minus that of the slab's marker, along the inertial axes [m]."""
    relative = displacement - displacement.sel(marker=slab_marker, drop=True)
    relative.attrs = {"long_name": "marker displacement relative to the slab's marker", "units": "m"}
    return relative


def moving_markers(ensemble):
    """Markers of an ensemble but that of the slab, a list of str."""
    slab = ensemble.attrs["slab_marker"]
    return [str(name) for name in ensemble["marker"].values if name != slab]


def block_curves(ensemble):
    """Displacement of `moving_markers` along x relative to the slab, float64 (n_samples, n_times, n_markers) [m]."""
    moved = ensemble["marker_displacement"].sel(axis="x", drop=True)
    along = relative_to_slab(moved, ensemble.attrs["slab_marker"])
    return along.sel(marker=moving_markers(ensemble)).transpose(..., "time", "marker").to_numpy()


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
        Long name and unit, by variable. ``NAME_interval``, where it is there, has the limits of ``NAME``.
    """
    for name, (long_name, units) in described.items():
        dataset[name].attrs = {"long_name": long_name, "units": units}
        if f"{name}_interval" in dataset:
            dataset[f"{name}_interval"].attrs = {"long_name": f"limits of the {long_name}", "units": units}


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
