"""Spectra of a response to its base, without leakage: responses, noise and coherence near every frequency."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.signal import detrend

_HALF_WIDTH = 12  # bins on each side that share one local quadratic: 25 complex readings, 19 to spare
_LEAST_POWER = 10.0  # of the base's spectrum over that of its error


@dataclass(frozen=True)
class Spectra:
    """Discrete Fourier transforms of one instrument's channels in a band, scaled so that noise keeps its variance.

    Attributes
    ----------
    frequency : float64 array, shape (n_bins,)
        [Hz]
    base : complex128 array, shape (n_bins,)
        Motion of the base.
    response : complex128 array, shape (n_bins, n_channels)
        Along the base's axis relative to it, else as read; same unit as the base.
    base_variance : float
        Variance of the base's reading error [unit squared].
    shared : float64 array, shape (n_channels,)
        Covariance of a channel's error with the base's, over `base_variance` [1].

    Notes
    -----
    A band ends where the base's motion no longer has ten times its error's power: beyond, what goes in is not known.
    """

    frequency: np.ndarray
    base: np.ndarray
    response: np.ndarray
    base_variance: float
    shared: np.ndarray


@dataclass(frozen=True)
class LocalResponse:
    """Frequency response from the neighbouring bins, at every `_HALF_WIDTH`-th bin.

    Attributes
    ----------
    frequency : float64 array, shape (n_centres,)
        [Hz]
    coherence : float64 array, shape (n_centres, n_channels)
        Share of a response's power that the base's motion explains and the record's ends do not, corrected for
        the number of coefficients [1].
    noise : float64 array, shape (n_centres, n_channels, n_channels)
        Covariance of what is left, real part [unit squared].
    """

    frequency: np.ndarray
    coherence: np.ndarray
    noise: np.ndarray


def spectra(time, base, response, band, base_variance, shared):
    """Transforms of evenly read histories without gaps.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        Even [s].
    base, response : float64 arrays, shapes (n_times,) and (n_times, n_channels)
    band : tuple of two floats
        Lowest and highest frequency that is kept [Hz].
    base_variance, shared
        As in `Spectra`.

    Returns
    -------
    Spectra
        Possibly of no bin.
    """
    step = (time[-1] - time[0]) / (len(time) - 1)
    frequency = np.fft.rfftfreq(len(time), step)
    kept = (frequency >= band[0]) & (frequency <= band[1]) & (frequency > 0.0)

    def transformed(values):
        return np.fft.rfft(detrend(values, axis=0), axis=0)[kept] / np.sqrt(len(time))

    moved, answered = transformed(base), transformed(response)
    # a window, so that what leaks from low frequencies does not pass for motion; sqrt(8/3) keeps noise's variance
    tapered = transformed(detrend(base) * np.hanning(len(time)) * np.sqrt(8.0 / 3.0))
    power = uniform_filter1d(np.abs(tapered) ** 2, 2 * _HALF_WIDTH + 1, mode="nearest")
    whole = _run_around_peak(power, _LEAST_POWER * base_variance)
    return Spectra(frequency[kept][whole], moved[whole], answered[whole], base_variance, np.asarray(shared))


def _run_around_peak(power, least):
    """Slice of the bins around the strongest that all have more than the least power."""
    if not len(power) or not power.max() > least:
        return slice(0, 0)
    weak = np.flatnonzero(power <= least)
    peak = int(np.argmax(power))
    begin = int(weak[weak < peak].max()) + 1 if (weak < peak).any() else 0
    end = int(weak[weak > peak].min()) if (weak > peak).any() else len(power)
    return slice(begin, end)


def local_response(read):
    """`LocalResponse`: responses fitted bin by bin by the local polynomial method.

    Parameters
    ----------
    read : Spectra
        Of at least ``2 * 12 + 1`` bins.

    Notes
    -----
    A record of finite length obeys exactly Y = G U + T, with T from the states at its two ends; G and T
    are smooth, so near a bin both are quadratics in the frequency, found by linear least squares, and what is left is
    noise (R. Pintelon, J. Schoukens, G. Vandersteen and K. Barbe 2010, Estimation of nonparametric noise and FRF models
    for multivariable systems, part I, Mech. Syst. Signal Process. 24, 573-595).
    """
    width = 2 * _HALF_WIDTH + 1
    centres = np.arange(_HALF_WIDTH, len(read.frequency) - _HALF_WIDTH, _HALF_WIDTH)
    place = np.arange(-_HALF_WIDTH, _HALF_WIDTH + 1) / _HALF_WIDTH
    powers = place[:, None] ** np.arange(3)
    coherence = np.empty((len(centres), read.response.shape[1]))
    noise = np.empty((len(centres), *2 * read.response.shape[1:]))
    for row, centre in enumerate(centres):
        near = slice(centre - _HALF_WIDTH, centre + _HALF_WIDTH + 1)
        base, response = read.base[near], read.response[near]
        regressors = np.hstack([powers * base[:, None], powers])
        found = np.linalg.lstsq(regressors, response, rcond=None)[0]
        left = response - regressors @ found
        noise[row] = (left.conj().T @ left).real / (width - 2 * powers.shape[1])
        ends = response - powers @ np.linalg.lstsq(powers, response, rcond=None)[0]
        total = (np.abs(ends) ** 2).sum(axis=0) / (width - powers.shape[1])
        share = np.divide(np.diagonal(noise[row]), total, out=np.ones_like(total), where=total > 0.0)
        coherence[row] = np.clip(1.0 - share, 0.0, 1.0)
    return LocalResponse(read.frequency[centres], coherence, noise)
