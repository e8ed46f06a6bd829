"""Soft layers in joints: what mortar, dust or asperities add to the compliance of a joint along its normal."""

import numpy as np


def joint_compliance(structure):
    """Normal compliance of the layer in each joint, for either solver.

    Returns
    -------
    float64 array, shape (n_bodies, n_bodies)
        Symmetric, zero where there is no layer: closing per pressure [m3/N].
    """
    compliance = np.zeros((len(structure.mass), len(structure.mass)))
    for joint in structure.file.joints:
        a, b = (structure.body_names.index(name) for name in joint.bodies)
        compliance[a, b] = compliance[b, a] = joint.compliance
    return compliance
