"""A local origin for formats of 32 bits, which are 0.25 m coarse in a surveyor's coordinates."""

import numpy as np

_FARTHEST = 100.0  # m: coordinates of 32 bits within this are exact to 4 micrometres


def local_origin(run):
    """Place that exports of a run in 32 bits count from, float64 (3,) [m].

    It is the middle of the mass centres at the start, in whole metres, along every axis on which one of them lies more
    than 100 m from the origin; else 0.
    """
    start = run["position"].isel(time=0).to_numpy()
    middle = np.round(0.5 * (start.min(axis=0) + start.max(axis=0)))
    return np.where(np.abs(start).max(axis=0) > _FARTHEST, middle, 0.0)
