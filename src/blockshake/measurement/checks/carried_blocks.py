"""Whether blocks move as the slab carries them: swapped axes and signs that their readings betray."""

import numpy as np

_LOW_PART = 0.2  # of the slab's largest displacement along x: till then blocks have hardly slipped or rocked
_CARRIED = (0.2, 2.0)  # of the slab's displacement, by which blocks move in the low part; 0.4 to 1.1 in data/
_SEEN = 10.0  # times the noise of a reading, that a displacement must reach to be judged
_FEWEST = 20  # readings
_SIDEWAYS = 3.0  # times the motion along z, that blocks shaken along x do not move along y


def carried_remarks(time, readings, names, slab, noise):
    """Remarks on markers of blocks that do not move with the slab while it moves little.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        [s]
    readings : float64 array, shape (n_times, n_markers, 3)
        Of markers on blocks [m]; gaps are NaN, as is a direction that a marker does not measure.
    names : list of str, length n_markers
    slab : float64 array, shape (n_times, 3)
        Mean displacement of the slab's markers [m].
    noise : float
        Standard deviation of a reading [m].
    """
    size = np.abs(slab[:, 0])
    largest = np.nanmax(size)
    low = np.arange(len(time)) < np.argmax(size > _LOW_PART * largest)
    wrong = []
    if low.sum() >= _FEWEST and _LOW_PART * largest > _SEEN * noise:
        for place, name in enumerate(names):
            read = np.isfinite(readings[:, place]).any(axis=0)
            known = low & np.isfinite(readings[:, place, read]).all(axis=1) & np.isfinite(slab[:, 0])
            base = slab[known, 0] - slab[known, 0].mean() if known.sum() >= _FEWEST else np.zeros(1)
            if not base.any() or not read[0]:
                continue
            share = base @ readings[known, place] / (base @ base)
            if not _CARRIED[0] < share[0] < _CARRIED[1]:
                along = ", ".join(
                    f"{one:.2f}" if told else "unknown" for one, told in zip(share, read, strict=True)
                )
                wrong.append(f"{name} moves by {along}")
    remarks = []
    if wrong:
        more = f", and {len(wrong) - 1} more markers likewise" if len(wrong) > 1 else ""
        remarks.append(
            f"{wrong[0]} (x, y, z) of the slab's x while that is below {1e3 * _LOW_PART * largest:.2g} mm, "
            f"expected near 1, 0, 0{more}"
        )
    spread = [
        np.sqrt(np.mean(part[np.isfinite(part)] ** 2 if np.isfinite(part).any() else 0.0))
        for part in np.moveaxis(readings, -1, 0)
    ]
    if np.isfinite(readings[..., 2]).any() and spread[1] > max(_SIDEWAYS * spread[2], _SEEN * noise):
        remarks.append(
            f"the blocks move by {1e3 * spread[1]:.2g} mm along y and {1e3 * spread[2]:.2g} mm along z (rms): "
            "are y and z swapped?"
        )
    return remarks
