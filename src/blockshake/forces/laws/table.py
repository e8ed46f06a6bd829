"""The table's rotation: with its acceleration, a fault of the table, or with the moment on it, a soft base."""

import numpy as np

from blockshake.forces.joint_motion import from_rest
from blockshake.forces.laws.statistic import UNTOLD, slopes

_BLOCK = 0.1  # s, over which residuals go together
_FEWEST = 30  # instants


def table_readings(forces):
    """Rotation of the driven body about y from its mean in the quiet start, and the two things that may turn it.

    Returns
    -------
    rotation, acceleration, moment : float64 arrays, shape (n_times,)
        [rad], along x [m/s2], and the moment about y of all contacts on it about its mass centre [N m]; NaN where
        unknown.

    Notes
    -----
    The moment is the sum over all free bodies of what they require, with the sign turned about: it is determinate
    whatever the joints.
    """
    structure, motion = forces.structure, forces.motion
    driven = int(np.flatnonzero(structure.driven)[0])
    pitch = from_rest(motion.rotation[:, driven, 0, 2], forces.still)
    arm = motion.position - motion.position[:, driven, None]
    wrench = forces.required.wrench
    moment = wrench[..., 4] + arm[..., 2] * wrench[..., 0] - arm[..., 0] * wrench[..., 2]
    return pitch, motion.acceleration[:, driven, 0], -moment[:, ~structure.driven].sum(axis=1)


def table_law(forces):
    """Statistics of the driven body, by name.

    Returns
    -------
    dict of str to Statistic
        ``table.pitch``: rotation about y by the acceleration along x [rad s2/m]; ``table.compliance``: rotation about
        y by the moment [rad/(N m)]; both slopes are of one regression of `table_readings`.
    """
    pitch, *causes = table_readings(forces)
    regressors = np.column_stack(causes)
    told = np.isfinite(pitch) & np.isfinite(regressors).all(axis=1)
    names = ("table.pitch", "table.compliance")
    if told.sum() < _FEWEST:
        return dict.fromkeys(names, UNTOLD)
    block = (forces.motion.time[told] / _BLOCK).astype(int)
    return dict(zip(names, slopes(pitch[told], regressors[told], block), strict=True))
