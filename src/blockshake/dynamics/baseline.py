"""Baseline correction of a recorded acceleration, so that its integrals stay bounded."""

import numpy as np
from scipy import fft

from blockshake.errors import InputError

CORNER_FREQUENCY = 0.1  # Hz; below it analogue records hold more noise than ground motion
_ORDER = 4  # of the Butterworth filter, applied forwards and backwards
_MOST_SAMPLES = 2e7  # a minute at 1 kHz has 180 000 with its pads at 0.1 Hz
_TAPERED = 0.02  # share of the record under the half-cosine at each end


def correct_baseline(acceleration, time_step, corner_frequency=CORNER_FREQUENCY):
    """Acceleration without drift: its velocity and displacement end at zero.

    Parameters
    ----------
    acceleration : float64 array, shape (n_rows,)
        Uniform samples, at least two [any unit].
    time_step : float
        [s]
    corner_frequency : float
        Of the high-pass filter, where half the amplitude is left [Hz].

    Returns
    -------
    float64 array, shape (n_rows,)
        The same samples corrected, in the same unit. Integrated as linear between rows from
        rest, they end with zero velocity and displacement to rounding.

    Notes
    -----
    The steps that Boore and Bommer (2005), Processing of strong-motion accelerograms, Soil Dyn. Earthq. Eng. 25,
    describe, with the compatible ending of Paolucci et al. (2011), Record processing in ITACA: subtract the mean; taper
    both ends by half-cosines over 2 % of the record; pad with zeros for ``1.5 order / corner`` at each end; high-pass
    by a fourth-order Butterworth filter in both directions (no phase shift, amplitude ``1 / (1 + (corner / f)^8)``);
    strip the pads. The pads' content would leave an end velocity and offset; the one linear function of time that
    cancels both is subtracted from the acceleration (a parabola in velocity). Choices of ours: the mean is of the whole
    record, because triggered analogue records have no quiet start; the corner is one for all records.
    """
    filtered = high_pass(taper_ends(acceleration - np.mean(acceleration)), time_step, corner_frequency)
    return close_integrals(filtered, time_step)


def check_samples(n_rows, time_step, corner_frequency, where):
    """Refuse a series that the correction would pad beyond what a computer holds.

    Raises
    ------
    InputError
        More than 20 million samples with the pads.
    """
    samples = n_rows + 2.0 * _pad(time_step, corner_frequency)
    if not samples <= _MOST_SAMPLES:
        raise InputError(
            where,
            "",
            f"expected at most {_MOST_SAMPLES:g} samples in a corrected record with its pads, not {samples:.3g}; the "
            f"time step is {time_step:g} s, the corner {corner_frequency:g} Hz",
        )


def correction_words(corner_frequency):
    """The steps of `correct_baseline` in words, for the attributes of a motion."""
    return (
        f"mean removed, ends tapered, Butterworth high-pass at {corner_frequency:g} Hz both ways, "
        "linear acceleration removed for zero end velocity and displacement"
    )


def taper_ends(values):
    """Values under a half-cosine rise and fall over 2 % of their number at each end."""
    count = max(1, round(_TAPERED * len(values)))
    rise = 0.5 * (1.0 - np.cos(np.pi * np.arange(count) / count))
    tapered = np.array(values, dtype=float)
    tapered[:count] *= rise
    tapered[-count:] *= rise[::-1]
    return tapered


def high_pass(values, time_step, corner_frequency):
    """Acausal fourth-order Butterworth high-pass of a zero-padded series, pads stripped."""
    pad = int(_pad(time_step, corner_frequency))
    length = fft.next_fast_len(len(values) + 2 * pad, real=True)
    frequency = fft.rfftfreq(length, time_step)
    power = (frequency / corner_frequency) ** (2 * _ORDER)
    padded = fft.irfft(fft.rfft(values, length) * power / (1.0 + power), length)
    return padded[: len(values)]


def _pad(time_step, corner_frequency):
    with np.errstate(over="ignore"):
        return np.ceil(1.5 * _ORDER / np.float64(corner_frequency) / time_step)


def close_integrals(acceleration, time_step):
    """Subtract the linear function of time that leaves no end velocity and no end displacement."""
    velocity, displacement = end_of_motion(acceleration, time_step)
    duration = time_step * (len(acceleration) - 1)
    # a0 T + a1 T^2 / 2 = velocity and a0 T^2 / 2 + a1 T^3 / 6 = displacement
    slope = (6.0 * velocity * duration - 12.0 * displacement) / duration**3
    offset = velocity / duration - slope * duration / 2.0
    return acceleration - (offset + slope * time_step * np.arange(len(acceleration)))


def end_of_motion(acceleration, time_step):
    """End velocity and displacement of an acceleration that is linear between rows, from rest."""
    before, after = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate([[0.0], np.cumsum(time_step * (before + after) / 2.0)])
    moved = time_step * velocity[:-1] + time_step**2 * (2.0 * before + after) / 6.0
    return float(velocity[-1]), float(np.sum(moved))
