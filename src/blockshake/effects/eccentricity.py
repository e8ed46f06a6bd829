"""The mass centre of a block lies beside its middle."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import blocks


def _act(experiment, values, place):
    file = experiment.structure.file
    body = next(body for body in file.bodies if body.name == place["body"])
    x, y, z = body.mass_offset
    return experiment.with_parameters(**{f"bodies.{body.name}.mass_offset": [x + values["offset"], y, z]})


EFFECT = Effect(
    name="eccentricity",
    title="eccentric mass of a block",
    acts="geometry",
    equation="mass centre at (e, 0, 0) of the shape's centroid: uplift at g (b - e) / h and g (b + e) / h",
    source="statics of a rigid block; inertia by the parallel-axis theorem",
    parameters=(EffectParameter("offset", "m", "of the mass centre along x", 0.0, -0.15, 0.15, 0.06),),
    signature=Signature("onset", "one-sided", "block"),
    confused_with=("stopper-contact", "marker-offset"),
    told_apart_by="weighing the block on two supports; a test with the block turned about",
    places=blocks,
    act=_act,
)  # fmt: skip
