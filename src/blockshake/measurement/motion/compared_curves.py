"""Measured and simulated curves side by side: same markers, same times."""

import numpy as np

from blockshake.errors import InputError

SAME_TIME = 1e-6  # s


def curves_along_x(measured, members):
    """Displacement along x of the markers that both have, inertial frame, at the measured times that both span.

    Parameters
    ----------
    measured : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], relative to the first reading; at any times of the members'
        clock.
    members : xarray.Dataset
        From `join_batches`.

    Returns
    -------
    read, curves : xarray.DataArray, (time, marker) and (sample, time, marker)
        [m]

    Raises
    ------
    InputError
        No marker in common, or fewer than two times.
    """
    markers = [name for name in measured["marker"].values if name in members["marker"].values]
    if not markers:
        raise InputError("coverage", "marker", "expected a measured marker that the simulation has too")
    time = members["time"].to_numpy()
    instants = measured["time"].to_numpy()
    inside = (instants >= time[0] - SAME_TIME) & (instants <= time[-1] + SAME_TIME)
    if inside.sum() < 2:
        raise InputError("curves", "time", "expected measured times within the ensemble's")
    read, curves = _along_x(measured, markers).isel(time=inside), _along_x(members, markers)
    values = at_times(curves.to_numpy(), time, instants[inside])
    other = {name: coordinate for name, coordinate in curves.coords.items() if "time" not in coordinate.dims}
    return read, read.expand_dims(sample=members.sizes["sample"]).copy(data=values).assign_coords(other)


def at_times(curves, time, instants):
    """Curves at other times, each by the cubic through the four values around it.

    Parameters
    ----------
    curves : float64 array, shape (..., n_times, n_markers)
        NaN, as after the end of a run, spreads to what it is needed for.
    time : float64 array, shape (n_times,)
        Uniform; at least four [s].
    instants : float64 array, shape (n_asked,)
        Within ``time`` [s].
    """
    step = (instants - time[0]) / (time[1] - time[0])
    nearest = np.rint(step).astype(int)
    if np.abs(step - nearest).max() * (time[1] - time[0]) < SAME_TIME:
        return curves[..., nearest, :]
    first = np.clip(np.floor(step).astype(int) - 1, 0, len(time) - 4)
    values = np.zeros((*curves.shape[:-2], len(instants), curves.shape[-1]))
    for node in range(4):
        weight = np.ones(len(instants))
        for other in range(4):
            if other != node:
                weight *= (step - first - other) / (node - other)
        values += weight[:, None] * curves[..., first + node, :]
    return values


def _along_x(dataset, markers):
    chosen = dataset["marker_displacement"].sel(axis="x", marker=markers, drop=True)
    return chosen.transpose(..., "time", "marker")
