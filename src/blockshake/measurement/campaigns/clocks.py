"""One clock for a test: the recorder's is set by the slab's motion, and all times count from the command's start."""

from typing import NamedTuple

import numpy as np
import scipy

from blockshake.dynamics.records.times import last_digit
from blockshake.measurement.sensors.accelerometers import shaken_channels
from blockshake.measurement.sensors.markers import slab_displacement

_FOLLOWS = 0.8  # correlation; of 150 pairs of other motions 3 % reach it at some start
_COARSE = 0.02  # s, between the starts that are tried: a tenth of a period of 5 Hz
_SPAN = 0.06  # s, over which velocities are means: half a period of 8 Hz, some 20 Hz and more hardly pass
# s, by which an even clock may err as written: in five digits, in 32 bits, or in seconds since 1970
_EVEN = 1e-5
LACKING = 1.5  # usual steps, beyond which a clock lacks a row
_DIGITS = 9  # of a time after the decimal point: nanoseconds
_RATE = 100.0  # Hz, at which recorder and optical system are compared
BAND = (1.0, 8.0)  # Hz, where a table's motion is well above the noise of both instruments
SHORTEST = 3.0  # s, of both records together
RELATED = 0.8  # correlation, that instruments of one slab have
AS_GOOD = 0.01  # of correlation, by which another lag may fall short: two standard errors in noise of a fifth
_NEAR = 0.1  # s: smaller lags are found by the parity checks, as the fault `clock-lag`


class Start(NamedTuple):
    """Start of the command [s], and the correlation of a motion with the command from then on, of either sign [1]."""

    time: float
    correlation: float

    @property
    def related(self):
        """Whether the motion is that of the command, or its opposite."""
        return abs(self.correlation) > _FOLLOWS


def command_start(time, moved, command):
    """`Start` of the command on the clock of a motion: where the correlation of their velocities is largest in size.

    Parameters
    ----------
    time, moved : float64 arrays, shape (n_times,)
        Displacement of the slab along an axis; NaN is a gap [s, m].
    command : GroundMotion
        Commanded along x; the table rests before its first row and after its last.

    Notes
    -----
    Velocities are means over 60 ms. Displacements would not do: the slow lobes of most pairs of earthquakes can be laid
    over each other. A table that is late by the phase of its control starts late.
    """
    known = np.isfinite(moved)
    grid = np.arange(time[0], time[-1] - _SPAN, _COARSE)
    if known.sum() < 2 or len(grid) < 2:
        return Start(0.0, 0.0)
    read = np.diff(np.interp([grid, grid + _SPAN], time[known], moved[known]), axis=0)[0]
    read -= read.mean()
    rows = np.arange(0.0, command.duration + _COARSE, _COARSE)
    displacement = command.evaluate(rows)[:, 0]

    def correlation(signal):
        gained = signal(grid + _SPAN) - signal(grid)
        gained = gained - gained.mean()
        size = np.sqrt((gained @ gained) * (read @ read))
        return gained @ read / size if size > 0.0 else 0.0

    # the first reading is tried first: where no start is better than another, it stays
    starts = np.concatenate([[0.0], np.arange(time[0] - command.duration, time[-1], _COARSE)])
    tried = [
        correlation(lambda at, start=start: np.interp(at - start, rows, displacement)) for start in starts
    ]
    best = starts[int(np.abs(tried).argmax())]

    def exactly(start):
        return correlation(lambda at: command.evaluate(at - start)[:, 0])

    start = scipy.optimize.minimize_scalar(
        lambda start: -abs(exactly(start)), bounds=(best - _COARSE, best + _COARSE), method="bounded",
        options={"xatol": 1e-6},
    ).x  # fmt: skip
    return Start(float(start), float(exactly(start)))


def missing_rows(time):
    """Number of rows that a clock (n_times,) lacks between each one and the next, int64 (n_times - 1,)."""
    steps = np.diff(time)
    # the mean, because 2, 2, 2, 1 ms are printed steps of 1.95 ms; steps of 2 and 3 ms are of one clock
    rows = steps / steps[steps <= 1.01 * LACKING * np.median(steps)].mean()
    return np.where(rows > LACKING, np.rint(rows) - 1, 0).astype(np.int64)


def from_first_reading(test):
    """The test with all its times counted from the markers' first reading, whatever its clock showed then.

    Rows that a clock lacks become gaps of all its readings. A clock that is even but for the digits it was written with
    becomes even, at the rate of fewest decimals.
    """
    zero = float(test["time"][0])
    for name in _clocks(test):
        time = test[name].to_numpy()
        rows = np.concatenate([[0], np.cumsum(missing_rows(time) + 1)])
        whole = np.interp(np.arange(rows[-1] + 1), rows, time)
        test = _at_times(test.reindex({name: whole}), name, _even(whole - zero, last_digit(time)))
    return test


def from_command(test, structure, command):
    """The test with all its times counted from the start of the command.

    Parameters
    ----------
    test : xarray.Dataset
        From `from_first_reading`.
    structure : Structure
    command : GroundMotion or None
        None where it is not at hand.

    Returns
    -------
    xarray.Dataset
        Attribute ``follows`` is 1, and ``correlation`` that of the velocities. Where the slab does not follow the
        command along x, ``follows`` is 0 and times count from the markers' first reading.
    """
    start = Start(0.0, 0.0)
    if command is not None:
        start = command_start(test["time"].to_numpy(), slab_displacement(test, structure)[:, 0], command)
    follows = start.related and start.correlation > 0.0
    zero = round(start.time, 6) if follows else 0.0
    return since(test, zero, -np.inf).assign_attrs(follows=int(follows), correlation=start.correlation)


def simulation_start(time):
    """Time of a test at which its simulation starts: its last reading before the command, so that both share readings.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        Times of the markers, from the start of the command on [s].

    Returns
    -------
    float
        Between a step before the command and the command; also where the first reading comes later [s].
    """
    if time[0] <= 0.0:
        return float(time[time <= 0.0][-1])
    step = float(np.median(np.diff(time)))
    return float(time[0] - step * np.ceil(time[0] / step))


def reading_rate(time):
    """Readings in a second of a clock (n_times,) [s], rows that it lacks counted as if they were there [Hz]."""
    length = time[-1] - time[0]
    return float(round(np.rint(length / np.median(np.diff(time))) / length, 6))


def since(test, zero, first=0.0):
    """The test with times that count from ``zero``, without readings before the new time ``first`` [s]."""
    for name in _clocks(test):
        time = np.round(test[name].to_numpy() - zero, _DIGITS)
        test = _at_times(test, name, time).isel({name: np.flatnonzero(time >= first)})
    return test


def _clocks(test):
    return [name for name in ("time", "time_acc") if name in test.coords]


def _at_times(test, clock, time):
    return test.assign_coords({clock: (clock, time, test[clock].attrs)})


def _even(time, digit):
    """Times (n_times,) of the even grid within 10 us of all or, else, within half of their last digit; or as they are.

    The grid has the rate of fewest decimals, and starts as near to the first time as it can.
    """
    rows = np.arange(len(time))
    mean = (time[-1] - time[0]) / rows[-1]
    if digit > 2.0 * _EVEN:
        time = np.round(time, 6)  # multiples of the digit again, whatever zero was taken off
    for width in sorted({2.0 * _EVEN, max(2.0 * _EVEN, 1.001 * digit)}):
        reach = width / rows[-1]
        step = scipy.optimize.minimize_scalar(
            lambda step: np.ptp(time - step * rows), bounds=(mean - reach, mean + reach), method="bounded",
            options={"xatol": 1e-6 * reach / len(rows)},
        ).x  # fmt: skip
        for decimals in range(_DIGITS):
            even = rows / (round(1.0 / step, decimals) or 1.0)
            earliest, latest = (time - even).max() - width / 2.0, (time - even).min() + width / 2.0
            if earliest <= latest:
                return np.round(even + np.clip(round(float(time[0]), 6), earliest, latest), _DIGITS)
    return np.round(time, _DIGITS)


def on_one_clock(test, structure):
    """The test with the recorder's times moved to where the slab's accelerometer reads what its markers do.

    The attribute ``recorder_late`` states by how much the times were too late [s], where they were moved. The test
    stays as it was read where the slab has no accelerometer along x, and where both agree within 0.1 s already, or at
    no lag.

    Notes
    -----
    Second differences of the slab's displacement and the channel are compared in 1 to 8 Hz at all lags that leave 3 s
    of both, by their correlation in size.
    """
    records = _slab_records(test, structure)
    if records is None:
        return test
    lag, correlation, near = _best_lag(*records)
    if correlation < RELATED or near >= RELATED:
        return test
    late = test["time_acc"] - lag
    return test.assign_coords(time_acc=late).assign_attrs(recorder_late=float(lag))


def agreement_words(test, structure):
    """Words on what to add to the recorder's times for the slab's sensors to agree; none where they do not tell it."""
    records = _slab_records(test, structure)
    summits = [] if records is None else correlation_summits(*correlations_by_lag(*records))
    best = max(summits, key=lambda summit: abs(summit[1]), default=(0.0, 0.0))
    if abs(best[1]) < RELATED:
        return ""
    others = [one for one in summits if one is not best and abs(one[1]) > abs(best[1]) - AS_GOOD]
    return f"; the slab's sensors agree with {-best[0]:.3f} s added to it" + (
        f", but {other_lags(best, others)}" if others else ""
    )


def _slab_records(test, structure):
    """Acceleration of the slab along x by its markers, to a factor, and by its channels, in `BAND` at 100 Hz.

    The first time of the one less that of the other comes with them [s]. None of a slab without a channel, and of
    records that are short or mostly lost.
    """
    channels = shaken_channels(test, structure)
    if not channels:
        return None
    time, time_acc = test["time"].to_numpy(), test["time_acc"].to_numpy()
    read = (
        test["accelerometer"].sel(channel=channels).transpose("time_acc", "channel").to_numpy().mean(axis=1)
    )
    moved = _band(time, slab_displacement(test, structure)[:, 0])
    felt = _band(time_acc, read)
    if moved is None or felt is None:
        return None
    return np.gradient(np.gradient(moved)), felt, time[0] - time_acc[0]


def correlations_by_lag(moved, felt, apart, rate=_RATE):
    """Correlation of two records at every lag that leaves 3 s of both.

    Parameters
    ----------
    moved, felt : float64 arrays, shape (n_moved,) and (n_felt,)
        Acceleration of the slab by its markers, and as the recorder has it, both in `BAND`; of any size.
    apart : float
        First time of ``moved`` less that of ``felt`` [s].
    rate : float
        Sampling rate of both records [Hz].

    Returns
    -------
    lags, correlation : float64 arrays, shape (n_lags,)
        By how much the recorder's times are too late [s]; correlation then, -1 to 1, and 0 at lags that leave less.
    """
    products = scipy.signal.correlate(felt, moved, mode="full")
    ones = (
        scipy.signal.correlate(felt**2, np.ones(len(moved)), mode="full"),
        scipy.signal.correlate(np.ones(len(felt)), moved**2, mode="full"),
    )
    both = scipy.signal.correlate(np.ones(len(felt)), np.ones(len(moved)), mode="full")
    size = np.sqrt(np.maximum(ones[0] * ones[1], np.finfo(float).tiny))
    # a few strong cycles may lie within a short overlap: the energy outside of it counts as unexplained
    size = np.maximum(size, 0.5 * np.sqrt((felt @ felt) * (moved @ moved)))
    correlation = np.where(np.rint(both) >= int(SHORTEST * rate), products / size, 0.0)
    return (np.arange(len(products)) - (len(moved) - 1)) / rate - apart, correlation


def _best_lag(moved, felt, apart):
    """Lag of the recorder's clock [s], the correlation there in size, and the largest one within 0.1 s."""
    lags, correlation = correlations_by_lag(moved, felt, apart)
    correlation = np.abs(correlation)
    best = int(correlation.argmax())
    near = correlation[np.abs(lags) <= _NEAR].max(initial=0.0)
    return lags[best], float(correlation[best]), float(near)


def correlation_summits(lags, correlation):
    """Lag [s] and correlation of every summit in size, and of no end, finer than the lags by a parabola."""
    size = np.abs(correlation)
    rows = 1 + np.flatnonzero(
        (size[1:-1] >= size[:-2]) & (size[1:-1] > size[2:]) & (size[:-2] > 0.0) & (size[2:] > 0.0)
    )
    found = []
    for row in rows:
        before, here, after = correlation[row - 1 : row + 2]
        place = 0.5 * (before - after) / (before - 2.0 * here + after)
        found.append((lags[row] + place * (lags[1] - lags[0]), here - 0.25 * (before - after) * place))
    return found


def other_lags(best, others):
    """Words on other lags that are about as good, (lag, correlation) each."""
    near = min(others, key=lambda peak: abs(peak[0] - best[0]))
    sign = ", with the sign reversed" if near[1] * best[1] < 0.0 else ""
    count = f"{len(others)} other lags are" if len(others) > 1 else "another lag is"
    return f"{count} about as good, the nearest {seconds(abs(near[0] - best[0]))} from it{sign}"


def seconds(size):
    """A time of at most a minute in words, to a tenth of a millisecond."""
    return f"{1e3 * size:.3g} ms" if size < 1.0 else f"{size:.4g} s"


def _band(time, values):
    """Values at the common rate in the band; None of a record that is short or mostly lost."""
    known = np.isfinite(values)
    if known.mean() < 0.5 or time[-1] - time[0] < SHORTEST:
        return None
    grid = np.arange(time[0], time[-1], 1.0 / _RATE)
    return in_band(np.interp(grid, time[known], values[known]), _RATE)


def in_band(values, rate):
    """Values (n_times,) without gaps, at a rate [Hz], in `BAND` alone and without lag."""
    sections = scipy.signal.butter(4, BAND, btype="bandpass", fs=rate, output="sos")
    return scipy.signal.sosfiltfilt(sections, values - values.mean())
