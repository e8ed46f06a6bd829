"""Times of the rows of a motion, given one by one."""

import numpy as np

from blockshake.errors import InputError

_GAP = 1.5  # usual steps, beyond which a row of an even series is missing
_EVEN = 0.2  # of the usual step, by which steps of an even series may differ: times printed with few digits
_EVEN_SHARE, _WIDE_SHARE = 0.9, 0.25  # of the steps: even ones of all that are no gap, and gaps
_FAR = 5.0  # steps longer than nearly all others, beyond which rows are missing of an uneven series too
_NEARLY_ALL = 0.95
_MOST_DECIMALS = 9  # of printed times
_FEWEST_ROWS = 20  # below it a table may be sparse on purpose


def check_increase(time, lines, where, name, row="line"):
    """Refuse times that do not increase.

    ``time`` (n_rows,) [s]; ``lines``: line of every row in the file ``where``, or another number that ``row`` names;
    ``name`` of the column.
    """
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        before, after = time[back[0] : back[0] + 2]
        wrong = f"expected times that increase; {after:.13g} s follows {before:.13g} s"
        raise InputError(where, f"{row} {lines[back[0] + 1]}, {name}", wrong)


def check_times(time, lines, where, name, row="line"):
    """Refuse times as `check_increase`, and gaps in a series that is even otherwise, which no line may bridge."""
    check_increase(time, lines, where, name, row)
    steps = np.diff(time)
    usual = float(np.median(steps)) if len(steps) else 0.0
    wide = _gaps(time, steps, usual) if len(time) >= _FEWEST_ROWS else np.zeros(0, dtype=bool)
    if wide.any():
        index = int(np.argmax(wide))
        raise InputError(
            where, f"{row} {lines[index + 1]}, {name}",
            f"expected rows {usual:.4g} s apart as elsewhere; {steps[index]:.4g} s after {time[index]:.13g} s have "
            f"none, {int(wide.sum())} such gaps in all: write the rows that are missing, or split the motion",
        )  # fmt: skip


def _gaps(time, steps, usual):
    """Whether each step is a gap: of even steps, of even steps but for the last printed digit, or far out of all."""
    for digit in (0.0, last_digit(time)):
        wide = steps > _GAP * usual + digit
        even = np.abs(steps[~wide] - usual) <= _EVEN * usual + digit
        if wide.any() and wide.mean() <= _WIDE_SHARE and even.mean() >= _EVEN_SHARE:
            return wide
    return steps > _FAR * np.quantile(steps, _NEARLY_ALL, method="lower")


def last_digit(time):
    """Unit of the last printed digit of all times [s]; 0 where there are too many digits."""
    printed = (places for places in range(_MOST_DECIMALS) if np.array_equal(np.round(time, places), time))
    return 10.0 ** -next(printed, np.inf)
