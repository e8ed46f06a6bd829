"""The least unexplained force of a test in few numbers."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, Statistic

_FEWEST = 20  # instants


def unexplained_law(forces):
    """Statistics of the least unexplained force, by name.

    Returns
    -------
    dict of str to Statistic
        ``unexplained.rms`` and ``unexplained.largest``: root mean square and largest over the test of its horizontal
        resultant on all blocks over their weight; ``unexplained.mean``: its mean [1].
    """
    names = ("unexplained.rms", "unexplained.largest", "unexplained.mean")
    structure = forces.structure
    weight = structure.mass[~structure.driven].sum() * np.linalg.norm(structure.file.gravity)
    force = forces.least.wrench[:, ~structure.driven, 0].sum(axis=1) / weight
    force = force[np.isfinite(force)]
    if len(force) < _FEWEST:
        return dict.fromkeys(names, UNTOLD)
    found = np.sqrt(np.mean(force**2)), np.abs(force).max(), force.mean()
    error = float(found[0] / np.sqrt(len(force)))
    return {name: Statistic(float(value), error) for name, value in zip(names, found, strict=True)}
