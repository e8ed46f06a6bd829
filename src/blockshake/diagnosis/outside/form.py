"""Definition of a form in which something from outside of the registry acts on a structure."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from blockshake.geometry.rotations import rotation_matrices


@dataclass(frozen=True)
class LoadShape:
    """A form, its size, and the same in the simulation."""

    # name, title: as in ``verdict.json``, and as in reports
    name: str
    title: str
    # size, unit: name and unit of the size
    size: str
    unit: str
    # of `JointRows`, the place and ``when``: rows of the form at the size 1, (n_rows,), of one with more sizes a
    # column each. None where the form states nothing of tests to come
    rows: Callable | None = None
    # of an experiment, the sizes, the place, what else the form is (``when``), and the name of a test: the
    # experiment with it. None of a form that no model holds
    act: Callable | None = None
    # of ``when``: whether the form acts in tests that are still to come, and so can be tried on a sealed one
    lasts: Callable = lambda when: True
    more: tuple = ()  # of (str, str); names and units of further sizes, none of which is negative

    @property
    def units(self):
        """Units by name of all sizes, in their order."""
        return {self.size: self.unit, **dict(self.more)}


def force_entry(structure, place, **values):
    """An entry of ``external_forces`` at a place, ``{"body": name, "height": over the body's height}``."""
    index = structure.body_names.index(place["body"])
    return {"body": place["body"], "position": above_centre(structure, index, place["height"]), **values}


def above_centre(structure, index, height):
    """Point above a body's mass centre by a share of its height, body frame, from the centroid [m]."""
    tall = float(np.ptp(structure.solids[structure.file.bodies[index].shape].vertices[:, 2]))
    turn = rotation_matrices(structure.orientation[index])
    return (structure.mass_offset[index] + height * tall * turn[2]).tolist()


def with_entry(experiment, key, entry):
    """An experiment with one more entry of a list of its structure file."""
    present = [one.model_dump() for one in getattr(experiment.structure.file, key)]
    return experiment.with_parameters(**{key: [*present, entry]})
