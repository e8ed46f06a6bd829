"""A point of a body as the forms from outside take it, with a motion of its own."""

from types import SimpleNamespace

import numpy as np


def moved_point(displacement, velocity, place="block-2@0"):
    """Give `Points` of one test: a point that a force along a row's own direction acts on, (n_rows,) each [m, m/s]."""
    point = SimpleNamespace(
        unit=np.ones(len(displacement)),
        displacement=displacement,
        velocity=velocity,
        fine_velocity=velocity,
        through_kernel=np.asarray,
    )
    return SimpleNamespace(place=place, by_test=[point])
