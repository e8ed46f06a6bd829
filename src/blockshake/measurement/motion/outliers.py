"""Readings that stand alone from their neighbours, which no motion of a body explains."""

from blockshake.measurement.motion.body_frame import frames_of_bodies, outlying


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
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    values = displacement.to_numpy().copy()
    for columns, frame in frames_of_bodies(test, structure):
        for column, wrong in zip(columns, outlying(frame.residual).T, strict=True):
            values[wrong, column] = float("nan")
    return test.assign(marker_displacement=displacement.copy(data=values))
