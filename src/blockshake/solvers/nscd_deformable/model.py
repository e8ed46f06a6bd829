"""Everything that stays as it is in a run with deformable bodies."""

from typing import NamedTuple

from blockshake.solvers.nscd.parameters import NscdParameters, StepParameters
from blockshake.solvers.nscd.scene import ContactScene, assemble_scene
from blockshake.solvers.nscd_deformable.elastic_bodies import Elastic, pack_elastic
from blockshake.solvers.nscd_deformable.elastic_step import ElasticResponse, step_response


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


def assemble_model(structure, bodies, stoppers, motion, parameters, time_step, order, viscous):
    """Model of a structure under a motion; arguments as of `assemble_scene` and `simulate_deformable`."""
    rigid = NscdParameters(**parameters.model_dump(include=set(StepParameters.model_fields)))
    elastic = pack_elastic(structure, order, parameters, viscous)
    whole, part = (
        step_response(elastic, time_step / parts, parameters.elastic_theta)
        for parts in (1, parameters.impact_parts)
    )
    return DeformableScene(
        scene=assemble_scene(structure, bodies, stoppers, motion, rigid, time_step, order),
        elastic=elastic,
        spacing=parameters.contact_spacing,
        whole=whole,
        part=part,
    )
