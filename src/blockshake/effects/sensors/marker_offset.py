"""One marker sits elsewhere on its block than the structure says."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import markers


def _act(experiment, values, place):
    offsets, name = experiment.instruments.marker_offset, place["marker"]
    x, y, z = offsets.get(name, (0.0, 0.0, 0.0))
    return experiment.with_instruments(marker_offset={**offsets, name: (x, y, z + values["height"])})


EFFECT = Effect(
    name="marker-offset",
    title="offset of a marker",
    acts="observation",
    equation="reading = displacement of the point (0, 0, e) above the stated one, body frame",
    source="rigid-body kinematics",
    parameters=(EffectParameter("height", "m", "of the marker above its stated place", 0.0, -0.1, 0.1, 0.05),),
    signature=Signature("onset", "symmetric"),
    confused_with=("sensor-gain", "eccentricity"),
    told_apart_by="rigid fit of at least four markers of the block while it rotates",
    places=markers,
    act=_act,
)  # fmt: skip
