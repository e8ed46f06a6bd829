"""Blocks bear on less than their whole face: edges rounded or worn on both sides."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere


def _act(experiment, values, place):
    file = experiment.load().file
    free = sorted({body.shape for body in file.bodies if not body.driven})
    worn = {
        f"shapes.{name}.chamfer": file.shapes[name].chamfer + values["inset"]
        for name in free
        if file.shapes[name].box is not None
    }
    return experiment.with_parameters(**worn)


EFFECT = Effect(
    name="reduced-bearing",
    title="reduced bearing width",
    acts="geometry",
    equation="chamfer of every block + r: it rocks about edges r further in, above g (b - r) / h",
    source="Housner (1963) with the half width b - r",
    parameters=(EffectParameter("inset", "m", "of the edge", 0.0, 0.0, 0.15, 0.06),),
    signature=Signature("onset", "symmetric", "all"),
    confused_with=("impact-restitution", "joint-compliance"),
    told_apart_by="onset of rocking at several intensities; contact prints on the faces",
    places=nowhere,
    act=_act,
)
