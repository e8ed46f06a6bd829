"""One joint slides at less friction than the others of its materials."""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import face_of, joints, stated_joint
from blockshake.forces.seen.wrench_histories import friction_against_slip

_SCALE = 0.7  # of the coefficient that is missing


def _act(experiment, values, place):
    present = stated_joint(experiment, place).friction_factor
    key = f"joints.{'.'.join(place['joint'])}.friction_factor"
    return experiment.with_parameters(**{key: present * values["factor"]})


def _columns(seen, place):
    face = face_of(seen, place)
    lost = -seen.faces[face].friction * seen.rows.along(friction_against_slip(seen, face))
    return [DesignMatrix({}, lost[:, None], (_SCALE,), True, 1.0)]


EFFECT = Effect(
    name="weak-joint",
    title="joint of low friction",
    acts="contact",
    equation="mu of the joint = r mu",
    source="Coulomb",
    parameters=(EffectParameter("factor", "1", "on the coefficient of friction", 1.0, 0.1, 1.0, 0.25),),
    confused_with=("rate-weakening-friction",),
    distinguished_by="slip of each joint in a test whose acceleration exceeds the reduced friction coefficient times g",
    places=joints,
    act=_act,
    columns=_columns,
    reads=lambda values, size, between: {"factor": np.maximum(1.0 - size, 0.0)},
)
