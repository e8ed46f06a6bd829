"""Friction is larger for slip to one side than to the other, as of faces that were cut or worn one way."""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import nowhere
from blockshake.forces.seen.wrench_histories import friction_against_slip

_SCALE, _LARGEST = 0.3, 0.99


def _act(experiment, values, place):
    changed = {
        f"friction.{'.'.join(one.pair)}.asymmetry": one.asymmetry + values["asymmetry"]
        for one in experiment.structure.file.friction
    }
    return experiment.with_parameters(**changed)


def _columns(seen, place):
    rows = np.zeros(len(seen.rows.value))
    for index, face in enumerate(seen.faces):
        towards = seen.states.slip[seen.rows.instant, index]
        rows += face.friction * towards * seen.rows.along(friction_against_slip(seen, index))
    return [DesignMatrix({}, rows[:, None], (_SCALE,), False, 1.0)]


EFFECT = Effect(
    name="friction-asymmetry",
    title="friction of two sides",
    acts="contact",
    equation="mu (1 + a) for slip of the upper body towards +x, mu (1 - a) towards -x",
    source="Coulomb, for each direction",
    parameters=(EffectParameter("asymmetry", "1", "of the coefficient", 0.0, -0.5, 0.5, 0.3),),
    confused_with=("eccentricity",),
    distinguished_by="a test with the motion reversed; a jack that pushes the block to either side",
    places=nowhere,
    act=_act,
    columns=_columns,
    reads=lambda values, size, between: {"asymmetry": np.clip(size, -_LARGEST, _LARGEST)},
)
