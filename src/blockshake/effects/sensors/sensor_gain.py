"""One marker reads its displacement too large or too small."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import markers


def _act(experiment, values, place):
    gains, name = experiment.instruments.marker_gain, place["marker"]
    return experiment.with_instruments(
        marker_gain={**gains, name: gains.get(name, 1.0) * (1.0 + values["error"])}
    )


EFFECT = Effect(
    name="sensor-gain",
    title="gain of a marker",
    acts="observation",
    equation="reading = (1 + g) displacement",
    source="scale error of a camera, by definition",
    parameters=(EffectParameter("error", "1", "relative error of the gain", 0.0, -0.1, 0.1, 0.03),),
    signature=Signature("quiet", "symmetric"),
    confused_with=("marker-offset",),
    told_apart_by="rigid fit of at least four markers of the block; a test in which the blocks do not move",
    places=markers,
    act=_act,
)
