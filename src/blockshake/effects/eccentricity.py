"""The mass centre of a block lies off its middle."""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import blocks
from blockshake.forces.seen.wrench_histories import mass_centre_off

_SCALE = 0.06  # m


def _act(experiment, values, place):
    file = experiment.structure.file
    body = next(body for body in file.bodies if body.name == place["body"])
    x, y, z = body.mass_offset
    return experiment.with_parameters(**{f"bodies.{body.name}.mass_offset": [x + values["offset"], y, z]})


def _columns(seen, place):
    """The mass centre at most the radius of gyration off: no mass within the shape has it further out."""
    structure = seen.structure
    body = structure.body_names.index(place["body"])
    solid = structure.solids[structure.file.bodies[body].shape]
    inertia = solid.properties.inertia / solid.properties.volume
    reach = np.sqrt(0.5 * np.trace(inertia) - inertia[0, 0]) - abs(structure.mass_offset[body, 0])
    rows = seen.rows.along(mass_centre_off(seen, body))
    return [DesignMatrix({}, rows[:, None], (_SCALE,), False, float(reach))]


EFFECT = Effect(
    name="eccentricity",
    title="eccentric mass of a block",
    acts="geometry",
    equation="mass centre at (e, 0, 0) of the shape's centroid: uplift at g (b - e) / h and g (b + e) / h",
    source="statics of a rigid block; inertia by the parallel-axis theorem",
    parameters=(EffectParameter("offset", "m", "of the mass centre along x", 0.0, -0.15, 0.15, 0.06),),
    confused_with=("stopper-contact", "marker-offset"),
    distinguished_by="weighing the block on two supports; a test with the block turned about",
    places=blocks,
    act=_act,
    columns=_columns,
    reads=lambda values, size, between: {"offset": size},
)  # fmt: skip
