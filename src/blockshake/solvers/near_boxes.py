"""Broad phase: which pairs of bodies are near enough to be looked at closely."""

import numpy as np

from blockshake.jit import kernel


@kernel
def find_pairs(low, high, driven, margin):
    """Pairs whose bounding boxes come within ``margin`` [m]: int64 (n_pairs, 2), sorted; not of two driven bodies.

    Sweep over the sorted lower ends along the axis on which the bodies are spread most, so that the
    cost grows with the bodies and the neighbours of each.

    Parameters
    ----------
    low, high : float64 arrays, shape (n_bodies, 3)
        Corners of the boxes, world frame [m].
    driven : bool array, shape (n_bodies,)
    margin : float
    """
    n_bodies = driven.size
    widest = np.argmax(np.array([np.ptp(low[:, axis]) for axis in range(3)]))
    order = np.argsort(low[:, widest], kind="mergesort")
    codes = []
    for rank in range(n_bodies):
        a = order[rank]
        for later in range(rank + 1, n_bodies):
            b = order[later]
            if low[b, widest] > high[a, widest] + margin:
                break
            near = not (driven[a] and driven[b])
            for axis in range(3):
                near &= low[a, axis] <= high[b, axis] + margin and low[b, axis] <= high[a, axis] + margin
            if near:
                codes.append(min(a, b) * n_bodies + max(a, b))
    sorted_codes = np.sort(np.array(codes)) if len(codes) > 0 else np.empty(0, np.int64)
    pairs = np.empty((len(codes), 2), np.int64)
    pairs[:, 0], pairs[:, 1] = sorted_codes // n_bodies, sorted_codes % n_bodies
    return pairs
