"""The noise of marker readings, given to simulated curves that are held against measured ones."""

import numpy as np


def noisy_reading(displacement, marker_noise, generator):
    """Displacement as read by markers with noise, relative to the first reading.

    Parameters
    ----------
    displacement : float64 array, shape (n_times, ...)
        True, since the first time [m]; NaN stays.
    marker_noise : float
        Standard deviation of the position read, independent in time, marker and axis [m].
    generator : numpy.random.Generator
        Source of the noise; advanced.

    Returns
    -------
    float64 array, same shape
        Zero at the first time: the first reading's own error is in all the others.
    """
    position = displacement + generator.normal(0.0, marker_noise, size=np.shape(displacement))
    return position - position[:1]
