"""Friction falls with the slip that a joint has made in the test, either way: asperities wear off."""

import numpy as np

from blockshake.effects.effect import Effect, EffectParameter
from blockshake.effects.friction.rate_weakening_friction import drop_columns, read_drop, with_drop
from blockshake.effects.places import nowhere

_SLIPS = (0.003, 0.01, 0.03, 0.1)  # m


def _columns(seen, place):
    step = seen.motion.time[1] - seen.motion.time[0]
    slipping = np.nan_to_num(np.abs(seen.joints.slip_rate)) * (seen.states.slip != 0)
    return drop_columns(seen, step * np.cumsum(slipping, axis=0), _SLIPS)


EFFECT = Effect(
    name="slip-weakening-friction",
    title="friction that falls with slip",
    acts="contact",
    equation="mu(S) = mu (1 - d (1 - exp(-S / S_c))), S the slip that the joint has made, either way",
    source="exponential law of slip weakening; docs/method.md has the literature on concrete",
    parameters=(
        EffectParameter("drop", "1", "share of the coefficient lost after long slip", 0.0, 0.0, 0.9, 0.7),
        EffectParameter("scale", "m", "slip after which 63 % of it is lost", 0.01, 0.001, 0.1, 0.01),
    ),
    confused_with=("weak-joint", "rate-weakening-friction"),
    distinguished_by="sine tests of one rate and many cycles: the coefficient falls from cycle to cycle",
    places=nowhere,
    act=lambda experiment, values, place: with_drop(experiment, values, "slip"),
    columns=_columns,
    reads=lambda values, size, between: read_drop(values, size, between, _SLIPS),
)
