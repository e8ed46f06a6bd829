"""Places of markers or bodies in the laboratory against those of the structure, before they become displacements."""

import itertools

import numpy as np

_FAR = 0.1  # m, off the structure's place, seen from the others
_PLACES = 0.2  # of the structure's spread, below which columns are displacements, which all begin near zero


def place_remarks(names, starts, nominal):
    """Remarks on places that are not those of the structure but for one displacement of all.

    Parameters
    ----------
    names : list of str
    starts, nominal : float64 arrays, shape (n_places, 3)
        First places in the file's origin, and those of the structure [m].
    """
    known = np.isfinite(starts).all(axis=1)
    names, starts, nominal = [names[row] for row in np.flatnonzero(known)], starts[known], nominal[known]
    if len(names) < 2 or _spread(starts) < _PLACES * _spread(nominal):
        return []
    off, reference = _off(starts, nominal)
    away = np.linalg.norm(off, axis=1)
    if away.max() < _FAR:
        return []
    for one, other in itertools.combinations(range(len(names)), 2):
        swapped = starts.copy()
        swapped[[one, other]] = swapped[[other, one]]
        if np.linalg.norm(_off(swapped, nominal)[0], axis=1).max() < _FAR:
            return [
                f"{names[one]} and {names[other]} stand where the structure has the other one: are they exchanged?"
            ]
    worst = int(away.argmax())
    shift = ", ".join(f"{part:.2f}" for part in np.round(off[worst], 2) + 0.0)
    more = f", and {np.count_nonzero(away > _FAR) - 1} more" if np.count_nonzero(away > _FAR) > 1 else ""
    seen = "the others" if reference is None else names[reference]
    return [
        f"{names[worst]} stands {shift} m (x, y, z) off its place in the structure, seen from {seen}{more}"
    ]


def _spread(places):
    return np.linalg.norm(places - places.mean(axis=0), axis=1).max()


def _off(starts, nominal):
    """Offsets (n_places, 3) from the usual one, and the place whose offset that is, None where it is the median."""
    off = starts - nominal
    return (off - off[0], 0) if len(off) == 2 else (off - np.median(off, axis=0), None)
