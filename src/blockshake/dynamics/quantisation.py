"""Drift that the rounding of printed accelerations leaves, from the values themselves."""

import numpy as np

_UNITS = (9.80665, 0.01, 1.0)  # m/s2, in which accelerations are printed: g, cm/s2, m/s2
_MOST_DIGITS = 10
_INTEGER = 1e-4  # of a last digit, by which a printed value may differ from a whole number of them
_DEVIATIONS = 4.0  # 6 in 100 000 of normal sums are larger; made records reach 3.6


def may_be_quantisation(values, time_step, end_velocity, end_displacement):
    """Whether an acceleration that ends so may be a print of one that ends at rest.

    Parameters
    ----------
    values : float64 array, shape (n_rows,)
        As printed, at even times [m/s2].
    time_step : float
        [s]
    end_velocity, end_displacement : float
        Its integrals from rest [m/s, m].

    Notes
    -----
    The error of a printed value is even between plus and minus half a step of its last digit, and so has the variance
    ``step^2 / 12``; a print that is cut off errs by half a step towards zero besides, and a zero by up to a whole one
    either way. Neighbours that print alike err alike; others err independently of each other. An error counts by the
    time step in the velocity, and by the time to the end as well in the displacement. The drift may be rounding up to
    four standard deviations, and never beyond the largest error that there can be.
    """
    step = _print_steps(values)
    weights = time_step * np.array([np.ones(len(values)), time_step * np.arange(len(values))[::-1]])
    drift = np.array([end_velocity, end_displacement])
    begins = np.flatnonzero(np.concatenate([[True], np.diff(values) != 0.0]))
    cut_steps = np.where(values == 0.0, 2.0 * step, step)
    cut_off = weights @ (np.sign(values) * step / 2.0)
    for missing, steps in ((drift, step), (drift + cut_off, cut_steps)):
        deviation = np.sqrt((np.add.reduceat(weights * steps, begins, axis=1) ** 2).sum(axis=1) / 12.0)
        largest = weights @ steps / 2.0
        if (np.abs(missing) <= np.minimum(_DEVIATIONS * deviation, largest)).all():
            return True
    return False


def _print_steps(values):
    """Step of the last digit of every value, in the unit that needs the fewest digits, shape (n_rows,) [m/s2].

    A print has a fixed number of decimals or of significant digits; the coarser step of the two is right for either. It
    is zero where no unit has few digits.
    """
    digits, unit = min((_significant_digits(values / unit), unit) for unit in _UNITS)
    if digits > _MOST_DIGITS:
        return np.zeros(len(values))
    printed = values / unit
    decimals = next((n for n in range(_MOST_DIGITS) if _whole(printed * 10.0**n)), _MOST_DIGITS)
    return unit * np.maximum(10.0**-decimals, _last_digit(printed, digits))


def _significant_digits(printed):
    counts = range(1, _MOST_DIGITS + 1)
    return next((n for n in counts if _whole(printed / _last_digit(printed, n))), _MOST_DIGITS + 1)


def _last_digit(printed, digits):
    """Size of the last of so many significant digits of each value; of a zero that of the smallest number."""
    size = np.abs(printed)
    exponent = np.floor(np.log10(np.where(size > 0.0, size, size[size > 0.0].min(initial=1.0))) + 1e-12)
    return 10.0 ** (exponent + 1 - digits)


def _whole(numbers):
    return bool((np.abs(numbers - np.rint(numbers)) < _INTEGER).all())
