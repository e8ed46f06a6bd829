"""One joint has a soft layer: dust, mortar, rough faces that touch at few points."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import joints, stated_joint


def _act(experiment, values, place):
    present = stated_joint(experiment, place).compliance
    key = f"joints.{'.'.join(place['joint'])}.compliance"
    return experiment.with_parameters(**{key: present + values["compliance"]})


EFFECT = Effect(
    name="joint-compliance",
    title="soft joint",
    acts="contact",
    equation="closure of the joint = c pressure, beside what the blocks give",
    source="Winkler's bed, 1 to 5 GPa/m for dry joints of stone",
    parameters=(
        EffectParameter("compliance", "m3/N", "closure of the joint by pressure", 0.0, 0.0, 6e-10, 3e-10),
    ),
    signature=Signature("quiet", "symmetric", "joint"),
    confused_with=("table-pitch", "clock-lag"),
    told_apart_by="rotation of the joint in a test below uplift; vertical displacement of the slab's markers",
    places=joints,
    act=_act,
)
