"""The memory of the markers' noise, from what no rigid motion explains."""

import numpy as np

from blockshake.measurement.motion.body_frame import frames_of_bodies

_LARGEST = 0.95


def noise_memory(test, structure):
    """Correlation of neighbouring readings' noise.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    structure : Structure

    Returns
    -------
    float
        Median over the bodies with at least three markers that measure all directions, between 0 and 0.95; 0
        where there is none [1].
    """
    known = [
        _lag_one(frame.residual.reshape(len(test["time"]), -1))
        for _, frame in frames_of_bodies(test, structure)
    ]
    return float(np.clip(np.median(known), 0.0, _LARGEST)) if known else 0.0


def _lag_one(residual):
    """Correlation of a residual with the next one, over all columns; 0 of none."""
    residual = residual - np.nanmean(residual, axis=0)
    first, second = residual[:-1], residual[1:]
    both = np.isfinite(first) & np.isfinite(second)
    first, second = np.where(both, first, 0.0), np.where(both, second, 0.0)
    size = np.sqrt((first**2).sum() * (second**2).sum())
    return (first * second).sum() / size if size > 0.0 else 0.0
