"""Envelopes: what an ensemble states of the displacement at each time."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import FALLEN, FINISHED
from blockshake.files import history
from blockshake.geometry.structure import load_structure
from blockshake.simulation.run_histories import JOINT_FIGURES
from blockshake.statistics.intervals import CONFIDENCE, quantile_interval, sample_quantiles, share_interval
from blockshake.study.ensembles.drift_limits import drift_limits
from blockshake.study.ensembles.ensemble import POSES, describe, in_frames, join_batches

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
BOUNDS = {"lower": 0.0, "upper": 1.0}
STILL = 1e-3  # m, of a displacement that counts as none
_LAST, _RESTLESS = 1.0, 0.05  # s of a curve's end, and share of its peak by which it still moves then
_NOISE = 6.0  # standard deviations between the largest and the smallest of two hundred readings
_MOST = 0.5  # of the samples, from which on a block counts as moving
_AT_HAND = 2**25  # displacements read from files at a time: 256 MiB
_SINGLE = ("peak", "residual", "peak_rotation", *JOINT_FIGURES)  # numbers of a sample
_DESCRIBED = {
    "marker_envelope": ("smallest and largest marker displacement over the samples", "m"),
    "marker_displacement": ("marker displacement since the start", "m"),
    "contributing": ("samples with a value at this time", "1"),
    "still_moving": ("share of the samples with a residual that still move along x in the last second", "1"),
    "quantile": ("probability of a smaller value", "1"),
}


def counted_samples(ensemble):
    """The samples that enter statistics: runs that completed, collapsed or still fell as the window ended."""
    return ensemble.isel(sample=np.isin(ensemble["status"].values, FINISHED))


def still_moves(along, peak, noise=0.0):
    """Whether curves along x over ``time``, xarray.DataArray [m], change in their last second beyond their noise.

    By more than 1 mm and a 20th of their ``peak`` [m], and what ``noise`` of this standard deviation adds [m].
    """
    late = along.sel(time=slice(float(along["time"][-1]) - _LAST, None))
    return late.max("time") - late.min("time") > np.maximum(STILL, _RESTLESS * peak) + _NOISE * noise


def is_moving(envelope, marker):
    """Whether a marker still moves at the end of the window in half of the samples of an `envelope` or more."""
    return bool(envelope["still_moving"].sel(marker=marker) >= _MOST)


def envelope_of_case(batches, largest_drift, structure):
    """`envelope` of the samples in these files, whose histories are read some markers at a time.

    ``largest_drift``: of `drift_limits` of the ``structure``, which is what `load_structure` takes.
    """
    structure = load_structure(structure)
    markers = structure.file.markers
    of_markers = drift_limits(structure, largest_drift)[structure.carriers(markers)]
    limits = {one.name: limit for one, limit in zip(markers, of_markers, strict=True)}
    ensemble = join_batches(batches, (*POSES, "marker_displacement"))

    def displacement(markers):
        return join_batches(batches, POSES, {"marker": markers})["marker_displacement"]

    return envelope(ensemble, [limits[str(name)] for name in ensemble["marker"].values], displacement)


def envelope(ensemble, largest_drift, displacement=None):
    """Bounds and quantiles of an ensemble over its samples.

    Parameters
    ----------
    ensemble : xarray.Dataset
        From `join_batches`.
    largest_drift : float64 array, shape (n_markers,) or ()
        Displacement along x relative to the slab whose exceedance is counted [m]; NaN for none.
    displacement : callable, optional
        Gives ``marker_displacement`` of all samples for a list of markers; by default the ensemble's.

    Returns
    -------
    xarray.Dataset
        ``marker_envelope(frame, bound, time, marker, axis)`` [m]: the smallest and the largest displacement at each
        time, coordinate ``bound`` lower and upper; ``marker_displacement(frame, quantile, time, marker, axis)`` [m];
        ``peak`` and ``residual(quantile, frame, marker)`` [m]; ``peak_rotation(quantile, body)`` [rad];
        `joint_figures` of joints ``(quantile, joint)``;
        ``contributing(time)``: samples with a value at that time; ``still_moving(marker)``: share of those with a
        residual of which `still_moves` holds relative to the slab; ``collapse_probability`` and
        ``drift_probability(marker)`` [1] with its ``largest_drift(marker)`` [m]. NaN where no sample has a value. The
        statistics of single numbers have their 95 % limits with them, ``NAME_interval(bound, ...)``, those of
        quantiles NaN of too few samples (`quantile_ranks`). Attributes ``samples`` and ``counted``: how many runs there
        were and how many enter.

    Notes
    -----
    Quantiles interpolate linearly between ordered values (Hyndman and Fan 1996, type 7) of the samples that have a
    value: after a collapse cut a run short, those of the others. The peak of a collapsed run is what it had reached, so
    that upper quantiles of the peak are then lower limits. The band from lower to upper of n runs holds a further run
    at one instant with probability (n - 1) / (n + 1); it has no stated probability for a whole record. A run that still
    falls as the window ends counts as a collapse, and a collapse as a drift beyond the limit. Failed runs are in no
    statistic; the limits of the probabilities hold that all of them fell and that none did.
    """
    counted = counted_samples(ensemble)
    probabilities = xr.DataArray(list(QUANTILES), dims="quantile", coords={"quantile": list(QUANTILES)})
    bounds = xr.DataArray(list(BOUNDS.values()), dims="bound", coords={"bound": list(BOUNDS)})
    read = displacement or (lambda markers: ensemble["marker_displacement"].sel(marker=markers))
    edges, quantiles, moving, known = _over_markers(counted, read, bounds, probabilities)
    result = xr.Dataset(
        {
            "marker_envelope": edges,
            "marker_displacement": quantiles,
            "contributing": known.sum("sample"),
            "still_moving": moving,
        }
    ).transpose("frame", "bound", "quantile", "time", "marker", "axis")
    singles = single_figures(ensemble, largest_drift)
    result = result.merge(singles)
    describe(result, _DESCRIBED)
    result["bound"].attrs = {"long_name": "edge of the envelope"}
    result.attrs = {
        **singles.attrs,
        "title": "envelope of an ensemble of simulated runs",
        "history": history(
            ensemble.attrs.get("history"), f"study: envelope of {ensemble.sizes['sample']} samples"
        ),
    }
    return result


def single_figures(ensemble, largest_drift):
    """The part of an `envelope` that needs no history: statistics of single numbers, with their limits.

    ``ensemble``: all samples, or those of one level, from `join_batches` or `sample_figures`.
    """
    counted = counted_samples(ensemble)
    probabilities = xr.DataArray(list(QUANTILES), dims="quantile", coords={"quantile": list(QUANTILES)})
    failed = ensemble.sizes["sample"] - counted.sizes["sample"]
    result = (
        xr.Dataset({name: over_samples(counted[name], probabilities) for name in _SINGLE})
        .transpose("frame", "quantile", "marker", "body", "joint")
        .assign_coords(bound=list(BOUNDS))
        .merge(_probabilities(counted, failed, largest_drift))
        .merge(_intervals(counted, probabilities))
    )
    for name in _SINGLE:
        result[name].attrs = {**ensemble[name].attrs, "ancillary_variables": f"{name}_interval"}
    numbers = {"samples": ensemble.sizes["sample"], "counted": counted.sizes["sample"]}
    result.attrs = {**ensemble.attrs, **numbers, "confidence": CONFIDENCE}
    return result


def _over_markers(counted, displacement, bounds, probabilities):
    """Bounds and quantiles of the displacement of every marker in both frames, the share of the samples that still
    move, and which samples have a value when.

    As many markers are read at a time as `_AT_HAND` allows, and one is worked on.
    """
    slab, markers = counted.attrs["slab_marker"], counted["marker"].values
    edges, quantiles, moving, known = [], [], [], True
    count = max(1, _AT_HAND // (3 * counted.sizes["time"] * max(1, counted.sizes["sample"])))
    for first in range(0, len(markers), count):
        group = markers[first : first + count]
        read = displacement(list(dict.fromkeys([*group, slab]))).sel(sample=counted["sample"].values)
        for marker in group:
            pair = read.sel(marker=list(dict.fromkeys([marker, slab])))
            known = pair.sel(marker=marker, drop=True).notnull().all("axis") & known
            both = in_frames(pair, slab).sel(marker=[marker])
            of_slab, peak = (one.sel(frame="slab", drop=True) for one in (both, counted["peak"]))
            moves = still_moves(of_slab.sel(axis="x", drop=True), peak.sel(marker=[marker]))
            ended = counted["residual"].sel(frame="slab", marker=[marker], drop=True).notnull()
            moving.append(moves.where(ended).mean("sample"))
            edges.append(over_samples(both, bounds))
            quantiles.append(over_samples(both, probabilities))
    return *(xr.concat(one, dim="marker") for one in (edges, quantiles, moving)), known


def _probabilities(counted, failed, largest_drift):
    """Shares of the samples that fell and that drifted too far, with limits for whatever the ``failed`` ones did."""
    fell = np.isin(counted["status"].values, FALLEN)
    peak = counted["peak"].sel(frame="slab", drop=True).transpose("sample", "marker").to_numpy()
    largest_drift = np.broadcast_to(np.asarray(largest_drift, dtype=float), peak.shape[1])
    counts = np.array([fell.sum(), *(fell[:, None] | (peak > largest_drift)).sum(axis=0)])
    size = len(fell)
    share = counts / size if size else np.full(len(counts), np.nan)
    limits = np.array([share_interval(int(count), size, failed) for count in counts]).T
    result = xr.Dataset(
        {
            "collapse_probability": ((), share[0]),
            "collapse_probability_interval": ("bound", limits[:, 0]),
            "drift_probability": ("marker", share[1:]),
            "drift_probability_interval": (("bound", "marker"), limits[:, 1:]),
            "largest_drift": ("marker", largest_drift),
        }
    )
    what = {
        "collapse": "collapse, or the fall that leads to it as the window ends",
        "drift": "a displacement along x of more than largest_drift from the slab",
    }
    for name, event in what.items():
        describe(result, {f"{name}_probability": (f"share of the samples with {event}", "1")})
        result[f"{name}_probability"].attrs["ancillary_variables"] = f"{name}_probability_interval"
    describe(result, {"largest_drift": ("displacement that counts as a potential collapse", "m")})
    return result


def _intervals(counted, probabilities):
    """Limits of the quantiles of single numbers."""
    result = xr.Dataset()
    for name in _SINGLE:
        values = counted[name].transpose("sample", ...)
        limits = quantile_interval(values.to_numpy(), probabilities.to_numpy())
        words = f"limits by order statistics of the quantiles of {name.replace('_', ' ')}"
        attributes = {"long_name": words, "units": counted[name].attrs["units"]}
        result[f"{name}_interval"] = (("bound", "quantile", *values.dims[1:]), limits, attributes)
    return result


def over_samples(values, probabilities):
    """Quantiles over ``sample`` of the values that are there.

    Parameters
    ----------
    values : xarray.DataArray
        With dimension ``sample``; NaN is no value.
    probabilities : xarray.DataArray, one dimension
        In [0, 1]; 0 is the smallest, 1 the largest value.

    Returns
    -------
    xarray.DataArray
        Dimension of ``probabilities`` in place of ``sample``; NaN where no sample has a value.
    """
    rest = values.transpose("sample", ...)
    quantiles = sample_quantiles(rest.to_numpy(), probabilities.to_numpy())
    dims = (*probabilities.dims, *rest.dims[1:])
    coordinates = {name: rest.coords[name] for name in rest.dims[1:] if name in rest.coords}
    return xr.DataArray(quantiles, dims=dims, coords={**probabilities.coords, **coordinates})
