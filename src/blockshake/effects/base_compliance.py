"""The first driven body rocks on what carries it: a slab on grout, or a table that gives under overturning moment."""

from dataclasses import replace

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import nowhere
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import DEEPEST_OVERLAP

_THICKNESS = 0.2  # m, of the body beneath; it is driven, so that its mass does not count
_WIDER = 3.0  # width of the bed over that of what stands on it: an edge stays within its middle third
_SINK = 0.8 * DEEPEST_OVERLAP  # nodes of LS-DEM sink farther than the layer: 4 % were seen
_SCALE = 2e-9  # rad/(N m)
_GRIP = 2.0  # coefficient of friction towards it: the driven body does not slide on its bed


def _act(experiment, values, place):
    driven = np.flatnonzero(experiment.structure.driven)
    if values["compliance"] == 0.0 or not len(driven):
        return experiment
    return _bedded(experiment, int(driven[0]), values["compliance"])


def _bedded(experiment, index, compliance):
    """The experiment with a driven bed beneath a body, which is free now, and a soft layer between the two.

    A layer of the compliance c over a plan of the second moment I turns by ``M c / I``. The bed is not wider than
    keeps the layer pressed, nor than lets it sink by what a structure file may start with: the narrower it is, the
    less it sinks for the same rotation. It stands as much higher as the layer sinks under the weight, so that
    everything starts where the structure has it.
    """
    structure = experiment.structure
    body, turn = structure.file.bodies[index], rotation_matrices(structure.orientation[index])
    vertices = structure.solids[body.shape].vertices
    size, bottom = np.ptp(vertices, axis=0), vertices[:, 2].min()
    carried = ~structure.driven
    weight = structure.mass[carried | (np.arange(len(carried)) == index)].sum() * -structure.file.gravity[2]
    pressed = np.sqrt(12.0 * _SINK / (weight * compliance))  # m; wider, it would sink farther
    width = float(min(size[0], _WIDER * _extent(structure, carried), pressed))
    layer = compliance * size[1] * width**3 / 12.0
    sink = weight * layer / (size[1] * width)
    middle = structure.position[carried, 0].mean() - structure.centroid[index, 0]
    middle = float(np.clip(middle, 0.5 * (width - size[0]), 0.5 * (size[0] - width)))
    bed = f"{body.name}-bed"
    beneath = {
        "name": bed,
        "shape": bed,
        "material": body.material,
        "position": (
            structure.centroid[index] + turn @ [middle, 0.0, bottom - 0.5 * _THICKNESS + sink]
        ).tolist(),
        "orientation": list(body.orientation),
        "driven": True,
    }
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"][bed] = {"box": [width, float(size[1]), _THICKNESS]}
    mapping["bodies"][index]["driven"] = False
    mapping["bodies"].append(beneath)
    friction = next((entry for entry in mapping["friction"] if set(entry["pair"]) == {body.material}), None)
    if friction is None:
        friction = {"pair": [body.material, body.material], "coefficient": _GRIP}
        mapping["friction"].append(friction)
    joint = {"friction_factor": _GRIP / friction["coefficient"], "compliance": float(layer)}
    mapping["joints"].append({"bodies": [bed, body.name], **joint})
    return replace(experiment, structure=structure.with_mapping(mapping))


def _extent(structure, chosen):
    """Extent along x of some bodies at the start [m]."""
    ends = []
    for index in np.flatnonzero(chosen):
        solid = structure.solids[structure.file.bodies[index].shape]
        along = (solid.vertices @ rotation_matrices(structure.orientation[index]).T)[:, 0]
        ends += [structure.centroid[index, 0] + along.min(), structure.centroid[index, 0] + along.max()]
    return max(ends) - min(ends)


def _turns(slab):
    """Rotation of the slab by the moment at its bottom."""
    return [DesignMatrix({}, slab.moment[slab.at][:, None], (_SCALE,), False)]


EFFECT = Effect(
    name="base-compliance",
    title="compliant base",
    acts="contact",
    equation="rotation of the driven body = c M, M the moment about y at its bottom, as a bed of springs beneath it",
    source="rocking stiffness of a bedded slab: Winkler's bed; range of shake tables and grouted slabs",
    parameters=(
        EffectParameter("compliance", "rad/(N m)", "rotation of the base by moment", 0.0, 0.0, 6e-9, 2e-9),
    ),
    confused_with=("table-pitch", "joint-compliance"),
    distinguished_by="vertical displacement of two markers on the slab, apart along x, under blocks of another mass",
    places=nowhere,
    act=_act,
    turns=_turns,
    reads=lambda values, size, between: {"compliance": np.maximum(size, 0.0)},
)
