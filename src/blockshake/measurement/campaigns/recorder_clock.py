"""The recorder's clock against the optical one: accelerometers that count from another zero are moved onto it."""

import numpy as np
from scipy.signal import butter, correlate, sosfiltfilt

from blockshake.measurement.sensors.markers import slab_displacement

_RATE = 100.0  # Hz, at which both are compared
BAND = (1.0, 8.0)  # Hz, where a table's motion is well above the noise of both instruments
SHORTEST = 3.0  # s, of both records together
RELATED = 0.8  # correlation, that instruments of one slab have
_NEAR = 0.1  # s: smaller lags are found by the parity checks, as the fault `clock-lag`


def on_one_clock(test, structure):
    """The test with the recorder's times moved to where the slab's accelerometer reads what its markers do.

    Parameters
    ----------
    test : xarray.Dataset
        As read.
    structure : Structure

    Returns
    -------
    xarray.Dataset
        Attribute ``recorder_late``: by how much the recorder's times were too late [s], where they were moved. As it is
        where the slab has no accelerometer along x, where both agree within 0.1 s already, or at no lag.

    Notes
    -----
    Second differences of the slab's displacement and the channel are compared in 1 to 8 Hz at all lags that leave 3 s
    of both, by their correlation in size.
    """
    driven = {body.name for body in structure.file.bodies if body.driven}
    own = [f"{item.name}-x" for item in structure.file.accelerometers if item.body in driven]
    if "accelerometer" not in test or not set(own) & set(test["channel"].values):
        return test
    own = [name for name in own if name in test["channel"].values]
    time, time_acc = test["time"].to_numpy(), test["time_acc"].to_numpy()
    read = test["accelerometer"].sel(channel=own).transpose("time_acc", "channel").to_numpy().mean(axis=1)
    moved = _band(time, slab_displacement(test, structure)[:, 0])
    felt = _band(time_acc, read)
    if moved is None or felt is None:
        return test
    moved = np.gradient(np.gradient(moved))
    lag, found, near = _best_lag(moved, felt, time[0] - time_acc[0])
    if found < RELATED or near >= RELATED:
        return test
    late = test["time_acc"] - lag
    return test.assign_coords(time_acc=late).assign_attrs(recorder_late=float(lag))


def _best_lag(moved, felt, apart):
    """Lag of the recorder's clock [s], the correlation there, and the largest one within 0.1 s."""
    fewest = int(SHORTEST * _RATE)
    products = np.abs(correlate(felt, moved, mode="full"))
    ones = (
        correlate(felt**2, np.ones(len(moved)), mode="full"),
        correlate(np.ones(len(felt)), moved**2, mode="full"),
    )
    both = correlate(np.ones(len(felt)), np.ones(len(moved)), mode="full")
    size = np.sqrt(np.maximum(ones[0] * ones[1], np.finfo(float).tiny))
    # a few strong cycles may lie within a short overlap: the energy outside of it counts as unexplained
    size = np.maximum(size, 0.5 * np.sqrt((felt @ felt) * (moved @ moved)))
    correlation = np.where(np.rint(both) >= fewest, products / size, 0.0)
    lags = (np.arange(len(products)) - (len(moved) - 1)) / _RATE - apart
    best = int(correlation.argmax())
    near = correlation[np.abs(lags) <= _NEAR].max(initial=0.0)
    return lags[best], float(correlation[best]), float(near)


def _band(time, values):
    """Values at the common rate in the band; None of a record that is short or mostly lost."""
    known = np.isfinite(values)
    if known.mean() < 0.5 or time[-1] - time[0] < SHORTEST:
        return None
    grid = np.arange(time[0], time[-1], 1.0 / _RATE)
    sections = butter(4, BAND, btype="bandpass", fs=_RATE, output="sos")
    whole = np.interp(grid, time[known], values[known])
    return sosfiltfilt(sections, whole - whole.mean())
