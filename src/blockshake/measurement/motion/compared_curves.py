"""Measured and simulated curves side by side: same markers, same times."""

import numpy as np

from blockshake.errors import InputError

_SAME_TIME = 1e-6  # s


def curves_along_x(measured, members):
    """Displacement along x of the markers that both have, inertial frame, as far as both go.

    Parameters
    ----------
    measured : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], relative to the first reading.
    members : xarray.Dataset
        From `gather_ensemble`.

    Returns
    -------
    read, curves : xarray.DataArray, (time, marker) and (sample, time, marker)
        [m]

    Raises
    ------
    InputError
        No marker in common, or other times.
    """
    markers = [name for name in measured["marker"].values if name in members["marker"].values]
    if not markers:
        raise InputError("coverage", "marker", "expected a measured marker that the simulation has too")
    n_times = common_times(measured["time"].to_numpy(), members["time"].to_numpy())
    return _along_x(measured, markers, n_times), _along_x(members, markers, n_times)


def common_times(measured, simulated):
    """Number of leading times that both have; InputError where they differ by more than 1 microsecond."""
    n_times = min(len(measured), len(simulated))
    if n_times == 0 or np.abs(measured[:n_times] - simulated[:n_times]).max() > _SAME_TIME:
        raise InputError("curves", "time", "expected measured times that are the ensemble's output times")
    return n_times


def _along_x(dataset, markers, n_times):
    chosen = dataset["marker_displacement"].sel(axis="x", marker=markers, drop=True)
    return chosen.isel(time=slice(n_times)).transpose(..., "time", "marker")
