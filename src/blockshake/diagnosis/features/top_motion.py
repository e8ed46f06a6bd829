"""Motion of the top body: mean square by frequency band, and delay against the lowest body."""

from typing import NamedTuple

import numpy as np


def band_levels(time, values, noise, bands):
    """Mean square of a history in frequency bands over that of the noise, as ln(1 + ratio).

    Parameters
    ----------
    time, values : float64 arrays, shape (n_times,)
        Uniform times [s]; finite values.
    noise : float
        Standard deviation of a value, white.
    bands : sequence of (low, high)
        [Hz]

    Returns
    -------
    float64 array, shape (n_bands,)
        0 where there is nothing.

    Notes
    -----
    One Hann-windowed periodogram, scaled so that a sine of amplitude A well inside a band has A^2 / 2 there; white
    noise has 2 noise^2 (high - low) / rate.
    """
    step = (time[-1] - time[0]) / (len(time) - 1)
    window = np.hanning(len(values) + 2)[1:-1]
    power = np.abs(np.fft.rfft(window * (values - values.mean()))) ** 2
    power *= 2.0 / (len(values) * (window**2).sum())
    frequency = np.fft.rfftfreq(len(values), step)
    levels = []
    for low, high in bands:
        of_noise = 2.0 * noise**2 * (high - low) * step
        levels.append(power[(frequency >= low) & (frequency < high)].sum() / of_noise)
    return np.log1p(np.array(levels))


class Delay(NamedTuple):
    """Lag [s] at which two histories correlate most, and that correlation [1]."""

    lag: float
    correlation: float


def delay(time, first, second, most=0.25):
    """`Delay` of the second history behind the first, arrays (n_times,) at uniform times, where they correlate most.

    Over lags up to ``most`` [s]; between readings by a parabola. Values are finite.
    """
    step = (time[-1] - time[0]) / (len(time) - 1)
    first, second = first - first.mean(), second - second.mean()
    size = np.sqrt((first**2).sum() * (second**2).sum())
    furthest = min(round(most / step), len(time) - 2)
    padded = 2 * len(time)
    product = np.fft.irfft(np.conj(np.fft.rfft(first, padded)) * np.fft.rfft(second, padded), padded) / size
    lags = np.arange(-furthest, furthest + 1)
    values = product[lags]
    best = int(np.argmax(values))
    lag, top = float(lags[best]), float(values[best])
    if 0 < best < len(values) - 1:
        before, after = values[best - 1], values[best + 1]
        bend = before - 2.0 * top + after
        if bend < 0.0:
            shift = 0.5 * (before - after) / bend
            lag, top = lag + shift, top - 0.25 * (before - after) * shift
    return Delay(lag * step, top)
