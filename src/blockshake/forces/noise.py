"""The memory of the markers' noise, from what no rigid motion explains."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_frame import see_from_body
from blockshake.measurement.sensors.markers import whole_markers

_FEWEST = 3  # markers on a body, that their residuals show noise
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
    read, whole = [str(name) for name in test["marker"].values], whole_markers(test)
    displacement = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()
    found = []
    for index, body in enumerate(structure.body_names):
        own = [marker for marker in structure.file.markers if marker.body == body and marker.name in whole]
        if len(own) < _FEWEST:
            continue
        points, start = structure.arms(own), rotation_matrices(structure.orientation[index])
        places = structure.position[index] + points @ start.T
        columns = [read.index(marker.name) for marker in own]
        frame = see_from_body(points, places + displacement[:, columns], structure.position[index], start)
        found.append(_lag_one(frame.residual.reshape(len(displacement), -1)))
    return float(np.clip(np.nanmedian(found), 0.0, _LARGEST)) if found else 0.0


def _lag_one(residual):
    """Correlation of a residual with the next one, over all columns."""
    residual = residual - np.nanmean(residual, axis=0)
    first, second = residual[:-1], residual[1:]
    both = np.isfinite(first) & np.isfinite(second)
    one, two = np.where(both, first, 0.0), np.where(both, second, 0.0)
    size = np.sqrt((one**2).sum() * (two**2).sum())
    return (one * two).sum() / size if size > 0.0 else 0.0
