"""The noise of a test's channels in its quiet start, held against what the campaign states."""

import numpy as np

from blockshake.errors import InputError

_FACTOR = 2.0  # between the noise found and the noise stated
_FEWEST = 10  # readings of a quiet start
# Readings in millimetres are a thousand times as noisy; no optical system has 1 mm, and no stated noise is a
# hundred times too small by mistake.
_OTHER_UNIT = 100.0
_WORST_MARKER = 1e-3  # m
_MANY = 3  # names that a remark spells out
NORMAL = 0.6745  # of a standard deviation is the median size of a normal deviate


def marker_noise(readings):
    """Standard deviation of each marker's readings [m], (n_markers,), from the differences of neighbours.

    No slow motion enters. ``readings`` (n_times, n_markers, 3) of the quiet start [m], gaps are NaN; NaN where there
    are too few. Displacement transducers read one direction: (n_times, n_transducers, 1).
    """
    steps = np.diff(readings, axis=0)
    known = np.isfinite(steps)
    count = known.sum(axis=(0, 2))
    total = np.where(known, steps, 0.0) ** 2
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count >= _FEWEST, np.sqrt(total.sum(axis=(0, 2)) / count / 2.0), np.nan)


def rounding_noise(readings):
    """Standard deviation of the rounding of each marker's readings [m], (n_markers,): of their last digit over root 12.

    The last digit is the least change of the readings (n_times, n_markers, 3) over a whole test [m]. Noise far below
    it does not show at rest.
    """
    steps = np.abs(np.diff(readings, axis=0))
    digit = np.where(steps > 0.0, steps, np.inf).min(axis=(0, 2))
    return np.where(np.isfinite(digit), digit, 0.0) / np.sqrt(12.0)


def check_unit(names, noise, stated, path):
    """Refuse markers and transducers with the noise of readings in millimetres, the only trace where nothing moves.

    Raises
    ------
    InputError
        A noise beyond 1 mm and beyond a hundred times the stated one.
    """
    for name, size in zip(names, noise, strict=True):
        if size > max(_WORST_MARKER, _OTHER_UNIT * stated):
            wrong = f"expected metres; its noise at rest, {size:.3g}, is far beyond the stated {stated:g} m"
            raise InputError(path, str(name), wrong)


def displacement_remarks(what, names, noise, stated):
    """Remarks on markers or displacement transducers whose noise is beyond twice, or below half, the stated one."""
    wrong = (noise > _FACTOR * stated) | (noise < stated / _FACTOR)
    return _remark(what, names, noise, wrong, 1e3, "mm", stated)


def accelerometer_noise(readings):
    """Lower and upper bound of each channel's noise.

    Parameters
    ----------
    readings : float64 array, shape (n_times, n_channels)
        Accelerations of the quiet start [m/s2]; gaps are NaN.

    Returns
    -------
    fast, whole : float64 arrays, shape (n_channels,)
        From the median size of neighbours' differences, which neither motion nor a thump enters but a filtered
        noise enters in part; and the standard deviation, with all motion in it [m/s2]. NaN where readings are few.
    """
    fast, whole = np.full((2, readings.shape[1]), np.nan)
    for channel, values in enumerate(readings.T):
        steps = np.diff(values)
        steps = steps[np.isfinite(steps)]
        if len(steps) >= _FEWEST:
            fast[channel] = np.median(np.abs(steps)) / NORMAL / np.sqrt(2.0)
            whole[channel] = np.nanstd(values)
    return fast, whole


def accelerometer_remarks(names, fast, whole, stated):
    """Remarks on channels whose noise must be beyond twice, or below half, the stated one."""
    noisy = _remark("accelerometer", names, fast, fast > _FACTOR * stated, 1.0, "m/s2", stated)
    return noisy + _remark("accelerometer", names, whole, whole < stated / _FACTOR, 1.0, "m/s2", stated)


def _remark(what, names, noise, wrong, factor, unit, stated):
    """One remark that names the channels, unless all are meant; none where nothing is wrong."""
    if not wrong.any():
        return []
    size = f"{factor * noise[wrong].min():.3g}"
    largest = f"{factor * noise[wrong].max():.3g}"
    size += f" to {largest}" if largest != size else ""
    shown = [str(name) for name in np.asarray(names)[wrong]]
    of = "" if len(shown) == len(noise) else f" of {', '.join(shown[:_MANY])}"
    of += f" and {len(shown) - _MANY} more" if of and len(shown) > _MANY else ""
    return [f"{what} noise{of} found {size} {unit}, stated {factor * stated:.3g} {unit}"]
