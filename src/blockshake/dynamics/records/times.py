"""Times of the rows of a motion, given one by one."""

import numpy as np

from blockshake.errors import InputError

_GAP = 1.5  # usual steps, beyond which a row of an even series is missing
_EVEN = 0.2  # of the usual step, by which steps of an even series may differ: times printed with few digits
_EVEN_SHARE, _WIDE_SHARE = 0.9, 0.25  # of the steps: even ones of all that are no gap, and gaps
_FAR = 5.0  # steps longer than nearly all others, beyond which rows are missing of an uneven series too
_NEARLY_ALL = 0.95
_MOST_DECIMALS = 9  # of printed times
_FEWEST_CROSSINGS = 4  # of a mean, so that a gap is at most an eighth of the motion
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


def check_times(time, columns, lines, where, name, row="line"):
    """Refuse times as `check_increase`, and a gap that is longer than a quarter of the mean period of a column.

    ``columns``: arrays (n_rows,) of the motion; their mean period is that of the crossings of their means. A shorter
    gap is bridged, and `gap_words` tells it.
    """
    check_increase(time, lines, where, name, row)
    steps, wide = np.diff(time), _wide(time)
    if not wide.any():
        return
    crossings = (np.count_nonzero(np.diff(np.signbit(column - np.mean(column)))) for column in columns)
    quarter = (time[-1] - time[0]) / (2.0 * max(_FEWEST_CROSSINGS, *crossings, 0))
    if steps[wide].max() > quarter:
        index = int(np.argmax(wide & (steps > quarter)))
        raise InputError(
            where, f"{row} {lines[index + 1]}, {name}",
            f"expected rows {np.median(steps):.4g} s apart as elsewhere; {steps[index]:.4g} s after "
            f"{time[index]:.13g} s have none, {gaps_words(wide)} in all, and a quarter of the mean period is "
            f"{quarter:.2g} s: write the rows that are missing, or split the motion",
        )  # fmt: skip


def gaps_words(wide):
    """Number of gaps in words, by a mask or a number of rows for each two neighbours (n_times - 1,)."""
    count = np.count_nonzero(wide)
    return "1 such gap" if count == 1 else f"{count} such gaps"


def gap_words(time):
    """Words on the rows that a series lacks, empty where it lacks none."""
    wide = _wide(time)
    if not wide.any():
        return ""
    steps, index = np.diff(time), int(np.argmax(wide))
    return (
        f"rows are missing: {steps[index]:.4g} s after {time[index]:.13g} s have none, where others are "
        f"{np.median(steps):.4g} s apart; {gaps_words(wide)} in all, bridged by lines"
    )


def _wide(time):
    """Whether each step is a gap (n_rows - 1,); a sparse table has none."""
    steps = np.diff(time)
    return (
        _gaps(time, steps, float(np.median(steps)))
        if len(time) >= _FEWEST_ROWS
        else np.zeros(len(steps), dtype=bool)
    )


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
