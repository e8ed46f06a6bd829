"""Friction falls with the slip rate."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere


def _act(experiment, values, place):
    changed = {}
    for entry in experiment.structure.file.friction:
        pair, present, drop = ".".join(entry.pair), entry.rate_drop, values["drop"]
        # what the structure states already stays in proportion
        share = drop / (present + drop) if present + drop > 0.0 else 0.0
        changed[f"friction.{pair}.rate_drop"] = present + drop - present * drop
        changed[f"friction.{pair}.rate_scale"] = entry.rate_scale ** (1.0 - share) * values["scale"] ** share
    return experiment.with_parameters(**changed)


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
