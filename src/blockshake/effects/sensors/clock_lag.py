"""The optical system's clock is behind the accelerometers'."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere


def _act(experiment, values, place):
    return experiment.with_instruments(marker_lag=experiment.instruments.marker_lag + values["lag"])


EFFECT = Effect(
    name="clock-lag",
    title="lag of the optical clock",
    acts="observation",
    equation="marker read at t shows t - tau",
    source="two recorders without a common trigger, by definition",
    parameters=(
        EffectParameter("lag", "s", "of the optical clock behind the accelerometers'", 0.0, -0.03, 0.03, 0.01),
    ),
    signature=Signature("quiet", "symmetric"),
    confused_with=("joint-compliance",),
    told_apart_by="phase between a marker and an accelerometer on the same body",
    places=nowhere,
    act=_act,
)  # fmt: skip
