"""When a simulation of a measured test is started again: while all is quiet, and where rocking turns."""

import numpy as np

from blockshake.diagnosis.excursions import turning_points
from blockshake.diagnosis.phases import TURN_NOISE, known_values

_EVERY = 0.25  # s, where nothing turns
_REST = 0.02  # of the base's peak acceleration
_MOST = 18  # of a test: of more, as many spread evenly


def restart_instants(histories, length):
    """Readings at which windows begin.

    Parameters
    ----------
    histories : xarray.Dataset
        From `joint_histories`.
    length : float
        Of a window [s].

    Returns
    -------
    int64 array
        Increasing; the window ends before the test does. Turning points of the joint that rotates most, where
        velocities are small and poses known best; and where none is within a quarter second, every quarter second,
        as long as the base moves in the window.
    """
    time = histories["time"].to_numpy()
    step = float(np.median(np.diff(time)))
    last = len(time) - 1 - int(np.ceil(length / step))
    turns = _turns(histories)
    apart = max(round(_EVERY / step), 1)
    grid = [
        place
        for place in range(apart, last + 1, apart)
        if not len(turns) or np.abs(turns - place).min() >= apart
    ]
    size = np.abs(histories["acceleration"].to_numpy())
    moving = size > _REST * size.max()
    n_window = round(length / step)
    grid = [place for place in grid if moving[place : place + n_window + 1].any()]
    every = np.unique(np.concatenate([turns[turns <= last], np.array(grid, dtype=np.int64)]))
    kept = np.linspace(0, len(every) - 1, min(len(every), _MOST)).round().astype(np.int64)
    return every[kept].astype(np.int64)


def _turns(histories):
    """Turning points of the rotation of the joint that rotates most beyond its noise."""
    rotation = histories["rotation"].sel(axis="y").transpose("time", "joint").to_numpy()
    noise = histories["rotation_noise"].sel(axis="y").to_numpy()
    size = np.array([np.sqrt(np.mean(known_values(column) ** 2)) for column in rotation.T]) / noise
    size[~np.isfinite(size)] = 0.0
    if not size.any():
        return np.empty(0, dtype=np.int64)
    most = int(np.argmax(size))
    return turning_points(known_values(rotation[:, most]), TURN_NOISE * noise[most])
