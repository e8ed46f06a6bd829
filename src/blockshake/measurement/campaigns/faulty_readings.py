"""Columns of a test that are no readings: constant, frozen for a while, clipped, or the same as another one."""

from typing import NamedTuple

import numpy as np

from blockshake.measurement.sensors.accelerometers import channel_carriers
from blockshake.measurement.sensors.markers import marker_bodies

LEVEL = 1e-3  # chance of any such column in a test of faultless sensors
_SHORTEST = 10  # steps without a change, below which nothing is called frozen
# chance that a faultless reading repeats the one before: a motion turns, and digits are few
_LEAST_REPEATED = 0.1
_DROP, _NEARLY_ALL = 3.0, 0.995  # times the step that this share of a column's steps stays below
_SAME = 1e-6  # of a column's range: readings this near its end are at it
_FEWEST_AT_END = 4
_NOISY = 0.3  # third over first differences: noise has 3, a motion of 10 Hz without noise 0.1 at 200 Hz
_WINDOW = 50  # readings, in which noise changes some
_RESOLVED = 0.3  # of the readings of the quietest window, that noise changes where its digits are fine enough
_MANY = 4  # columns that a line spells out
_ONE_POSE = 3  # columns of a body and axis, which one pose may move alike from this number on
# beyond which a sensor that reads the same throughout reads nothing: no first reading, and twice gravity
_STUCK = {"m": 0.01, "m/s2": 20.0}
_INSTRUMENTS = (
    ("marker_displacement", "time", "marker", "m"),
    ("accelerometer", "time_acc", "channel", "m/s2"),
    ("transducer_displacement", "time_acc", "transducer", "m"),
)


class Faulty(NamedTuple):
    """Readings of a column that were made gaps.

    ``sensor``: marker, channel or transducer; ``column``: its name, with an axis unless all axes are gaps; ``kind``:
    ``constant``, ``frozen``, ``clipped``, ``doubled``, ``dropped`` or ``lost``; ``value`` that they have [m or m/s2];
    ``p``: chance of a faultless column like it; ``words``: what they do.
    """

    sensor: str
    column: str
    kind: str
    value: float
    p: float
    words: str


class _Fault(NamedTuple):
    kind: str
    column: int
    rows: np.ndarray
    p: float


def instruments(test):
    """Each instrument's readings (time, sensor, ...) with their unit, the names of its columns, and their values.

    Generator of (xarray.DataArray, str, list of str, float64 array of shape (n_times, n_columns)).
    """
    for variable, clock, dimension, unit in _INSTRUMENTS:
        if variable in test:
            readings = test[variable].transpose(clock, dimension, ...)
            axes = [f".{axis}" for axis in readings["axis"].values] if "axis" in readings.dims else [""]
            columns = [f"{name}{axis}" for name in readings[dimension].values for axis in axes]
            yield readings, unit, columns, readings.to_numpy().reshape(-1, len(columns))


def stuck(values, unit="m"):
    """Mask (...) of columns (n_times, ...) that hold one value alone, farther from zero than a sensor at rest."""
    known, low = np.isfinite(values).sum(axis=0), np.fmin.reduce(values, axis=0)
    return (known > _SHORTEST) & (low == np.fmax.reduce(values, axis=0)) & (np.abs(low) > _STUCK[unit])


def dropouts(values):
    """Readings of columns (n_times, n_columns), a mask, that are exactly 0 for a moment while those around stand off.

    Loggers write so where a contact is lost: up to 9 zeros on end between readings of one sign, both farther from 0
    than three times the steps that nearly all readings make.
    """
    dropped = np.zeros(values.shape, dtype=bool)
    for column, own in enumerate(values.T):
        zero = own == 0.0
        edges = np.flatnonzero(np.diff(np.concatenate([[0], zero.astype(int), [0]]))).reshape(-1, 2)
        edges = edges[(edges[:, 0] > 0) & (edges[:, 1] < len(own)) & (np.diff(edges)[:, 0] < _SHORTEST)]
        steps = np.abs(np.diff(own[~zero & np.isfinite(own)]))
        if not len(edges) or not len(steps):
            continue
        usual = _DROP * np.quantile(steps, _NEARLY_ALL)
        before, after = own[edges[:, 0] - 1], own[edges[:, 1]]
        off = (np.sign(before) == np.sign(after)) & (np.minimum(np.abs(before), np.abs(after)) > usual)
        for begin, end in edges[off]:
            dropped[begin:end, column] = True
    return dropped


def dropped_words(rows, time):
    """When a channel read 0, by the mask and the times of its readings since the markers' first one (n_times,) [s]."""
    return f"0 between readings far from it, first at {time[np.argmax(rows)]:.4g} s ({rows.sum()} in all)"


def without_faulty(test, structure):
    """The test with such readings as gaps; a sensor without any other reading is left out.

    Parameters
    ----------
    test : xarray.Dataset
        As a file has it, checked.
    structure : Structure

    Returns
    -------
    xarray.Dataset
        Attribute ``faulty``: tuple of `Faulty`.

    Notes
    -----
    A column that is `stuck` holds no readings, whatever others do. Any other is held against those of its body and
    axis; where these do not change either, against all others of its instrument, if those have noise. In a test without
    noise equal and constant columns may be true, of a slab that does not rise or of blocks at rest.
    """
    faulty = list(test.attrs.get("faulty", ()))
    for readings, unit, columns, values in instruments(test):
        values, (clock, dimension, *_) = values.copy(), readings.dims
        dropped = dropouts(values)
        values[dropped] = np.nan
        names = [str(name) for name in readings[dimension].values]
        each = len(columns) // len(names)
        faults = _faults(values, _groups(names, each, dimension, structure), stuck(values, unit))
        step = float(np.median(np.diff(test[clock].to_numpy())))
        for fault in faults:
            value = float(values[np.argmax(fault.rows), fault.column]) + 0.0
            words = {
                "constant": f"{value:.4g} {unit} throughout",
                "frozen": f"no change for {fault.rows.sum() * step:.3g} s while others change",
                "clipped": f"readings that end at {abs(value):.4g} {unit}",
                "doubled": "the same readings twice",
            }[fault.kind]
            sensor = names[fault.column // each]
            faulty.append(Faulty(sensor, columns[fault.column], fault.kind, value, fault.p, words))
        for column in np.flatnonzero(dropped.any(axis=0)):
            words = dropped_words(dropped[:, column], (test[clock] - test["time"][0]).to_numpy())
            faulty.append(Faulty(names[column // each], columns[column], "dropped", 0.0, 0.0, words))
        for fault in faults:
            values[fault.rows, fault.column] = np.nan
        test = test.assign({readings.name: readings.copy(data=values.reshape(readings.shape))})
        read = np.isfinite(values).reshape(len(values), len(names), -1).any(axis=(0, 2))
        test = test.isel({dimension: np.flatnonzero(read)})
    return test.assign_attrs(faulty=tuple(faulty))


def faulty_lines(test):
    """Lines for a reader that name the columns of a test whose readings `without_faulty` took as gaps."""
    columns = {}
    for fault in test.attrs.get("faulty", ()):
        columns.setdefault(fault.words, []).append(fault.column)
    return [
        f"{words}, taken as gaps: {', '.join(mine[:_MANY])}"
        + (f" and {len(mine) - _MANY} more" if len(mine) > _MANY else "")
        for words, mine in columns.items()
    ]


def _groups(names, each, dimension, structure):
    """Body and axis of every column; a transducer has no other like it."""
    if dimension == "marker":
        return [(body, axis) for body in marker_bodies(structure, names) for axis in range(each)]
    carriers = channel_carriers(structure)
    return [carriers.get(name, name) for name in names]


def _faults(values, groups, nothing):
    """List of `_Fault` of columns (n_times, n_columns), a column's ``constant`` without any other.

    ``nothing`` (n_columns,): whether each is `stuck`.
    """
    known = np.isfinite(values[1:]) & np.isfinite(values[:-1])
    steps = np.diff(values, axis=0)
    changed = known & (steps != 0.0)
    varying = changed.any(axis=0)
    hung = _long_enough(~changed.any(axis=1))
    noisy = _is_noisy(steps[~hung][:, varying], changed[~hung][:, varying])
    faults, copies = [], {}
    for column, group in enumerate(groups):
        if nothing[column]:
            faults.append(_Fault("constant", column, np.isfinite(values[:, column]), 0.0))
            continue
        others = np.array([other == group for other in groups]) & varying
        others[column] = False
        if not others.any():
            others = varying & noisy
            others[column] = False
        if not others.any() or not known[:, column].any():
            continue
        moving = changed[:, others].sum(axis=1) / np.maximum(known[:, others].sum(axis=1), 1)
        moving = np.where(hung & noisy, 1.0, moving)  # where the whole instrument hangs, its noise states it
        repeats = known[:, column] & ~changed[:, column]
        if varying[column]:
            at_end, p = _at_end(values[:, column], 0.5 * LEVEL / len(groups))
            touched = at_end[1:] | at_end[:-1]
            if at_end.any() and (noisy or moving[touched].mean() > 0.5):
                faults.append(_Fault("clipped", column, at_end, p))
                repeats &= ~touched
            original = copies.setdefault(_content(values[:, column]), column)
            if noisy and original != column and not _of_one_pose(values, groups, original, column):
                every = np.isfinite(values[:, column])
                faults.append(_Fault("doubled", original, every, 0.0))
                faults.append(_Fault("doubled", column, every, 0.0))
                continue
        rows, p = _frozen(repeats, known[:, column], moving, LEVEL / len(groups))
        if rows.any():
            faults.append(_Fault("frozen" if varying[column] else "constant", column, rows, p))
    return faults


def _of_one_pose(values, groups, original, column):
    """Whether a column and its copy are, with all others of their body and axis, what one unturned pose gives."""
    mine = values[:, [other == groups[column] for other in groups]]
    apart = np.abs(mine - values[:, [column]]) > _SAME * np.nanmax(np.abs(values[:, column]))
    return groups[original] == groups[column] and mine.shape[1] >= _ONE_POSE and not apart.any()


def _long_enough(still):
    """Steps, a mask, of the stretches of still ones that are long enough to be looked at."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]]))).reshape(-1, 2)
    taken = np.zeros(len(still), dtype=bool)
    for begin, end in edges[np.diff(edges, axis=1)[:, 0] >= _SHORTEST]:
        taken[begin:end] = True
    return taken


def _is_noisy(steps, changed):
    """Whether readings scatter from one to the next more than a motion does, and are written finely enough for that."""
    if len(steps) < _WINDOW or not steps.shape[1]:
        return False
    share = np.convolve(changed.mean(axis=1), np.full(_WINDOW, 1.0 / _WINDOW), mode="valid").min()
    third = np.nanmedian(np.abs(np.diff(steps, 2, axis=0)))
    return bool(share > _RESOLVED and third > _NOISY * np.nanmedian(np.abs(steps)))


def _content(column):
    """Bytes that columns with the same readings share, also of opposite sign."""
    first = column[np.argmax(np.isfinite(column) & (column != 0.0))]
    return (np.where(np.isfinite(column), column, 0.0) * np.sign(first) + 0.0).tobytes()


def _frozen(repeats, known, moving, level):
    """Readings (n_times,) in stretches without a change, and the chance of the most probable of these.

    Each step of a stretch has the chance of a repeated reading: that of the column next to the stretch, or that of the
    others within it, whichever is larger.
    """
    rows, chance = np.zeros(len(repeats) + 1, dtype=bool), 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[0], repeats.astype(int), [0]])))
    for begin, end in edges.reshape(-1, 2):
        if end - begin < _SHORTEST:
            continue
        elsewhere = (repeats.sum() - (end - begin) + 1.0) / (known.sum() - (end - begin) + 2.0)
        repeated = max(elsewhere, 1.0 - moving[begin:end].mean(), _LEAST_REPEATED)
        p = known.sum() * repeated ** (end - begin)
        if p < level:
            rows[begin : end + 1] = True
            chance = max(chance, p)
    return rows, chance


def _at_end(values, level):
    """Mask of the readings at the ends of a column's range, (n_times,), and the chance of as many in a faultless
    record.

    Next to a largest (or smallest) reading that is shared by neighbours each further one has the chance with which any
    reading repeats the one before, taken from the record itself below the plateau, so that coarse digits and a sensor
    at rest are no saturation. A limit that acts before the noise is added leaves no equal readings and is not seen.
    """
    known = np.isfinite(values)
    nothing = np.zeros(len(values), dtype=bool)
    if known.sum() < 10 * _FEWEST_AT_END:
        return nothing, 1.0
    width = _SAME * np.ptp(values[known])
    clipped, chance = nothing, 1.0
    for end in (values[known].max(), values[known].min()):
        at_end = known & (np.abs(values - end) <= width)
        together = (at_end[1:] & at_end[:-1]).sum()
        pairs = known[1:] & known[:-1] & ~(at_end[1:] | at_end[:-1])
        equal = (np.abs(np.diff(values)) <= width) & pairs
        rate = (equal.sum() + 1.0) / (pairs.sum() + 2.0)
        p = known.sum() * rate ** (together - 1.0)
        if together >= _FEWEST_AT_END - 1 and p < level:
            clipped, chance = clipped | at_end, min(p, chance)
    return clipped, chance
