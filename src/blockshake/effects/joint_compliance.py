"""One joint has a soft layer: dust, mortar, rough faces that touch at few points."""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import face_of, joints, stated_joint
from blockshake.forces.seen.wrench_histories import bed_inset, edge_inward, normal_force

COMPLIANCES = np.geomspace(2e-11, 1e-9, 18)  # m3/N
_RATIO = COMPLIANCES[1] / COMPLIANCES[0]
_SMALLEST = 1e-4  # rad


def _act(experiment, values, place):
    present = stated_joint(experiment, place).compliance
    key = f"joints.{'.'.join(place['joint'])}.compliance"
    return experiment.with_parameters(**{key: present + values["compliance"]})


def _columns(seen, place):
    """Edge further in by the `bed_inset` of a layer, for every compliance."""
    face = face_of(seen, place)
    inward, instant = seen.rows.along(edge_inward(seen, face)), seen.rows.instant
    turn = np.maximum(np.abs(seen.joints.rotation[instant, face]), _SMALLEST)
    normal = np.maximum(normal_force(seen, face)[instant], 0.0)
    return [
        DesignMatrix(
            {"compliance": float(value)},
            (inward * bed_inset(normal, value, turn, seen.faces[face]))[:, None],
            None,
            True,
        )
        for value in COMPLIANCES
    ]


def rotation_by_compliance(lever, normal, half_width, length):
    """Rotation of a closed joint over its compliance, ``phi / c`` [N/m3]: Winkler's bed without tension.

    ``e N / I`` while the resultant lies in the middle third (I the second moment of the face), and ``2 N / (9 L (b -
    e)^2)`` beyond, where the pressed part is ``3 (b - e)`` wide.

    Parameters
    ----------
    lever, normal : float64 arrays, shape (n_rows,)
        Distance of the resultant from the middle [m], and its normal force [N].
    half_width, length : float
        The face along and across the lever [m].
    """
    second_moment = length * (2.0 * half_width) ** 3 / 12.0
    away = np.minimum(np.abs(lever), 0.99 * half_width)
    partly = np.sign(lever) * 2.0 * normal / (9.0 * length * (half_width - away) ** 2)
    return np.where(away < half_width / 3.0, lever * normal / second_moment, partly)


EFFECT = Effect(
    name="joint-compliance",
    title="soft joint",
    acts="contact",
    equation="closure of the joint = c pressure, next to what the blocks give",
    source="Winkler's bed, 1 to 5 GPa/m for dry joints of stone",
    parameters=(
        EffectParameter("compliance", "m3/N", "closure of the joint by pressure", 0.0, 0.0, 6e-10, 3e-10),
    ),
    confused_with=("table-pitch", "clock-lag"),
    distinguished_by="rotation of the joint in a test below uplift; vertical displacement of the slab's markers",
    places=joints,
    act=_act,
    columns=_columns,
    reads=lambda values, size, between: {"compliance": size * values["compliance"] * _RATIO**between},
)
