"""Readings at which the cameras lost a marker: leaps that no block can make, and places that stand for a short while.

Find, of each marker, the longest chain of stretches between impossible leaps of which each can be reached from the one
before; what is not in the chain is lost.
"""

import numpy as np

from blockshake.measurement.campaigns.faulty_readings import LEVEL, Faulty

_LOWEST = 1.0  # m; blocks are taken to fall at least so far
_TIP = 1.5  # corner of a column that topples over its mass centre in free fall; sqrt(3/2) of a slender one
_TABLE = 2.0  # m/s, of a table
_NOISE = 0.02  # m, of two readings
_LONGEST = 9  # equal readings on end; longer stretches are looked at column by column
_LEAST_REPEATED = 1e-3  # chance that all coordinates of a faultless marker repeat at once
_CHANGING = 0.9  # share of the other markers' readings that change meanwhile
_SPELT = 3  # times of a marker that a line spells out
_MOST_STRETCHES = 2000  # of a marker; more leaps than that are no losses


def without_lost(test, structure):
    """The test with the readings of lost markers as gaps.

    Returns
    -------
    xarray.Dataset
        Attribute ``faulty``: tuple of `Faulty` of the kind ``lost``, one of each marker that was lost.

    Notes
    -----
    A corner moves at most with the table, and with 1.5 times the speed of a free fall from the height of the structure.
    Exports write lost markers as zeros, as the last place, or under the name of another marker. Those that an import
    found by their zeros are in the attribute ``lost_markers`` of a file, a line each.
    """
    readings = test["marker_displacement"].transpose("time", "marker", "axis")
    values, time = readings.to_numpy().copy(), test["time"].to_numpy()
    found = (line.partition(": ") for line in test.attrs.get("lost_markers", "").splitlines())
    faulty = [Faulty(name, name, "lost", 0.0, 0.0, words) for name, _, words in found]
    speed = _fastest(structure)
    frozen = _frozen(values)
    for column, name in enumerate(readings["marker"].values):
        known = np.isfinite(values[:, column]).any(axis=1)
        lost = _off_the_chain(values[:, column], known, time, speed) | frozen[:, column]
        if lost.any():
            faulty.append(Faulty(str(name), str(name), "lost", 0.0, 0.0, lost_words(lost, time - time[0])))
            values[lost, column] = np.nan
    return test.assign({readings.name: readings.copy(data=values)}).assign_attrs(faulty=tuple(faulty))


def _fastest(structure):
    """Speed that no marker of a structure exceeds [m/s]."""
    tops = [
        structure.centroid[body, 2] + np.abs(structure.solid(body).vertices).max()
        for body in range(len(structure.mass))
    ]
    height = max(max(tops) - structure.centroid[int(np.argmax(structure.driven)), 2], _LOWEST)
    return _TABLE + _TIP * np.sqrt(2.0 * np.linalg.norm(structure.file.gravity) * height)


def _off_the_chain(places, known, time, speed):
    """Rows (n_times,) of a marker that are not among the most that can follow each other."""
    rows = np.flatnonzero(known)
    lost = np.zeros(len(time), dtype=bool)
    if len(rows) < 2:
        return lost
    axes = np.isfinite(places[rows]).any(axis=0)
    placed, at = places[rows][:, axes], time[rows]

    def leaps(one, other):
        away = np.nan_to_num(placed[one] - placed[other])
        return np.linalg.norm(away, axis=-1) > _NOISE + speed * np.abs(at[one] - at[other])

    cuts = np.flatnonzero(leaps(np.arange(1, len(rows)), np.arange(len(rows) - 1))) + 1
    if not 0 < len(cuts) < _MOST_STRETCHES:
        return lost
    first, last = np.concatenate([[0], cuts]), np.concatenate([cuts, [len(rows)]]) - 1
    # the most readings in a chain that ends with each stretch
    count, before = (last - first + 1).astype(float), np.full(len(first), -1)
    for stretch in range(1, len(first)):
        reached = np.flatnonzero(~leaps(np.full(stretch, first[stretch]), last[:stretch]))
        if len(reached):
            before[stretch] = reached[np.argmax(count[reached])]
            count[stretch] += count[before[stretch]]
    lost[rows] = True
    stretch = int(np.argmax(count))
    while stretch >= 0:
        lost[rows[first[stretch] : last[stretch] + 1]] = False
        stretch = before[stretch]
    return lost


def _frozen(values):
    """Rows of markers (n_times, n_markers) whose coordinates all stand for some readings while other markers move."""
    finite = np.isfinite(values)
    known = (finite | ~finite.any(axis=0)).all(axis=2) & finite.any(axis=2)  # along every axis that is read
    both = known[1:] & known[:-1]
    changes = (np.nan_to_num(np.diff(values, axis=0)) != 0.0).any(axis=2) & both
    repeats, frozen = both & ~changes, np.zeros(known.shape, dtype=bool)
    for column in range(known.shape[1]):
        others = np.arange(known.shape[1]) != column
        moving = changes[:, others].sum(axis=1) / np.maximum(both[:, others].sum(axis=1), 1)
        edges = np.flatnonzero(np.diff(np.concatenate([[0], repeats[:, column].astype(int), [0]]))).reshape(
            -1, 2
        )
        for begin, end in edges:
            length, total = end - begin, both[:, column].sum()
            if not 2 < length < _LONGEST or moving[begin:end].min() < _CHANGING:
                continue
            elsewhere = (repeats[:, column].sum() - length + 1.0) / (total - length + 2.0)
            if total * max(elsewhere, _LEAST_REPEATED) ** length < LEVEL / known.shape[1]:
                frozen[begin + 1 : end + 1, column] = True
    return frozen


def lost_words(lost, time):
    """When a marker was lost, by the mask and the times of its readings since the first one (n_times,) [s]."""
    begins = time[np.flatnonzero(lost & ~np.concatenate([[False], lost[:-1]]))]
    times = ", ".join(f"{one:.4g}" for one in begins[:_SPELT])
    more = f" s and {len(begins) - _SPELT} times more" if len(begins) > _SPELT else " s"
    return f"lost by the cameras at {times}{more}, {'1 reading' if lost.sum() == 1 else f'{lost.sum()} readings'}"
