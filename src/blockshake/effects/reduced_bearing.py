"""Blocks bear on less than their whole face: edges worn on all sides, which takes 3 % of the mass at 9 cm."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere


def _act(experiment, values, place):
    structure = experiment.structure
    file = structure.file
    mass = {}
    for body, own, driven in zip(file.bodies, structure.mass, structure.driven, strict=True):
        mass[body.material] = mass.get(body.material, 0.0) + (0.0 if driven else own)
    blocks = max(mass, key=mass.get)  # steel beams keep their edges
    worn = sorted({body.shape for body in file.bodies if not body.driven and body.material == blocks})
    return experiment.with_parameters(
        **{
            f"shapes.{name}.chamfer": file.shapes[name].chamfer + values["inset"]
            for name in worn
            if file.shapes[name].box is not None
        }
    )


EFFECT = Effect(
    name="reduced-bearing",
    title="reduced bearing width",
    acts="geometry",
    equation="chamfer of every block + r: it rocks about edges r further in, above g (b - r) / h, and weighs less",
    source="Housner (1963) with the half width b - r",
    parameters=(EffectParameter("inset", "m", "of the edge", 0.0, 0.0, 0.15, 0.06),),
    signature=Signature("onset", "symmetric", "all"),
    confused_with=("impact-restitution",),
    told_apart_by="onset of rocking at several intensities; contact prints on the faces",
    places=nowhere,
    act=_act,
)
