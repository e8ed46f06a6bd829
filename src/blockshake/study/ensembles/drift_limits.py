"""Displacements of blocks and slips of joints that count as a potential collapse."""

import numpy as np

from blockshake.geometry.reference_block import upright_size
from blockshake.measurement.motion.joints import find_joints

OF_JOINT = "/"  # between the two bodies of a joint that a limit is given for


def drift_limits(structure, given=None):
    """Horizontal displacement against the slab that counts as a potential collapse of a block.

    Parameters
    ----------
    structure : Structure
    given : float or dict of str to float, optional
        For all blocks, or by the name of a block [m]. By default half of each block's own smaller horizontal width: a
        block that slides so far over a support of its own width has its mass centre above the edge.

    Returns
    -------
    float64 array, shape (n_bodies,)
        [m]; NaN for driven bodies, which have none.
    """
    if isinstance(given, float | int):
        limits = np.full(len(structure.mass), float(given))
    else:
        widths = [upright_size(structure, body)[:2].min() for body in range(len(structure.mass))]
        named = given or {}
        limits = np.array(
            [named.get(name, 0.5 * width) for name, width in zip(structure.body_names, widths, strict=True)]
        )
    return np.where(structure.driven, np.nan, limits)


def limits_joints(given):
    """Whether limits that are given name a joint."""
    return isinstance(given, dict) and any(OF_JOINT in name for name in given)


def slip_limits(structure, given=None):
    """Slip at the middle of a joint that counts as a potential collapse, where ``given`` names the joint.

    Returns
    -------
    dict of tuple of str to float
        By lower and upper body [m], of the joints that the structure has at its start.
    """
    if not limits_joints(given):
        return {}
    pairs = [tuple(structure.body_names[body] for body in pair) for pair in find_joints(structure)[0]]
    limits = {frozenset(name.split(OF_JOINT)): limit for name, limit in given.items() if OF_JOINT in name}
    return {pair: limits[frozenset(pair)] for pair in pairs if frozenset(pair) in limits}
