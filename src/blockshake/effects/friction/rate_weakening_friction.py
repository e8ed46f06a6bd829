"""Friction falls with the slip rate."""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import nowhere
from blockshake.forces.seen.wrench_histories import friction_against_slip, slips_early

_SCALE = 0.6
_MOST = 0.99  # of the coefficient
_RATES = (0.003, 0.01, 0.03, 0.1)  # m/s


def with_drop(experiment, values, along):
    """The experiment with friction that falls ``along`` the ``rate`` or the ``slip`` of every joint."""
    changed = {}
    for entry in experiment.structure.file.friction:
        pair, drop = ".".join(entry.pair), values["drop"]
        present, scale = getattr(entry, f"{along}_drop"), getattr(entry, f"{along}_scale")
        # what the structure states already stays in proportion
        share = drop / (present + drop) if present + drop > 0.0 else 0.0
        changed[f"friction.{pair}.{along}_drop"] = present + drop - present * drop
        changed[f"friction.{pair}.{along}_scale"] = scale ** (1.0 - share) * values["scale"] ** share
    return experiment.with_parameters(**changed)


def drop_columns(seen, history, scales):
    """`DesignMatrix` of the friction that all joints lose, by ``history`` (n_times, n_joints) over each of some scales.

    A joint that begins to slip at less than half of its friction has not lost it by this law.
    """
    full = [
        f.friction * seen.rows.along(friction_against_slip(seen, i)) * (not slips_early(seen, i))
        for i, f in enumerate(seen.faces)
    ]
    drops = (1.0 - np.exp(-history[seen.rows.instant] / scale) for scale in scales)
    return [
        DesignMatrix(
            {"scale": scale}, -(np.stack(full, axis=1) * drop).sum(axis=1)[:, None], (_SCALE,), True, _MOST
        )
        for scale, drop in zip(scales, drops, strict=True)
    ]


def read_drop(values, size, between, scales):
    """Drop and scale from what was found."""
    ratio = scales[1] / scales[0]
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
    confused_with=("weak-joint", "slip-weakening-friction"),
    distinguished_by="sine tests of one acceleration and several frequencies, which slip at several rates",
    places=nowhere,
    act=lambda experiment, values, place: with_drop(experiment, values, "rate"),
    columns=lambda seen, place: drop_columns(seen, np.abs(seen.joints.slip_rate), _RATES),
    reads=lambda values, size, between: read_drop(values, size, between, _RATES),
)
