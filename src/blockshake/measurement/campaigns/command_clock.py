"""When, on the clock of a test, the table began to do what it was told."""

import numpy as np
from scipy.optimize import minimize_scalar

_RELATED = 0.7  # correlation beyond which one motion is the other's
_COARSE = 0.02  # s, between the starts that are tried: a tenth of a period of 5 Hz


def command_start(time, slab, command):
    """Start of the command on the clock of a test [s]; None where the slab does not follow the command.

    Parameters
    ----------
    time, slab : float64 arrays, shape (n_times,)
        Displacement of the slab along x, without gaps [s, m].
    command : GroundMotion
        Commanded; it rests before its first row and after its last.

    Notes
    -----
    The start of the largest correlation of the two displacements over the whole record. A table that is late by the
    phase of its control starts late.
    """
    centred = slab - slab.mean()

    def unlike(start):
        told = command.evaluate(time - start)[:, 0]
        told = told - told.mean()
        size = np.sqrt((told @ told) * (centred @ centred))
        return 1.0 - (told @ centred / size if size > 0.0 else 0.0)

    starts = np.arange(time[0] - command.duration, time[-1], _COARSE)
    # the clocks' common zero is tried first: where nothing is told apart, it stays
    starts = np.concatenate([[0.0], starts])
    best = starts[int(np.argmin([unlike(start) for start in starts]))]
    found = minimize_scalar(
        unlike, bounds=(best - _COARSE, best + _COARSE), method="bounded", options={"xatol": 1e-6}
    )
    return float(found.x) if found.fun < 1.0 - _RELATED else None
