"""Everything that stays as it is in a run, bodies from the lowest upwards."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import collapse_limits
from blockshake.dynamics.friction import joint_compliance
from blockshake.dynamics.motion import MotionTable, rest_table
from blockshake.dynamics.system import Bodies, Stoppers
from blockshake.solvers.external_forces import ExternalForces, assemble_external_forces
from blockshake.solvers.nscd.contact.law import OrderedFriction, ordered_friction
from blockshake.solvers.nscd.contact.polyhedra import Polyhedra, pack_polyhedra


class Settings(NamedTuple):
    """Numbers of the method: ``dt`` [s]; ``restitution`` [1] of Newton; the rest as in `NscdParameters`."""

    dt: float
    theta: float
    tolerance: float
    max_iterations: int
    shrink: float
    restitution: float
    impact_parts: int


class Watch(NamedTuple):
    """Collapse limits of `collapse_limits`, and ``base``: first driven body of the file, -1 without one."""

    supported: np.ndarray
    drop_limit: np.ndarray
    base: int


class ContactScene(NamedTuple):
    """Bodies and what acts on them.

    ``layers`` (n_bodies, n_bodies): compliance of the layers in the joints [m3/N]. ``table``: motion of the driven
    bodies.
    """

    bodies: Bodies
    friction: OrderedFriction
    stoppers: Stoppers | None
    forces: ExternalForces | None
    layers: np.ndarray
    polyhedra: Polyhedra
    table: MotionTable
    settings: Settings
    watch: Watch


def order_of_bodies(structure):
    """Indices of the bodies from the lowest upwards, then along x, then y: int64 (n_bodies,)."""
    centroid = structure.centroid
    return np.lexsort((centroid[:, 1], centroid[:, 0], centroid[:, 2]))


def reordered(part, order):
    """Bodies or State with their bodies in another order."""
    return type(part)(*(values if values is None else np.ascontiguousarray(values[order]) for values in part))


def assemble_scene(structure, bodies, given, stoppers, motion, parameters, time_step, order):
    """Scene of a structure under a motion; ``order`` int64 (n_bodies,) is that of `order_of_bodies`.

    ``bodies``, ``given`` (State) and ``stoppers`` are those of `assemble_bodies`, in the order of the file; ``motion``
    is None for a ground at rest; ``parameters`` (NscdParameters); ``time_step`` [s].

    Raises
    ------
    InputError
        A shape is not convex.
    """
    rank = np.argsort(order)
    table = rest_table() if motion is None else motion.table
    driven, forces = np.flatnonzero(structure.driven), assemble_external_forces(structure, given)
    base = int(rank[driven[0]]) if len(driven) else -1
    supported, drop_limit = collapse_limits(structure)
    return ContactScene(
        bodies=reordered(bodies._replace(gravity=None), order)._replace(gravity=bodies.gravity),
        friction=ordered_friction(structure, order),
        stoppers=stoppers and stoppers._replace(body=rank[stoppers.body]),
        forces=forces
        and forces._replace(body=rank[forces.body], base=base, given=reordered(forces.given, order)),
        layers=np.ascontiguousarray(joint_compliance(structure)[np.ix_(order, order)]),
        polyhedra=pack_polyhedra(structure, order),
        table=MotionTable(*(np.ascontiguousarray(part) for part in table)),
        settings=Settings(
            float(time_step),
            parameters.theta,
            parameters.tolerance,
            parameters.max_iterations,
            parameters.shrink,
            structure.file.nscd_restitution,
            parameters.impact_parts,
        ),
        watch=Watch(supported[order], drop_limit[order], base),
    )
