"""Nonsmooth contact dynamics of elastic and viscoelastic boxes: one call, one trajectory."""

import dataclasses
import functools
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.system import assemble_bodies
from blockshake.solvers.checkpoint import Checkpoint, run_key
from blockshake.solvers.nscd.contact.contacts import Contacts, empty_contacts
from blockshake.solvers.nscd.driver import rows_of, trajectory_of
from blockshake.solvers.nscd.parameters import NscdParameters, StepParameters
from blockshake.solvers.nscd.progress import Joints, Progress, no_joints, start_progress
from blockshake.solvers.nscd.scene import ContactScene, assemble_scene, order_of_bodies, reordered
from blockshake.solvers.nscd_deformable.elastic_bodies import Deformation, Elastic, pack_elastic
from blockshake.solvers.nscd_deformable.elastic_step import ElasticResponse, step_response
from blockshake.solvers.nscd_deformable.loop import integrate
from blockshake.solvers.nscd_deformable.solve.newton import Factor, no_factor
from blockshake.solvers.nscd_deformable.start import settled_state
from blockshake.solvers.pieces import run_in_pieces
from blockshake.solvers.record import RunRecord


class DeformableScene(NamedTuple):
    """Bodies, what acts on them, and how they deform.

    ``spacing`` [m]: of the points of a joint. ``whole``, ``part``: over a whole step, and over a part of one in which
    bodies meet.
    """

    scene: ContactScene
    elastic: Elastic
    spacing: float
    whole: ElasticResponse
    part: ElasticResponse


def assemble_model(structure, bodies, given, stoppers, motion, parameters, time_step, order, viscous):
    """Model of a structure under a motion; arguments as of `assemble_scene` and `simulate_deformable`."""
    rigid = NscdParameters(**parameters.model_dump(include=set(StepParameters.model_fields)))
    elastic = pack_elastic(structure, order, parameters, viscous)
    whole, part = (
        step_response(elastic, time_step / parts, parameters.elastic_theta)
        for parts in (1, parameters.impact_parts)
    )
    return DeformableScene(
        scene=assemble_scene(structure, bodies, given, stoppers, motion, rigid, time_step, order),
        elastic=elastic,
        spacing=parameters.contact_spacing,
        whole=whole,
        part=part,
    )


def simulate_deformable(
    structure, motion, parameters, record_times, time_step=1e-3, checkpoint=None, kept=None, *, viscous
):
    """Motion of deformable boxes with Signorini's condition and Coulomb's friction at the points of their joints.

    Parameters
    ----------
    structure, motion, record_times, time_step, checkpoint, kept
        As of `simulate_nscd`; the driven bodies are rigid.
    parameters : DeformableParameters
    viscous : bool
        Whether the viscous moduli of the materials act.

    Returns
    -------
    Trajectory
        As of `simulate_nscd`: positions, orientations and velocities are those of the bodies' mean axes.
        ``numerics`` has ``energy_lost_to_scheme`` [J] and the number of ``elastic_shapes`` besides.

    Raises
    ------
    InputError
        A free body is not a box, or its mesh is too fine.
    KeyboardInterrupt
        See `run_in_pieces`.

    Notes
    -----
    ``docs/theory/nscd-deformable.md`` has the equations. Bodies are handled from the lowest upwards, whatever their
    order in the file.
    """
    times = np.ascontiguousarray(record_times, dtype=float)
    order = order_of_bodies(structure)
    bodies, given, stoppers = assemble_bodies(structure, motion)
    model = assemble_model(structure, bodies, given, stoppers, motion, parameters, time_step, order, viscous)

    def start():
        touching = structure.touching[np.ix_(order, order)]
        state, deformation = settled_state(model, touching, reordered(given, order))
        return start_progress(state), deformation, empty_contacts(0), no_joints(len(order)), no_factor()

    def rows(progress, deformation, contacts, joints, factor, record):
        return rows_of(order, times, progress, joints, record)

    go_on = functools.partial(integrate, model, times)
    key = run_key(structure, model.scene.table, parameters, times, time_step, viscous)
    kinds = Progress, Deformation, Contacts, Joints, Factor, RunRecord
    saving = Checkpoint(checkpoint, key, kinds)
    code, culprit, parts = run_in_pieces(start, go_on, rows, times, time_step, saving, kept)
    progress, deformation, _, joints, _, record = parts
    trajectory = trajectory_of(structure, order, times, time_step, code, culprit, progress, joints, record)
    figures = {"energy_lost_to_scheme": float(deformation.lost[0]), "elastic_shapes": len(deformation.rate)}
    return dataclasses.replace(trajectory, numerics=trajectory.numerics | figures)


simulate_elastic = functools.partial(simulate_deformable, viscous=False)
simulate_viscoelastic = functools.partial(simulate_deformable, viscous=True)
