"""Colours of blocks in pictures and animations: one a material, grey for what is driven, told apart in grey too."""

import numpy as np
from matplotlib.colors import to_rgb

_MATERIALS = ("#cfd8dc", "#f2d6a2", "#b9d7ea", "#c9dfb8")
_DRIVEN = "#b0b0b0"


def body_colors(structure):
    """Red, green and blue of every body of a structure, float64 array, shape (n_bodies, 3)."""
    materials = list(structure.file.materials)
    return np.array(
        [
            to_rgb(_DRIVEN if body.driven else _MATERIALS[materials.index(body.material) % len(_MATERIALS)])
            for body in structure.file.bodies
        ]
    )
