"""Baseline of a recorded acceleration: whether the record ends at rest, and a correction where it does not."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
import scipy
from pydantic import BeforeValidator, Field
from scipy import fft

from blockshake.dynamics.intensity import motion_figures
from blockshake.dynamics.motion import CHANNELS, PITCH, ground_motion
from blockshake.dynamics.quantisation import may_be_quantisation
from blockshake.errors import InputError
from blockshake.tables.numbers import plain_number
from blockshake.validation import Positive

AUTO, NONE = "auto", "none"
CORNER_FREQUENCY = 0.1  # Hz; below it analogue records hold more noise than ground motion
_HIGH = 1.0  # Hz; a corner above it reaches frequencies that move blocks
_ORDER = 2  # of the Butterworth filter, which is applied forwards and backwards
_MOST_SAMPLES = 2e7  # a minute at 1 kHz has 120 000 with its pads at 0.1 Hz
_UNEVEN = 1e-3  # of the step, by which rows of an even series may be uneven
# of the peaks: a smaller drift is less than the correction itself changes them by
_SLOW, _NEAR = 0.05, 0.2
_SETTLED, _LAST = 0.05, 0.75  # share of the end displacement by which the ground moves in the last quarter


def checked_baseline(value):
    """``auto``, ``none`` or a corner frequency [Hz] from an entry of a file or an option; or a ValueError."""
    if value in (AUTO, NONE):
        return value
    try:
        number = plain_number(value) if isinstance(value, str) else value
        corner = np.nan if isinstance(number, bool) else float(number)
    except (TypeError, ValueError):
        corner = np.nan
    if not 0.0 < corner < np.inf:
        raise ValueError(f"expected {AUTO}, {NONE} or a corner frequency above 0 Hz")
    return corner


Baseline = Annotated[
    str | float,
    BeforeValidator(checked_baseline, json_schema_input_type=Literal["auto", "none"] | Positive),
    Field(
        description="of the motion: auto corrects a record that does not end at rest, none nothing, and a corner "
        "frequency in Hz any motion of even accelerations; docs/guide/motions.md"
    ),
]


def correct_baseline(motion, baseline, where, published=False):
    """The same motion with its baseline as requested.

    Parameters
    ----------
    motion : GroundMotion
        As read.
    baseline : str or float
        ``none``: nothing is changed. ``auto``: a published record that does not end at rest is corrected, with a corner
        of 0.1 Hz. A number: any motion is corrected, with this corner [Hz].
    where : str or path
        File that an error names.
    published : bool
        The motion is a record in a provider's format.

    Returns
    -------
    GroundMotion
        Its attribute ``baseline`` states in words how the record ends and what was done, with the peaks before and
        after. A corrected motion starts with the zero pad before the record, and its attribute ``record_start`` is the
        time of the record's first value [s]; other motions keep every bit.

    Raises
    ------
    InputError
        Another baseline; a correction of other than evenly spaced accelerations, with a corner that is not below the
        Nyquist frequency, or of more than 20 million samples with the pads.

    Notes
    -----
    A record is at rest where all its components are: where the end velocity is at most 5 % of the peak velocity and the
    end displacement at most 20 % of the peak displacement, or where both may come from the rounding of the values
    (`may_be_quantisation`). A component is at rest elsewhere, after a permanent displacement, where the end velocity is
    as small and the last quarter of the record moves by at most 5 % of the end displacement.

    The correction is that of Boore (2005), On pads and filters: processing strong-motion data, Bull. Seism. Soc. Am.
    95: subtract the least-squares line; pad with zeros for ``1.5 order / corner`` at each end; high-pass by a
    second-order Butterworth filter in both directions (no phase shift, amplitude ``1 / (1 + (corner / f)^4)``); keep
    the pads, in which the filter's answer dies out (Boore, Azari Sisi and Akkar 2012). No taper: it would cut the start
    of a record that was triggered late.
    """
    try:
        baseline = checked_baseline(baseline)
    except ValueError as error:
        raise InputError(where, "baseline", f"{error}, not {baseline}") from None
    if not published and baseline in (AUTO, NONE):
        return _with_words(motion, motion.attributes.get("baseline", NONE))
    if baseline == NONE:
        return _with_words(motion, f"{NONE}, as requested; the record {_ends(motion)}")
    if baseline == AUTO:
        rests = [_rest(motion, axis) for axis in _accelerations(motion)]
        if all(rests):
            return _with_words(motion, f"as published: the record {_ends(motion)}, {rests[0]}")
        return _corrected(motion, CORNER_FREQUENCY, where, "not at rest")
    return _corrected(motion, baseline, where, "as requested")


def check_samples(n_rows, time_step, pad, where):
    """Refuse a series that its ``pad`` [s] at each end makes longer than a computer holds.

    Raises
    ------
    InputError
        More than 20 million samples with the pads.
    """
    samples = n_rows + 2.0 * pad / time_step
    if not samples <= _MOST_SAMPLES:
        raise InputError(
            where,
            "",
            f"expected at most {_MOST_SAMPLES:g} samples of a filtered motion with its pads, not {samples:.3g}; the "
            f"time step is {time_step:g} s, a pad {pad:g} s",
        )


def fast_length(n_rows):
    """Number of samples, at least ``n_rows``, whose Fourier transform is fast."""
    return fft.next_fast_len(n_rows, real=True)


def check_window(motion, duration, where, key):
    """Refuse a window of a corrected record that ends before the record starts, with `InputError`."""
    start = motion.attributes.get("record_start", 0.0)
    if duration <= start:
        raise InputError(
            where,
            key,
            f"expected more than {start:g} s: {motion.name} is corrected, and starts behind a pad of that length",
        )


def high_pass(values, time_step, corner_frequency, order, length):
    """Acausal Butterworth high-pass of a series at the start of ``length`` samples, zero beyond; it goes round them."""
    frequency = fft.rfftfreq(length, time_step)
    power = (frequency / corner_frequency) ** (2 * order)
    return fft.irfft(fft.rfft(values, length) * power / (1.0 + power), length)


def _with_words(motion, words, **attributes):
    return replace(motion, attributes={**motion.attributes, "baseline": words, **attributes})


def _end(motion, axis):
    """Velocity [m/s] and displacement from the first row [m] at the last row."""
    channel, ends = CHANNELS.index(axis), motion.table.breaks[[0, -1]]
    velocity, displacement = (motion.evaluate(ends, derivative)[:, channel] for derivative in (1, 0))
    return velocity[-1], displacement[-1] - displacement[0]


def _end_words(motion, axis):
    velocity, displacement = _end(motion, axis)
    return f"ends with {velocity:.3g} m/s at {1e3 * displacement:.4g} mm"


def _ends(motion):
    """How every component of a record ends, in words."""
    axes = list(_accelerations(motion))
    ends = [_end_words(motion, axis) for axis in axes]
    if len(axes) == 1:
        return ends[0]
    return ", ".join(f"{end} along {axis}" for axis, end in zip(axes, ends, strict=True))


def _rest(motion, axis):
    """How a component of a published record is at rest, in words; empty where it is not."""
    breaks, peaks = motion.table.breaks, motion_figures(motion, axis)
    velocity, displacement = _end(motion, axis)
    if may_be_quantisation(
        _accelerations(motion)[axis], breaks[-1] / (len(breaks) - 1), velocity, displacement
    ):
        return "at rest within the rounding of its values"
    if abs(velocity) > _SLOW * peaks["peak_velocity"]:
        return ""
    if abs(displacement) <= _NEAR * peaks["peak_displacement"]:
        return f"less than {_SLOW:.0%} of its peak velocity and {_NEAR:.0%} of its peak displacement"
    late = motion.evaluate(breaks[breaks >= _LAST * breaks[-1]])[:, CHANNELS.index(axis)]
    return "at rest after a permanent displacement" if np.ptp(late) <= _SETTLED * abs(displacement) else ""


def _accelerations(motion):
    """Rows of the channels that move, by axis, float64 arrays, shape (n_rows,) [m/s2]."""
    coefficients, last = motion.table.coefficients, motion.evaluate(motion.table.breaks[-1:], 2)
    rows = np.concatenate([2.0 * coefficients[:, :, 2], last])
    return {
        axis: rows[:, channel]
        for channel, axis in enumerate(CHANNELS[:PITCH])
        if axis == "x" or coefficients[:, channel].any()
    }


def _corrected(motion, corner, where, reason):
    breaks = motion.table.breaks
    step = float(breaks[-1] / (len(breaks) - 1))
    uneven = np.ptp(np.diff(breaks)) > _UNEVEN * step
    if motion.kind != "acceleration" or uneven or motion.table.coefficients[:, PITCH].any():
        wrong = "expected accelerations at even times, which alone can be corrected"
        raise InputError(where, "baseline", wrong)
    if corner >= 0.5 / step:
        wrong = f"expected below the Nyquist frequency, {0.5 / step:g} Hz, not {corner:g} Hz"
        raise InputError(where, "baseline", wrong)
    pad = 1.5 * _ORDER / corner
    check_samples(len(breaks), step, pad, where)
    before, pad, detrend = _accelerations(motion), int(np.ceil(pad / step)), scipy.signal.detrend
    n_rows = len(breaks) + 2 * pad
    after = {
        axis: np.roll(high_pass(detrend(values), step, corner, _ORDER, fast_length(n_rows)), pad)[:n_rows]
        for axis, values in before.items()
    }
    corrected = ground_motion(motion.name, step * np.arange(n_rows), after, motion.kind, motion.attributes)
    changes = [
        f"along {axis} it {_end_words(motion, axis)}, {_changes(motion, corrected, axis)}" for axis in before
    ]
    words = (
        f"corrected, {reason}: {'; '.join(changes)}; least-squares line subtracted, zero pads of {pad * step:.4g} s "
        f"kept at both ends, second-order Butterworth high-pass at {corner:g} Hz both ways; the record starts at "
        f"{pad * step:.4g} s"
    )
    if corner > _HIGH:
        words += f"; a corner above {_HIGH:g} Hz takes ground motion away, not its noise alone"
    return _with_words(corrected, words, record_start=pad * step)


def _changes(before, after, axis):
    """Peaks along an axis before and after, in words."""
    was, becomes = motion_figures(before, axis), motion_figures(after, axis)
    return ", ".join(
        f"{name} {factor * was[key]:.4g} to {factor * becomes[key]:.4g} {unit}"
        for name, key, factor, unit in (
            ("PGA", "peak_acceleration", 1.0, "m/s2"),
            ("PGV", "peak_velocity", 1.0, "m/s"),
            ("PGD", "peak_displacement", 1e3, "mm"),
        )
    )
