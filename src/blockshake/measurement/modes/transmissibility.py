"""Answers to a sine: amplitude and phase of every marker over the base's, and how much is at its multiples.

In the steady state every linear channel moves at the drive's frequency; its complex amplitude over the base's is
the frequency response there. For one mass on a spring that is, in absolute terms, (1 + 2 i z r) / (1 - r^2 + 2 i z
r), r the ratio of drive to natural frequency and z the damping ratio (A. K. Chopra, Dynamics of Structures, on
transmissibility).
"""

from itertools import pairwise

import numpy as np
import xarray as xr
from scipy.optimize import minimize_scalar

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.modes.channel_histories import marker_histories

WHERE = "transmissibility"
_STEADY = 0.9  # of the base's amplitude, from where on it counts as full
_SETTLING = 1.0 / 3.0  # of the time at full amplitude, in which the structure's own motion dies
PIECES = 8  # whose scatter gives the errors
_CYCLES = 2  # at least, in each piece
_MULTIPLES = 3  # of the drive's frequency that are fitted
_OVER_NOISE = 10.0  # of the base's amplitude over its error


def transmissibility(test, structure, frequency=None, axis="x"):
    """Steady answer of every marker to a sine of the base.

    Parameters
    ----------
    test : xarray.Dataset
        Of `read_test`, or a run file.
    structure : Structure
    frequency : float, optional
        Of the drive [Hz]; found in the base's motion by default.
    axis : str
        Along which the base moves.

    Returns
    -------
    xarray.Dataset
        ``drive_frequency`` [Hz], ``base_amplitude`` [m]; over ``marker, axis``: ``amplitude``, the absolute
        displacement's over the base's [1], ``phase``, by which it is ahead [rad], their standard errors from the
        scatter of eight pieces (so of seven degrees of freedom), and ``distortion``, the amplitude at twice and
        three times the frequency over that at it [1]. NaN for channels left out.

    Raises
    ------
    InputError
        No reading of the base along the axis, fewer than 16 cycles to read, or an amplitude at the noise.

    Notes
    -----
    Least squares of sines and cosines at the drive's frequency and its multiples with a linear trend, over pieces of
    whole cycles; the first third of the time at full amplitude is left for the structure's own motion to die.
    """
    markers = marker_histories(test, structure)
    base, _ = markers.base(axis)
    if base is None:
        raise InputError(
            WHERE, "marker", f"expected a marker of the driven body with whole readings along {axis}"
        )
    time = markers.time - markers.time[0]
    frequency = _drive(time, base) if frequency is None else float(frequency)
    pieces = _pieces(time, base, frequency)
    moved = np.array([_amplitudes(time[piece], base[piece, None], frequency)[0, 0] for piece in pieces])
    answered = np.array([_amplitudes(time[piece], markers.values[piece], frequency)[0] for piece in pieces])
    scatter = np.abs(moved - moved.mean()).std() / np.sqrt(len(pieces))
    if not np.abs(moved.mean()) > _OVER_NOISE * scatter:
        raise InputError(
            WHERE, "amplitude", f"expected a sine that rises over the noise at {frequency:.4g} Hz"
        )
    ratio = (moved.conj() @ answered) / (np.abs(moved) ** 2).sum()
    apart = answered / moved[:, None] / np.where(ratio == 0.0, 1.0, ratio) - 1.0
    share = np.sqrt(len(pieces) * (len(pieces) - 1))
    amplitude_error = np.abs(ratio) * np.sqrt((apart.real**2).sum(axis=0)) / share
    phase_error = np.sqrt((apart.imag**2).sum(axis=0)) / share
    whole = slice(pieces[0].start, pieces[-1].stop)
    every = _amplitudes(time[whole], markers.values[whole], frequency)
    distortion = np.sqrt((np.abs(every[1:]) ** 2).sum(axis=0)) / np.maximum(np.abs(every[0]), 1e-300)
    columns = {
        "amplitude": (np.abs(ratio), "1", "displacement over the base's"),
        "amplitude_error": (amplitude_error, "1", "standard error"),
        "phase": (np.angle(ratio), "rad", "ahead of the base"),
        "phase_error": (phase_error, "rad", "standard error"),
        "distortion": (distortion, "1", "amplitude at twice and three times the frequency over that at it"),
    }
    names = [str(name) for name in test["marker"].values]
    rows = [names.index(marker) for marker, _ in markers.names]
    places = [AXES.index(own) for _, own in markers.names]
    variables = {
        "drive_frequency": ((), frequency, {"units": "Hz"}),
        "base_amplitude": ((), float(np.abs(moved.mean())), {"units": "m"}),
    }
    for name, (values, units, words) in columns.items():
        table = np.full((len(names), 3), np.nan)
        table[rows, places] = values
        variables[name] = (("marker", "axis"), table, {"units": units, "long_name": words})
    return xr.Dataset(
        variables, {"marker": names, "axis": list(AXES)}, {"left_out": ", ".join(markers.left_out)}
    )


def _amplitudes(time, values, frequency):
    """Complex amplitudes at the frequency and its multiples, (_MULTIPLES, n_channels), of ``Re(A exp(i w t))``."""
    angles = 2.0 * np.pi * frequency * np.outer(time, np.arange(1, _MULTIPLES + 1))
    trend = np.stack([np.ones_like(time), time - time.mean()], axis=1)
    found = np.linalg.lstsq(np.hstack([np.cos(angles), np.sin(angles), trend]), values, rcond=None)[0]
    return found[:_MULTIPLES] - 1j * found[_MULTIPLES : 2 * _MULTIPLES]


def _drive(time, base):
    """Frequency whose sine leaves least of the base's motion."""
    spacing = 1.0 / (time[-1] - time[0])
    spectrum = np.abs(np.fft.rfft((base - base.mean()) * np.hanning(len(base))))
    peak = max(int(np.argmax(spectrum[1:])) + 1, 2) * spacing

    def left(frequency):
        phase = np.exp(-2j * np.pi * frequency * time)
        return -np.abs((phase * (base - base.mean()) * np.hanning(len(base))).sum())

    return float(
        minimize_scalar(
            left, bounds=(peak - spacing, peak + spacing), method="bounded", options={"xatol": 1e-7}
        ).x
    )


def _pieces(time, base, frequency):
    """Slices of whole cycles at full amplitude, after settling."""
    step = time[1] - time[0]
    cycle = 1.0 / (frequency * step)
    turned = np.exp(-2j * np.pi * frequency * time) * (base - base.mean())
    window = max(round(cycle), 1)
    envelope = 2.0 * np.abs(np.convolve(turned, np.ones(window) / window, mode="same"))
    full = np.flatnonzero(envelope > _STEADY * np.median(envelope[envelope > 0.5 * envelope.max()]))
    begin, end = full[0] + _SETTLING * (full[-1] - full[0]), full[-1] + 1
    cycles = int((end - begin) / cycle / PIECES)
    if cycles < _CYCLES:
        found, least = (end - begin) / cycle, PIECES * _CYCLES
        raise InputError(
            WHERE,
            "time",
            f"expected {least} cycles or more at full amplitude after settling, not {found:.0f}",
        )
    edges = np.round(begin + cycles * cycle * np.arange(PIECES + 1)).astype(int)
    return [slice(one, two) for one, two in pairwise(edges)]
