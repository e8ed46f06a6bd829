"""Two bodies that meet obliquely while one of them spins, and their momenta."""

import numpy as np
from scipy.spatial.transform import Rotation

BODIES = [
    {"name": "a", "shape": "cube", "position": [0.0, 0.0, 2.0], "velocity": [0.5, 0.2, 1.0]},
    {
        "name": "b", "shape": "block", "position": [0.3, 0.2, 3.5], "angular_velocity": [1.0, -0.5, 0.3],
        "orientation": [np.cos(0.1), np.sin(0.1), 0.0, 0.0],
    },
]  # fmt: skip


def momenta(structure, run):
    """Linear momentum, and angular momentum about the origin, of both bodies: (n_times, 3) each, over the first's."""
    assert len(run.joints) == 1  # they did meet
    assert np.abs(run.velocity[-1, 1] - run.velocity[0, 1]).max() > 0.1
    moved = structure.mass[1:, None] * run.velocity[:, 1:]
    angular = np.cross(run.position[:, 1:], moved).sum(axis=1)
    for body in (1, 2):
        R = Rotation.from_quat(run.orientation[:, body], scalar_first=True).as_matrix()
        angular += np.einsum(
            "tij,jk,tlk,tl->ti", R, structure.inertia[body], R, run.angular_velocity[:, body]
        )
    return moved.sum(axis=1) / structure.mass[1], angular / structure.mass[1]
