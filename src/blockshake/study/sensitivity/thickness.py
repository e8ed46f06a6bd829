"""Thickness of envelopes: whether it grows upward and with the structure, as Zhou et al. (2023) state."""

from itertools import combinations
from typing import NamedTuple

import numpy as np


class Thickness(NamedTuple):
    """Spread of the blocks of one structure, from the lowest up.

    Attributes
    ----------
    blocks : int
        Free bodies of the structure, beams included.
    shaking : tuple
        Whatever else is different between two structures: motion, scale, window.
    spread : tuple of float
        Standard deviation over samples and time, from the lowest block up [m]; NaN where samples are too few.

    Examples
    --------
    >>> tower = Thickness(4, ("alkion", 1.5), (0.001, 0.002, 0.004))
    >>> tower.known, tower.grows_upward
    (True, True)
    """

    blocks: int
    shaking: tuple
    spread: tuple

    @property
    def known(self):
        """Whether the samples sufficed for every block."""
        return bool(np.isfinite(self.spread).all())

    @property
    def grows_upward(self):
        """Whether each block's spread is larger than that of the next lower one."""
        return bool(np.all(np.diff(self.spread) > 0.0))


class Growth(NamedTuple):
    """Growth of the thickness at the top with the number of blocks.

    Attributes
    ----------
    pairs : int
        Pairs of structures of different numbers of blocks.
    thicker : int
        Pairs of which the structure of more blocks has the larger spread at its top.
    same_shaking : bool
        All structures are shaken alike: nothing but the structure can make the difference.

    Examples
    --------
    >>> tower = Thickness(4, ("alkion", 1.5), (0.001, 0.004))
    >>> walls = Thickness(9, ("alkion", 1.0), (0.001, 0.003))
    >>> growth_with_structure([tower, walls])
    Growth(pairs=1, thicker=0, same_shaking=False)
    """

    pairs: int
    thicker: int
    same_shaking: bool


def thickness(result, markers, blocks, shaking):
    """`Thickness` of the envelopes of one structure by one model.

    Parameters
    ----------
    result : xarray.Dataset
        From `sensitivity`.
    markers : sequence of str
        From the lowest block up.
    blocks, shaking
        As in `Thickness`.
    """
    spread = result["spread"].sel(quantity="history", marker=list(markers))
    return Thickness(int(blocks), shaking, tuple(float(one) for one in spread))


def growth_with_structure(structures):
    """`Growth`: known structures, each a `Thickness`, compared in pairs by their number of blocks."""
    known = sorted((one for one in structures if one.known), key=lambda one: one.blocks)
    pairs = [(less, more) for less, more in combinations(known, 2) if less.blocks < more.blocks]
    thicker = sum(more.spread[-1] > less.spread[-1] for less, more in pairs)
    return Growth(len(pairs), int(thicker), len({one.shaking for one in known}) == 1)
