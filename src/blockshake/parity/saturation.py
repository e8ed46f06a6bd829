"""Saturation: readings that stop at the end of a sensor's range."""

from typing import NamedTuple

import numpy as np

from blockshake.parity.finding import Finding

_LEVEL_WIDTH = 1e-6  # of the range: readings this near are the same
_EQUAL_READINGS_NEEDED = 4


class Saturation(NamedTuple):
    """Mask of the readings at the end of the range, shape (n_times,), and the chance of as many."""

    at_end: np.ndarray
    p: float


def saturated(values):
    """`Saturation`: readings at the end of the range, and the chance of as many in a sound record.

    Parameters
    ----------
    values : float64 array, shape (n_times,)
        NaN is a gap.

    Notes
    -----
    Beside a largest (or smallest) reading that is shared by neighbours each further one has the chance with which any
    reading repeats the one before, taken from the record itself below the plateau, so that coarse digits and a sensor
    at rest are no saturation. A limit that acts before the noise is added leaves no equal readings and is not seen.
    """
    known = np.isfinite(values)
    nothing = np.zeros(len(values), dtype=bool)
    if known.sum() < 10 * _EQUAL_READINGS_NEEDED:
        return Saturation(nothing, 1.0)
    width = _LEVEL_WIDTH * np.ptp(values[known])
    best, chance = nothing, 1.0
    for end in (values[known].max(), values[known].min()):
        at_end = known & (np.abs(values - end) <= width)
        together = (at_end[1:] & at_end[:-1]).sum()
        pairs = known[1:] & known[:-1] & ~(at_end[1:] | at_end[:-1])
        equal = (np.abs(np.diff(values)) <= width) & pairs
        rate = (equal.sum() + 1.0) / (pairs.sum() + 2.0)
        p = (
            min(1.0, known.sum() * rate ** (together - 1.0))
            if together >= _EQUAL_READINGS_NEEDED - 1 and width > 0.0
            else 1.0
        )
        if p < chance:
            best, chance = at_end, p
    return Saturation(best, chance)


def without_saturation(test, name, level, looked_at):
    """A test with saturated readings as gaps, and its findings.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign.
    name : str
        Of the test.
    level : float
        Of all hypotheses together.
    looked_at : int
        Number of columns of all tests, times two ends.
    """
    findings = []
    test = test.copy()
    for variable, dimension in (
        ("marker_displacement", "marker"),
        ("accelerometer", "channel"),
        ("transducer_displacement", "transducer"),
    ):
        if variable not in test:
            continue
        time = "time" if dimension == "marker" else "time_acc"
        values = test[variable].transpose(time, dimension, ...)
        array = values.to_numpy().copy()
        for index, where in enumerate(values[dimension].values):
            columns = array[:, index] if array.ndim == 3 else array[:, [index]]
            for column in range(columns.shape[1]):
                at_end, p = saturated(columns[:, column])
                if p * looked_at >= level:
                    continue
                largest = np.abs(columns[at_end, column]).max(keepdims=True)
                findings.append(Finding(
                    "sensor-saturation", (str(where),), "range", largest, np.zeros((1, 1)), p * looked_at, (name,),
                ))  # fmt: skip
                array[at_end, index] = np.nan
        test[variable] = values.copy(data=array)
    return test, findings
