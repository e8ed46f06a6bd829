"""Friction falls with the slip rate."""

import numpy as np

from blockshake.effects.effect import Columns, Effect, EffectParameter
from blockshake.effects.places import nowhere
from blockshake.forces.seen.wrench_histories import friction_against_slip

_SCALE = 0.6
_MOST = 0.99  # of the coefficient
_RATES = (0.003, 0.01, 0.03, 0.1)  # m/s


def _act(experiment, values, place):
    changed = {}
    for entry in experiment.structure.file.friction:
        pair, present, drop = ".".join(entry.pair), entry.rate_drop, values["drop"]
        # what the structure states already stays in proportion
        share = drop / (present + drop) if present + drop > 0.0 else 0.0
        changed[f"friction.{pair}.rate_drop"] = present + drop - present * drop
        changed[f"friction.{pair}.rate_scale"] = entry.rate_scale ** (1.0 - share) * values["scale"] ** share
    return experiment.with_parameters(**changed)


def _columns(seen, place):
    return [Columns({"scale": rate}, _lost(seen, rate)[:, None], (_SCALE,), True) for rate in _RATES]


def _lost(seen, scale):
    """Rows of the friction that all joints lose at full drop."""
    lost = np.zeros(len(seen.rows.value))
    for index, face in enumerate(seen.faces):
        rate = np.abs(seen.joints.slip_rate[seen.rows.instant, index])
        drop = 1.0 - np.exp(-rate / scale)
        lost -= face.friction * drop * seen.rows.along(friction_against_slip(seen, index))
    return lost


def _reads(values, size, between):
    ratio = _RATES[1] / _RATES[0]
    return {"drop": np.minimum(size, _MOST), "scale": values["scale"] * ratio**between}


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
    confused_with=("weak-joint",),
    told_apart_by="sine tests of one acceleration and several frequencies, which slip at several rates",
    places=nowhere,
    act=_act,
    columns=_columns,
    reads=_reads,
)
