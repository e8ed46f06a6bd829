"""Everything that stays as it is in a run of LS-DEM."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.motion import MotionTable, rest_table
from blockshake.dynamics.system import Bodies, Stoppers
from blockshake.solvers.external_forces import ExternalForces, assemble_external_forces
from blockshake.solvers.ls_dem.interfaces import Interfaces, assemble_interfaces
from blockshake.solvers.ls_dem.surfaces import Surfaces, assemble_surfaces


class Assembly(NamedTuple):
    """Bodies and what acts on them.

    ``table``: motion of the driven bodies. ``supported``, ``drop_limit`` (n_bodies,): of `collapse_limits`. ``skin``:
    reach of the lists of near nodes [m]. ``dt`` [s], ``n_steps``: number of the last step.
    """

    bodies: Bodies
    surfaces: Surfaces
    interfaces: Interfaces
    stoppers: Stoppers
    forces: ExternalForces
    table: MotionTable
    supported: np.ndarray
    drop_limit: np.ndarray
    skin: float
    dt: float
    n_steps: int


def assemble(structure, bodies, stoppers, motion, parameters, time_step, n_steps):
    """`Assembly` of a structure under a motion, None for a ground at rest.

    Raises
    ------
    InputError
        A shape that LS-DEM cannot read.
    """
    return Assembly(
        bodies,
        assemble_surfaces(structure, parameters),
        assemble_interfaces(structure, parameters),
        stoppers,
        assemble_external_forces(structure),
        rest_table() if motion is None else motion.table,
        *collapse_limits(structure),
        parameters.skin,
        time_step,
        n_steps,
    )
