"""A block is heavier than the model has it: another density, a lifting frame, instruments, water.

A lighter block is not tried: as an amplitude of either sign the column took up lost friction, at sizes beyond sense.
"""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import blocks
from blockshake.forces.seen.wrench_histories import heavier

_SCALE = 0.2  # of the block's mass
HEIGHTS = (0.0, 0.42)  # of what is added or lacks, above the mass centre, over the block's height


def _act(experiment, values, place):
    """The block heavier, and its mass centre drawn to where the mass is added, by default the mass centre itself."""
    share = values["excess"]
    if share == 0.0:
        return experiment
    structure, file = experiment.structure, experiment.structure.file
    body = file.bodies[structure.body_names.index(place["body"])]
    tall = float(np.ptp(structure.solids[body.shape].vertices[:, 2]))
    raised = place.get("height", 0.0) * tall * share / (1.0 + share)
    density = body.density or file.materials[body.material].density
    x, y, z = body.mass_offset
    return experiment.with_parameters(
        **{
            f"bodies.{body.name}.density": density * (1.0 + share),
            f"bodies.{body.name}.mass_offset": [x, y, z + raised],
        }
    )


def _columns(seen, place):
    """``-(a - g)`` of the point, times the block's mass."""
    body = seen.structure.body_names.index(place["body"])
    solid = seen.structure.solids[seen.structure.file.bodies[body].shape]
    above = place["height"] * float(np.ptp(solid.vertices[:, 2]))
    rows = seen.rows.along(heavier(seen, body, above))
    return [DesignMatrix({}, rows[:, None], (_SCALE,), True)]


EFFECT = Effect(
    name="block-mass",
    title="mass of a block",
    acts="geometry",
    equation="mass of the block = (1 + e) m; what is added lies in the block's middle, or near its top",
    source="Newton and Euler; densities scatter by 4 % in Zhou et al. (2023), Table 2",
    parameters=(EffectParameter("excess", "1", "of the mass over the stated one", 0.0, 0.0, 0.6, 0.2),),
    confused_with=("eccentricity",),
    distinguished_by="weighing the block",
    places=blocks,
    seen_at=lambda structure: [{**place, "height": height} for place in blocks(structure) for height in HEIGHTS],
    act=_act,
    columns=_columns,
    reads=lambda values, size, between: {"excess": np.maximum(size, 0.0)},
)  # fmt: skip
