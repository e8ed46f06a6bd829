"""Virtual tests: one simulated run seen through the measuring system, called synthetic wherever it shows."""

import numpy as np
import xarray as xr

_SHOWN = ("structure", "motion", "motion_scale", "motion_synthetic")


def noisy_reading(displacement, marker_noise, generator):
    """Displacement as read by markers with noise, relative to the first reading.

    Parameters
    ----------
    displacement : float64 array, shape (n_times, ...)
        True, since the first time [m]; NaN stays.
    marker_noise : float
        Standard deviation of the position read, independent in time, marker and axis [m].
    generator : numpy.random.Generator
        Source of the noise; advanced.

    Returns
    -------
    float64 array, same shape
        Zero at the first time: the first reading's own error is in all the others.
    """
    position = displacement + generator.normal(0.0, marker_noise, size=np.shape(displacement))
    return position - position[:1]


def virtual_test(run, seed, marker_noise=1e-4):
    """Synthetic measurement of one run.

    Parameters
    ----------
    run : xarray.Dataset
        A run file's content, with ``marker_displacement(time, marker, axis)``.
    seed : int
        Of the noise.
    marker_noise : float
        Standard deviation of a marker's position along an axis [m].

    Returns
    -------
    xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], inertial frame, relative to the first
        reading, as in a campaign's test file; attribute ``synthetic`` is 1. Of the run's
        attributes only what was commanded is kept: not the parameters, which are the truth to find.
    """
    true = run["marker_displacement"].transpose("time", "marker", "axis")
    read = noisy_reading(true.to_numpy(), marker_noise, np.random.default_rng(seed))
    measured = xr.DataArray(
        read,
        dims=true.dims,
        coords={name: true.coords[name] for name in true.dims},
        attrs={
            "long_name": "synthetic marker displacement since the first reading, inertial frame",
            "units": "m",
        },
    )
    return xr.Dataset(
        {"marker_displacement": measured},
        attrs={
            "Conventions": "CF-1.11",
            "title": "virtual test: synthetic, not measured",
            "synthetic": 1,
            "source": "one simulated run seen through its markers, with independent Gaussian noise on each "
            "reading",
            "marker_noise": float(marker_noise),
            "noise_seed": int(seed),
            **{name: run.attrs[name] for name in _SHOWN if name in run.attrs},
        },
    )
