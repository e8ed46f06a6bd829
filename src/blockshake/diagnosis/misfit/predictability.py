"""How long a test can be predicted: the spread of twin simulations that start apart by less than sensors resolve."""

import numpy as np

_TOLD_APART_BY = 3.0  # standard deviations of a reading that twins must be apart to be told apart
_SHARE_OF_MOTION = 0.3  # of the farthest that a cell has moved until then


def horizons(twins, noise):
    """Time until which each cell of a test can be predicted.

    Parameters
    ----------
    twins : xarray.DataArray, (run, time, cell)
        Cells of nominal draw 0 and of its twins, from `as_cells`; all with the same noise of the sensors.
    noise : xarray.DataArray, (cell,)
        Standard deviation of a reading.

    Returns
    -------
    float64 array, shape (n_cells,)
        [s]; the end of the twins where they stay together.

    Notes
    -----
    The horizon is the first time at which the standard deviation over the twins is above three standard deviations of
    a reading, so that they can be told apart, and above 0.3 of the farthest that draw 0 has moved until then, so that
    it matters. Twins of which one has ended are told apart.
    """
    time, values = twins["time"].to_numpy(), twins.transpose("run", "time", "cell").to_numpy()
    moved = np.maximum.accumulate(np.nan_to_num(np.abs(values[0])), axis=0)
    limit = np.maximum(_SHARE_OF_MOTION * moved, _TOLD_APART_BY * noise.to_numpy())
    known = np.isfinite(values)
    started, going = np.logical_or.accumulate(known, axis=1), known[:, ::-1]
    going = np.logical_or.accumulate(going, axis=1)[:, ::-1]
    parted = (started & ~going).any(axis=0)
    whole = known.all(axis=0)
    spread = np.where(whole, values, 0.0).std(axis=0, ddof=1)
    parted |= whole & (spread > limit)
    return np.where(parted.any(axis=0), time[parted.argmax(axis=0)], time[-1])
