"""Everything that stays as it is in a run with deformable bodies."""

from typing import NamedTuple

from blockshake.solvers.nscd.parameters import NscdParameters, StepParameters
from blockshake.solvers.nscd.scene import Scene, assemble_scene
from blockshake.solvers.nscd_deformable.elastic_bodies import Elastic, pack_elastic
from blockshake.solvers.nscd_deformable.elastic_step import Response, step_response


class Model(NamedTuple):
    """Bodies, what acts on them, and how they deform.

    ``spacing`` [m]: of the points of a joint. ``whole``, ``part``: over a whole step, and over a part of one in which
    bodies meet.
    """

    scene: Scene
    elastic: Elastic
    spacing: float
    whole: Response
    part: Response


def assemble_model(structure, bodies, stoppers, motion, parameters, time_step, order, viscous):
    """Model of a structure under a motion; arguments as of `assemble_scene` and `simulate_deformable`."""
    rigid = NscdParameters(**parameters.model_dump(include=set(StepParameters.model_fields)))
    elastic = pack_elastic(structure, order, parameters, viscous)
    whole, part = (
        step_response(elastic, time_step / parts, parameters.elastic_theta)
        for parts in (1, parameters.impact_parts)
    )
    return Model(
        scene=assemble_scene(structure, bodies, stoppers, motion, rigid, time_step, order),
        elastic=elastic,
        spacing=parameters.contact_spacing,
        whole=whole,
        part=part,
    )
