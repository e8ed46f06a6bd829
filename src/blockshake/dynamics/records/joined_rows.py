"""Components of one motion from files of their own, row by row."""

import numpy as np

from blockshake.errors import InputError

_SAME_TIME = 1e-3  # of a usual step: times with few digits


def joined_rows(parts, kind):
    """Times and columns of a motion whose components are in files of their own; the shorter ones rest behind their end.

    Parameters
    ----------
    parts : dict of str to tuple
        By axis the name of a file, its times (n_rows,) [s] and its values (n_rows,).
    kind : str
        ``acceleration``, ``velocity`` or ``displacement``: a rest is zero, and the last value of a displacement.

    Returns
    -------
    time, columns, rests : float64 array, dict of str to float64 array, list of str
        The times are those of the longest file; words on every rest.

    Raises
    ------
    InputError
        Times that are not those of the longest file.
    """
    longest, time, _ = max(parts.values(), key=lambda part: len(part[1]))
    slack, columns, rests = _SAME_TIME * float(np.median(np.diff(time))), {}, []
    for axis, (where, times, values) in parts.items():
        off = np.flatnonzero(np.abs(times - time[: len(times)]) > slack)
        if len(off):
            wrong = f"expected the times of {longest}, {time[off[0]]:.6g} s in row {off[0] + 1}, found "
            raise InputError(where, "", f"{wrong}{times[off[0]]:.6g} s")
        short = len(time) - len(values)
        columns[axis] = np.pad(
            values, (0, short), constant_values=values[-1] if kind == "displacement" else 0.0
        )
        if short:
            rests.append(f"{where}: rest for {time[-1] - times[-1]:g} s behind its end")
    return time, columns, rests
