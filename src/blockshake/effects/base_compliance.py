"""The driven body rocks on what carries it: a slab on grout or a table that gives under the overturning moment."""

from dataclasses import replace

import numpy as np

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere
from blockshake.geometry.rotations import rotation_matrices

_THICKNESS = 0.2  # m, of the body beneath; it is driven, so that its mass does not count
_GRIP = 2.0  # coefficient of friction towards it: the driven body does not slide on its bed


def _act(experiment, values, place):
    if values["compliance"] == 0.0:
        return experiment
    for name in [body.name for body in experiment.structure.file.bodies if body.driven]:
        experiment = _bedded(experiment, name, values["compliance"])
    return experiment


def _bedded(experiment, name, compliance):
    """The experiment with a driven body beneath another one, which is free now, and a soft layer between the two.

    A layer of the compliance c over a plan of the second moment I turns by ``M c / I``.
    """
    structure = experiment.structure
    index = structure.body_names.index(name)
    body = structure.file.bodies[index]
    vertices = structure.solids[body.shape].vertices
    size = np.ptp(vertices, axis=0)
    down = np.array(
        [0.0, 0.0, 0.5 * (vertices[:, 2].max() + vertices[:, 2].min()) - 0.5 * (size[2] + _THICKNESS)]
    )
    beneath = {
        "name": f"{name}-bed",
        "shape": f"{name}-bed",
        "material": body.material,
        "position": (
            structure.centroid[index] + rotation_matrices(structure.orientation[index]) @ down
        ).tolist(),
        "orientation": list(body.orientation),
        "driven": True,
    }
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"][f"{name}-bed"] = {"box": [float(size[0]), float(size[1]), _THICKNESS]}
    mapping["bodies"][index]["driven"] = False
    mapping["bodies"].append(beneath)
    friction = next((one for one in mapping["friction"] if set(one["pair"]) == {body.material}), None)
    if friction is None:
        friction = {"pair": [body.material, body.material], "coefficient": _GRIP}
        mapping["friction"].append(friction)
    mapping["joints"].append(
        {
            "bodies": [f"{name}-bed", name],
            "friction_factor": _GRIP / friction["coefficient"],
            "compliance": float(compliance * size[1] * size[0] ** 3 / 12.0),
        }
    )
    return replace(experiment, structure=structure.with_mapping(mapping))


EFFECT = Effect(
    name="base-compliance",
    title="compliant base",
    acts="contact",
    equation="rotation of the driven body = c M, M the moment on it about y, as a bed of springs beneath it",
    source="rocking stiffness of a bedded slab: Winkler's bed; range of shake tables and grouted slabs",
    parameters=(
        EffectParameter("compliance", "rad/(N m)", "rotation of the base by moment", 0.0, 0.0, 6e-9, 2e-9),
    ),
    signature=Signature("quiet", "symmetric", "slab"),
    confused_with=("table-pitch", "joint-compliance"),
    told_apart_by="vertical displacement of two markers on the slab, apart along x, under blocks of another mass",
    places=nowhere,
    act=_act,
)
