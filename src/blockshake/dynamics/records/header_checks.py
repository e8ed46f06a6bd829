"""Entries of a header that say twice what the values say already: a contradiction is an error that names both."""

import numpy as np

from blockshake.dynamics.records.record import finite_number
from blockshake.errors import InputError

ROUNDING = 1e-3  # of a stated figure: peaks of single precision, steps such as 1/150 s with four digits
_UNKNOWN = (0.0, -999.0)  # stand for a missing entry in the headers of COSMOS and CSMIP


class HeaderChecks:
    """Checks of one series against its header.

    Every check passes an entry that is empty, and one that agrees within half of its last digit and 0.1 %.

    Parameters
    ----------
    where : str
        File that a message names.
    values : float64 array, shape (n_rows,)
        [m/s2]
    time_step : float
        [s]
    """

    def __init__(self, where, values, time_step):
        self.where, self.values, self.time_step = where, values, time_step
        self._made = []

    @property
    def made(self):
        """Names of the entries that were held against the values, in words."""
        return ", ".join(dict.fromkeys(["number of values", *self._made]))

    def step(self, key, text):
        """Another statement of the time step [s]."""
        stated = self._stated(key, text)
        if stated is not None:
            slack = _half_digit(text) + ROUNDING * self.time_step
            self._hold(key, "time step", abs(stated - self.time_step) <= slack, stated, self.time_step, "s")

    def length(self, key, text, slack=0.0):
        """Length of the series [s]: from the first value to the last, or one step more; ``slack`` of a rough entry."""
        stated = self._stated(key, text)
        if stated is not None:
            length = len(self.values) * self.time_step
            slack = max(slack, _half_digit(text)) + ROUNDING * length + self.time_step
            self._hold(key, "length", abs(stated - length) <= slack, stated, length, "s")

    def peak(self, key, text, size):
        """Largest magnitude, in a unit of ``size`` m/s2: of the values, or of their distance from their mean.

        A negative entry is a peak below zero; some formats give no sign.
        """
        stated = self._stated(key, text, size)
        if stated is not None:
            slack = _half_digit(text) * size + ROUNDING * abs(stated)
            peaks = [_peak(series, stated) for series in self._series()]
            agrees = any(abs(abs(stated) - peak) <= slack for peak in peaks)
            self._hold(key, "peak", agrees, stated, float(np.abs(self.values).max()), "m/s2")

    def extreme(self, key, text, size):
        """Largest value, or the smallest one where the entry is negative."""
        stated = self._stated(key, text, size)
        if stated is not None:
            slack = _half_digit(text) * size + ROUNDING * abs(stated)
            extremes = [float(side) for series in self._series() for side in (series.max(), series.min())]
            nearest = min(extremes, key=lambda extreme: abs(extreme - stated))
            self._hold(key, "peak", abs(nearest - stated) <= slack, stated, nearest, "m/s2")

    def peak_time(self, key, text, sign=0):
        """Time of the peak [s], of the largest value for ``sign`` 1 and of the smallest one for -1."""
        stated = self._stated(key, text, blanks=(-999.0,))
        if stated is None:
            return
        slack = 1.5 * self.time_step + _half_digit(text) + ROUNDING * stated
        nearest = None
        for series in self._series():
            heights = sign * series if sign else np.abs(series)
            # values that the print makes equal to the peak are peaks too
            times = self.time_step * np.flatnonzero(
                heights >= heights.max() - ROUNDING * np.abs(heights).max()
            )
            off = float(times[np.argmin(np.abs(times - stated))])
            nearest = off if nearest is None or abs(off - stated) < abs(nearest - stated) else nearest
        self._hold(key, "time of the peak", abs(nearest - stated) <= slack, stated, nearest, "s")

    def _series(self):
        """The values, and their distances from their mean, which providers remove before they look for a peak."""
        return self.values, self.values - self.values.mean()

    def _stated(self, key, text, size=1.0, blanks=_UNKNOWN):
        if text is None or not text.strip():
            return None
        number = finite_number(text, self.where, key)
        return None if number in blanks else number * size

    def _hold(self, key, name, agrees, stated, actual, unit):
        if not agrees:
            raise InputError(
                self.where,
                key,
                f"expected a {name} of {actual:.6g} {unit}, as the values have, found {stated:.6g} {unit}",
            )
        self._made.append(name)


def _half_digit(text):
    """Half of the last digit of a printed number."""
    mantissa, _, exponent = text.strip().lower().replace("d", "e").partition("e")
    try:
        return 0.5 * 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    except (ValueError, OverflowError):  # of a zero with thousands of digits
        return 0.0


def _peak(series, stated):
    return float(-series.min() if stated < 0.0 and -series.min() >= (1.0 - ROUNDING) * series.max() else
                 np.abs(series).max() if stated >= 0.0 else np.inf)  # fmt: skip
