"""Levels of intensity that the samples of a case are scaled to: statistics are made level by level."""

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.dynamics.record_set import DrawnMotions


def levels_of(case, seed, size):
    """Level that each sample of a design is scaled to, by sample.

    Parameters
    ----------
    case : dict
        Entries of the case in the configuration.
    seed, size : int
        The design.

    Returns
    -------
    dict of int to float
        In the unit of the case's measure of intensity; empty where no level has two samples, or none is requested.
    """
    if case.get("intensity") is None:
        return {}
    drawn = DrawnMotions.of(case)
    levels = {sample: drawn.draw(sample, seed).level for sample in range(size)}
    if None in levels.values() or (
        not drawn.intensity.levels and len(set(levels.values())) * 2 > len(levels)
    ):
        return {}
    return {sample: case["scale"] * level for sample, level in levels.items()}


def at_level(samples, levels, level):
    """Samples, of a Dataset along ``sample``, that are scaled to a level of `levels_of`."""
    here = [levels[int(sample)] == level for sample in samples["sample"].values]
    return samples.isel(sample=np.flatnonzero(here))


def by_level(levels, make):
    """Statistics of a case along ``level``; without levels those of all samples together.

    ``make`` returns a Dataset from a function that takes the samples of one level out of a Dataset along ``sample``.
    """
    if not levels:
        return make(lambda samples: samples)
    every = sorted(set(levels.values()))
    parts = [make(lambda samples, level=level: at_level(samples, levels, level)) for level in every]
    return xr.concat(parts, dim=pd.Index(every, name="level"))
