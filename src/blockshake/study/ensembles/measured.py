"""Measured curves beside an ensemble: in its frames and window, and at its times."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.measurement.motion.compared_curves import SAME_TIME, curves_along_x
from blockshake.measurement.sensors.markers import noisy_reading
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW, in_frames, peak_and_residual
from blockshake.study.ensembles.envelope import counted_samples


class ComparedCurves(NamedTuple):
    """Measured and simulated displacement along x at the same times, inertial frame [m].

    Attributes
    ----------
    measured : xarray.DataArray, (time, marker)
    members : xarray.Dataset
        Completed and collapsed samples of the ensemble.
    curves, readings : float64 arrays, shape (n_samples, n_times, n_markers)
        Of the members, and the same with a marker's noise.
    """

    measured: xr.DataArray
    members: xr.Dataset
    curves: np.ndarray
    readings: np.ndarray


def compared_curves(measured, ensemble, marker_noise, seed):
    """`ComparedCurves` of a measured test and of an ensemble, the ensemble's read with noise too.

    Parameters
    ----------
    measured : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], inertial frame, relative to the first reading; NaN is a
        gap. Its clock is the ensemble's, its times need not be.
    ensemble : xarray.Dataset
        From `gather_ensemble`.
    marker_noise : float
        Standard deviation of a measured marker's position [m].
    seed : int
        Of the noise that the members are read with.

    Raises
    ------
    InputError
        No marker or no time in common.
    """
    members = counted_samples(ensemble)
    read, curves = curves_along_x(measured, members)
    curves, generator = curves.to_numpy(), np.random.default_rng(seed)
    readings = [noisy_reading(curve, marker_noise, generator) for curve in curves]
    readings = np.reshape(readings, curves.shape)
    return ComparedCurves(read, members, curves, readings)


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
