"""Envelopes: what an ensemble says of the displacement at each time."""

import numpy as np
import xarray as xr

from blockshake.study.ensemble import in_frames

COUNTED = ("completed", "collapsed")  # a run that the solver could not finish is no prediction
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
BOUNDS = {"lower": 0.0, "upper": 1.0}


def counted_samples(ensemble):
    """The samples that enter statistics: completed or collapsed runs."""
    return ensemble.isel(sample=np.isin(ensemble["status"].values, COUNTED))


def envelope(ensemble):
    """Bounds and quantiles of an ensemble over its samples.

    Parameters
    ----------
    ensemble : xarray.Dataset
        From `gather_ensemble`.

    Returns
    -------
    xarray.Dataset
        ``marker_envelope(frame, bound, time, marker, axis)`` [m]: the smallest and the largest
        displacement at each time, coordinate ``bound`` lower and upper;
        ``marker_displacement(frame, quantile, time, marker, axis)`` [m]; ``peak`` and
        ``residual(quantile, frame, marker)`` [m]; ``peak_rotation(quantile, body)`` [rad];
        ``contributing(time)``: samples with a value at that time. NaN where none has. Attributes
        ``samples`` and ``counted``: how many runs there were and how many enter.

    Notes
    -----
    Quantiles interpolate linearly between ordered values (Hyndman and Fan 1996, type 7) of the
    samples that have a value: after a collapse cut a run short, those of the others. The peak of a
    collapsed run is what it had reached, so that upper quantiles of the peak are then lower limits.
    The band from lower to upper of n runs holds a further run at one instant with
    probability (n - 1) / (n + 1); it has no stated probability for a whole record.
    """
    counted = counted_samples(ensemble)
    displacement = in_frames(counted["marker_displacement"], ensemble.attrs["slab_marker"])
    probabilities = xr.DataArray(list(QUANTILES), dims="quantile", coords={"quantile": list(QUANTILES)})
    bounds = xr.DataArray(list(BOUNDS.values()), dims="bound", coords={"bound": list(BOUNDS)})
    result = xr.Dataset(
        {
            "marker_envelope": over_samples(displacement, bounds),
            "marker_displacement": over_samples(displacement, probabilities),
            "peak": over_samples(counted["peak"], probabilities),
            "residual": over_samples(counted["residual"], probabilities),
            "peak_rotation": over_samples(counted["peak_rotation"], probabilities),
            "contributing": counted["marker_displacement"].notnull().all(("marker", "axis")).sum("sample"),
        }
    ).transpose("frame", "bound", "quantile", "time", "marker", "body", "axis")
    result["marker_envelope"].attrs = {
        "long_name": "smallest and largest marker displacement over the samples",
        "units": "m",
    }
    result["marker_displacement"].attrs = {"long_name": "marker displacement since the start", "units": "m"}
    for name in ("peak", "residual", "peak_rotation"):
        result[name].attrs = dict(ensemble[name].attrs)
    result["contributing"].attrs = {"long_name": "samples with a value at this time", "units": "1"}
    result["quantile"].attrs = {"long_name": "probability of a smaller value", "units": "1"}
    result["bound"].attrs = {"long_name": "edge of the envelope"}
    result.attrs = {
        **ensemble.attrs,
        "title": "envelope of an ensemble of simulated runs",
        "samples": ensemble.sizes["sample"],
        "counted": counted.sizes["sample"],
    }
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
    ordered = np.sort(rest.to_numpy(), axis=0)  # NaN last
    count = np.isfinite(ordered).sum(axis=0)
    rows = []
    for probability in probabilities.to_numpy():
        if len(ordered) == 0:
            rows.append(np.full(ordered.shape[1:], np.nan))
            continue
        place = probability * np.maximum(count - 1, 0)
        below = np.floor(place).astype(np.int64)
        above = np.minimum(below + 1, np.maximum(count - 1, 0))
        low = np.take_along_axis(ordered, below[None], axis=0)[0]
        high = np.take_along_axis(ordered, above[None], axis=0)[0]
        rows.append(low + (place - below) * (high - low))
    dims = (*probabilities.dims, *rest.dims[1:])
    coordinates = {name: rest.coords[name] for name in rest.dims[1:] if name in rest.coords}
    return xr.DataArray(np.stack(rows), dims=dims, coords={**probabilities.coords, **coordinates})
