"""Friction falls with the slip rate."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere


def _act(experiment, values, place):
    pairs = [".".join(entry.pair) for entry in experiment.load().file.friction]
    drops = {f"friction.{pair}.rate_drop": values["drop"] for pair in pairs}
    scales = {f"friction.{pair}.rate_scale": values["scale"] for pair in pairs}
    return experiment.with_parameters(**drops, **scales)


EFFECT = Effect(
    name="rate-weakening-friction",
    title="friction that falls with slip rate",
    acts="contact",
    equation="mu(v) = mu (1 - d (1 - exp(-|v| / v_c)))",
    source="exponential (Stribeck) law; concrete on concrete falls with rate: Taklas et al. (2022)",
    parameters=(
        EffectParameter("drop", "1", "share of the coefficient lost at high slip rate", 0.0, 0.0, 0.9, 0.7),
        EffectParameter("scale", "m/s", "slip rate at which 63 % of it is lost", 0.01, 0.001, 0.1, 0.01),
    ),
    signature=Signature("onset", "symmetric", "joint"),
    confused_with=("weak-joint",),
    told_apart_by="sine tests of one acceleration and several frequencies, which slip at several rates",
    places=nowhere,
    act=_act,
)
