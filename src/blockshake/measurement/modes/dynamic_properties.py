"""Modes of a structure from a low-amplitude test with a broad-band base motion, measured or simulated.

By what method and why is said in `modal_fit`. A stack of rigid blocks in rigid contact has no mode; blocks on
elastic joints have. Only what noise cannot explain is called a mode.
"""

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.modes.channel_histories import accelerometer_histories, marker_histories
from blockshake.measurement.modes.frequency_response import local_response, spectra
from blockshake.measurement.modes.modal_fit import HEAVIEST, fit_modes
from blockshake.measurement.motion.base_motion import smoothed_base
from blockshake.measurement.sensors.accelerometers import CUTOFF

WHERE = "dynamic properties"
_LEAST = {"marker": 1e-6, "accelerometer": 1e-3}  # m, m/s2: below is no motion that a test could show
_FEWEST_BINS = 60  # of a usable spectrum, more than twice what a local fit shares
_OF_NYQUIST = 0.9
_BEYOND_CUTOFF = 1.2  # both base and answer pass the filter: their ratio holds while they rise over the noise


def modes_from_noise(test, structure, marker_noise, accelerometer_noise, axis="x", lowest=0.5):
    """Natural frequencies, damping ratios and shapes of the modes that a broad-band base motion excites.

    Parameters
    ----------
    test : xarray.Dataset
        Of `read_test`, or a run file; it begins at rest if accelerometers are read.
    structure : Structure
    marker_noise, accelerometer_noise : float
        Standard deviation of a reading [m, m/s2]; 0 for a run.
    axis : str
        Along which the base moves.
    lowest : float
        Frequency where the band begins [Hz].

    Returns
    -------
    xarray.Dataset
        Along ``mode``: ``frequency`` [Hz], ``damping_ratio`` [1], each with ``..._error``, and ``chance``, the decimal
        logarithm of the chance that noise explains as much. Over ``mode, marker, axis``: ``shape``, displacement
        relative to the base (along its axis; else absolute) over the largest, with ``shape_error`` at known poles, and
        ``coherence``; NaN for channels left out and modes beyond the markers' band. Attributes say the bands, what was
        left out, and the ``finding`` in words. Errors are of noise alone, one standard deviation.

    Raises
    ------
    InputError
        No reading of the base along the axis, a record too short, or a base that hardly rises over the noise.
    """
    if axis not in AXES or min(marker_noise, accelerometer_noise) < 0.0:
        raise InputError(WHERE, "axis, noise", "expected axis x, y or z and noise that is not negative")
    markers, channels = marker_histories(test, structure), accelerometer_histories(test, structure)
    base, n_base = markers.base(axis)
    if base is None:
        raise InputError(
            WHERE, "marker", f"expected a marker of the driven body with whole readings along {axis}"
        )
    base_error = marker_noise / np.sqrt(n_base)
    read, highest = {}, np.inf
    if channels is not None and channels.base(axis)[1]:
        table, n_table = channels.base(axis)
        error = accelerometer_noise / np.sqrt(n_table)
        read["accelerometer"] = _read(channels, table, axis, (lowest, _BEYOND_CUTOFF * CUTOFF), error)
        smooth = smoothed_base(
            markers.time, base, max(base_error, _LEAST["marker"]), channels.time, table,
            max(error, _LEAST["accelerometer"]),
        )  # fmt: skip
        base, base_error = smooth.displacement, 0.0
        known = read["accelerometer"].frequency
        highest = known[-1] if len(known) else lowest
    read["marker"] = _read(markers, base, axis, (lowest, highest), base_error)
    noise = {"marker": marker_noise, "accelerometer": accelerometer_noise}
    used = [name for name in read if len(read[name].frequency) >= _FEWEST_BINS]
    _check_used(used, markers, lowest)
    floors = [max(noise[name], _LEAST[name]) for name in used]
    modes = fit_modes([read[name] for name in used], floors)
    bands = {name: (read[name].frequency[0], read[name].frequency[-1]) for name in used}
    left_out = markers.left_out + (channels.left_out if channels is not None else [])
    shapes = _shapes(modes, used, markers, read["marker"], [str(name) for name in test["marker"].values])
    return _dataset(modes, shapes, bands, left_out)


def _read(histories, base, axis, band, base_error):
    """Spectra with what moves along the axis taken relative to the base."""
    along = np.array([name[1] == axis for name in histories.names])
    shared = -along.astype(float)
    if base_error > 0.0:  # the mean of the base's own channels shares their error
        shared[along & histories.driven] += 1.0
    rate = (len(histories.time) - 1) / (histories.time[-1] - histories.time[0])
    band = (band[0], min(band[1], _OF_NYQUIST * 0.5 * rate))
    values = histories.values - along * base[:, None]
    return spectra(histories.time, base, values, band, base_error**2, shared)


def _check_used(used, markers, lowest):
    if used:
        return
    duration = markers.time[-1] - markers.time[0]
    bins = duration * (_OF_NYQUIST * 0.5 * (len(markers.time) - 1) / duration - lowest)
    if bins < _FEWEST_BINS:
        raise InputError(
            WHERE, "time", f"expected a longer record; {duration:.3g} s resolve {max(bins, 0):.0f} lines"
        )
    raise InputError(
        WHERE, "amplitude",
        f"expected a base that rises over the noise on {_FEWEST_BINS} spectral lines or more: shake harder or longer",
    )  # fmt: skip


def _shapes(modes, used, markers, spectrum, names):
    """Shape, its error and coherence by marker and axis, as arrays by name."""
    shape, shape_error, coherence = (np.full((len(modes.frequency), len(names), 3), np.nan) for _ in range(3))
    if "marker" in used and len(modes.frequency):
        place = used.index("marker")
        residues, errors = modes.residues[place], modes.residue_errors[place]
        local = local_response(spectrum)
        rows = [names.index(marker) for marker, _ in markers.names]
        columns = [AXES.index(axis) for _, axis in markers.names]
        for mode, frequency in enumerate(modes.frequency):
            if not spectrum.frequency[0] <= frequency <= spectrum.frequency[-1]:
                continue
            largest = residues[mode][np.argmax(np.abs(residues[mode]))]
            shape[mode, rows, columns] = (residues[mode] / largest).real
            shape_error[mode, rows, columns] = errors[mode] / np.abs(largest)
            coherence[mode, rows, columns] = local.coherence[np.argmin(np.abs(local.frequency - frequency))]
    return {"names": names, "shape": shape, "shape_error": shape_error, "coherence": coherence}


def _dataset(modes, shapes, bands, left_out):
    n_modes = len(modes.frequency)
    highest = max(band[1] for band in bands.values())
    lowest = min(band[0] for band in bands.values())
    finding = f"no mode from {lowest:.3g} to {highest:.3g} Hz with a damping ratio below {HEAVIEST:g}"
    if n_modes:
        finding = f"{n_modes} modes from {lowest:.3g} to {highest:.3g} Hz"
    everywhere = ("mode", "marker", "axis")
    return xr.Dataset(
        {
            "frequency": ("mode", modes.frequency, {"units": "Hz", "long_name": "undamped natural frequency"}),
            "frequency_error": ("mode", modes.frequency_error, {"units": "Hz", "long_name": "standard error"}),
            "damping_ratio": ("mode", modes.damping, {"units": "1", "long_name": "ratio to critical damping"}),
            "damping_ratio_error": ("mode", modes.damping_error, {"units": "1", "long_name": "standard error"}),
            "chance": ("mode", modes.chance / np.log(10.0), {"units": "1", "long_name": "log10 chance from noise"}),
            "shape": (everywhere, shapes["shape"], {"units": "1", "long_name": "displacement over the largest"}),
            "shape_error": (everywhere, shapes["shape_error"], {"units": "1", "long_name": "standard error"}),
            "coherence": (everywhere, shapes["coherence"], {"units": "1", "long_name": "power that follows the base"}),
        },
        {"mode": np.arange(1, n_modes + 1), "marker": shapes["names"], "axis": list(AXES)},
        {
            "finding": finding,
            **{f"{name}_band_hz": [float(edge) for edge in band] for name, band in bands.items()},
            "left_out": ", ".join(left_out),
        },
    )  # fmt: skip
