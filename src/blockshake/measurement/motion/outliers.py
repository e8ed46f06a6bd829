"""Readings that stand alone from their neighbours, which no motion of a body explains."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_frame import outlying, see_from_body
from blockshake.measurement.sensors.markers import whole_markers

_FEWEST = 3  # markers of a body, that one of them can be told to be wrong


def without_outliers(test, structure):
    """The test with lone wrong readings of markers as gaps, on bodies with three markers that measure all directions.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    structure : Structure

    Returns
    -------
    xarray.Dataset
    """
    read, whole = [str(name) for name in test["marker"].values], whole_markers(test)
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    values = displacement.to_numpy().copy()
    for index, body in enumerate(structure.body_names):
        own = [marker for marker in structure.file.markers if marker.body == body and marker.name in whole]
        if len(own) < _FEWEST:
            continue
        columns = [read.index(marker.name) for marker in own]
        points = structure.arms(own)
        start = rotation_matrices(structure.orientation[index])
        places = structure.position[index] + points @ start.T
        frame = see_from_body(points, places + values[:, columns], structure.position[index], start)
        for column, wrong in zip(columns, outlying(frame.residual).T, strict=True):
            values[wrong, column] = np.nan
    return test.assign(marker_displacement=displacement.copy(data=values))
