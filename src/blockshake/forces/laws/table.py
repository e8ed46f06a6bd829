"""The table's rotation: with its acceleration, a fault of the table, or with the moment on it, a soft base."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, slopes

_BLOCK = 0.1  # s, over which residuals go together
_FEWEST = 30  # instants


def table_law(forces):
    """Statistics of the driven body, by name.

    Returns
    -------
    dict of str to Statistic
        ``table.pitch``: rotation about y by the acceleration along x [rad s2/m]; ``table.compliance``: rotation about
        y by the moment of all contacts on it about its mass centre [rad/(N m)].

    Notes
    -----
    The moment is the sum over all free bodies of what they require, with the sign turned about: it is
    determinate whatever the joints. Both slopes are of one regression.
    """
    structure, motion = forces.structure, forces.motion
    driven = int(np.flatnonzero(structure.driven)[0])
    pitch = motion.rotation[:, driven, 0, 2]
    pitch = pitch - np.nanmean(pitch[forces.still]) if forces.still.any() else pitch
    arm = motion.position - motion.position[:, driven, None]
    wrench = forces.required.wrench
    moment = wrench[..., 4] + arm[..., 2] * wrench[..., 0] - arm[..., 0] * wrench[..., 2]
    on_table = -moment[:, ~structure.driven].sum(axis=1)
    regressors = np.column_stack([motion.acceleration[:, driven, 0], on_table])
    told = np.isfinite(pitch) & np.isfinite(regressors).all(axis=1)
    names = ("table.pitch", "table.compliance")
    if told.sum() < _FEWEST:
        return dict.fromkeys(names, UNTOLD)
    block = (motion.time[told] / _BLOCK).astype(int)
    return dict(zip(names, slopes(pitch[told], regressors[told], block), strict=True))
