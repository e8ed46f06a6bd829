"""Displacement of each block that counts as a potential collapse."""

import numpy as np

from blockshake.geometry.reference_block import upright_size


def drift_limits(structure, given=None):
    """Horizontal displacement against the slab that counts as a potential collapse of a block.

    Parameters
    ----------
    structure : Structure
    given : float, optional
        For all blocks [m]. By default half of each block's own smaller horizontal width: a block that slides so far
        over a support of its own width has its mass centre above the edge.

    Returns
    -------
    float64 array, shape (n_bodies,)
        [m]; NaN for driven bodies, which have none.
    """
    widths = [upright_size(structure, body)[:2].min() for body in range(len(structure.mass))]
    limits = 0.5 * np.array(widths) if given is None else np.full(len(widths), float(given))
    return np.where(structure.driven, np.nan, limits)
